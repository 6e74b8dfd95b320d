"""make plan: what it says of a scene, against firmware and pictures of the whole.
From the top of the repository, after make: python3 tests/test_plan.py"""

import math
import os
import re
import subprocess
import sys
import time
import types
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, "src/study")
import pictures  # noqa: E402
import plan as planning  # noqa: E402
from programs import environment  # noqa: E402

SCENE, BOARD, SIZE = "build/test_plan.nff", "rv32_virt", "200x150"
# Edges lie between pixels, and in every sixteenth row on them: what stands for the picture must not be whole rows.
WALL = """v from 0 0.02 9  at 0 0.02 0  up 0 1 0  angle 40  hither 1  resolution 320 240
l -3 5 8
material colour 0.8 0.4 0.2 texture stripes 1 1 1 0.8735 0 1 0
p 4  -9 -6 0  9 -6 0  9 6 0  -9 6 0
"""


def make(*words):
    done = subprocess.run(["make", "--no-print-directory", *words], capture_output=True, text=True, env=environment())
    return done.returncode, done.stdout, done.stderr


def plan(*words, size=SIZE):
    return make("plan", f"SCENE={SCENE}", f"BOARD={BOARD}", f"SIZE={size}", *words)


def rows(text):
    """[{chosen, built, options of qray, of make, and the numbers of the row}, ...]"""
    out = []
    for line in text.splitlines():
        found = re.match(r"([* ]) (\w+) +(adaptive )?([\d.,]+) +(\d) ([~ ]) +(\d+) +([\d.]+ +)?([\d.]+)"
                         r" +([\d.]+) +([\d.]+)% +(\S+) +(\S+) +(\S+)$", line)
        if found:
            chosen, number, adaptive, samples, depth, rough, instructions, seconds, *accuracy, a, b, c = found.groups()
            decibels, flip, seen = map(float, accuracy)
            way = ("-a", "ADAPTIVE") if adaptive else ("-r", "SAMPLES")
            out.append({"chosen": chosen == "*", "built": rough == " ", "instructions": int(instructions),
                        "seconds": float(seconds or 0), "dB": decibels, "flip": flip, "seen": seen / 100,
                        "sizes": [a, b, c],
                        "qray": ["-n", number, way[0], samples, "-d", depth],
                        "make": [f"NUMBER={number}", f"{way[1]}={samples}", f"DEPTH={depth}"]})
    return out


def picture(*options):
    path = "build/test_plan.ppm"
    subprocess.run(["build/qray", SCENE, "-q", "-s", SIZE, "-o", path, *options], check=True)
    return pictures.read(path)


