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
from settings import BOARDS  # noqa: E402

STUDY = "src/study/README.md"


def costs():
    """Instructions a ray from the study's table of boards: {board: {number: {scene: instructions}}}."""
    with open(STUDY, encoding="utf-8") as file:
        table = file.read().split("<!-- report:boards -->")[1].split("<!-- /report -->")[0]
    names = {label: board for board, label in BOARDS.items()}
    found = {board: {} for board in BOARDS}
    scene = column = None
    for line in table.splitlines():
        cells = [cell.strip() for cell in line.split("|")[1:-1]]
        if title := re.match(r"`scenes/(\S+)\.nff`", line):
            scene = title[1]
        elif "instructions/ray" in cells:
            column = cells.index("instructions/ray")
        elif cells and cells[0] in names:
            found[names[cells[0]]].setdefault(cells[1], {})[scene] = int(re.sub(r"\D", "", cells[column]))
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
