"""qray plan: its options, the counts that it predicts from, and what it chooses from them.
From the top of the repository, after make: python3 tests/test_plan.py"""

import os
import re
import subprocess
import unittest

QRAY = "build/qray"
OPERATIONS = "build/study/operations"


def run(*words):
    done = subprocess.run(words, capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def plan(*words):
    return run(QRAY, "plan", *words)


def rows(text):
    """The frontier: (chosen, number, samples, depth, instructions, seconds, dB)."""
    out = []
    for line in text.splitlines():
        found = re.match(r"([* ]) (\w+) +(\d+|adaptive \S+) +(\d) +(\d+) +([\d.e+]+) +([\d.]+) ", line)
        if found:
            chosen, number, samples, depth, *values = found.groups()
            out.append((chosen == "*", number, samples, int(depth), *map(float, values)))
    return out


class Plan(unittest.TestCase):
    def test_options(self):
        scene = "scenes/balls.nff"
        for words, said in (((), "no scene"), ((scene,), "no board"), ((scene, "--board", "z80"), "z80"),
                            ((scene, "--board", "microbit"), "what is wanted"),
                            ((scene, "--board", "microbit", "--seconds", "1"), "--mhz"),
                            ((scene, "--board", "microbit", "--seconds", "0"), "above 0"),
                            ((scene, "--board", "microbit", "--error", "-3dB"), "above 0"),
                            ((scene, "--board", "microbit", "--error", "bad"), "above 0"),
                            ((scene, "-n", "q32"), "unknown option")):
            status, out, err = plan(*words)
            self.assertEqual((status, out), (2, ""), words)
            self.assertIn(said, err, words)
            self.assertEqual(err.count("\n"), 1, words)

    def test_frontier_and_choice(self):
        status, out, err = plan("scenes/floor.nff", "--board", "mps2_an385", "--mhz", "25", "--seconds", "4",
                                "-s", "48x36")
        self.assertEqual(status, 0, err)
        found = rows(out)
        self.assertGreater(len(found), 3)
        for one, other in zip(found, found[1:]):
            self.assertLess(one[5], other[5])  # seconds
            self.assertLess(one[6], other[6])  # dB
        within = [r for r in found if r[5] <= 4]
        self.assertEqual([r for r in found if r[0]], within[-1:])
        self.assertIn("make run BOARD=mps2_an385 SCENE=scenes/floor.nff NUMBER=", out)

        status, out, err = plan("scenes/floor.nff", "--board", "mps2_an385", "--mhz", "25", "--error", "28dB",
                                "-s", "48x36")
        found = rows(out)
        self.assertEqual([r for r in found if r[0]], [r for r in found if r[6] >= 28][:1])

    def test_what_cannot_be_had(self):
        status, out, err = plan("scenes/floor.nff", "--board", "microbit", "--mhz", "1", "--seconds", "0.001",
                                "-s", "32x24")
        self.assertEqual(status, 1)
        self.assertIn("within what was asked for", err)
        self.assertNotIn("make run", out)


class Counts(unittest.TestCase):
    def counts(self, scene, size, *words, number="q32"):
        status, out, err = run(OPERATIONS, number, scene, size, *words)
        self.assertEqual(status, 0, err)
        return {k: float(v) for k, v in re.findall(r"^(\w+): ([\d.]+)$", out, re.M)}

    # Three balls, no shadow, no mirror: each ray asks for each of them.
    def test_ray_casting(self):
        for samples in (1, 4):
            c = self.counts("scenes/balls.nff", "32x24", str(samples))
            self.assertEqual(c["pixel"], 32 * 24)
            self.assertEqual(c["ray"], samples * 32 * 24)
            self.assertEqual(c["sphere_test"], 3 * samples * 32 * 24)
            self.assertEqual((c["test"], c["nearest_test"]), (c["sphere_test"],) * 2)
            self.assertEqual(c["sphere_several"], c["sphere_test"])
            self.assertEqual((c["sphere_single"], c["sphere_many"]), (0, 0))
            self.assertEqual(c["sphere_ahead"], c["sphere_test"])
            self.assertEqual(c["sphere_seen"], c["hit"])
            for name in ("shadow_ray", "disc_test", "mirrored", "refracted", "checker"):
                self.assertEqual(c[name], 0, name)

    def one_ray(self, *lines, number="q32"):
        """Of a picture of one pixel, seen from the origin along -z."""
        os.makedirs("build/study", exist_ok=True)
        path = "build/study/test_plan.nff"
        with open(path, "w") as file:
            file.write("v from 0 0 0 at 0 0 -1 up 0 1 0 angle 1 hither 1 resolution 1 1\n")
            file.writelines(line + "\n" for line in lines)
        return self.counts(path, "1x1", number=number)

    # In floating point windows leave out what the one pixel cannot meet: two balls of three, or all.
    def test_windows(self):
        balls = ["shadows off", "s 0 0 -9 1", "s 50 0 -9 1", "s 0 -50 -9 1"]
        for number, tests in (("q16", 3), ("q32", 3), ("float", 1), ("double", 1)):
            c = self.one_ray(*balls, number=number)
            self.assertEqual((c["ray"], c["sphere_test"], c["sphere_seen"]), (1, tests, 1), number)
        c = self.one_ray(balls[0], *balls[2:], number="float")
        self.assertEqual((c["sample"], c["ray"], c["sphere_test"]), (1, 0, 0))

    # One ray along the axis of ten balls, five of them behind it, and of five aside.
    def test_how_far_a_test_goes(self):
        c = self.one_ray("shadows off", *(f"s 0 0 {3 * i} 1" for i in range(-5, 6) if i),
                         *(f"s 5 0 {-3 * i} 1" for i in range(1, 6)),
                         "disc 0 0 -20 0 0 1 2", "disc 0 0 20 0 0 1 2",
                         "p 4 -1 -1 -30 1 -1 -30 1 1 -30 -1 1 -30")
        for name, count in (("ray", 1), ("sphere_test", 15), ("sphere_several", 0), ("sphere_many", 15),
                            ("sphere_ahead", 10),
                            ("sphere_line", 10), ("sphere_met", 5), ("sphere_seen", 1), ("disc_test", 2),
                            ("disc_several", 2), ("disc_many", 0), ("disc_ahead", 1), ("disc_met", 0),
                            ("polygon_single", 1), ("polygon_several", 0), ("polygon_near", 1),
                            ("polygon_met", 0), ("polygon_corner", 0), ("hit", 1),
                            ("kinds", 3), ("balls", 15), ("lamp", 0), ("effect_shadow", 0)):
            self.assertEqual(c[name], count, name)

    # Two squares around the ray, the nearer one the second, and a triangle above it whose ball it enters.
    def test_corners(self):
        c = self.one_ray(*(f"p 4 -1 -1 -{z} 1 -1 -{z} 1 1 -{z} -1 1 -{z}" for z in (30, 20)),
                         "p 3 -1 0.2 -10 1 0.2 -10 0 3 -10")
        for name, count in (("polygon_several", 3), ("polygon_near", 3), ("polygon_met", 3),
                            ("polygon_corner", 11), ("polygon_edge", 4), ("polygon_inside", 2),
                            ("polygon_found", 8), ("polygon_seen", 1), ("polygon_opaque", 3)):
            self.assertEqual(c[name], count, name)

    # Across a tube of mirrors to and fro, until the depth of 5.
    def test_inside_a_cone(self):
        c = self.one_ray("material mirror 1", "c -9 0 0 1 9 0 0 1")
        for name, count in (("ray", 5), ("mirrored", 4), ("cone_test", 5), ("cone_single", 5),
                            ("cone_several", 0), ("cone_near", 5), ("cone_met", 5), ("cone_inward", 4),
                            ("cone_seen", 5)):
            self.assertEqual(c[name], count, name)

    def test_lamps(self):
        for number in (0, 1, 3):
            c = self.one_ray(*["l 0 0 9"] * number, "sun 0 0 1", "s 0 0 -3 1")
            self.assertEqual((c["hit"], c["lamp"], c["sun_lamp"]), (1, number, 1))
            self.assertEqual(c["lamp_several"], number if number > 1 else 0)
            self.assertEqual(c["lit"], number + 1)

    # The same rays as the command counts.
    def test_rays(self):
        for scene in ("floor", "glass", "showcase"):
            c = self.counts(f"scenes/{scene}.nff", "32x24")
            os.makedirs("build/study", exist_ok=True)
            _, _, err = run(QRAY, f"scenes/{scene}.nff", "-n", "double", "-s", "32x24", "--stats", "-q", "-o",
                            "build/study/plan.ppm")
            stats = {k: float(v) for k, v in re.findall(r"^(\w+)_rays: (\d+)", err, re.M)}
            self.assertEqual(c["sample"], stats["camera"])
            self.assertEqual(c["shadow_ray"], stats["shadow"])
            self.assertEqual(c["mirrored"], stats["mirrored"])
            self.assertEqual(c["refracted"], stats["refracted"])
            # Every ray that is traced is counted where it looks for what it meets.
            self.assertEqual(c["ray"], c["sample"] + c["mirrored"] + c["refracted"])


if __name__ == "__main__":
    unittest.main()
