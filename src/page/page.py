"""Puts the page together in one file: page.py OUTPUT. Text, script and style as they are, the tracer packed."""

import base64
import glob
import gzip
import json
import os
import re
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "study"))
from cycles import PARTS  # noqa: E402
from settings import BOARDS  # noqa: E402

STUDY = "src/study/README.md"


def table(report):
    """Rows of the study's tables of boards, {heading: cell}, each with the scene that is named above it."""
    scene = head = None
    for line in read(STUDY).split(f"<!-- report:{report} -->")[1].split("<!-- /report -->")[0].splitlines():
        cells = [cell.strip() for cell in line.split("|")[1:-1]]
        if title := re.match(r"`scenes/(\S+)\.nff`", line):
            scene = title[1]
        elif "board" in cells or "core" in cells or not cells:
            head = cells
        elif head and not set("".join(cells)) <= set("-:"):
            yield dict(zip(head, cells), scene=scene)


def count(cell):
    return int(re.sub(r"\D", "", cell))


def costs():
    """{board: {number: {"rays": {scene: instructions a ray}, "cycles": of an instruction}}}"""
    names = {label: board for board, label in BOARDS.items()}
    found = {board: {} for board in BOARDS}
    for row in table("boards"):
        own = found[names[row["board"]]].setdefault(row["number"], {"rays": {}, "cycles": 1})
        own["rays"][row["scene"]] = count(row["instructions/ray"])
    for row in table("study"):
        both = [sum(count(cell) for head, cell in row.items() if str(head).endswith(f"{what}/pixel"))
                for what in ("cycles", "instructions")]
        found[names[row["board"]]][row["number"]]["cycles"] = round(both[0] / both[1], 3)
    for row in table("time"): # cores that the study has not
        own = found[names[row["core"]]].get(row["number"])
        if own and own["cycles"] == 1:
            cycles = count(row["cycles/pixel"].split("(")[0])
            own["cycles"] = round(cycles / count(row["instructions/pixel"]), 3)
    if not all(found.values()):
        sys.exit(f"{STUDY}: no table of boards with instructions a ray for each of {', '.join(BOARDS.values())}")
    return found


def read(path, mode="r"):
    with open(path, mode, encoding=None if "b" in mode else "utf-8") as file:
        return file.read()


def packed(data):
    return base64.b64encode(data).decode()


def main():
    output, = sys.argv[1:]
    scenes = {os.path.basename(path)[:-4]: read(path) for path in sorted(glob.glob("scenes/*.nff"))}
    named = {word for text in scenes.values() for word in re.sub("#.*", "", text).split()}
    data = {
        "wasm": packed(gzip.compress(read("build/page/qray.wasm", "rb"), mtime=0)),
        "scenes": scenes,
        "files": {name: packed(read(f"scenes/{name}", "rb")) for name in sorted(os.listdir("scenes")) if name in named},
        "costs": costs(),
        "boards": BOARDS,
        "parts": {board: {"name": PARTS[board].name, "mhz": PARTS[board].clock / 1e6} for board in BOARDS},
    }
    parts = {name: read(f"{HERE}/{name}") for name in ("page.css", "worker.js", "page.js")}
    parts["data"] = json.dumps(data, ensure_ascii=False).replace("</", "<\\/")
    page = read(f"{HERE}/page.html")
    for name, text in parts.items():
        assert "</script" not in text and "</style" not in text
        page = page.replace(f"/*{name}*/", text)
    with open(output, "w", encoding="utf-8") as file:
        file.write(page)


main()
