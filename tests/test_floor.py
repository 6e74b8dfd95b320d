"""What src/study/floor.py makes of counts. From the top of the repository: python3 tests/test_floor.py"""

import re
import subprocess
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
        with self.assertRaisesRegex(SystemExit, "cone_test.* no least cost"):
            floor.counts("scenes/showcase.nff", "16x12")

    def test_every_step_of_a_scene_is_counted(self):
        done = subprocess.run(["build/study/operations", "q32", floor.SCENE, "16x12"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        found = floor.counts(floor.SCENE, "16x12")
        self.assertEqual(found["pixel"], 192)
        least, _ = floor.floor("microbit", found, found["ray"] + found["lit"])
        self.assertEqual(set(least), set(floor.STEPS))


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
