"""Checks linked firmware files, each at build/BOARD/SCENE-NUMBER[-uart].elf with its objects in a folder
beside it, .obj for .elf. One line for each fault found; exit status 1 if there is one.

    check_elf.py --tools PREFIX [--budgets FILE] FILE.elf...

- nothing is undefined, nothing runs before main, and every byte lies in a section that the sizes count
- no allocation, exception or exit function; of the compiler's library only what the number system may use
- no recursion, no calls through pointers; all code followed, with the compiler's own figures of frames; no
  breakpoint in a uart image
- the tracer has no mutable global: main's row buffer is all of the static RAM
- flash, static RAM and the stack's bound within the budgets: a line `board scene number flash ram stack` each
"""

import argparse
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
    "q32": [INTEGER],
    "float": [INTEGER, SINGLE],
    "double": [INTEGER, SINGLE, DOUBLE],
}
ASSEMBLY = {"reset", "fault", "systick"}  # src/boards/common
ROW = "_ZZ4mainE3row"


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
    objects = path.removesuffix(".elf") + ".obj"
    frames, dynamic = elf_file.compiler_frames(objects)

    defined = {symbol for symbol, *_, index in elf.symbols if index != 0}
    for file in sorted(os.listdir(objects)):
        if file.endswith(".o"):  # a weak name left undefined leaves no trace in the linked file
            weak = elf_file.Elf(os.path.join(objects, file)).weak
            faults += [f"{symbol} is undefined" for symbol in sorted(weak - defined)]

    for section, _, flags, _, _, size, _ in elf.sections:
        if flags & 2 and size and section not in SECTIONS:
            faults.append(f"section {section} of {size} bytes")
    host = [(s[3], s[3] + s[5]) for s in elf.sections if s[0] == ".host_bss"]
    for symbol, address, size, kind, index in elf.symbols:
        if index == 0 and symbol:
            faults.append(f"{symbol} is undefined")
        if FORBIDDEN.match(symbol):
            faults.append(f"{symbol} is linked")
        if kind == 1 and index < len(elf.sections) and elf.sections[index][2] & 1:
            if symbol != ROW and not any(low <= address < high for low, high in host):
                faults.append(f"{symbol} is a mutable global of {size} bytes")
    # Constructors have two names, of which the compiler states one.
    names = {}
    for symbol, address, _, kind, index in elf.symbols:
        if kind == 2 and index != 0:
            names.setdefault(address, set()).add(symbol)
    stated_frames = {address: frames[name] for address in names for name in names[address] & frames.keys()}

    helpers = HELPERS.get(number, [INTEGER, SINGLE])
    for address, (function, _) in elf.functions.items():
        if address not in stated_frames and function not in ASSEMBLY:
            if not any(h.match(function) for h in helpers):
                faults.append(f"{function} of the compiler's library is not for {number}")
    faults += [f"{function} has a frame of no fixed size" for function in dynamic]

    program = elf_file.Program(elf, tools)
    bound, _ = program.bound(program.entry("start"))
    faults += program.problems
    faults += ["recursion by jumps: " + " -> ".join(cycle) for cycle in program.jump_cycles()]
    for address in program.memo:
        stated = stated_frames.get(address)
        if stated is None:
            continue
        followed = program.own_depth(address)
        # On Arm the compiler leaves out registers that it saves beside arguments on the stack.
        if not stated <= followed <= stated + (16 if elf.machine == "arm" else 0):
            faults.append(f"{program.name(address)} has a frame of {followed} bytes, "
                          f"and the compiler states {stated}")
        lost = program.unreached(address)
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
