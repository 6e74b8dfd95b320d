"""make report: measures what README.md's tables say and writes them between their markers,

    <!-- report:NAME -->  ...  <!-- /report -->

report.py [NAME...]    only these; report.py --check    only that each marker holds all that it should name"""

import os
import re
import sys

sys.dont_write_bytecode = True
import floor  # noqa: E402
import ladder  # noqa: E402
import runs  # noqa: E402
import text as texts  # noqa: E402
from text import count, table  # noqa: E402

README = "README.md"
FOLDER = "build/study"
# Scenes of the table of boards, and the size that all their firmwares share.
BOARD_SCENES = {"scenes/floor.nff": "32x24", "scenes/showcase.nff": "16x12"}


def boards():
    out = []
    plan = [(scene, board, number, runs.Run(board, scene, number, size, rays=True))
            for scene, size in BOARD_SCENES.items() for board in runs.BOARDS for number in runs.numbers()]
    runs.perform([run for *_, run in plan])
    for scene, size in BOARD_SCENES.items():
        rows = []
        for at, board, number, run in plan:
            if at != scene:
                continue
            r = run.result
            if "refused" in r:
                rows.append([runs.BOARDS[board], number] + ["–"] * 5)
                continue
            rows.append([runs.BOARDS[board], number, count(r["flash"]), count(r["ram"]), count(r["stack"]),
                         count(r["instructions/pixel"]), count(r["instructions/ray"])])
        head = ["board", "number", "flash", "RAM", "stack", "instructions/pixel", "instructions/ray"]
        out.append(f"`{scene}`, {size.replace('x', ' × ')} pixels, one sample:\n\n{table(head, rows)}")
    return "\n".join(out)


def effects():
    steps = ladder.write(f"{FOLDER}/ladder")
    boards_shown = ["microbit", "mps2_an385"]
    plan = {(path, board): runs.Run(board, path, "q32", "32x24", **options)
            for _, path, options in steps for board in boards_shown}
    runs.perform(list(plan.values()))
    rows, before = [], None
    for name, path, options in steps:
        now = [plan[path, board].result[key] for board in boards_shown
               for key in ("flash", "stack", "instructions/pixel")]
        if before is None:
            rows.append([name] + [count(v) for v in now])
        else:
            rows.append(["+ " + name] + [f"{round(b - a):+,}".replace(",", " ").replace("-", "−")
                                         for a, b in zip(before, now)])
        before = now
    rows.append(["all"] + [count(v) for v in before])
    head = ["effect"] + [f"{runs.BOARDS[b]} {what}" for b in boards_shown
                         for what in ("flash", "stack", "instructions/pixel")]
    return (f"{ladder.TITLE} q32, 32 × 24 pixels:\n\n" + table(head, rows))


# What README may hold, and the words that its text must hold to be whole.
REPORTS = {
    "boards": (boards, lambda: list(BOARD_SCENES) + [f"| {short} | {n} |" for short in runs.BOARDS.values()
                                                     for n in runs.numbers()]),
    **texts.REPORTS,
    **floor.REPORTS,
    "effects": (effects, lambda: ["+ " + name for name, *_ in ladder.STEPS[1:]]),
}


def marker(name):
    return re.compile(rf"(<!-- report:{re.escape(name)} -->\n).*?(<!-- /report -->)", re.S)


def problems(text, reports):
    """What is missing or not known in README's tables."""
    out = []
    for name, content in re.findall(r"<!-- report:(\S+) -->(.*?)<!-- /report -->", text, re.S):
        if name not in reports and not content.strip():
            out.append(f"{README}: report:{name} is empty")
    for name, (_, needs) in reports.items():
        found = marker(name).search(text)
        if found is None:
            out.append(f"{README}: no '<!-- report:{name} -->' ... '<!-- /report -->'")
            continue
        out += [f"{README}: report:{name} says nothing of '{n}'; `make report` writes it again"
                for n in needs() if n not in found[0]]
    return out


def put(name, made, path):
    """Writes a report to a file of its own and between its markers in README, if that has them."""
    with open(path, "w") as file:
        file.write(made)
    text = ""
    if os.path.exists(README):  # as it is now: others may have edited it meanwhile
        with open(README) as file:
            text = file.read()
    new, number = marker(name).subn(lambda m: m[1] + made + m[2], text)
    if number == 0:
        print(f"{README} has no '<!-- report:{name} -->'; see {path}", file=sys.stderr)
    elif new != text:
        with open(README + ".part", "w") as file:
            file.write(new)
        os.replace(README + ".part", README)


def main():
    text = ""
    if os.path.exists(README):
        with open(README) as file:
            text = file.read()
    if sys.argv[1:] == ["--check"]:
        found = problems(text, REPORTS)
        print("\n".join(found) if found else "all reports are whole")
        return found != []
    names = sys.argv[1:] or list(REPORTS)
    os.makedirs(FOLDER, exist_ok=True)
    for name in names:
        if name not in REPORTS:
            runs.fail(f"there is no report '{name}'; reports are {', '.join(REPORTS)}")
        made = REPORTS[name][0]()
        put(name, made, f"{FOLDER}/{name}.md")
    return runs.failures != []


if __name__ == "__main__":
    sys.exit(main())
