"""Animations on the boards: the desktop's bytes, frame by frame. From the top of the repository:
python3 tests/firmware/test_frames.py; with --all, twenty frames of all of them on every board that counts."""

import os
import re
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, "src/study")
import moving  # noqa: E402
from programs import make  # noqa: E402

ALL = "--all" in sys.argv
FRAMES = 20 if ALL else 3
SCENE = "build/frames_test/moves.nff"
WITHIN = "-7,-1,-7,7,7,7"
ANIMATIONS = ["orbit", "ball", "tumble", "mesh"]
BOARDS = ["microbit", "mps2_an385", "mps2_an386", "rv32_virt"]
NUMBERS = ["q16", "q32", "float", "q24"]


def scene():
    """That of the study: a ball, a cone, a polygon and a mesh with a tree, lit by one lamp; in colours."""
    text = moving.scene("0 1 0")
    for shape, material in (("s", "colour 0.9 0.2 0.2 highlight 0.5 shine 9"), ("c", "colour 0.2 0.8 0.3 highlight 0"),
                            ("p", "colour 0.3 0.4 0.9")):
        text = text.replace(f"\n{shape} ", f"\nmaterial {material} diffuse 0.8\n{shape} ", 1)
    return text


def contents(path):
    with open(path, "rb") as file:
        return file.read()


class Frames(unittest.TestCase):
    def drawn(self, *arguments):
        status, text = make(*arguments, f"SCENE={SCENE}", f"WITHIN={WITHIN}", f"FRAMES={FRAMES}")
        self.assertEqual(status, 0, text)

    def test_boards_draw_the_desktops_frames(self):
        os.makedirs(os.path.dirname(SCENE), exist_ok=True)
        with open(SCENE, "w") as file:
            file.write(scene())
        for k, animation in enumerate(ANIMATIONS):
            for number in NUMBERS if ALL else [NUMBERS[k]]:
                boards = BOARDS if ALL else [BOARDS[k]]
                self.drawn("frames", f"ANIMATION={animation}", f"NUMBER={number}")
                expected = contents(f"build/frames/moves-{animation}-{number}.ppm")
                size = len(expected) // FRAMES
                self.assertEqual(len({expected[i * size:(i + 1) * size] for i in range(FRAMES)}), FRAMES)
                for board in boards:
                    with self.subTest(animation=animation, number=number, board=board):
                        self.drawn("run", f"BOARD={board}", f"ANIMATION={animation}", f"NUMBER={number}")
                        self.assertEqual(contents(f"build/{board}/moves-{animation}-{number}.ppm"), expected)

    # Some triangles move, others are in little room: that compiles without a warning.
    def test_beside_what_stands_still(self):
        words = ["SCENE=scenes/patches.nff", "ANIMATION=mesh", "NUMBER=q32", "SIZE=16x12", "FRAMES=2"]
        for command in ["frames"], ["run", "BOARD=mps2_an386"]:
            status, text = make(*command, *words)
            self.assertEqual(status, 0, text)
        self.assertEqual(contents("build/mps2_an386/patches-mesh-q32.ppm"),
                         contents("build/frames/patches-mesh-q32.ppm"))

    # A frame is the desktop's picture of the text with that frame's numbers.
    def test_frames_are_those_of_the_text(self):
        os.makedirs(os.path.dirname(SCENE), exist_ok=True)
        with open(SCENE, "w") as file:
            file.write(scene())
        # Half way, the ball is as high as it is wide, and the lamp as far on its other side.
        text = scene().replace("s -2 1 0 0.75", "s -2 2.5 0 0.75").replace("l 3 6 4", "l -7 6 -4")
        with open("build/frames_test/half.nff", "w") as file:
            file.write(text)
        status, said = make("frames", f"SCENE={SCENE}", f"WITHIN={WITHIN}", "FRAMES=2", "ANIMATION=ball")
        self.assertEqual(status, 0, said)
        run = ["build/qray", "build/frames_test/half.nff", "-q", "--within", WITHIN, "-o", "build/frames_test/half.ppm"]
        self.assertEqual(subprocess.run(run).returncode, 0)
        half = contents("build/frames_test/half.ppm")
        self.assertEqual(contents("build/frames/moves-ball-q32.ppm")[-len(half):], half)

    def test_what_cannot_be(self):
        status, text = make("frames", f"SCENE={SCENE}", "ANIMATION=none")
        self.assertNotEqual(status, 0)
        self.assertIn("there is no animation none", text)
        for frames in ("0", "-1", "1.5", "x", "4294967297"):
            status, text = make("frames", f"SCENE={SCENE}", "ANIMATION=orbit", f"FRAMES={frames}")
            self.assertNotEqual(status, 0)
            self.assertIn(f"FRAMES={frames}: expected a whole number from 1 to 999999", text)
        status, text = make("frames")
        self.assertNotEqual(status, 0)
        self.assertIn("usage", text)

    # README's own line draws; without its box the eye leaves the scene's, and what to do is said.
    def test_the_line_of_readme(self):
        words = re.search(r"^    make (frames .*?)\s+#", contents("README.md").decode(), re.M)[1].split()
        self.assertEqual(make(*words, "SIZE=16x12")[0], 0)
        status, text = make(*(word for word in words if not word.startswith("WITHIN=")), "SIZE=16x12")
        self.assertNotEqual(status, 0)
        self.assertIn("a move that leaves the scene's frame was refused; expected WITHIN=", text)


if __name__ == "__main__":
    unittest.main(argv=[a for a in sys.argv if a != "--all"])
