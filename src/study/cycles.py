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
import os
import re
import shlex
import subprocess
import sys
import tempfile

sys.path.insert(0, "src/boards/common")
import elf as elf_file  # noqa: E402
import profile as profiler  # noqa: E402
from programs import environment, fail, message_of  # noqa: E402
from settings import board_facts  # noqa: E402

# Cycles by class of src/boards/common/profile.py; `several` is what a load or store of several costs beside
# one cycle for each register, `return` what it costs where it pops them.
M0 = {"other": 1, "multiply": 1, "load": 2, "store": 2, "several": 1,
      "branch, not taken": 1, "branch, taken": 3, "jump": 3, "call": 4, "return": 3}
M3 = {"other": 1, "multiply": 1, "long multiply": 4, "divide": 7, "load": 2, "store": 1, "several": 1,
      "branch, not taken": 1, "branch, taken": 3, "jump": 3, "call": 3, "return": 3}
M4F = {**M3, "long multiply": 1, "float": 1, "float divide or root": 14}
RV32 = {"other": 1, "multiply": 1, "long multiply": 2, "divide": 37, "load": 2, "store": 2,
        "branch, not taken": 1, "branch, taken": 3, "jump": 2, "call": 2, "return": 2}
TIMINGS = {"microbit": M0, "mps2_an385": M3, "mps2_an386": M4F, "rv32_virt": RV32}

TEXTURES = ["checker", "stripes", "gradient", "rings", "noise", "marble", "wood", "brick"]
# The step that an instruction belongs to is that of the innermost of these files that it was inlined into.
# What was inlined into none (arithmetic out of line, the compiler's library) counts for the step that called
# it.
STEPS = {
    "camera": "camera", "render": "camera", "grid": "camera", "adaptive": "camera", "windows": "camera",
    "sphere": "spheres", "disc": "discs", "cone": "cones", "polygon": "polygons", "patch": "patches",
    "nearest": "nearest hit", "tree": "nearest hit", "shadow": "nearest hit", "see_through": "nearest hit",
    "trace": "shading", "highlight": "shading", "light": "shading", "sun": "shading", "mirror": "shading",
    "transmit": "shading", "sampler": "output", "sink": "output", "ppm": "output", "main": "output",
    **{name: name for name in TEXTURES},
}
ROOTS = re.compile(r"sqrt|reciprocal|normalise|quotient|div")


def cost(board, i, kind):
    """Cycles of one instruction, of a class as profile.py has it."""
    timing = TIMINGS[board]
    if re.search(r"[{]", i.operands):
        words = elf_file.Program.registers(i.operands) // 4
        return timing["several"] + words + (timing["return"] if kind == "return" else 0)
    return timing[kind]


def chains(tools, path, addresses):
    """{address: [(file, function), ...]}, innermost first, of all that was inlined there."""
    done = subprocess.run([tools + "addr2line", "-e", path, "-f", "-C", "-a", "-i"], check=True, text=True,
                          input="\n".join(map(hex, addresses)), capture_output=True).stdout
    out, chain, function = {}, [], None
    for line in done.splitlines():
        if re.fullmatch(r"0x[0-9a-f]+", line):
            chain = out[int(line, 16)] = []
            function = None
        elif function is None:
            function = re.sub(r"\(.*|<.*", "", line)
        else:
            chain.append((os.path.basename(line.split(":")[0]).split(".")[0], function))
            function = None
    return out


def step_of(chain):
    for file, function in chain:
        # A function out of line may start with lines that compilers take from main's file.
        if file in STEPS and (file != "main" or function == "main"):
            return STEPS[file]
    return None


def count(command, image, step):
    """As profile.py's trace(): runs of each address and how often the next was not below it; beside these,
    instructions by step."""
    runs_of, taken, steps = collections.Counter(), collections.Counter(), collections.Counter()
    program_next, blocks, block = image["next"], {}, []
    current, last, below = "output", None, None
    with tempfile.TemporaryDirectory() as folder:
        pipe = os.path.join(folder, "trace")
        os.mkfifo(pipe)
        command = command + ["-nographic", "-monitor", "none", "-serial", "none",
                             "-d", "in_asm,exec,nochain", "-D", pipe, "-semihosting-config",
                             f"enable=on,target=native,arg={folder}/picture",
                             "-kernel", image["path"]]
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        cached = {}
        with open(pipe, errors="replace") as log:
            for line in log:
                if line.startswith("Trace"):
                    pc = int(line.split("/", 2)[1], 16)
                    runs_of[pc] += 1
                    if pc != below:
                        taken[last] += 1
                    known = cached.get(pc)
                    if known is None:
                        addresses = blocks.get(pc, [pc])
                        named = [step.get(a) for a in addresses]
                        own = collections.Counter(n for n in named if n)
                        end = next((n for n in reversed(named) if n), None)
                        known = cached[pc] = (own, named.count(None), end, addresses[-1],
                                              program_next.get(addresses[-1]))
                    own, others, end, last, below = known
                    for name, number in own.items():
                        steps[name] += number
                    steps[current if not own else end] += others
                    current = end or current
                elif line.startswith("IN:"):
                    block = []
                elif line.startswith("0x"):
                    address = int(line[:10], 16)
                    if not block:
                        blocks[address] = block
                        cached.pop(address, None)
                    block.append(address)
        if process.wait() != 0:
            fail(f"{image['path']}: exit status {process.returncode}")
    counts = collections.Counter()
    for pc, number in runs_of.items():
        for address in blocks[pc]:
            counts[address] += number
    return counts, taken, steps


def measure(run, name):
    """Builds the firmware of a run and traces it: {instructions, cycles, classes, steps}."""
    build = [c for c in run.command(name)]
    build[build.index("profile")] = "size"
    done = subprocess.run(build, capture_output=True, text=True, env=environment())
    if done.returncode != 0:
        return {"refused": message_of(done)}
    facts = board_facts(run.board)
    path = f"build/{run.board}/{name}-{run.number}.elf"
    elf = elf_file.Elf(path)
    program = elf_file.Program(elf, facts["tools"])
    host = [(s[3], s[3] + s[5]) for s in elf.sections if s[0] in (".host", ".vectors")]
    start = program.entry("start")
    mine = {a for a in program.code if program.owner(a) not in (start, None)
            and not any(low <= a < high for low, high in host)}
    names = chains(facts["tools"], path, sorted(mine))
    step = {a: step_of(chain) for a, chain in names.items()}
    for a in program.code:
        if a not in mine:
            step[a] = "outside"
    image = {"path": path, "next": {a: i.next for a, i in program.code.items()}}
    counts, taken, steps = count(shlex.split(facts["qemu"]), image, step)
    steps.pop("outside", None)
    classes, cycles = collections.Counter(), 0
    for address, number in counts.items():
        if address not in mine:
            continue
        i = program.at(address)
        kind = profiler.classify(i)
        if kind == "branch":
            jumped = taken[address]
            classes["branch, taken"] += jumped
            cycles += jumped * cost(run.board, i, "branch, taken")
            number -= jumped
            kind = "branch, not taken"
        classes[kind] += number
        cycles += number * cost(run.board, i, kind)
    sizes = {k: int(v) for k, v in re.findall(r"^(flash|ram|stack_bound): (\d+)$", done.stdout, re.M)}
    roots = sum(number for address, number in counts.items() if address in mine and ROOTS.search(
        chain[0][1] if (chain := names[address]) else program.name(program.owner(address))))
    return {"instructions": sum(classes.values()), "cycles": cycles, "classes": dict(classes),
            "steps": dict(steps), "roots": roots, **sizes}
