"""Checks linked firmware files, each at build/BOARD/SCENE-NUMBER[-uart].elf with its object in a folder beside it, .obj
for .elf, and those of its board in semihosting.obj or uart.obj. One line for each fault found; exit status 1 if there
is one.

    check_elf.py --tools PREFIX [--budgets FILE] FILE.elf...

- nothing is undefined, nothing runs before main, and every byte lies in a section that the sizes count
- no allocation, exception or exit function; of the compiler's library only what the number system may use
- no recursion, no calls through pointers; all code followed, with the compiler's own figures of frames; no
  breakpoint in a uart image
- the tracer has no mutable global: main's row buffer is all of the static RAM
- flash, static RAM and the stack's bound within the budgets: a line `board scene number flash ram stack` each
"""

import argparse
import glob
import os
import re
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../src/boards/common"))
import elf as elf_file  # noqa: E402

SECTIONS = {".vectors", ".host", ".host_rodata", ".text", ".rodata", ".data", ".bss", ".host_bss"}
FORBIDDEN = re.compile(
    r"_*(malloc|calloc|realloc|free|sbrk|_sbrk|atexit|abort|exit|raise|printf|errno|__errno)$"
    r"|_Zn[wa]|_Zd[la]|__cxa_|_Unwind|__gxx_|__dso_handle|__aeabi_unwind|__register|_impure_ptr")

INTEGER = re.compile(
    r"__aeabi_(lmul|ll?s[lr]|lasr|u?idiv|u?idivmod|u?ldivmod|u?lcmp|idiv0|ldiv0)$"
    r"|__gnu_thumb1_case_(uqi|sqi|uhi|shi|si)$"
    r"|__(mul[sd]i3|ash[lr]di3|lshrdi3|u?(div|mod)[sd]i3|u?divmod[sd]i4)$"
    r"|__((clz|ctz|ffs|popcount|bswap)[sd]i2|clz_tab)$"
    r"|\.?divsi3_skip_div0_test$")
SINGLE = re.compile(
    r"__aeabi_(f(add|sub|rsub|mul|div|cmp\w+|2u?iz|2u?lz|neg)|c?f(cmp\w+|rcmple)|u?i2f|u?l2f)$"
    r"|__(add|sub|mul|div|neg|eq|ne|lt|le|gt|ge|unord|cmp)sf[23]$"
    r"|__(fix(uns)?sf[sd]i|float(un|uns)?[sd]isf)$")
DOUBLE = re.compile(
    r"__aeabi_(d(add|sub|rsub|mul|div|cmp\w+|2u?iz|2u?lz|2f|neg)|f2d|c?d(cmp\w+|rcmple)|u?i2d|u?l2d)$"
    r"|__(add|sub|mul|div|neg|eq|ne|lt|le|gt|ge|unord|cmp)df[23]$"
    r"|__(fix(uns)?df[sd]i|float(un|uns)?[sd]idf|extendsfdf2|truncdfsf2)$")
HELPERS = {
    "q16": [INTEGER],
    "q24": [INTEGER],
    "q32": [INTEGER],
    "float": [INTEGER, SINGLE],
    "double": [INTEGER, SINGLE, DOUBLE],
}
ASSEMBLY = {"reset", "fault", "systick"}  # src/boards/common
ROW = "_ZZ4mainE3row"


def own_depth(program, entry):
    """The deepest depth within a function's own body, without what it calls or jumps on to."""
    end = entry + program.elf.functions[entry][1]
    depths = program.walk(entry)[2]
    return max([d + program.at(a).move for a, d in depths.items() if entry <= a < end] + [0])


def unreached(program, entry):
    """Instructions of a function's body that no path from its entry reaches, padding left out."""
    depths = program.walk(entry)[2]
    end = entry + program.elf.functions[entry][1]
    return [a for a in range(entry, end)
            if a in program.code and a not in depths and program.code[a].name != "nop"]


def jump_cycles(program):
    """Recursion by jumps (tail calls), which needs no stack and so does not show in `bound`."""
    edges = {}
    for i in program.code.values():
        if i.kind in (elf_file.CALL, elf_file.JUMP, elf_file.BRANCH) and i.target in program.elf.functions:
            if i.kind == elf_file.CALL or program.owner(i.address) != i.target:
                edges.setdefault(program.owner(i.address), set()).add(i.target)
    done, found = set(), []

    def visit(node, chain):
        if node in chain:
            found.append([program.name(a) for a in chain[chain.index(node):]])
        elif node not in done:
            for target in sorted(edges.get(node, ())):
                visit(target, chain + [node])
            done.add(node)

    for node in sorted(edges):
        visit(node, [])
    return found


