"""make study: what accuracy costs, on this machine and on the boards, as CSV and plots in build/study.

One dial at a time is turned around the default (q32, 1 sample, depth 5, cutoff 0.0014). Cost is measured on
small pictures; error on larger ones of the same scene and settings, on this machine, as the boards draw the
same bytes. study.py [quick]: one scene, small pictures, few settings"""

import csv
import functools
import glob
import math
import os
import subprocess
import sys

sys.dont_write_bytecode = True
import bits  # noqa: E402
import figures  # noqa: E402
import pictures  # noqa: E402
import runs  # noqa: E402
from settings import DEFAULT, STUDIED as BOARDS, Setting, options  # noqa: E402

FOLDER = "build/study"
BEST = Setting("double", "256", 8, DEFAULT.cutoff)  # what total errors are against
# Scenes of the boards, and the size of their pictures there.
SCENES = {"scenes/floor.nff": "32x24", "scenes/glass.nff": "24x18", "scenes/showcase.nff": "24x18"}
ERROR_SIZE = "160x120"


def settings(quick=False):
    if quick:
        return [DEFAULT, DEFAULT._replace(number="float"), DEFAULT._replace(samples="4")]
    out = [DEFAULT._replace(number=n) for n in runs.numbers()]
    out += [DEFAULT._replace(samples=s) for s in ("4", "9", "16", "a2,0.0625", "a3,0.03125")]
    out += [DEFAULT._replace(number=n, samples=s) for n in runs.numbers() if n not in (DEFAULT.number, "double")
            for s in ("4", "a2,0.0625")]
    out += [DEFAULT._replace(depth=d) for d in (1, 2, 3)]
    return out + [DEFAULT._replace(cutoff=0.02)]


def traced_size(board, number):
    """Of a picture that is traced: the slower the arithmetic, the smaller."""
    if number == "double":
        return "6x4"
    return "8x6" if number == "float" and board != "mps2_an386" else "12x9"


def commit():
    done = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True)
    if done.returncode != 0:
        return "unknown"
    changed = subprocess.run(["git", "status", "--porcelain", "--", "include", "src"], capture_output=True,
                             text=True)
    return done.stdout.strip() + ("+changes" if changed.stdout.strip() else "")


def board_flags(board):
    facts = runs.board_facts(board)
    return f"{facts['cpu']} {facts['optimise']} -std=c++20 -ffreestanding -ffp-contract=off"


def desktop(scene, size, wanted, total=True):
    """{setting: {rays, time/float, arithmetic psnr, ..., other objects}}, or {} where it does not fit."""
    path = "{}/{}.json".format(runs.CACHE, runs.hash_of(
        runs.tree_hash("include", "src/scene", "src/cli", "src/study/measure.cpp", "src/study/flip.hpp"),
        runs.text_of("build/obj/flags"),
        runs.scene_text(scene), size, wanted, total))
    if not os.path.exists(path):
        runs.keep(path, measure_desktop(scene, size, wanted, total))
    return {Setting(*setting): values for setting, values in runs.kept(path)}


def measure_desktop(scene, size, wanted, total):
    @functools.cache
    def drawn(setting):
        to = f"{FOLDER}/desktop.ppm"
        said = pictures.draw(scene, size, setting, to=to)
        return said and {**said, "picture": pictures.read(to)}

    # Of one thread, the best of three tries.
    def speed(setting):
        return max(pictures.draw(scene, size, setting, "-j", "1")["rays/second"] for _ in range(3))

    centres = [DEFAULT._replace(number=n) for n in runs.numbers()]
    _, *combs = runs.measure(0, 1 << 31, scene, size, DEFAULT._replace(number="double"), *centres)
    others = {n: sum(other for *_, other in of) for n, of in zip(runs.numbers(), combs)}
    out = []
    for setting in wanted:
        own, values = drawn(setting), {}
        exact, single = (setting._replace(number=n) for n in ("double", "float"))
        if own:
            time = own["rays"] / speed(setting) * speed(single) / drawn(single)["rays"]
            values = {"rays": own["rays"], "time/float": round(time, 3)}
            for kind, truth in [("arithmetic", exact)] + [("total", BEST)] * total:
                errors = pictures.errors(own["picture"], drawn(truth)["picture"])
                values.update({f"{kind} {name}": round(value, 6) for name, value in errors.items()})
            values["other objects"] = others[setting.number]
        out.append((setting, values))
    return out


