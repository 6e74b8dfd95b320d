"""make report: measures what the tables of README.md and src/study/README.md say and writes them between their markers,

    <!-- report:NAME -->  ...  <!-- /report -->

report.py [NAME...]    only these"""

import os
import re
import sys

sys.dont_write_bytecode = True
import ladder  # noqa: E402
import runs  # noqa: E402
import text as texts  # noqa: E402
from text import count, table  # noqa: E402

PAGES = ["README.md", "src/study/README.md"]
FOLDER = "build/study"
# Scenes of the table of boards, and the size that all their firmwares share.
BOARD_SCENES = {"scenes/floor.nff": "32x24", "scenes/showcase.nff": "16x12"}


def boards():
    out = []
    plan = [(scene, board, number, runs.Run(board, scene, number, size))
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


# What the pages may hold, and the words that its text must hold to be whole.
REPORTS = {
    "boards": (boards, lambda: list(BOARD_SCENES) + [f"| {short} | {n} |" for short in runs.BOARDS.values()
                                                     for n in runs.numbers()]),
    **texts.REPORTS,
    "effects": (effects, lambda: ["+ " + name for name, *_ in ladder.STEPS[1:]]),
}


def marker(name):
    return re.compile(rf"(<!-- report:{re.escape(name)} -->\n).*?(<!-- /report -->)", re.S)


def pages():
    """The pages that hold tables, as one text."""
    return "".join(runs.text_of(page) for page in PAGES)


def put(name, made, path):
    """Writes a report to a file of its own and between its markers, in the page that has them."""
    with open(path, "w") as file:
        file.write(made)
    for page in filter(os.path.exists, PAGES):
        text = runs.text_of(page)  # as it is now: others may have edited it meanwhile
        # Paths of figures are those of the repository; a page says them from where it stands.
        here = made.replace("](src/study/", "](") if page.startswith("src/study/") else made
        new, number = marker(name).subn(lambda m: m[1] + here + m[2], text)
        if new != text:
            with open(page + ".part", "w") as file:
                file.write(new)
            os.replace(page + ".part", page)
        if number:
            return
    print(f"no page has '<!-- report:{name} -->'; see {path}", file=sys.stderr)


def main():
    names = sys.argv[1:] or list(REPORTS)
    os.makedirs(FOLDER, exist_ok=True)
    for name in names:
        if name not in REPORTS:
            runs.fail(f"there is no report '{name}'; reports are {', '.join(REPORTS)}")
        put(name, REPORTS[name][0](), f"{FOLDER}/{name}.md")
    return runs.failures != []


if __name__ == "__main__":
    sys.exit(main())
