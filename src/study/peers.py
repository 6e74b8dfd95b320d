"""make peers PEERS=folder: the command beside POV-Ray and Embree, one thread, 512 x 512, into src/study/README.md

The folder holds NAME.nff.xz and NAME.pov.xz, and embree.cpp, which says '... Mrays/s' of a scene; Debian's packages
povray, libembree-dev and xz-utils are needed. Where one of these is not there a line says so, and nothing is
written."""

import os
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import report  # noqa: E402
from tables import table  # noqa: E402

POV = ["balls_4", "gears_4", "mount_6", "rings_7", "teapot_12", "tetra_6", "tree_11"]
EMBREE = ["balls_1", "balls_3", "balls_4", "balls_5", "teapot_12", "tetra_6", "tetra_8"]
NUMBERS = ["float", "q32"]
SIZE, ROUNDS = 512, 7


def missing(folder):
    """What is not there, or None."""
    needed = [f"{s}.nff.xz" for s in {*POV, *EMBREE}] + [f"{s}.pov.xz" for s in POV] + ["embree.cpp"]
    absent = sorted(f for f in needed if not os.path.exists(os.path.join(folder, f)))
    if absent:
        return f"no {absent[0]} in '{folder}'; give their folder with PEERS=folder"
    tools = [t for t in ("povray", "xz", "g++") if shutil.which(t) is None]
    if tools:
        return f"no {tools[0]}; install povray, libembree-dev and xz-utils"
    return None


def timed(command):
    """CPU seconds of the whole process, and what it said."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, result.stdout + result.stderr


def measured(folder):
    def ours(scene, number):
        return timed(["build/qray", f"{folder}/{scene}.nff", "-s", f"{SIZE}x{SIZE}", "-n", number, "-j", "1", "--stats",
                      "-q", "-o", f"{folder}/picture.ppm"])

    def row(scene, form, rounds):
        """Medians of our own figures and of the peer's, and of their ratios in each round."""
        columns = [statistics.median(c) for c in zip(*rounds)]
        ratios = [statistics.median(form(r[0], own) for r in rounds for own in [r[1 + i]]) for i in range(len(NUMBERS))]
        return [scene] + [f"{c:.2f}" for c in columns] + [f"{r:.2f}" for r in ratios]

    seconds, rates = [], []
    for s in POV:
        pov = ["povray", f"+I{folder}/{s}.pov", f"+W{SIZE}", f"+H{SIZE}", "-D", f"+O{folder}/picture.png", "+WT1",
               "-GA"]
        seconds.append(row(s, lambda peer, own: peer / own,
                           [[timed(pov)[0]] + [ours(s, n)[0] for n in NUMBERS] for _ in range(ROUNDS)]))
    for s in EMBREE:
        def rate(text):
            return float(re.search(r"rays/second: *(\d+)", text)[1]) / 1e6

        embree = [f"{folder}/embree", f"{folder}/{s}.nff", str(SIZE)]
        rates.append(row(s, lambda peer, own: own / peer,
                         [[float(re.search(r"([\d.]+) Mrays/s", timed(embree)[1])[1])]
                          + [rate(ours(s, n)[1]) for n in NUMBERS] for _ in range(ROUNDS)]))
    return (f"CPU seconds of the whole process, {SIZE} × {SIZE} pixels, one thread:\n\n"
            + table(["scene", "POV-Ray", *NUMBERS] + [f"POV-Ray/{n}" for n in NUMBERS], seconds)
            + "\nMillion rays a second while tracing, beside single-ray calls with next to no shading:\n\n"
            + table(["scene", "Embree", *NUMBERS] + [f"{n}/Embree" for n in NUMBERS], rates))


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else ""
    why = missing(folder)
    if why is not None:
        print(f"peers are not measured: {why}")
        return 0
    with tempfile.TemporaryDirectory() as unpacked:
        for f in os.listdir(folder):
            if f.endswith(".xz"):
                with open(f"{unpacked}/{f[:-3]}", "wb") as out:
                    subprocess.run(["xz", "-dc", os.path.join(folder, f)], stdout=out, check=True)
        made = subprocess.run(["g++", "-O3", "-march=native", "-w", os.path.join(folder, "embree.cpp"), "-lembree3",
                               "-o", f"{unpacked}/embree"], capture_output=True)
        if made.returncode != 0:
            print("peers are not measured: embree.cpp does not compile; install libembree-dev")
            return 0
        os.makedirs(report.FOLDER, exist_ok=True)
        report.put("peers", measured(unpacked), f"{report.FOLDER}/peers.md")
    return 0


if __name__ == "__main__":
    sys.exit(main())
