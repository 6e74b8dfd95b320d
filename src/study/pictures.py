"""Pictures that the command draws on this machine, and how far two are apart."""

import math
import re
import subprocess

import numpy
from PIL import Image


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
        return {k: float(v) for k, v in re.findall(r"^([\w/]+): ([\d.]+)$", done.stderr, re.M)}


def read(path):
    """A PPM's levels."""
    return numpy.asarray(Image.open(path)).astype(int)


def decibels(mean_square):
    """PSNR; pictures without a difference have 99."""
    return min(99, 10 * math.log10(255 ** 2 / mean_square)) if mean_square else 99


def errors(picture, truth):
    """PSNR, root mean square and largest difference in levels, and the share of pixels off by more than 2."""
    off = abs(picture - truth)
    square = float((off ** 2).mean())
    return {"psnr": decibels(square), "rms": math.sqrt(square), "largest": int(off.max()),
            "off": float((off.max(2) > 2).mean())}