class Plan(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with open(SCENE, "w") as file:
            file.write(WALL)
        start = time.monotonic()
        cls.status, cls.text, cls.said = plan("ERROR=30dB")
        cls.seconds, cls.rows = time.monotonic() - start, rows(cls.text)

    def test_choice(self):
        self.assertEqual(self.status, 0, self.said)
        self.assertLess(self.seconds, 60)
        self.assertGreater(len(self.rows), 2, self.text)
        for one, other in zip(self.rows, self.rows[1:]):
            self.assertLess(one["instructions"], other["instructions"])
            self.assertLess(one["dB"], other["dB"])
        chosen = [r for r in self.rows if r["chosen"]]
        self.assertEqual(chosen, [r for r in self.rows if r["dB"] >= 30][:1])
        number, *_ = chosen[0]["make"]
        self.assertIn(f"\nmake run BOARD={BOARD} SCENE={SCENE} {number} SIZE={SIZE}", self.text)

    def test_accuracy_is_that_of_the_whole_picture(self):
        options = re.search(r"build/qray \S+ (.*?) -s", self.text)[1].split()
        better = picture(*options)
        for row in self.rows:
            drawn = picture(*row["qray"])
            mean = ((drawn - better) ** 2).mean()
            self.assertAlmostEqual(row["dB"], min(99, 10 * math.log10(255 ** 2 / mean)) if mean else 99, delta=1)
            seen = pictures.errors(drawn, better)
            self.assertAlmostEqual(row["flip"], seen["flip"], delta=1e-4)
            self.assertAlmostEqual(row["seen"], seen["seen"], delta=1e-3)

    def test_firmware_is_as_predicted(self):
        # One that was drawn whole, and one that was not.
        for row in (self.rows[0], self.rows[-1]):
            self.assertTrue(row["built"])
            status, out, err = make("run", f"BOARD={BOARD}", f"SCENE={SCENE}", f"SIZE={SIZE}", *row["make"])
            self.assertEqual(status, 0, err)
            found = dict(re.findall(r"^(\w+): (\d+)$", out, re.M))
            self.assertEqual(row["sizes"], [found[k] for k in ("flash", "ram", "stack_bound")])
            self.assertAlmostEqual(row["instructions"] / int(found["instructions"]), 1, delta=0.05)

    # From what is kept; what was asked for cannot be had, and what is said instead can.
    def test_what_cannot_be_had(self):
        status, out, err = plan("MHZ=1", "SECONDS=1")
        self.assertNotEqual(status, 0)
        self.assertNotIn("make run", out)
        cycles = float(re.search(r"q16 ([\d.]+)", out)[1])
        nearest = re.search(r"^make run (.*NUMBER=q16.*)$", err, re.M)[1].split()
        status, out, _ = make("run", *nearest)
        self.assertEqual(status, 0)
        self.assertLess(cycles * float(re.search(r"instructions: (\d+)", out)[1]), 1e6)
        status, out, err = plan("ERROR=100dB")
        self.assertNotEqual(status, 0)
        self.assertIn(f"the most accurate has {self.rows[-1]['dB']:.1f} dB", err)

    def test_mistakes(self):
        good = [f"SCENE={SCENE}", f"BOARD={BOARD}"]
        for words, said in (([f"SCENE={SCENE}", "BOARD=z80"], "microbit"), ([f"SCENE={SCENE}"], "microbit"),
                            ([f"BOARD={BOARD}"], "no scene"), (["SCENE=none.nff", f"BOARD={BOARD}"], "none.nff"),
                            (good + ["SIZE=0x4"], "WIDTHxHEIGHT"), (good + ["SECONDS=1"], "MHZ"),
                            (good + ["MHZ=fast"], "above 0"), (good + ["WAITS=-1"], "0 to 15"),
                            (good + ["ERROR=-3dB"], "above 0"), (good + ["MHZ=1", "SECONDS=nan"], "above 0"),
                            (good + ["CUTOFF=2"], "from 0 to 1")):
            status, out, err = make("plan", *words)
            self.assertNotEqual(status, 0, words)
            self.assertEqual(out, "", words)
            lines = [line for line in err.splitlines() if not re.match(r"make: \*\*\* \[", line)]
            self.assertEqual(len(lines), 1, err)
            self.assertIn(said, lines[0])


class Doubt(unittest.TestCase):
    """What few pixels say turns nothing away that the whole picture might choose."""
    @staticmethod
    def plan(combs, known, asked=None, length=32):
        """A plan that knows {setting: mean squares of the combs that were drawn}, of q16 and q32 with the same rays."""
        pixels, out = object.__new__(planning.Pixels), object.__new__(planning.Plan)
        pixels.head, pixels.seen = {"combs": combs, "length": length, "width": length, "height": combs}, {}
        pixels.known = {s: [(100, 3 * length * square, 0) for square in of] for s, of in known.items()}
        pixels.count = len(next(iter(known.values())))
        out.pixels, out.settings, out.refused, out.built, out.cycles = pixels, list(known), {}, {}, {}
        out.per_ray = {s: {"q16": 1, "q32": 2}[s.number] for s in known}
        out.question = types.SimpleNamespace(decibels=asked)
        return out

    cheap, dear = (planning.Setting(n, "1", 5, "0") for n in ("q16", "q32"))

    def test_the_margin(self):
        # Of 0, 0, 0, 4 the standard error is 1; a pixel of 4 * 2 may be off by 32 levels; a quarter of all is drawn.
        few = self.plan(16, {self.cheap: [0, 0, 0, 4]}, length=2).pixels
        margin = math.sqrt(3 / 4) * (3 * 1 + 32 ** 2 / 8)
        self.assertAlmostEqual(few.margin(few.squares(self.cheap)), margin)
        self.assertAlmostEqual(few.decibels(self.cheap), 10 * math.log10(255 ** 2 / 1))
        self.assertAlmostEqual(few.decibels(self.cheap, 1), 10 * math.log10(255 ** 2 / (1 + margin)))
        self.assertEqual(few.decibels(self.cheap, -1), 99)
        whole = self.plan(4, {self.cheap: [0, 0, 0, 4], self.dear: [0, 0, 0, 1]}, length=2).pixels
        self.assertEqual(whole.margin(whole.squares(self.cheap)), 0)
        self.assertAlmostEqual(whole.gain(self.dear, self.cheap), 10 * math.log10(4))

    def test_what_is_turned_away(self):
        noise = [4, 1, 9, 2, 7, 1, 3, 5] * 8
        for combs, dear, asked, stays in (
                (600, noise, None, False),  # the same pixels, the same errors
                (600, [n + 1 for n in noise], None, False),
                (600, [n + 4 for n in noise[1:] + noise[:1]], None, False),
                (600, noise[1:] + noise[:1], None, True),  # as good, but of other pixels
                (64, noise[1:] + noise[:1], None, False),  # that was all
                (600, [n - 1 for n in noise], None, True),
                (600, noise, 43, True),  # 42 dB: perhaps 43, and perhaps the other not
                (600, noise, 38, False), (600, noise, 50, False)):
            plan = self.plan(combs, {self.cheap: noise, self.dear: dear}, asked)
            self.assertIn(self.cheap, plan.promising())
            self.assertEqual(self.dear in plan.promising(), stays, (combs, dear[:8], asked))

    def test_a_picture(self):
        # 1,000 pixels of it say that 16 samples in q16 are worse than in three adaptive levels.
        os.makedirs(planning.FOLDER, exist_ok=True)
        question = planning.Question(["SCENE=scenes/phong.nff", "BOARD=microbit", "SIZE=160x120", "ERROR=54dB"])
        plan = planning.Plan(question)
        plan.settings = [s for s in plan.settings if s.depth == 5 and s.number in ("q16", "q24", "q32")]
        plan.per_ray = {s: {"q16": 0.48, "q24": 0.65, "q32": 1}[s.number] for s in plan.settings}
        plan.pixels.draw(plan.settings, 10 ** 6)
        chosen = next(s for s in plan.frontier() if plan.pixels.decibels(s) >= 54)
        self.assertEqual(chosen[:2], ("q16", "16"))
        for count in 32, 64, 128, 256:
            plan.pixels.draw(plan.settings, count)
            self.assertIn(chosen, plan.promising(), count)


if __name__ == "__main__":
    unittest.main()
