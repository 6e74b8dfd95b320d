"""What robustness costs in a whole picture: the firmware of a scene of balls and a plane, and the same with the
forms of a textbook in place of robust ones, in the same template and behind the same reject. Writes
build/robustness.md and, between its markers, the page that has them.

    lean.py [SCENE [WxH]]    of another such scene: prints only

A textbook's: b^2 - c and o + t d (lean/sphere.hpp), a disc without care for overflow (lean/disc.hpp), a threshold
on t in place of the known surface, no step off it, no unit length restored. Between these and the robust forms
stand mixed ones."""

import hashlib
import os
import re
import shutil
import sys
import textwrap

sys.dont_write_bytecode = True
sys.path.insert(0, "src/study")
sys.path.insert(0, "src/boards/common")
sys.path.insert(0, "tests/firmware")
import report  # noqa: E402
import runs  # noqa: E402
import test_catalogue  # noqa: E402
from tables import count, listed, table  # noqa: E402

FOLDER = "build/lean"
HEADERS = "tests/stability/lean"
SCENE, SIZE = "scenes/floor.nff", "64x48"
BOARDS = {"microbit": "M0", "mps2_an385": "M3", "rv32_virt": "RV32"}
# What a form has of the robust ones, and what that is called.
FORMS = {
    "robust": {"sphere", "disc", "known", "step", "unit"},
    "robust, but no unit length restored": {"sphere", "disc", "known", "step"},
    "robust, but no step off a surface": {"sphere", "disc", "known", "unit"},
    "textbook sphere, the rest robust": {"disc", "known", "step", "unit"},
    "textbook sphere and disc, surface known": {"known"},
    "textbook sphere, surface known": {"disc", "known"},
    "textbook": set(),
}


def change(path, changes):
    """Replaces in a file what each pattern finds, which must be one place."""
    with open(path) as file:
        text = file.read()
    for pattern, new in changes:
        text, number = re.subn(pattern, new, text, flags=re.S)
        if number != 1:
            runs.fail(f"{path} has {number} places like '{pattern}', not 1: bring lean.py up to date")
    with open(path, "w") as file:
        file.write(text)


def hollow(head, body):
    """The change that replaces the body of the function with this head."""
    return rf"({head}\n    \{{\n).*?(\n    \}}\n)", rf"\g<1>        {body}\g<2>"


# By header, in q32.
NO_STEPS = {"system": [hollow(r"constexpr Length leave\(Unit g\)", "return {g.raw & 0};")],
            "q32": [hollow(r"constexpr Length leave_along\(Unit d\)", "return {d.raw & 0};"),
                    (r"Unit steep\{one\.raw / 16\}", "Unit steep{0}")]}  # all may leave alike
NO_LENGTHS = {"q32": [hollow(r"constexpr void sharpen\(Unit& x, Unit& y, Unit& z\)",
                             "static_cast<void>(x.raw + y.raw + z.raw);")]}


def include(form):
    """A copy of include/ in which what a form has not is lean."""
    has = FORMS[form]
    folder = f"{FOLDER}/{'_'.join(['has', *sorted(has)])}"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree("include", folder)
    if "sphere" not in has:
        shutil.copy(f"{HEADERS}/sphere.hpp", f"{folder}/qray/shape")
        if "known" in has:
            change(f"{folder}/qray/shape/sphere.hpp", [(r"(lean_knows_surface = )false", r"\g<1>true")])
    if "disc" not in has:
        shutil.copy(f"{HEADERS}/disc.hpp", f"{folder}/qray/shape")
    for part, changes in (("step", NO_STEPS), ("unit", NO_LENGTHS)):
        for header in changes if part not in has else ():
            change(f"{folder}/qray/number/{header}.hpp", changes[header])
    return folder


