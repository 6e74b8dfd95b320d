"""The scenes of scenes/ on the boards: the desktop's bytes, sound linked files, and budgets kept. From the
top of the repository: python3 tests/firmware/test_scenes.py; with --all, every scene on every board in q16,
q24, q32 and float."""

import concurrent.futures
import glob
import os
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = ["src/boards/common", "src/study", "tests/firmware"]
import check_elf  # noqa: E402
from programs import make  # noqa: E402
from test_boards import BOARDS, PARTS, tools  # noqa: E402

BUDGETS = "tests/firmware/budgets.txt"
OPTIONS = {"horizon": "SAMPLES=4", "castle": "ADAPTIVE=2", "mirrors": "DEPTH=9", "glass": "CUTOFF=0.02",
           "cornell": "LIGHT_BITS=4"}
FLAGS = {"SAMPLES": "-r", "ADAPTIVE": "-a", "DEPTH": "-d", "CUTOFF": "--cutoff", "LIGHT_BITS": "--light-bits"}
ALL = "--all" in sys.argv


def scenes():
    return sorted(os.path.basename(path).removesuffix(".nff") for path in glob.glob("scenes/*.nff"))


def budgets():
    """(board, scene, number) of each line."""
    with open(BUDGETS) as file:
        lines = [line.split("#")[0].split() for line in file]
    return [tuple(line[:3]) for line in lines if line]


def images():
    """What is built and run: all that has a budget, each scene in q32 on the microbit, and in q32 on another board or
    in float, q16 or q24 on one, by turns."""
    chosen = set(budgets())
    for k, scene in enumerate(scenes()):
        chosen.add(("microbit", scene, "q32"))
        chosen.add((BOARDS[1 + k // 2 % 4], scene, "q32") if k % 2 == 0 else
                   (BOARDS[k // 2 % 5], scene, ("float", "q16", "q24")[k // 2 % 3]))
        if ALL:
            chosen |= {(board, scene, number) for board in BOARDS for number in ("q16", "q24", "q32", "float")}
    return sorted(chosen)


def size(scene):
    """That of the budgets, else a small one."""
    return "64x48" if any(scene == known for _, known, _ in budgets()) else "32x24"


def desktop(scene, number):
    path = f"build/desktop/{scene}-{number}.ppm"
    option, _, value = OPTIONS.get(scene, "").partition("=")
    subprocess.run(["build/qray", f"scenes/{scene}.nff", "-n", number, "-s", size(scene), "-q", "-o", path,
                    *([FLAGS[option], value] if option else [])], check=True)
    with open(path, "rb") as file:
        return file.read()


def faults(board, scene, number, expected):
    """What is wrong with a board's picture and its firmware."""
    elf = f"build/{board}/{scene}-{number}.elf"
    status, text = make("-o", "build/qray", "run", f"BOARD={board}", f"SCENE=scenes/{scene}.nff", f"NUMBER={number}",
                        f"SIZE={size(scene)}", OPTIONS.get(scene, "--silent"), "FW_COUNT=echo 0")  # rays: of no use
    if status != 0:
        return [text]
    with open(elf.removesuffix("elf") + "ppm", "rb") as file:
        got = file.read()
    differ = sum(a != b for a, b in zip(got, expected))
    wrong = [f"{differ} bytes differ from the desktop's"] if got != expected else []
    return wrong + check_elf.check(elf, tools(board), BUDGETS)


class Scenes(unittest.TestCase):
    def test_boards_draw_the_desktops_bytes(self):
        os.makedirs("build/desktop", exist_ok=True)
        chosen = images()
        with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
            expected = {key: pool.submit(desktop, *key) for key in {image[1:] for image in chosen}}
            expected = {key: picture.result() for key, picture in expected.items()}
            runs = {image: pool.submit(faults, *image, expected[image[1:]]) for image in chosen}
            for image, run in runs.items():
                with self.subTest(image=image):
                    self.assertEqual(run.result(), [])

    # The product's image: no semihosting, and the picture by the serial port.
    def test_the_serial_port_sends_the_desktops_bytes(self):
        os.makedirs("build/desktop", exist_ok=True)
        expected = {number: desktop("balls", number) for number in ("q32", "float")}
        for board in BOARDS + PARTS:
            number = "float" if board == "netduinoplus2" else "q32"
            with self.subTest(board=board):
                status, text = make("-o", "build/qray", "run", f"BOARD={board}", "SCENE=scenes/balls.nff",
                                    f"NUMBER={number}", f"SIZE={size('balls')}", "NAME=serial", "OUTPUT=uart")
                self.assertEqual(status, 0, text)
                with open(f"build/{board}/serial-{number}.ppm", "rb") as file:
                    self.assertEqual(file.read(), expected[number])
                elf = f"build/{board}/serial-{number}-uart.elf"
                self.assertEqual(check_elf.check(elf, tools(board), None), [])


if __name__ == "__main__":
    unittest.main(argv=[a for a in sys.argv if a != "--all"])
