"""Instructions by class and by step of the tracer, from QEMU's trace of a small picture, and the cycles that
published timings of the cores make of them.

    M0    Cortex-M0 Technical Reference Manual (ARM DDI 0432C), section 3.3, with the 1-cycle multiplier: exact where
          memory never waits
    M3    Cortex-M3 Technical Reference Manual (ARM DDI 0337I), section 3.3.1
    M4F   Cortex-M4 Technical Reference Manual (ARM DDI 0439B), sections 3.3.1 and 7.2.3
    RV32  Ibex Reference Guide, "Pipeline Details": single-cycle multiplier, no branch target unit
    M7F   Arm publishes no timings. The Cortex-M7 Technical Reference Manual (ARM DDI 0489) says that two instructions
          issue in order at once and that branches are predicted; what follows from it here is a model: PAIRS, USE, and
          one taken branch of eight mispredicted.

Where a manual gives a range, that is the model's known error: three numbers, the least, what the model takes, and the
most. Refilling the pipeline after a taken branch is 1 to 3 cycles, a load 1 where it follows another, or 2.

Memory that waits: behind a prefetch buffer, a core waits where it jumps, and where it loads through another register
than the stack pointer, as constants and a scene's tables are in flash (an upper estimate: tables that move are in RAM).
Without one it also waits for each word of instructions. Caches, as of an M7, are taken to hold all that is used."""

import collections
import re
import sys

sys.path.insert(0, "src/boards/common")
import elf as elf_file  # noqa: E402
import profile as profiler  # noqa: E402
from settings import board_facts, told  # noqa: E402

# Cycles by class of src/boards/common/profile.py; `several` is what a load or store of several costs beside
# one cycle for each register, `return` what it costs where it pops them.
M0 = {"other": 1, "multiply": 1, "load": 2, "store": 2, "several": 1,
      "branch, not taken": 1, "branch, taken": 3, "jump": 3, "call": 4, "return": 3}
M3 = {"other": 1, "multiply": 1, "long multiply": (3, 4, 5), "divide": (2, 7, 12), "load": (1, 2, 2), "store": 1,
      "several": 1, "branch, not taken": 1, "branch, taken": (2, 3, 4), "jump": (2, 3, 4), "call": (2, 3, 4),
      "return": (2, 3, 4)}
M4F = {**M3, "long multiply": 1, "float": 1, "float divide or root": 14}
M7F = {**M4F, "load": 1, "branch, taken": (1, 2, 9), "jump": 1, "call": 1, "return": (1, 2, 9)}
RV32 = {"other": 1, "multiply": 1, "long multiply": 2, "divide": 37, "load": 2, "store": 2,
        "branch, not taken": 1, "branch, taken": (3, 3, 4), "jump": (2, 2, 3), "call": (2, 2, 3), "return": (2, 2, 3)}
TIMINGS = {"microbit": M0, "mps2_an385": M3, "mps2_an386": M4F, "mps2_an500": M7F, "rv32_virt": RV32,
           "stm32vldiscovery": M3, "lm3s6965evb": M3, "netduinoplus2": M4F}
CACHED = ("mps2_an500",)

# A part with each core: its clock, the wait states of its flash at it, and pC a cycle (µA/MHz) and volts where a data
# sheet tells them of a processor that runs from flash with its peripherals off.
#   STM32F031  data sheet, table 23: 11.4 mA at 48 MHz, typical, CoreMark, one wait state, prefetch
#   STM32L100  data sheet DocID024295, table 15: 9.6 mA at 32 MHz, typical, Dhrystone, one wait state, prefetch
#   nRF52832   Product Specification: 3.7 mA at 64 MHz, CoreMark, DC/DC regulator; behind a cache
Part = collections.namedtuple("Part", "name clock waits charge volts", defaults=(0, None, None))
PARTS = {"microbit": Part("STM32F031", 48e6, 1, 11.4e3 / 48, 3.6), "mps2_an385": Part("STM32L100", 32e6, 1, 300, 3.6),
         "mps2_an386": Part("nRF52832", 64e6, 0, 3.7e3 / 64, 3.0), "mps2_an500": Part("a Cortex-M7", 300e6),
         "rv32_virt": Part("Ibex", 50e6)}
# CoreMark a MHz as published, of M7 to M4: by how much the M7's model should be quicker.
COREMARK = 5.01 / 3.40

