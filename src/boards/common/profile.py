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


def trace(command, image, code):
    """By address: how often an instruction ran, and how often the next to run was not the one below it."""
    runs, taken = collections.Counter(), collections.Counter()
    blocks, block = {}, []
    with tempfile.TemporaryDirectory() as folder:
        pipe = os.path.join(folder, "trace")
        os.mkfifo(pipe)
        command = command + ["-nographic", "-monitor", "none", "-serial", "none", "-d", "in_asm,exec,nochain",
                             "-D", pipe, "-semihosting-config",
                             f"enable=on,target=native,arg={folder}/picture", "-kernel", image]
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        last, below = None, None
        with open(pipe, errors="replace") as log:
            for line in log:
                if line.startswith("Trace"):
                    pc = int(line.split("/", 2)[1], 16)
                    runs[pc] += 1
                    if pc != below:
                        taken[last] += 1
                    block = blocks.get(pc, [0])
                    last = block[-1]
                    below = code[last].next if last in code else None
                elif line.startswith("IN:"):
                    block = []
                elif line.startswith("0x"):
                    address = int(line[:10], 16)
                    if not block:
                        blocks[address] = block
                    block.append(address)
        if process.wait() != 0:
            raise SystemExit(f"profile: {image}: exit status {process.returncode}")
    counts = collections.Counter()
    for pc, number in runs.items():
        for address in blocks[pc]:
            counts[address] += number
    return counts, taken


def classify(i):
    name = re.sub(r"^c\.", "", i.name)
    if i.kind in (elf_file.CALL, elf_file.RETURN, elf_file.JUMP, elf_file.SWITCH, elf_file.INDIRECT):
        return {elf_file.CALL: "call", elf_file.RETURN: "return"}.get(i.kind, "jump")
    if i.kind == elf_file.BRANCH:
        return "branch"
    if re.match(r"(push|pop|stm|ldm|vpush|vpop)", name):
        return "load or store several"
    if re.match(r"(ldr|vldr|l[bhw]u?$|flw|fld|lr\.)", name):
        return "load"
    if re.match(r"(str|vstr|s[bhw]$|fsw|fsd|sc\.)", name):
        return "store"
    if re.match(r"([us]mull|[us]mlal|umaal|mulhs?u?$)", name):
        return "long multiply"
    if re.match(r"(mul|mla|mls|smul|smla)", name):
        return "multiply"
    if re.match(r"([us]div|divu?$|remu?$)", name):
        return "divide"
    if re.match(r"v(div|sqrt)", name):
        return "float divide or root"
    if name.startswith("v") or re.match(r"f\w+\.[sd]", name):
        return "float"
    return "other"


def sources(tools, path, addresses):
    """{address: (file, function as written)}, innermost of what was inlined there."""
    result = subprocess.run([tools + "addr2line", "-e", path, "-f", "-C", "-a"], check=True, text=True,
                            input="\n".join(map(hex, addresses)), capture_output=True).stdout
    lines = result.splitlines()
    out = {}
    for address, function, place in zip(lines[::3], lines[1::3], lines[2::3]):
        out[int(address, 16)] = os.path.basename(place.split(":")[0]), re.sub(r"\(.*|<.*", "", function)
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

    elf = elf_file.Elf(args.image)
    program = elf_file.Program(elf, args.tools)
    host = [(s[3], s[3] + s[5]) for s in elf.sections if s[0] in (".host", ".vectors")]
    start = program.entry("start")
    counts, taken = trace(shlex.split(args.qemu), args.image, program.code)
    counts = {a: n for a, n in counts.items()
              if a in program.code and program.owner(a) not in (start, None)
              and not any(low <= a < high for low, high in host)}
    places = sources(args.tools, args.image, sorted(counts))
    files, functions, linked, classes = (collections.Counter() for _ in range(4))
    for address, number in counts.items():
        file, function = places[address]
        owner = program.name(program.owner(address))
        if file == "??":
            file, function = "compiler's library", owner
        files[file] += number
        functions[f"{function} ({file})"] += number
        linked[owner] += number
        kind = classify(program.at(address))
        if kind == "branch":
            classes["branch, taken"] += taken[address]
            number -= taken[address]
            kind = "branch, not taken"
        classes[kind] += number
    total = sum(counts.values())
    print(f"instructions: {total}")
    table("by class", classes, total, None)
    table("by source file", files, total, args.top)
    table("by function as written", functions, total, args.top)
    table("by function as linked", linked, total, args.top)


if __name__ == "__main__":
    main()
