"""Pictures that the command draws on this machine, and how far two are apart."""

import json
import math
import os
import subprocess
import tempfile

import numpy
from PIL import Image

from programs import output_of, values


def words(setting):
    """Options of the command for a setting, as settings.DEFAULT."""
    number, samples, depth, cutoff = setting
    sampling = ["-a", samples[1:]] if samples[0] == "a" else ["-r", samples]
    return ["-n", number, *sampling, "-d", str(depth), "--cutoff", str(cutoff)]


def draw(scene, size, setting, *more, to="/dev/null"):
    """What the command says of a picture, {name: number}; None where the scene does not fit the number system."""
    done = subprocess.run(["build/qray", scene, "-q", "--stats", "-s", size, *words(setting), *more, "-o", to],
                          capture_output=True, text=True)
    if done.returncode == 0:
        return values(done.stderr)


def read(path):
    """A PPM's levels."""
    return numpy.asarray(Image.open(path)).astype(int)


def decibels(mean_square):
    """PSNR; pictures without a difference have 99."""
    return min(99, 10 * math.log10(255 ** 2 / mean_square)) if mean_square else 99


def flip(truth, *others):
    """[{flip, seen}] of PPMs: the mean of FLIP, and the share of pixels above the threshold of seeing (flip.hpp)."""
    found = map(json.loads, output_of("build/study/flip", truth, *others).splitlines())
    return [{k: of[k] for k in ("flip", "seen")} for of in found]


def errors(picture, truth):
    """PSNR, root mean square and largest difference in levels, the share of pixels off by more than 2, and FLIP."""
    off = abs(picture - truth)
    square = float((off ** 2).mean())
    with tempfile.TemporaryDirectory() as folder:
        paths = [os.path.join(folder, name) for name in ("truth.ppm", "picture.ppm")]
        for path, levels in zip(paths, (truth, picture)):
            Image.fromarray(levels.astype("uint8")).save(path)
        return {"psnr": decibels(square), "rms": math.sqrt(square), "largest": int(off.max()),
                "off": float((off.max(2) > 2).mean()), **flip(*paths)[0]}
