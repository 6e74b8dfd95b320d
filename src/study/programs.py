"""Running other programs."""

import os
import subprocess
import sys


def fail(text):
    raise SystemExit(f"{os.path.basename(sys.argv[0])}: {text}")


def environment():
    """Without what an outer make says to its own children."""
    return {k: v for k, v in os.environ.items() if k not in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS")}


def output_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def message_of(done):
    """The first error in what a program said, else its last line."""
    lines = (done.stdout + done.stderr).strip().splitlines() or ["no message"]
    return next((line for line in lines if "error:" in line), lines[-1])
