"""make study: what accuracy costs, on this machine and on the boards, as CSV and plots in build/study.

One dial at a time is turned around the default (q32, 1 sample, depth 5, cutoff 0.0014). Cost is measured on
small pictures; error on larger ones of the same scene and settings, on this machine, as the boards draw the
same bytes. study.py [quick]: one scene, small pictures, few settings"""

import csv
import glob
import hashlib
import json
import math
import os
import subprocess
import sys

sys.dont_write_bytecode = True
import figures  # noqa: E402
import runs  # noqa: E402
from settings import DEFAULT, STUDIED as BOARDS, options  # noqa: E402

FOLDER = "build/study"
MEASURE = FOLDER + "/measure"
# Scenes of the boards, and the size of their pictures there.
SCENES = {"scenes/floor.nff": "32x24", "scenes/glass.nff": "24x18", "scenes/showcase.nff": "24x18"}
ERROR_SIZE = "160x120"
ERRORS = ["psnr", "rms", "largest", "off"]


def settings(quick=False):
    """As settings.DEFAULT."""
    number, samples, depth, cutoff = DEFAULT
    if quick:
        return [DEFAULT, ("float", samples, depth, cutoff), (number, "4", depth, cutoff)]
    out = [(n, samples, depth, cutoff) for n in runs.numbers()]
    out += [(number, s, depth, cutoff) for s in ("4", "9", "16", "a2,0.0625", "a3,0.03125")]
    out += [(n, "4", depth, cutoff) for n in runs.numbers() if n not in (number, "double")]
    out += [(number, samples, d, cutoff) for d in (1, 2, 3)]
    out += [(number, samples, depth, c) for c in (0.02,)]
    return out


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


def number(text):
    try:
        return float(text)
    except ValueError:
        return text


def desktop(scene, size, wanted, total=True):
    """{setting: {rays, time/float, arithmetic psnr, ..., other objects}}, or {} where it does not fit."""
    with open(scene, "rb") as file:
        text = file.read()
    key = hashlib.sha256(json.dumps([
        runs.tree_hash("include", "src/scene", "src/study/measure.cpp", "src/study/errors.hpp"), hashlib.sha256(text).hexdigest(), size, total,
        wanted, open("build/obj/flags").read()]).encode()).hexdigest()[:24]
    path = f"{runs.CACHE}/{key}.csv"
    if not os.path.exists(path):
        words = [f"{n}:{s}:{d}:{c}" for n, s, d, c in wanted]
        out = runs.output_of(MEASURE, *([] if total else ["-a"]), scene, size, *words)
        with open(path + ".part", "w") as file:
            # A setting holds a comma where it is adaptive.
            for line in out.splitlines()[1:]:
                for setting, word in zip(wanted, words):
                    if f",{word}," in line:
                        values = line.split(f",{word},")[1].split(",")
                        file.write(json.dumps([setting, values]) + "\n")
        os.replace(path + ".part", path)
    names = ["rays", "time/float"] + [f"{kind} {e}" for kind in ("arithmetic", "total") for e in ERRORS]
    out = {}
    with open(path) as file:
        for line in file:
            setting, values = json.loads(line)
            known = values != ["refused"]
            out[tuple(setting)] = dict(zip(names + ["other objects"], map(float, values))) if known else {}
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
        numbers = [(n, *DEFAULT[1:]) for n in runs.numbers()]
        for scene in self.scenes if self.quick else sorted(glob.glob("scenes/*.nff")):
            self.everywhere[scene] = desktop(scene, self.error_size, numbers, total=scene in self.errors)

    def measure_boards(self):
        plan = {(scene, board, setting): runs.Run(board, scene, setting[0], size, **options(setting))
                for scene, size in self.scenes.items() for board in BOARDS for setting in self.settings}
        numbers = [n for n in runs.numbers() if n in [s[0] for s in self.settings]]
        first = next(iter(self.scenes))
        traced = {(scene, board, n): runs.Run(board, scene, n, traced_size(board, n), profile=True)
                  for scene in self.scenes for board in BOARDS for n in numbers
                  if not (n == "double" and scene != first)}
        runs.perform(list(plan.values()) + list(traced.values()), inputs=self.inputs)
        self.profiles = {k: r.result for k, r in traced.items() if "refused" not in r.result}
        rays = {}
        for scene, size in self.scenes.items():
            rays[scene] = desktop(scene, size, self.settings, total=False)
        for (scene, board, setting), run in plan.items():
            if "refused" in run.result:
                continue
            r, e = run.result, self.errors[scene][setting]
            near = self.profiles.get((scene, board, setting[0])) or self.profiles[first, board, setting[0]]
            # What a pixel of the larger picture takes: adaptive sampling needs more in a small one.
            pixels = math.prod(map(int, self.error_size.split("x")))
            per_ray = r["instructions"] / rays[scene][setting]["rays"]
            large = per_ray * e["rays"] / pixels
            per = near["cycles"] / near["instructions"]
            self.rows.append({
                "scene": scene, "size": run.size, "board": board, "number": setting[0], "samples": setting[1],
                "depth": setting[2], "cutoff": setting[3], "instructions/pixel": r["instructions/pixel"],
                "instructions/ray": round(per_ray, 1), "cycles/pixel": round(r["instructions/pixel"] * per, 1),
                "instructions/pixel at error size": round(large, 1),
                "cycles/pixel at error size": round(large * per, 1),
                "flash": r["flash"], "ram": r["ram"], "stack": r["stack"], **e,
                "setting": setting})

    def write_csv(self):
        at = commit()
        with open(f"{self.folder}/boards.csv", "w", newline="") as file:
            names = [n for n in self.rows[0] if n not in ("setting", "rays", "time/float")]
            out = csv.writer(file)
            out.writerow(names + ["error size", "compiler", "flags", "commit"])
            for row in self.rows:
                out.writerow([row[n] for n in names] + [self.error_size, self.inputs.compiler(row["board"]),
                                                        board_flags(row["board"]), at])
        compiler, flags = open("build/obj/flags").read().strip().split(" ", 1)
        compiler = runs.output_of(compiler, "--version").splitlines()[0]
        with open(f"{self.folder}/desktop.csv", "w", newline="") as file:
            out = csv.writer(file)
            names = list(next(v for v in self.errors[next(iter(self.scenes))].values() if v))
            out.writerow(["scene", "size", "number", "samples", "depth", "cutoff"] + names
                         + ["compiler", "flags", "commit"])
            for scene in self.everywhere:
                for setting, values in {**self.everywhere[scene], **self.errors.get(scene, {})}.items():
                    if values:
                        out.writerow([scene, self.error_size, *setting, *values.values(), compiler, flags,
                                      at])

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
    print(f"{len(study.rows)} settings of boards in {study.folder}/boards.csv; plots beside it")


if __name__ == "__main__":
    main()
    sys.exit(runs.failures != [])
