"""Instructions by class and by step of the tracer, from QEMU's trace of a small picture, and the cycles that
published timings of the cores make of them, with memory that never makes the core wait.

    M0    Cortex-M0 Technical Reference Manual (ARM DDI 0432C), section 3.3, with the 1-cycle multiplier
    M3    Cortex-M3 Technical Reference Manual (ARM DDI 0337I), section 3.3.1; refilling the pipeline
          after a taken branch as 2 of its 1 to 3 cycles, long multiplies and divisions by the middle of
          their range
    M4F   Cortex-M4 Technical Reference Manual (ARM DDI 0439B), sections 3.3.1 and 7.2.3, the same way
    RV32  Ibex Reference Guide, "Pipeline Details": single-cycle multiplier, no branch target unit

A load's cycles do not count what following loads gain from the pipeline, so M3 and M4F are upper
estimates."""

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
M3 = {"other": 1, "multiply": 1, "long multiply": 4, "divide": 7, "load": 2, "store": 1, "several": 1,
      "branch, not taken": 1, "branch, taken": 3, "jump": 3, "call": 3, "return": 3}
M4F = {**M3, "long multiply": 1, "float": 1, "float divide or root": 14}
RV32 = {"other": 1, "multiply": 1, "long multiply": 2, "divide": 37, "load": 2, "store": 2,
        "branch, not taken": 1, "branch, taken": 3, "jump": 2, "call": 2, "return": 2}
TIMINGS = {"microbit": M0, "mps2_an385": M3, "mps2_an386": M4F, "rv32_virt": RV32,
           "stm32vldiscovery": M3, "lm3s6965evb": M3, "netduinoplus2": M4F}

Part = collections.namedtuple("Part", "name clock")
PARTS = {"microbit": Part("micro:bit", 16e6), "mps2_an385": Part("STM32F103", 72e6),
         "mps2_an386": Part("STM32F405", 168e6), "rv32_virt": Part("Ibex", 50e6)}

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
    """Cycles of one instruction, of a class as profile.py has it."""
    timing = TIMINGS[board]
    if re.search(r"[{]", i.operands):
        words = elf_file.Program.registers(i.operands) // 4
        return timing["several"] + words + (timing["return"] if kind == "return" else 0)
    return timing[kind]


def step_of(chain):
    for file, function in chain:
        file = file.split(".")[0]
        # A function out of line may start with lines that compilers take from main's file.
        if file in STEPS and (file != "main" or function == "main"):
            return STEPS[file]
    return None


def measure(run, name):
    """Builds the firmware of a run and traces it: {instructions, cycles, steps, roots}."""
    built = run.measure(run.command(name))
    if "refused" in built:
        return built
    facts = board_facts(run.board)
    profile = profiler.Profile(facts["tools"], facts["qemu"], f"build/{run.board}/{name}-{run.number}.elf", step_of)
    program, instructions, cycles, roots = profile.program, 0, 0, 0
    for address, kind, number in profile.classes:
        instructions += number
        cycles += number * cost(run.board, program.at(address), kind)
        chain = profile.names[address]
        if ROOTS.search(chain[0][1] if chain else program.name(program.owner(address))):
            roots += number
    return {"instructions": instructions, "cycles": cycles, "steps": dict(profile.steps), "roots": roots}
