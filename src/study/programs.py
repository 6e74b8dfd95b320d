"""Running other programs."""

import os
import re
import subprocess
import sys


def fail(text):
    raise SystemExit(f"{os.path.basename(sys.argv[0])}: {text}")


# What an outer make says to its own children, and what firmware is made of.
OUTER = {"MAKEFLAGS", "MAKELEVEL", "MFLAGS", "BOARD", "SCENE", "NUMBER", "SIZE", "SAMPLES", "ADAPTIVE", "DEPTH",
         "CUTOFF", "NAME", "OUTPUT"}


def environment():
    return {k: v for k, v in os.environ.items() if k not in OUTER}


def output_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True, env=environment()).stdout.strip()


def make(*words, **variables):
    """(status, all that it said) of make, with variables in its environment."""
    done = subprocess.run(["make", "--no-print-directory", *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, errors="replace", env={**environment(), **variables})
    return done.returncode, done.stdout


def values(text):
    """{name: number} of what was said as `name: number`, one a line."""
    return {k: float(v) for k, v in re.findall(r"^([\w/]+): ([\d.]+)$", text, re.M)}


def message_of(text):
    """The first error in what a program said, else its last line."""
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("make")]
    lines = lines or ["no message"]
    return next((line for line in lines if "error:" in line), lines[-1])
