"""Every board, end to end, with pictures and programs whose results are known without running them; and that
check_elf.py finds what it is for. From the top of the repository: python3 tests/firmware/test_boards.py"""

import os
import re
import sys
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = ["src/boards/common", "src/study", "tests/firmware"]
import check_elf  # noqa: E402
from programs import make, values  # noqa: E402

BOARDS = ["microbit", "mps2_an385", "mps2_an386", "mps2_an500", "rv32_virt"]
# Parts with these cores: what is theirs alone, memory, serial port and clock, takes a picture to see.
PARTS = ["lm3s6965evb", "netduinoplus2", "stm32vldiscovery"]


def tools(board):
    return "riscv64-unknown-elf-" if board.startswith("rv32") else "arm-none-eabi-"


def card(width, height):
    """The test card by its definition in src/firmware/test_card.hpp."""
    out = bytearray(f"P6\n{width} {height}\n255\n".encode())
    for y in range(height):
        for x in range(width):
            a = x * 2654435769 % 2**32
            b = (y * 2246822519 + 1) % 2**32
            out += bytes((255 * x // max(width - 1, 1), a * b >> 32 & 255,
                          ((x % 1024)**2 + (y % 1024)**2) // 8 % 256))
    return bytes(out)


class Boards(unittest.TestCase):
    def test_card(self):
        for board in BOARDS:
            for size, name in (("64x48", "card"), ("1x1", "card_1"), ("129x7", "card_129")):
                for output in ("semihosting", "uart"):
                    with self.subTest(board=board, size=size, output=output):
                        status, text = make("run", f"BOARD={board}", f"SIZE={size}", f"NAME={name}",
                                            f"OUTPUT={output}")
                        self.assertEqual(status, 0, text)
                        with open(f"build/{board}/{name}-float.ppm", "rb") as file:
                            self.assertEqual(file.read(), card(*map(int, size.split("x"))))
                        self.assertEqual(values(text)["ram"], -(-3 * int(size.split("x")[0]) // 4) * 4)
                for elf in (f"build/{board}/{name}-float.elf", f"build/{board}/{name}-float-uart.elf"):
                    self.assertEqual(check_elf.check(elf, tools(board), None), [])

    # Three instructions a loop; what is added is the call of the output, and two ticks at most.
    def test_instructions(self):
        for board in BOARDS + PARTS:
            with self.subTest(board=board):
                status, text = make("run", f"BOARD={board}", "NAME=count", "FW_MAIN=tests/firmware/count.cpp",
                                    "FW_EXTRA=-DLOOPS=1000000")
                self.assertEqual(status, 0, text)
                self.assertLess(abs(values(text)["instructions"] - 3_000_000), 200)

    # A row longer than the 24 bits of SysTick, on the board whose ticks are shortest.
    def test_instructions_beyond_a_wrap(self):
        status, text = make("run", "BOARD=netduinoplus2", "NAME=count", "FW_MAIN=tests/firmware/count.cpp",
                            "FW_EXTRA=-DLOOPS=40000000")
        self.assertEqual(status, 0, text)
        self.assertLess(abs(values(text)["instructions"] - 120_000_000), 200)

    def test_stack(self):
        for board in BOARDS:
            with self.subTest(board=board):
                status, text = make("run", f"BOARD={board}", "NAME=deep", "FW_MAIN=tests/firmware/count.cpp",
                                    "FW_EXTRA=-DLOOPS=1 -DDEEP")
                self.assertEqual(status, 0, text)
                found = values(text)
                self.assertGreaterEqual(found["stack"], 400)
                self.assertEqual(found["stack"], found["stack_bound"])

    def test_faults(self):
        for board in BOARDS:
            for what, message in (("", "fault: "), ("-DJUMP", "fault: .* at 0x30000000"),
                                  ("-DSTATUS", "stopped|exit status 7")):
                for output in ("semihosting", "uart"):
                    with self.subTest(board=board, what=what, output=output):
                        name = "fault" + what[2:].lower()
                        status, text = make("run", f"BOARD={board}", f"NAME={name}", f"OUTPUT={output}",
                                            "FW_MAIN=tests/firmware/fault.cpp", f"FW_EXTRA={what}")
                        if "JUMP" in what:  # refused for its call through a pointer, so run it regardless
                            self.assertIn("call through a pointer", text)
                            status, text = make("run", f"BOARD={board}", f"NAME={name}", f"OUTPUT={output}",
                                                "FW_MAIN=tests/firmware/fault.cpp", f"FW_EXTRA={what}",
                                                "UNBOUNDED=yes")
                        self.assertNotEqual(status, 0)
                        self.assertRegex(text, message)
                        self.assertFalse(os.path.exists(f"build/{board}/{name}-float.ppm"))


class Usage(unittest.TestCase):
    def refused(self, said, *arguments, **environment):
        with self.subTest(arguments=arguments):
            status, text = make(*arguments, **environment)
            self.assertEqual(status, 2)
            lines = [line for line in text.splitlines() if not re.match(r"make: \*\*\* \[", line)]
            self.assertEqual(len(lines), 1, text)
            self.assertIn(said, lines[0])

    def test_what_cannot_be(self):
        run = ["run", "BOARD=microbit"]
        scene = "SCENE=scenes/balls.nff"
        self.refused("no board z80", "run", "BOARD=z80")
        self.refused("OUTPUT=usart", *run, scene, "OUTPUT=usart")
        self.refused("NUMBER=q8", *run, scene, "NUMBER=q8")
        self.refused("NUMBER=:", *run, scene, "NUMBER=")
        self.refused("no scene scenes/none.nff", *run, "SCENE=scenes/none.nff")
        self.refused("SIZE=64", *run, "SIZE=64")
        self.refused("SIZE=0x4", *run, "SIZE=0x4")
        self.refused("profile", "profile", "BOARD=microbit", scene, "OUTPUT=uart")
        for name in ("a b", "it's", 'a"b', "k(l)", "a&b", "a;b", "a:b", "a%b", "a|b", "a<b", "a*b"):
            self.refused("make cannot", *run, f"SCENE=build/{name}.nff")
            self.refused("make cannot", *run, f"NAME={name}")

    def test_what_does_not_fit(self):
        self.refused("ram of microbit is ", "run", "BOARD=microbit", "NAME=wide", "SIZE=6000x1")

    # Of the shell that make runs in: Zephyr's tools have a BOARD, and WSL has a NAME.
    def test_environment(self):
        status, text = make("-n", "build/qray", BOARD="nrf52840dk", NAME="DESKTOP")
        self.assertEqual(status, 0, text)
        status, text = make("-n", "run", "BOARD=microbit", "SCENE=scenes/balls.nff", NAME="DESKTOP")
        self.assertEqual(status, 0, text)
        self.assertIn("build/microbit/balls-q32.ppm", text)
        self.assertNotIn("DESKTOP", text)


MAIN = '#include "boards/common/board.hpp"\n%s\nint main() { %s }\n'


class CheckElf(unittest.TestCase):
    def faults(self, board, name, declarations, body, number="q32"):
        os.makedirs("build/check_elf", exist_ok=True)
        source = f"build/check_elf/{name}.cpp"
        with open(source, "w") as file:
            file.write(MAIN % (declarations, body))
        elf = f"build/{board}/check_{name}-{number}.elf"
        if os.path.exists(elf):
            os.remove(elf)
        status, text = make("size", f"BOARD={board}", f"NAME=check_{name}", f"NUMBER={number}",
                            f"FW_MAIN={source}", "FW_EXTRA=-Wno-error")
        self.assertTrue(os.path.exists(elf), text)
        return elf, check_elf.check(elf, tools(board), None)

    def expect(self, text, name, declarations, body, **options):
        for board in ("microbit", "mps2_an386", "rv32_virt"):
            with self.subTest(board=board, name=name):
                faults = self.faults(board, name, declarations, body, **options)[1]
                self.assertTrue(any(re.search(text, fault) for fault in faults), faults)

    def test_good(self):
        for board in BOARDS:
            with self.subTest(board=board):
                faults = self.faults(board, "good", "", "return board::reg(0x4000'0000) != 0;")[1]
                self.assertEqual(faults, [])

    def test_recursion(self):
        self.expect("recursion: .*f", "recursion", "[[gnu::noinline]] int f(int n)"
                    "{ volatile int a = n; return n < 2 ? a : f(n / 2) + f(n / 3) * a; }",
                    "return f(int(board::reg(0x4000'0000)));")

    def test_mutual_recursion(self):
        self.expect("recursion: .*(f.*g|g.*f)", "mutual", "int g(int);"
                    "[[gnu::noinline, gnu::noclone]] int f(int n) { return n < 2 ? n : 3 * g(n / 2); }"
                    "[[gnu::noinline, gnu::noclone]] int g(int n) { return n < 3 ? n : 5 + f(n / 3); }",
                    "return f(int(board::reg(0x4000'0000)));")

    def test_recursion_by_jumps(self):
        self.expect("recursion by jumps", "jumps", "int g(int);"
                    "[[gnu::noinline, gnu::noclone]] int f(int n) { return n < 2 ? n : g(n / 2); }"
                    "[[gnu::noinline, gnu::noclone]] int g(int n) { return n < 3 ? n : f(n / 3); }",
                    "return f(int(board::reg(0x4000'0000)));")

    def test_pointer(self):
        self.expect("call through a pointer", "pointer", "",
                    "auto f = reinterpret_cast<int (*)()>(board::reg(0x4000'0000)); return f() + 1;")

    def test_global(self):
        self.expect("counter is a mutable global of 4 bytes", "global", "volatile int counter;",
                    "counter = 3; return counter;")

    def test_constructor(self):
        self.expect("section .init_array of 4 bytes", "constructor",
                    "struct S { S() { board::reg(0x4000'0000) = 1; } } s;", "return 0;")

    def test_undefined(self):
        self.expect("nowhere is undefined", "undefined", 'extern "C" [[gnu::weak]] int nowhere();',
                    "return nowhere != nullptr;")

    def test_allocation(self):
        self.expect("malloc is linked", "allocation",
                    'extern "C" [[gnu::noinline]] void* malloc(decltype(sizeof 0))'
                    '{ asm volatile(""); return nullptr; }',
                    "return malloc(board::reg(0x4000'0000)) != nullptr;")

    def test_soft_float(self):
        self.expect("library is not for q32", "double", "",
                    "volatile double x = 3; return int(x * x / 7 + x);")

    # A compiler loads and stores several words of its frame at once.
    def test_words_at_the_stack_pointer(self):
        for board in ("mps2_an385", "mps2_an386"):
            faults = self.faults(board, "words", "", 'asm volatile("ldmia sp, {r0, r1}\\n stmia sp, {r0, r1}" '
                                 '::: "r0", "r1", "memory"); return 0;')[1]
            self.assertEqual(faults, [])

    def test_frame_of_no_fixed_size(self):
        self.expect("no fixed size|unknown amount|from a register", "alloca", "",
                    "auto* a = static_cast<volatile char*>(__builtin_alloca(board::reg(0x4000'0000)));"
                    "a[0] = 1; return a[board::reg(0x4000'0004)];")

    def test_budgets(self):
        elf, _ = self.faults("microbit", "budget", "[[gnu::noinline]] void f()"
                             "{ volatile char a[200]; a[0] = 1; }", "f(); return 0;")
        size = values(make("size", "BOARD=microbit", "NAME=check_budget", "NUMBER=q32",
                           "FW_MAIN=build/check_elf/budget.cpp", "FW_EXTRA=-Wno-error")[1])
        exact = [int(size[k]) for k in ("flash", "ram", "stack_bound")]
        self.assertGreaterEqual(exact[2], 200)
        for change, text in ((None, None), (0, "flash"), (1, None), (2, "stack")):
            limits = [v - (i == change) for i, v in enumerate(exact)]
            limits[1] = max(limits[1], 0)
            with open("build/check_elf/budgets.txt", "w") as file:
                file.write("# comment\nmicrobit check_budget q32 %d %d %d\n" % tuple(limits))
            faults = check_elf.check(elf, tools("microbit"), "build/check_elf/budgets.txt")
            if text is None:
                self.assertEqual(faults, [])
            else:
                self.assertEqual(len(faults), 1)
                self.assertRegex(faults[0], f"{text} of .* is above the budget of")


if __name__ == "__main__":
    unittest.main()
