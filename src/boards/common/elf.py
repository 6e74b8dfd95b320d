"""What a linked firmware says about itself: sizes, symbols, call graph, and the deepest its stack can get.

The stack is followed through the instructions of the linked file, so that it covers the compiler's library
and assembly too: along each path the stack pointer's depth, at each call that depth plus the callee's bound.
It is exact for code without recursion, function pointers and arrays of variable length, and says so where
it meets one of them. `python3 elf.py TOOLS-PREFIX FILE.elf` prints the deepest chain of calls.
"""

import bisect
import collections
import re
import subprocess
import sys

RETURN, JUMP, BRANCH, CALL, SWITCH, INDIRECT, PLAIN = range(7)
CONDITION = "(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le|hs|lo)"


Section = collections.namedtuple("Section", "name type address offset size flags")
Symbol = collections.namedtuple("Symbol", "name address size type bind section")  # Thumb bit cleared


class Elf:
    def __init__(self, path):
        self.path = path
        said = subprocess.run(["readelf", "-hSsW", path], capture_output=True, text=True).stdout
        machine = re.search(r"ELF32$.*^  Machine: +(ARM|RISC-V)$", said, re.M | re.S)
        if machine is None:
            raise SystemExit(f"{path}: not a 32-bit ELF file of Arm or RISC-V")
        self.is_arm = machine[1] == "ARM"
        self.sections = [
            Section(name, kind, *(int(n, 16) for n in numbers), flags) for name, kind, *numbers, flags in re.findall(
                r"^  \[ *\d+\] (\S*) +(\S+) +([0-9a-f]{8}) ([0-9a-f]+) ([0-9a-f]+) .. +([A-Za-z]*)", said, re.M)]
        self.symbols = [
            Symbol(name, int(value, 16) & (~1 if self.is_arm and kind == "FUNC" else ~0), int(size, 0), kind, *of)
            for value, size, kind, *of, name in re.findall(
                r"^ *\d+: ([0-9a-f]{8}) +(\w+) (\w+) +(\w+) +\w+ +(\w+) ?(.*)$", said, re.M)]
        self.functions = {}  # address -> (name, size); of several names for one address the first
        for s in self.symbols:
            if s.type == "FUNC" and s.section != "UND":
                known = self.functions.get(s.address)
                if known is None or known[1] < s.size:
                    self.functions[s.address] = (s.name, s.size)

    def symbol(self, name):
        for s in self.symbols:
            if s.name == name:
                return s.address
        raise SystemExit(f"{self.path}: no symbol {name}")

    def contents(self, section):
        with open(self.path, "rb") as file:
            file.seek(section.offset)
            return file.read(section.size)

    def word(self, address):
        for s in self.sections:
            if "A" in s.flags and s.type == "PROGBITS" and s.address <= address < s.address + s.size:
                return int.from_bytes(self.contents(s)[address - s.address:][:4], "little")
        raise SystemExit(f"{self.path}: no constant at {address:#x}")

    def sizes(self):
        """Bytes of flash and static RAM, with and without what only an emulated run needs."""
        def size(*names):
            return sum(s.size for s in self.sections if s.name in names)
        flash = size(".vectors", ".text", ".rodata", ".init_array", ".data")
        ram = size(".data", ".bss")
        return {"flash": flash, "ram": ram,
                "flash_total": flash + size(".host", ".host_rodata"), "ram_total": ram + size(".host_bss")}


class Instruction:
    __slots__ = ("address", "name", "operands", "kind", "target", "move", "next")


