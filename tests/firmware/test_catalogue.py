"""The hard cases on the boards: tests/hard_catalogue.hpp, case by case, and pictures whose every pixel is known.
From the top of the repository: python3 tests/firmware/test_catalogue.py"""

import concurrent.futures
import glob
import os
import re
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, "src/study")
from programs import make  # noqa: E402
from settings import board_facts  # noqa: E402

# What reject.hpp, base.hpp and the number systems do differently on a core each.
IMAGES = [("microbit", "q32"), ("microbit", "q16"), ("microbit", "q24"), ("microbit", "float"), ("mps2_an385", "q32"),
          ("mps2_an385", "q24"), ("mps2_an386", "float"), ("rv32_virt", "q32"), ("rv32_virt", "q24")]
TYPES = {"float": "Float", "double": "Double"}  # of those whose name is another

VIEW = "v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 9 9\n"
MIRRORS = "disc 0 0 -3 0 0 1 30\n disc 0 0 8 0 0 1 30\n"
# Name: (scene, options of make, the one colour of all pixels); each is a test of test_hard_cases.cpp, too.
PICTURES = {
    "sixteen_lights_of_one_saturate": (
        VIEW + 16 * "l 0 0 5 1 1 1\n" + "b 0 0 0\n ambientlight 0 0 0\n material highlight 1 shine 3\n"
        "disc 0 0 0 0 0 1 20\n", [], (255, 255, 255)),
    "sixtyfour_lights_gathered_by_mirrors_saturate": (
        VIEW + 64 * "l 0 0 5 64 64 64\n" + "b 64 64 64\n ambientlight 64 64 64\n"
        "material highlight 1 mirror 1\n disc 0 0 0 0 0 1 20\n disc 0 0 9 0 0 -1 20\n", ["DEPTH=64"],
        (255, 255, 255)),
    "sixtyfour_samples_of_white_are_white": (
        VIEW + "b 1 1 1\n ambientlight 1 1 1\n material diffuse 0\n disc 0 0 0 0 0 1 1\n", ["SAMPLES=64"],
        (255, 255, 255)),
    "facing_mirrors_of_weight_one_are_black": (
        VIEW + "b 0 0 0\n ambientlight 0 0 0\n material colour 0 0 0 mirror 1\n" + MIRRORS, ["DEPTH=64"], (0, 0, 0)),
    # 1/2 sum 2^-k over 40 depths is 1 - 2^-40 times the colour.
    "mirrors_of_a_half_for_40_bounces": (
        VIEW.replace("9 9", "1 1") + "b 0 0 0\n ambientlight 1 1 1\n"
        "material colour 0.4 0.2 0.8 mirror 0.5 diffuse 0\n" + MIRRORS, ["DEPTH=40", "CUTOFF=0"], (204, 102, 255)),
    "light_inside_an_opaque_ball_stays_there": (
        VIEW + "b 0 0 0\n ambientlight 0 0 0\n l 0 0 0 1 1 1\n material\n s 0 0 0 0.01\n disc 0 0 -2 0 0 1 20\n", [],
        (0, 0, 0)),
    "camera_of_a_single_pixel": (
        "v from 0 0 5 at 0 0 0 up 0 1 0 angle 179.999 hither 1 resolution 1 1\n b 0 0 0\n ambientlight 1 1 1\n"
        "material colour 0.2 0.4 1 diffuse 0\n s 0 0 0 1\n", [], (51, 102, 255)),
    # Inside of a glass ball that shines with nothing, in a furnace of light 1.
    "glass_in_a_furnace_adds_no_light": (
        "v from 0.1 0.2 0.3 at 1 0.4 0.7 up 0 1 0 angle 120 hither 1 resolution 9 9\n b 1 1 1\n ambientlight 0 0 0\n"
        "material colour 0 0 0 ambient 0 diffuse 0 transmit 1 ior 1\n s 0 0 0 1\n", ["DEPTH=12", "CUTOFF=0"],
        (255, 255, 255)),
}
FOLDER = "build/hard"


def case_count():
    count = 0
    for path in glob.glob("tests/hard/*.hpp"):
        with open(path) as file:
            count += len(re.findall(r"^QRAY_CASE\(", file.read(), re.M))
    return count


def run_catalogue(board, number, name="catalogue", **options):
    """What the firmware says: {name: number} and the lines of cases that do not hold."""
    elf = f"build/{board}/{name}-{number}.elf"
    status, text = make(elf, f"BOARD={board}", f"NAME={name}", f"NUMBER={number}",
                        "FW_MAIN=tests/firmware/catalogue.cpp",
                        f"FW_EXTRA=-DCATALOGUE_NUMBER={TYPES.get(number, number)}",
                        *(f"{k}={v}" for k, v in options.items()))
    if status != 0:
        raise RuntimeError(text)
    qemu = board_facts(board)["qemu"].split()
    done = subprocess.run(qemu + ["-nographic", "-monitor", "none", "-serial", "none", "-semihosting-config",
                                  f"enable=on,target=native,arg={elf}.ppm", "-kernel", elf],
                          capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL)
    said = done.stdout + done.stderr
    values = {k: int(v, 16) for k, v in re.findall(r"^(\w+): (0x\w+)$", said, re.M)}
    fails = re.findall(r"^(\w+) does not hold: (\S+)(0x\w+)$", said, re.M)
    return done.returncode, values, [(name, f"{file}{int(line, 16)}") for name, file, line in fails]


class Catalogue(unittest.TestCase):
    def test_every_case_holds_on_every_core(self):
        with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
            for image, run in [(i, pool.submit(run_catalogue, *i)) for i in IMAGES]:
                with self.subTest(image=image):
                    status, values, wrong = run.result()
                    self.assertEqual((status, wrong), (0, []))
                    self.assertEqual((values["passed"], values["failed"]), (case_count(), 0))
                    self.assertGreater(values["checks"], 10_000)

    def test_pictures_of_one_colour(self):
        def draw(name, number):
            path = f"{FOLDER}/{name}.nff"
            with open(path, "w") as file:
                file.write(PICTURES[name][0])
            status, text = make("-o", "build/qray", "run", "BOARD=microbit", f"SCENE={path}", f"NUMBER={number}",
                                *PICTURES[name][1])
            if status != 0:
                raise RuntimeError(text)
            with open(f"build/microbit/{name}-{number}.ppm", "rb") as file:
                width, height, rgb = re.match(rb"P6\n(\d+) (\d+)\n255\n(.*)$", file.read(), re.S).groups()
            return int(width) * int(height), rgb

        os.makedirs(FOLDER, exist_ok=True)
        with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
            for name, run in [(name, pool.submit(draw, name, "q32")) for name in PICTURES]:
                with self.subTest(name=name):
                    pixels, rgb = run.result()
                    self.assertEqual(rgb, bytes(PICTURES[name][2]) * pixels)


if __name__ == "__main__":
    unittest.main()