SHAPES = {name: name + ("es" if name[-1] in "hsx" else "s") for name in told()["shapes"]}
# The step that an instruction belongs to is that of the innermost of these files that it was inlined into.
# What was inlined into none (arithmetic out of line, the compiler's library) counts for the step that called
# it.
FILES = {
    "camera": "camera render grid adaptive", "nearest hit": "nearest tree shadow see_through",
    "shading": "trace highlight light sun panel light_map light_of_surfaces mirror transmit",
    "textures": " ".join([*told()["textures"], "texels"]),
    "output": "sampler sink ppm main",
}
STEPS = {**SHAPES, **{file: step for step, files in FILES.items() for file in files.split()}}
ROOTS = re.compile(r"sqrt|reciprocal|normalise|quotient|div")


def cost(board, i, kind):
    """Cycles of one instruction, of a class as profile.py has it: (least, as modelled, most)."""
    timing = TIMINGS[board]
    several = re.search(r"[{]", i.operands)
    words = elf_file.Program.registers(i.operands) // 4 if several else 0
    own = (timing["return"] if kind == "return" else 0) if several else timing[kind]
    own = own if isinstance(own, tuple) else (own,) * 3
    return [c + words + (timing["several"] if several else 0) for c in own]


# Two that issue at once: no two of a group, and the second does not name what the first writes.
PAIRS = [("load", "store"), ("multiply", "long multiply"), ("float",)]
USE = {"load": 1, "float": 2}  # cycles more where the next instruction needs the result


def dual_issue(program, counts):
    """Cycles that an M7 saves by issuing two instructions at once, less those it waits for results."""
    saved, follows, kinds = 0, None, {a: profiler.classify(program.at(a)) for a in counts}
    for address in sorted(counts):
        i = program.at(address)
        kind = kinds[address]
        if i.next not in counts or address == follows or i.kind != elf_file.PLAIN or "{" in i.operands:
            continue
        next_kind, times = kinds[i.next], min(counts[address], counts[i.next])
        reads_only = kind == "store" or re.match("cmp|cmn|tst|teq|vcmp", i.name)
        written = [] if reads_only else re.split(r",\s*", i.operands)[:2 if kind == "long multiply" else 1]
        named = re.findall(r"\w+", program.at(i.next).operands)
        if any(w in named for w in written):
            saved -= USE.get(kind, 0) * times
        elif ("divide" not in kind + next_kind and "{" not in program.at(i.next).operands
              and not any(kind in group and next_kind in group for group in PAIRS)):
            saved += times
            follows = i.next
    return saved


def step_of(chain):
    for file, function in chain:
        file = file.split(".")[0]
        # A function out of line may start with lines that compilers take from main's file.
        if file in STEPS and (file != "main" or function == "main"):
            return STEPS[file]
    return None


def measure(run, name):
    """Builds the firmware of a run and traces it: {instructions, cycles as modelled, and the least and the most,
    jumps and words, as wait states count, steps, roots}."""
    built = run.measure(run.command(name))
    if "refused" in built:
        return built
    facts = board_facts(run.board)
    profile = profiler.Profile(facts["tools"], facts["qemu"], f"build/{run.board}/{name}-{run.number}.elf", step_of)
    program, cycles, roots, jumps, size = profile.program, [0, 0, 0], 0, 0, 0
    counts = collections.Counter()
    for address, kind, number in profile.classes:
        i = program.at(address)
        counts[address] += number
        cycles = [c + number * own for c, own in zip(cycles, cost(run.board, i, kind))]
        goes_on = kind not in ("branch, taken", "jump", "call", "return")
        from_flash = kind == "load" and not re.search(r"\bsp\b", i.operands)
        jumps += number * (from_flash or not goes_on)
        size += number * ((i.next or address + 4) - address)
        chain = profile.names[address]
        if ROOTS.search(chain[0][1] if chain else program.name(program.owner(address))):
            roots += number
    if TIMINGS[run.board] is M7F:
        saved = dual_issue(program, counts)
        cycles = [c - saved for c in cycles]
    if run.board in CACHED:
        jumps = size = 0
    return {"instructions": counts.total(), "cycles": cycles[1], "least": cycles[0], "most": cycles[2], "jumps": jumps,
            "words": size / 4, "steps": dict(profile.steps), "roots": roots}


def waiting(result, waits, prefetch=True):
    """Cycles with wait states, as modelled."""
    return result["cycles"] + waits * (result["jumps"] + (0 if prefetch else result["words"]))
