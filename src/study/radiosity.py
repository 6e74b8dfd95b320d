"""Light between surfaces: what smaller cells buy, and what they cost."""

import os

import pictures
import runs
from settings import DEFAULT
from tables import count, table

SCENE = "scenes/cornell.nff"
EDGES = [1.2, 0.6, 0.3, 0.15]
BITS = [4, 2]
TRUTH, SIZE = 0.07, "160x160"
FOLDER = "build/study/radiosity"


def write(edge):
    """The scene with cells of that size."""
    os.makedirs(FOLDER, exist_ok=True)
    text = runs.text_of(SCENE)
    start = text.index("\nradiosity ") + 1
    path = f"{FOLDER}/cornell-{edge}.nff"
    with open(path, "w") as file:
        file.write(f"{text[:start]}radiosity {edge}{text[text.index(chr(10), start):]}")
    return path


def report():
    pictures.draw(write(TRUTH), SIZE, DEFAULT._replace(number="double"), to=f"{FOLDER}/truth.ppm")
    truth = pictures.read(f"{FOLDER}/truth.ppm")
    settings = [(edge, 8) for edge in EDGES] + [(EDGES[2], bits) for bits in BITS]
    scenes = {edge: write(edge) for edge in EDGES}
    built = {(edge, bits): runs.Run("mps2_an385", scenes[edge], "q32", "32x24", build_only=True, LIGHT_BITS=bits)
             for edge, bits in settings}
    runs.perform(list(built.values()))
    rows = []
    for edge, bits in settings:
        said = pictures.draw(scenes[edge], SIZE, DEFAULT, "--light-bits", str(bits), to=f"{FOLDER}/own.ppm")
        own = pictures.read(f"{FOLDER}/own.ppm")
        rows.append([f"`radiosity {edge}`", str(bits), f"{pictures.errors(own, truth)['psnr']:.1f} dB",
                     count(said["radiosity_cells"]), f"{said['radiosity_seconds']:.1f} s",
                     count(built[edge, bits].result["flash"])])
    return (f"`{SCENE}` in `q32`, {SIZE.replace('x', ' × ')} pixels, against `radiosity {TRUTH}` in `double`; "
            "seconds are this machine's, with all its threads; bits of a colour in the light maps by `--light-bits`, "
            "or `LIGHT_BITS=` of make:\n\n"
            + table(["cells' edges", "bits", "PSNR", "cells", "solved in", "M3 flash"], rows))


REPORTS = {"radiosity": (report, lambda: [f"| `radiosity {edge}` |" for edge in EDGES]
                          + [f"| `radiosity {EDGES[2]}` | {bits} |" for bits in BITS])}
