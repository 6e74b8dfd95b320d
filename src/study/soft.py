"""Soft shadows: what more places of a panel, and more samples a pixel, buy."""

import os

import pictures
import runs
from settings import DEFAULT
from tables import table

SCENE, SIZE = "scenes/soft.nff", "80x60"
PLACES, MOST = [1, 2, 3, 4, 8], 16
SAMPLES = ["1", "4", "16"]
FOLDER = "build/study/soft"


def drawn(places, samples):
    """The scene with a panel of so many places along an edge."""
    path = f"{FOLDER}/soft-{places}"
    with open(path + ".nff", "w") as file:
        file.write(runs.text_of(SCENE).replace("\npanel 3 ", f"\npanel {places} "))
    pictures.draw(path + ".nff", SIZE, DEFAULT._replace(samples=samples), to=path + ".ppm")
    return pictures.read(path + ".ppm")


def report():
    os.makedirs(FOLDER, exist_ok=True)
    truth = {samples: drawn(MOST, samples) for samples in SAMPLES}
    rows = [[f"`panel {places}`"] + [f"{pictures.errors(drawn(places, s), truth[s])['psnr']:.1f} dB" for s in SAMPLES]
            for places in PLACES]
    return (f"`{SCENE}` in `q32`, {SIZE.replace('x', ' × ')} pixels, against {MOST} × {MOST} places and as many "
            "samples:\n\n"
            + table(["places", *(f"{s} sample{'s' * (s != '1')}" for s in SAMPLES)], rows))


REPORTS = {"soft": (report, lambda: [f"| `panel {places}` |" for places in PLACES])}