class Study:
    def __init__(self, quick):
        self.quick = quick
        self.folder = FOLDER + ("/quick" if quick else "")
        os.makedirs(self.folder, exist_ok=True)
        os.makedirs(runs.CACHE, exist_ok=True)
        self.scenes = {"scenes/floor.nff": "16x12"} if quick else SCENES
        self.error_size = "48x36" if quick else ERROR_SIZE
        self.settings = settings(quick)
        self.inputs = runs.Inputs()
        self.errors, self.everywhere, self.rows, self.profiles = {}, {}, [], {}

    def measure_desktop(self):
        for scene in self.scenes:
            print(f"errors of {scene}", file=sys.stderr, flush=True)
            self.errors[scene] = desktop(scene, self.error_size, self.settings)
        numbers = [DEFAULT._replace(number=n) for n in runs.numbers()]
        for scene in self.scenes if self.quick else sorted(glob.glob("scenes/*.nff")):
            self.everywhere[scene] = desktop(scene, self.error_size, numbers, total=scene in self.errors)

    def measure_boards(self):
        plan = {(scene, board, setting): runs.Run(board, scene, setting.number, size, **options(setting))
                for scene, size in self.scenes.items() for board in BOARDS for setting in self.settings}
        numbers = dict.fromkeys(s.number for s in self.settings)
        first = next(iter(self.scenes))
        traced = {(scene, board, n): runs.Run(board, scene, n, traced_size(board, n), profile=True)
                  for scene in self.scenes for board in BOARDS for n in numbers
                  if not (n == "double" and scene != first)}
        runs.perform(list(plan.values()) + list(traced.values()), inputs=self.inputs)
        self.profiles = {k: r.result for k, r in traced.items() if "refused" not in r.result}
        for (scene, board, setting), run in plan.items():
            if "refused" in run.result:
                continue
            r, e = run.result, self.errors[scene][setting]
            near = self.profiles.get((scene, board, setting.number)) or self.profiles[first, board, setting.number]
            # What a pixel of the larger picture takes: adaptive sampling needs more in a small one.
            pixels = math.prod(map(int, self.error_size.split("x")))
            per_ray = r["instructions"] / r["rays"]
            large = per_ray * e["rays"] / pixels
            per, jumps = (near[k] / near["instructions"] for k in ("cycles", "jumps"))
            self.rows.append({
                "scene": scene, "size": run.size, "board": board, **setting._asdict(),
                "instructions/pixel": r["instructions/pixel"], "instructions/ray": round(per_ray, 1),
                "cycles/pixel": round(r["instructions/pixel"] * per, 1),
                "instructions/pixel at error size": round(large, 1),
                "cycles/pixel at error size": round(large * per, 1),
                "cycles/pixel and wait state": round(large * jumps, 1),
                "flash": r["flash"], "ram": r["ram"], "stack": r["stack"], **e, "setting": setting})

    def write_csv(self):
        at, own = commit(), runs.text_of("build/obj/flags").strip()
        compiler, flags = own.split(" ", 1)
        compiler = runs.output_of(compiler, "--version").splitlines()[0]
        self.write_table("boards.csv", [
            {**row, "error size": self.error_size, "compiler": self.inputs.compiler(row["board"]),
             "flags": board_flags(row["board"]), "commit": at} for row in self.rows], {"setting", "rays", "time/float"})
        self.write_table("desktop.csv", [
            {"scene": scene, "size": self.error_size, **setting._asdict(), **values, "compiler": compiler,
             "flags": flags, "commit": at}
            for scene in self.everywhere
            for setting, values in {**self.everywhere[scene], **self.errors.get(scene, {})}.items() if values])

    def write_table(self, name, rows, without=()):
        with open(f"{self.folder}/{name}", "w", newline="") as file:
            names = [n for n in max(rows, key=len) if n not in without]
            out = csv.DictWriter(file, names, restval="nan", extrasaction="ignore")
            out.writeheader()
            out.writerows(rows)

    def draw(self, folder):
        os.makedirs(folder, exist_ok=True)
        for board in BOARDS:
            figures.frontier(self, board, f"{folder}/{runs.BOARDS[board].lower()}.svg")
        figures.bits(self, f"{folder}/bits.svg")
        figures.samples(self, f"{folder}/samples.svg")
        figures.panel(self, f"{folder}/panel.svg")


def run(quick=False):
    study = Study(quick)
    study.measure_desktop()
    study.measure_boards()
    study.write_csv()
    return study


def main():
    quick = sys.argv[1:] == ["quick"]
    study = run(quick)
    study.draw(study.folder)
    bits.study(study.folder, quick)
    print(f"{len(study.rows)} settings of boards in {study.folder}/boards.csv; plots beside it")


if __name__ == "__main__":
    main()
    sys.exit(runs.failures != [])