class LeanRun(runs.Run):
    """A firmware run with headers of its own, which keeps what the picture was."""

    def __init__(self, folder, *arguments):
        super().__init__(*arguments)
        self.folder = folder

    def key(self, inputs):
        return hashlib.sha256((super().key(inputs) + runs.tree_hash(self.folder)).encode()).hexdigest()[:24]

    def command(self, name):
        return super().command(name) + [f"FW_INCLUDE={self.folder}"]

    def measure(self, command):
        found = super().measure(command)
        if "refused" not in found:
            name = next(c.removeprefix("NAME=") for c in command if c.startswith("NAME="))
            with open(f"build/{self.board}/{name}-{self.number}.ppm", "rb") as file:
                found["bytes"] = file.read().hex()
        return found


def measure(scene, size):
    """{form: {"runs": {board: instructions a ray}, "off": bytes, "fails": names}}"""
    os.makedirs(FOLDER, exist_ok=True)
    plan = {(f, b): LeanRun(include(f), b, scene, "q32", size) for f in FORMS for b in BOARDS}
    runs.perform(list(plan.values()))
    if runs.failures:
        runs.fail(f"{runs.failures[0][0]}: {runs.failures[0][1]}")
    right = bytes.fromhex(plan["robust", "microbit"].result["bytes"])
    out = {}
    for form in FORMS:
        pictures = [bytes.fromhex(plan[form, b].result["bytes"]) for b in BOARDS]
        _, _, fails = test_catalogue.run_catalogue("microbit", "q32", "lean", FW_INCLUDE=plan[form, "microbit"].folder)
        out[form] = {"runs": {b: plan[form, b].result["instructions/ray"] for b in BOARDS},
                     "off": max(sum(a != b for a, b in zip(p, right)) for p in pictures),
                     "fails": [name for name, _ in fails]}
    return out


def more(ours, theirs):
    return f"{100 * (ours / theirs - 1):+.0f} %".replace("-", "−")


def text(found, scene, size):
    ours = found["robust"]["runs"]

    def beside(forms):
        """What robust forms take more than the leanest of these, board by board."""
        least = {b: min(forms, key=lambda f: found[f]["runs"][b]) for b in BOARDS}
        return listed([f"{more(ours[b], found[least[b]]['runs'][b])} ({short})" for b, short in BOARDS.items()])

    same = [f for f in FORMS if found[f]["off"] == 0]
    sound = [f for f in same if not found[f]["fails"]]
    rows = [[form] + [count(r["runs"][b]) for b in BOARDS] + [count(r["off"]), count(len(r["fails"]))]
            for form, r in found.items()]
    fails = listed(sorted(set(found["textbook"]["fails"])))
    about = (f"In a whole picture, `{scene}` at {size.replace('x', ' × ')} in `q32`: instructions a ray with robust "
             "forms, with those of a textbook (b² − c, a threshold on t, a hit where o + td is, no step off a "
             "surface, no unit length restored), and with some of each, in the same tracer and behind the same "
             "reject; bytes of the picture that then differ, and how many of the exact hard cases "
             "(`tests/hard_catalogue.hpp`, on the M0) do not hold.")
    verdict = (f"Robust forms cost {beside(['textbook'])} beside the textbook's, {beside(sound)} beside the leanest "
               f"that hold the hard cases and draw the same bytes, and {beside(same)} beside the leanest that draw the "
               f"same bytes. The textbook fails in {fails}.")
    head = ["instructions/ray", *BOARDS.values(), "bytes off", "hard cases failed"]
    return "\n\n".join(textwrap.fill(part, 110, break_on_hyphens=False, break_long_words=False)
                       for part in (about, verdict)) + "\n\n" + table(head, rows)


def problems(readme):
    """What README's table lacks."""
    found = report.marker("robustness").search(readme)
    if found is None:
        return ["no '<!-- report:robustness -->' ... '<!-- /report -->'"]
    rows = {line.split("|")[1].strip(): line.count("|") for line in found[0].splitlines() if line.startswith("| ")}
    return [f"report:robustness has not one whole row '{form}'; `make robustness` writes it again"
            for form in FORMS if rows.get(form) != len(BOARDS) + 4]


def main():
    scene, size = (sys.argv[1:] + [SCENE, SIZE][len(sys.argv) - 1:])[:2]
    made = text(measure(scene, size), scene, size)
    print(made)
    if len(sys.argv) == 1:
        report.put("robustness", made, "build/robustness.md")


if __name__ == "__main__":
    main()
