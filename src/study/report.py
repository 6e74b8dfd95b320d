"""make report: measures what the tables of README.md and src/study/README.md say and writes them between their markers,

    <!-- report:NAME -->  ...  <!-- /report -->

report.py [NAME...]    only these"""

import os
import re
import sys

sys.dont_write_bytecode = True
import bits  # noqa: E402
import growth  # noqa: E402
import ladder  # noqa: E402
import moving  # noqa: E402
import radiosity  # noqa: E402
import runs  # noqa: E402
import soft  # noqa: E402
import text as texts  # noqa: E402
from tables import count, table  # noqa: E402

PAGES = ["README.md", "src/study/README.md"]
FOLDER = "build/study"
# Scenes of the table of boards, and the size that all their firmwares share.
BOARD_SCENES = {"scenes/floor.nff": "32x24", "scenes/knot.nff": "32x24", "scenes/showcase.nff": "16x12"}


def boards():
    plan = {(scene, board, number): runs.Run(board, scene, number, size) for scene, size in BOARD_SCENES.items()
            for board in runs.BOARDS for number in runs.numbers()}
    runs.perform(list(plan.values()))
    figures = ["flash", "RAM", "stack", "instructions/pixel", "instructions/ray"]
    out = []
    for scene, size in BOARD_SCENES.items():
        rows = [[runs.BOARDS[board], number]
                + ["–" if "refused" in run.result else count(run.result[f.lower()]) for f in figures]
                for (at, board, number), run in plan.items() if at == scene]
        out.append(f"`{scene}`, {size.replace('x', ' × ')} pixels, one sample:\n\n"
                   + table(["board", "number", *figures], rows))
    return "\n".join(out)


def effects():
    steps = ladder.write(f"{FOLDER}/ladder")
    figures = ["flash", "stack", "instructions/pixel"]
    columns = [(board, figure) for board in ("microbit", "mps2_an385") for figure in figures]
    plan = {(path, board): runs.Run(board, path, "q32", "32x24", **options)
            for _, path, options in steps for board in dict(columns)}
    runs.perform(list(plan.values()))
    found = [[plan[path, board].result[figure] for board, figure in columns] for _, path, _ in steps]
    rows = [[steps[0][0], *map(count, found[0])]]
    for (name, *_), before, now in zip(steps[1:], found, found[1:]):
        rows.append(["+ " + name] + [f"{round(b - a):+,}".replace(",", " ").replace("-", "−")
                                     for a, b in zip(before, now)])
    rows.append(["all", *map(count, found[-1])])
    head = ["effect"] + [f"{runs.BOARDS[board]} {figure}" for board, figure in columns]
    return f"{ladder.TITLE} q32, 32 × 24 pixels:\n\n" + table(head, rows)


# What the pages may hold, and the words that its text must hold to be whole.
REPORTS = {
    "boards": (boards, lambda: list(BOARD_SCENES) + [f"| {short} | {n} |" for short in runs.BOARDS.values()
                                                     for n in runs.numbers()]),
    **texts.REPORTS,
    **bits.REPORTS,
    **growth.REPORTS,
    **radiosity.REPORTS,
    **soft.REPORTS,
    **moving.REPORTS,
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
