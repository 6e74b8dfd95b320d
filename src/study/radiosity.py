"""Light between surfaces: what smaller cells buy, and what they cost."""

import os

import pictures
import runs
from settings import DEFAULT
from text import count, table

SCENE = "scenes/cornell.nff"
EDGES = [1.2, 0.6, 0.3, 0.15]
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
    scenes = {edge: write(edge) for edge in EDGES}
    built = {edge: runs.Run("mps2_an385", scene, "q32", "32x24", build_only=True) for edge, scene in scenes.items()}
    runs.perform(list(built.values()))
    rows = []
    for edge, scene in scenes.items():
        said = pictures.draw(scene, SIZE, DEFAULT, to=f"{FOLDER}/own.ppm")
        own = pictures.read(f"{FOLDER}/own.ppm")
        rows.append([f"`radiosity {edge}`", f"{pictures.errors(own, truth)['psnr']:.1f} dB", count(said["radiosity_cells"]),
                     f"{said['radiosity_seconds']:.1f} s", count(built[edge].result["flash"])])
    return (f"`{SCENE}` in `q32`, {SIZE.replace('x', ' × ')} pixels, against `radiosity {TRUTH}` in `double`; "
            "seconds are this machine's, with all its threads:\n\n"
            + table(["cells' edges", "PSNR", "cells", "solved in", "M3 flash"], rows))


REPORTS = {"radiosity": (report, lambda: [f"| `radiosity {edge}` |" for edge in EDGES])}