def compiler_frames(objects):
    """Frame bytes by symbol by the compiler's -fcallgraph-info=su, and names of frames of unknown size."""
    frames, dynamic = {}, []
    for path in objects:
        with open(path.removesuffix(".o") + ".ci") as text:
            for title, size, kind in re.findall(
                    r'node: \{ title: "([^"]*)" label: "[^"]*\\n(\d+) bytes \(([a-z,]+)\)', text.read()):
                symbol = title.rsplit(":", 1)[-1]
                frames[symbol] = max(frames.get(symbol, 0), int(size))
                if kind != "static":
                    dynamic.append(symbol)
    return frames, dynamic


def budget_of(file, key):
    """(flash, ram, stack) for (board, scene, number), or None where none is set."""
    for number, line in enumerate(file, 1):
        fields = line.split("#")[0].split()
        if not fields:
            continue
        if len(fields) != 6 or not all(f.isdigit() for f in fields[3:]):
            raise SystemExit(f"{file.name}:{number}: expected `board scene number flash ram stack`")
        if tuple(fields[:3]) == key:
            return [int(f) for f in fields[3:]]
    return None


def check(path, tools, budgets):
    faults = []
    elf = elf_file.Elf(path)
    folder, name = os.path.split(path)
    uart = name.endswith("-uart.elf")
    scene, number = name.removesuffix(".elf").removesuffix("-uart").rsplit("-", 1)
    board = os.path.basename(folder)
    objects = [object for of in (path.removesuffix(".elf"), f"{folder}/{'uart' if uart else 'semihosting'}")
               for object in sorted(glob.glob(f"{of}.obj/*.o"))]
    frames, dynamic = compiler_frames(objects)

    defined = {s.name for s in elf.symbols if s.section != "UND"}
    for object in objects:  # a weak name left undefined leaves no trace in the linked file
        weak = {s.name for s in elf_file.Elf(object).symbols if s.section == "UND" and s.bind == "WEAK"}
        faults += [f"{symbol} is undefined" for symbol in sorted(weak - defined)]

    for s in elf.sections:
        if "A" in s.flags and s.size and s.name not in SECTIONS:
            faults.append(f"section {s.name} of {s.size} bytes")
    for s in elf.symbols:
        if s.section == "UND" and s.name:
            faults.append(f"{s.name} is undefined")
        if FORBIDDEN.match(s.name):
            faults.append(f"{s.name} is linked")
        if s.type == "OBJECT" and s.section.isdigit():
            holder = elf.sections[int(s.section)]
            if "W" in holder.flags and holder.name != ".host_bss" and s.name != ROW:
                faults.append(f"{s.name} is a mutable global of {s.size} bytes")
    # Constructors have two names, of which the compiler states one.
    names = {}
    for s in elf.symbols:
        if s.type == "FUNC" and s.section != "UND":
            names.setdefault(s.address, set()).add(s.name)
    stated_frames = {address: frames[name] for address in names for name in names[address] & frames.keys()}

    helpers = HELPERS.get(number, [INTEGER, SINGLE])
    for address, (function, _) in elf.functions.items():
        if address not in stated_frames and function not in ASSEMBLY:
            if not any(h.match(function) for h in helpers):
                faults.append(f"{function} of the compiler's library is not for {number}")
    faults += [f"{function} has a frame of no fixed size" for function in dynamic]

    program = elf_file.Program(elf, tools)
    bound, _ = program.bound(elf.symbol("start"))
    faults += program.problems
    faults += ["recursion by jumps: " + " -> ".join(cycle) for cycle in jump_cycles(program)]
    for address in program.memo:
        stated = stated_frames.get(address)
        if stated is None:
            continue
        followed = own_depth(program, address)
        # On Arm the compiler leaves out registers that it saves beside arguments on the stack.
        if not stated <= followed <= stated + (16 if elf.is_arm else 0):
            faults.append(f"{program.name(address)} has a frame of {followed} bytes, "
                          f"and the compiler states {stated}")
        lost = unreached(program, address)
        if lost:
            faults.append(f"{program.name(address)} has code that was not followed, at {lost[0]:#x}")
    if uart:
        for i in program.code.values():
            if i.name in ("bkpt", "ebreak", "c.ebreak"):
                faults.append(f"a breakpoint at {i.address:#x}")

    sizes = elf.sizes()
    found = [sizes["flash"], sizes["ram"], bound]
    if budgets and not uart:
        with open(budgets) as file:
            limits = budget_of(file, (board, scene, number))
        for what, have, limit in zip(("flash", "static RAM", "stack"), found, limits or found):
            if have > limit:
                faults.append(f"{what} of {have} bytes is above the budget of {limit}")
    return faults


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("files", nargs="+")
    parser.add_argument("--tools", required=True)
    parser.add_argument("--budgets")
    args = parser.parse_args()
    status = 0
    for path in args.files:
        for fault in check(path, args.tools, args.budgets):
            print(elf_file.readable(args.tools, f"{path}: {fault}"))
            status = 1
    sys.exit(status)


if __name__ == "__main__":
    main()
