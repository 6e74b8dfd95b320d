"""Boards, number systems and settings: what measurements name."""

import collections
import functools
import json

from programs import output_of

# Short names of boards, in the order of tables.
BOARDS = {"microbit": "M0", "mps2_an385": "M3", "mps2_an386": "M4F", "mps2_an500": "M7F", "rv32_virt": "RV32"}
# Those that are studied.
STUDIED = ["microbit", "mps2_an385", "mps2_an386", "rv32_virt"]
# Samples are a square, or ADAPTIVE's value after an `a`.
Setting = collections.namedtuple("Setting", "number samples depth cutoff")
DEFAULT = Setting("q32", "1", 5, 0.0014)


@functools.cache
def told():
    """What there is of each kind, as the command says."""
    return json.loads(output_of("build/qray", "--describe"))


def numbers():
    """The number systems, as the command names them."""
    return told()["numbers"]


def fixed_numbers():
    """Those in fixed point: Q-formats."""
    return [n for n in numbers() if n.startswith("q")]


@functools.cache
def boards():
    """The boards that make knows."""
    return json.loads(output_of("make", "-s", "describe"))["boards"].split()


@functools.cache
def board_facts(board):
    """What its board.mk says: {tools, cpu, optimise, qemu, tick}."""
    return json.loads(output_of("make", "-s", "describe", f"BOARD={board}"))


def label(setting):
    """What differs from the default."""
    number, samples, depth, cutoff = setting
    out = []
    if number != DEFAULT[0] or setting == DEFAULT:
        out.append(number)
    if samples != DEFAULT[1]:
        out.append(samples.split(",")[0] if samples[0] == "a" else f"{samples}×")
    if depth != DEFAULT[2]:
        out.append(f"depth {depth}")
    if cutoff != DEFAULT[3]:
        out.append(f"cutoff {cutoff}")
    return " ".join(out)


def options(setting):
    """Of make, where the setting differs from the default."""
    _, samples, depth, cutoff = setting
    sampling = {"ADAPTIVE": samples[1:]} if samples[0] == "a" else {"SAMPLES": samples} if samples != "1" else {}
    return {**sampling, **({"DEPTH": depth} if depth != DEFAULT[2] else {}),
            **({"CUTOFF": cutoff} if float(cutoff) != DEFAULT[3] else {})}
