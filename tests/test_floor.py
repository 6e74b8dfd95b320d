"""What src/study/floor.py makes of counts. From the top of the repository: python3 tests/test_floor.py"""

import os
import re
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, "src/study")
import floor  # noqa: E402


def rows(text):
    """{step: numbers} of a report's table."""
    return {line.split("|")[1].strip(): [int(c.replace(" ", "")) for c in line.split("|")[2:-1]]
            for line in text.splitlines() if re.match(r"\| [a-z ]+ \| +\d", line)}


class Parts(unittest.TestCase):
    # Three products, two sums of 64 bits, one rounding: 3 18 + 2 2 + 3; three long multiplies and two shifts;
    # three times two, two times four and five.
    def test_price_of_a_dot_product(self):
        self.assertEqual([floor.price(b, floor.DOT) for b in floor.BOARDS], [61, 5, 19])

    def test_floor_of_some_counts(self):
        found = {"ray": 1, "mirrored": 0, "checker": 2, "sphere_test": 4}
        least, products = floor.floor("mps2_an385", found, 2)
        # Three products, nine others and six words, three at a time, twice for two rays; no product of 64
        # bits elsewhere but three in each test of a sphere.
        self.assertEqual(least["textures"], 14)
        self.assertEqual(least["spheres"], 2 * (6 + 3 + 4 / 3))
        self.assertEqual(products, 3 + 6)

    def test_text(self):
        found = {"ray": 1, "mirrored": 1, "hit": 1}
        text = floor.text("a.nff", "8x6", {b: (2, {"shading": 600, "spheres": 300, "checker": 100})
                                           for b in floor.BOARDS}, found)
        self.assertEqual(rows(text)["shading"][::2], [300] * 3)
        self.assertEqual(rows(text)["textures"], [50, 0] * 3)
        self.assertEqual(rows(text)["all"][::2], [500] * 3)
        self.assertIn("90 % (M0, shading and spheres)", text)
        for need in floor.REPORTS["floor"][1]():
            if need != floor.SCENE:
                self.assertIn(need, " ".join(text.split("\n")))

    def test_other_effects_are_refused(self):
        with self.assertRaisesRegex(SystemExit, "cone, of which no least cost"):
            floor.counts("scenes/showcase.nff", "16x12")

    def test_every_step_of_a_scene_is_counted(self):
        found = floor.counts(floor.SCENE, "16x12")
        self.assertEqual(found["pixel"], 192)
        least, _ = floor.floor("microbit", found, found["ray"] + found["lit"])
        self.assertEqual(set(least), set(floor.STEPS))

    # One ray along the axis of five balls before it and five behind it, past five more, between two discs; a lamp at
    # its origin lights the first ball.
    def test_what_one_ray_asks_for(self):
        os.makedirs("build/study", exist_ok=True)
        path = "build/study/test_floor.nff"
        with open(path, "w") as file:
            file.write("v from 0 0 0 at 0 0 -1 up 0 1 0 angle 1 hither 1 resolution 1 1\nl 0 0 0\n"
                       "material highlight 1 shine 5\n")
            file.writelines(f"s 0 0 {3 * i} 1\n" for i in range(-5, 6) if i)
            file.writelines(f"s 5 0 {-3 * i} 1\n" for i in range(1, 6))
            file.write("disc 0 0 -20 0 0 1 2\ndisc 0 0 20 0 0 1 2\n")
        found = floor.counts(path, "1x1")
        for name, count in (("pixel", 1), ("sample", 1), ("ray", 1), ("hit", 1), ("sphere_seen", 1), ("disc_seen", 0),
                            ("mirrored", 0), ("checker", 0), ("lamp", 1), ("lit", 1), ("shine", 1), ("shine_square", 3)):
            self.assertEqual(found[name], count, name)
        # Of the ray itself and of the light's, which starts at the first ball, up to z = 0.
        self.assertEqual(found["sphere_test"], 15 + 15)


class Readme(unittest.TestCase):
    # What is measured is above the bound, step by step.
    def test_floor_is_below(self):
        with open("README.md") as file:
            part = re.search(r"<!-- report:floor -->(.*?)<!-- /report -->", file.read(), re.S)[1]
        found = rows(part)
        self.assertEqual(set(found), {*floor.STEPS, "all"})
        for step, values in found.items():
            for ours, least in zip(values[::2], values[1::2]):
                self.assertGreaterEqual(ours, least, step)


if __name__ == "__main__":
    unittest.main()
