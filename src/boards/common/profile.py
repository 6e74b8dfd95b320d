"""Where a firmware's instructions go: by class, by source file, by function as written (before inlining) and
as linked, from QEMU's trace of a whole run. Start-up, measuring and semihosting are left out.

    profile.py --tools PREFIX --qemu COMMAND [--top N] FILE.elf
"""

import argparse
import collections
import os
import re
import shlex
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import elf as elf_file  # noqa: E402


def trace(command, image, code, step):
    """By address: how often an instruction ran, and how often the next to run was not the one below it; and how many
    ran by step, for which `step` names addresses. What has no name counts for the step before."""
    runs, taken, steps = collections.Counter(), collections.Counter(), collections.Counter()
    blocks, block, cached = {}, [], {}
    current, last, below = "output", None, None
    with tempfile.TemporaryDirectory() as folder:
        pipe = os.path.join(folder, "trace")
        os.mkfifo(pipe)
        command = command + ["-nographic", "-monitor", "none", "-serial", "none", "-d", "in_asm,exec,nochain",
                             "-D", pipe, "-semihosting-config",
                             f"enable=on,target=native,arg={folder}/picture", "-kernel", image]
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        with open(pipe, errors="replace") as log:
            for line in log:
                if line.startswith("Trace"):
                    pc = int(line.split("/", 2)[1], 16)
                    runs[pc] += 1
                    if pc != below:
                        taken[last] += 1
                    if pc not in cached:
                        addresses = blocks.get(pc, [pc])
                        named = [step.get(a) for a in addresses]
                        own = collections.Counter(filter(None, named))
                        end = next(filter(None, reversed(named)), None)
                        below = code[addresses[-1]].next if addresses[-1] in code else None
                        cached[pc] = own, named.count(None), end, addresses[-1], below
                    own, others, end, last, below = cached[pc]
                    for name, number in own.items():
                        steps[name] += number
                    steps[end or current] += others
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
            raise SystemExit(f"profile: {image}: exit status {process.returncode}")
    counts = collections.Counter()
    for pc, number in runs.items():
        for address in blocks[pc]:
            counts[address] += number
    return counts, taken, steps


class Profile:
    """A traced run: `names` of what was inlined at each address of the tracer, how many instructions ran by class and
    address (`classes`: [(address, class, number)]) and by step, as `step_of` says of the names."""

    def __init__(self, tools, qemu, path, step_of=lambda names: None):
        elf = elf_file.Elf(path)
        self.program = program = elf_file.Program(elf, tools)
        host = [(s.address, s.address + s.size) for s in elf.sections if s.name in (".host", ".vectors")]
        start = elf.symbol("start")
        mine = {a for a in program.code if program.owner(a) not in (start, None)
                and not any(low <= a < high for low, high in host)}
        self.names = chains(tools, path, sorted(mine))
        step = {a: step_of(self.names[a]) if a in mine else "outside" for a in program.code}
        counts, taken, self.steps = trace(shlex.split(qemu), path, program.code, step)
        self.steps.pop("outside", None)
        self.classes = []
        for address, number in counts.items():
            if address in mine:
                kind = classify(program.at(address))
                if kind == "branch":
                    self.classes.append((address, "branch, taken", taken[address]))
                    number -= taken[address]
                    kind = "branch, not taken"
                self.classes.append((address, kind, number))


# Of an instruction's name, the first that matches.
CLASSES = {
    "load or store several": r"push|pop|stm|ldm|vpush|vpop",
    "load": r"ldr|vldr|l[bhw]u?$|flw|fld|lr\.",
    "store": r"str|vstr|s[bhw]$|fsw|fsd|sc\.",
    "long multiply": r"[us]mull|[us]mlal|umaal|mulhs?u?$",
    "multiply": r"mul|mla|mls|smul|smla",
    "divide": r"[us]div|divu?$|remu?$",
    "float divide or root": r"vdiv|vsqrt",
    "float": r"v|f\w+\.[sd]",
}
FLOWS = {elf_file.CALL: "call", elf_file.RETURN: "return", elf_file.BRANCH: "branch", elf_file.JUMP: "jump",
         elf_file.SWITCH: "jump", elf_file.INDIRECT: "jump"}


def classify(i):
    name = i.name.removeprefix("c.")
    return FLOWS.get(i.kind) or next((c for c, names in CLASSES.items() if re.match(names, name)), "other")


def chains(tools, path, addresses):
    """{address: [(file, function as written), ...]}, innermost first, of all that was inlined there."""
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
            chain.append((os.path.basename(line.split(":")[0]), function))
            function = None
    return out


def table(title, counter, total, top):
    print(f"\n{title}")
    for name, number in counter.most_common(top):
        print(f"{number:12} {100 * number / total:5.1f} %  {name}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("image")
    parser.add_argument("--tools", required=True)
    parser.add_argument("--qemu", required=True)
    parser.add_argument("--top", type=int, default=25)
    args = parser.parse_args()

    profile = Profile(args.tools, args.qemu, args.image)
    files, functions, linked, classes = (collections.Counter() for _ in range(4))
    for address, kind, number in profile.classes:
        file, function = profile.names[address][0]
        owner = profile.program.name(profile.program.owner(address))
        if file == "??":
            file, function = "compiler's library", owner
        files[file] += number
        functions[f"{function} ({file})"] += number
        linked[owner] += number
        classes[kind] += number
    total = classes.total()
    print(f"instructions: {total}")
    table("by class", classes, total, None)
    table("by source file", files, total, args.top)
    table("by function as written", functions, total, args.top)
    table("by function as linked", linked, total, args.top)


if __name__ == "__main__":
    main()