class Program:
    """The instructions of an ELF file, each with its effect on control flow and on the stack pointer."""

    def __init__(self, elf, tools):
        self.elf = elf
        self.problems = []
        self.code = {}
        self.starts = sorted(elf.functions)
        output = subprocess.run([tools + "objdump", "-d", "-z", "--no-show-raw-insn", elf.path],
                                check=True, capture_output=True, text=True).stdout
        comment = "@;" if elf.is_arm else "#"
        pattern = re.compile(rf"\s*([0-9a-f]+):\t(\S+)\s*([^{comment}<]*)")
        self.decode = self.decode_arm if elf.is_arm else self.decode_riscv
        last = None
        for line in output.splitlines():
            match = re.match(pattern, line)
            if match is None:
                continue
            name = match[2].removesuffix(".n").removesuffix(".w")
            i = Instruction()
            i.address, i.name, i.operands = int(match[1], 16), name, match[3].strip()
            i.kind, i.target, i.move, i.next = None, None, 0, None
            if last is not None:
                last.next = i.address
            last = None if name.startswith(".") else i  # what follows data is reached by a jump only
            if not name.startswith("."):
                self.code[i.address] = i
        self.memo = {}

    # The function that holds an address, as its start; padding between functions belongs to none.
    def owner(self, address):
        at = bisect.bisect_right(self.starts, address)
        start = self.starts[at - 1] if at else None
        size = self.elf.functions[start][1] if at else 0
        return start if at and (size == 0 or address < start + size) else None

    def name(self, address):
        return self.elf.functions.get(address, (hex(address), 0))[0]

    def problem(self, i, text):
        text = f"{self.name(self.owner(i.address))} at {i.address:#x}: {text}: {i.name} {i.operands}"
        if text not in self.problems:
            self.problems.append(text)

    # Decoded when first reached, as data may stand between functions.
    def at(self, address):
        i = self.code[address]
        if i.kind is None:
            i.kind = PLAIN
            self.decode(i)
        return i

    def decode_arm(self, i):
        ops, name = i.operands, i.name
        if re.fullmatch("b" + CONDITION, name):
            i.kind, i.target = BRANCH, int(ops, 16)
            return
        # In an IT block: what may be skipped may take from the stack but does not give back.
        match = re.fullmatch("(push|pop|vpush|vpop|bx|blx|bl|ldr|ldmia|stmdb|add|sub|mov)" + CONDITION, name)
        conditional = match is not None
        if conditional:
            name = match[1]

        if name == "bl":
            i.kind, i.target = CALL, int(ops, 16)
            if self.name(i.target).startswith("__gnu_thumb1_case_"):
                i.kind = SWITCH
            elif i.target not in self.elf.functions and self.owner(i.target) == self.owner(i.address):
                i.kind = BRANCH  # Thumb-1's jump for more than 2 KB, or the library's local subroutine
        elif name in ("bx", "mov") and re.match(r"(pc, )?lr$", ops):
            i.kind = RETURN
        elif name in ("pop", "ldmia") and re.search(r"\bpc\b", ops):
            i.kind = RETURN
        elif name == "ldr" and ops.startswith("pc, [sp]"):
            i.kind = RETURN
        elif name in ("tbb", "tbh") or name in ("mov", "ldr", "add") and ops.startswith("pc,"):
            i.kind = SWITCH
        elif name in ("bx", "blx"):
            popped = any(b.name == "pop" and re.search(rf"\b{ops}\b", b.operands) for b in self.before(i, 6))
            i.kind = RETURN if name == "bx" and popped else INDIRECT
        elif name == "b":
            i.kind, i.target = JUMP, int(ops, 16)
        elif name in ("cbz", "cbnz"):
            i.kind, i.target = BRANCH, int(ops.split(",")[1], 16)
        elif name == "udf":
            i.kind = RETURN
        if conditional and i.kind in (RETURN, SWITCH):
            i.kind = PLAIN

        down = name in ("push", "vpush") or name == "stmdb" and ops.startswith("sp!")
        up = name in ("pop", "vpop") or name == "ldmia" and ops.startswith("sp!")
        if down or up:
            i.move = self.registers(ops) * (1 if down else -1)
        elif re.fullmatch(r"v?(ldm|stm)\w*", name) and ops.startswith("sp!"):
            self.problem(i, "stack use not understood")
        elif re.search(r"\[sp, #-?\d+\]!", ops):
            i.move = -int(re.search(r"#(-?\d+)\]!", ops)[1])
        elif re.search(r"\[sp\], #-?\d+", ops):
            i.move = -int(re.search(r"\], #(-?\d+)", ops)[1])
        elif name in ("add", "addw", "sub", "subw") and re.match(r"sp,", ops):
            value = re.search(r"#(\d+)$", ops)
            amount = int(value[1]) if value else self.constant(i, ops.split(", ")[-1])
            if re.match(r"sp, (?!sp|#)\w+, ", ops):
                self.problem(i, "stack pointer from a register")
            i.move = amount if name.startswith("sub") else -amount
        elif re.match(r"(sp$|sp,)", ops) and not re.match(r"(str|cmp|tst|v?ldm|v?stm)", name):
            self.problem(i, "stack pointer from a register")
        if conditional:
            i.move = max(i.move, 0)

    @staticmethod
    def registers(ops):
        number, width = 0, 4
        for part in re.search(r"\{(.*)\}", ops)[1].split(","):
            ends = [e.strip() for e in part.split("-")]
            width = 8 if ends[0].startswith("d") and ends[0] != "d" and ends[0][1:].isdigit() else 4
            number += (int(ends[1][1:]) - int(ends[0][1:]) + 1 if len(ends) == 2 else 1) * width
        return number

    def decode_riscv(self, i):
        ops = i.operands.split(",") if i.operands else []
        if i.name in ("jal", "call"):
            link = ops[0] if len(ops) == 2 else "ra"
            i.kind, i.target = CALL, int(ops[-1], 16)
            if link != "ra":
                self.problem(i, "call with another link register")
        elif i.name == "ret" or i.name == "mret":
            i.kind = RETURN
        elif i.name == "j":
            i.kind, i.target = JUMP, int(ops[0], 16)
        elif i.name == "jr":
            i.kind = SWITCH
        elif i.name == "jalr":
            i.kind = INDIRECT
        elif i.name.startswith("b") and ops:
            i.kind, i.target = BRANCH, int(ops[-1], 16)
        if i.name in ("add", "addi", "sub") and ops[:2] == ["sp", "sp"]:
            amount = int(ops[2]) if re.fullmatch(r"-?\d+", ops[2]) else self.constant(i, ops[2])
            i.move = amount if i.name == "sub" else -amount
        elif ops and ops[0] == "sp" and not re.match(r"(s[bhw]|fs[wd]|b\w+)$", i.name):
            self.problem(i, "stack pointer from a register")

    def before(self, i, size):
        return [self.code[a] for a in range(i.address - size, i.address) if a in self.code]

    # The constant in a register just before instruction i, by running the few instructions before it.
    def constant(self, i, register):
        value = None
        for before in self.before(i, 48):
            ops = [o.strip() for o in before.operands.split(",")]
            if ops[0] != register or before.name in ("cmp", "push", "pop", "str", "sw"):
                continue
            try:
                if before.name == "ldr" and ops[1] == "[pc":
                    offset = int(ops[2].strip("#]"))
                    value = self.elf.word((before.address + 4 & ~3) + offset)
                elif before.name in ("mov", "movs", "movw", "li"):
                    value = int(ops[1].strip("#"), 0)
                elif before.name == "lui":
                    value = int(ops[1], 0) << 12
                elif before.name in ("lsl", "lsls", "slli"):
                    value = value << int(ops[-1].strip("#"))
                elif before.name in ("neg", "negs", "rsbs"):
                    value = -value
                elif before.name in ("add", "adds", "addi"):
                    value += int(ops[-1].strip("#"))
                else:
                    value = None
            except (TypeError, ValueError):
                value = None
        if value is None:
            self.problem(i, "stack pointer moved by an unknown amount")
            return 0
        value &= 0xffffffff
        return value - (value >> 31 << 32)

    def walk(self, entry):
        """From a function's entry: its own deepest depth, and calls as (depth, address, target)."""
        depths, deepest, calls, switches = {}, 0, set(), []
        todo = [(entry, 0)]
        while todo:
            address, depth = todo.pop()
            while address in self.code:
                if depths.get(address, -1) >= depth:
                    break
                if depth > 1 << 24:
                    self.problem(self.code[address], "stack grows in a loop")
                    break
                i = self.at(address)
                depths[address] = depth
                after = depth + i.move
                deepest = max(deepest, after)
                if i.kind == CALL:
                    calls.add((after, address, i.target))
                elif i.kind == INDIRECT:
                    self.problem(i, "call through a pointer")
                elif i.kind == SWITCH:
                    switches.append((address, after))
                elif i.kind == BRANCH:
                    todo.append((i.target, after))
                if i.kind in (RETURN, SWITCH):
                    break
                is_call = i.name == "bl" or i.kind == CALL
                if is_call and i.next is not None and self.owner(i.next) != self.owner(address):
                    break  # a call that does not return, at the end of its function
                address, depth = i.target if i.kind == JUMP else i.next, after
            if not todo and switches:
                # All ways out of a switch leave at its depth: take the code of its function that nothing else
                # has reached, from the top.
                at, depth = switches[0]
                start = self.owner(at)
                end = start + self.elf.functions[start][1]
                rest = [a for a in range(at + 1, end) if a in self.code and a not in depths]
                if rest:
                    todo.append((rest[0], depth))
                else:
                    switches.pop(0)
        return deepest, calls, depths

    def bound(self, entry, chain=()):
        """(bytes, chain of (name, depth at the call)) of the deepest path from a function's entry."""
        if entry in chain:
            names = " -> ".join(self.name(a) for a in chain[chain.index(entry):] + (entry,))
            text = f"recursion: {names}"
            if text not in self.problems:
                self.problems.append(text)
            return 0, []
        if entry not in self.memo:
            own, calls, _ = self.walk(entry)
            best = own, [(self.name(entry), own)]
            for depth, _, target in sorted(calls):
                deep, path = self.bound(target, chain + (entry,))
                if depth + deep > best[0]:
                    best = depth + deep, [(self.name(entry), depth)] + path
            self.memo[entry] = best
        return self.memo[entry]


def readable(tools, text):
    """The text with C++ names as written, without template arguments and parameters."""
    text = subprocess.run([tools + "c++filt"], input=text, check=True, capture_output=True, text=True).stdout
    for inner in (r"<[^<>]*>", r"\([^()]*\)(?= const|\b|[:\]]|$)"):
        while re.search(inner, text, re.M):
            text = re.sub(inner, "", text, flags=re.M)
    return text


def main():
    tools, path = sys.argv[1:3]
    program = Program(Elf(path), tools)
    total, chain = program.bound(program.elf.symbol("start"))
    lines = [f"{depth:6} {name}" for name, depth in chain] + [f"{total:6} total"] + program.problems
    print(readable(tools, "\n".join(lines)))


if __name__ == "__main__":
    main()
