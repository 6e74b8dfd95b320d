"""qray explain: values known by hand, the tree's shape, what is in a light's way; and that the pixel is the picture's.
From the top of the repository, after `make test-programs`: python3 tests/test_explain.py"""

import math
import os
import re
import subprocess
import tempfile
import unittest

QRAY = os.path.abspath("build/qray")
SANITIZED = os.path.abspath("build/sanitized/qray")
SCENES = os.path.abspath("scenes")
NUMBERS = "q16", "q24", "q32", "float", "double"
# What a number may be off: half of its fifth digit, and in q16 and q24 two steps, of 1/1024 and 1/65536.
OFF = {"q16": 2e-3, "q24": 8.2e-5, "q32": 5.1e-5, "float": 5.1e-5, "double": 5.1e-5}

VIEW = "v from 0 0 5 at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 9 9\n"
BALL = VIEW + """b 0.125 0.25 0.5
l 3 0 3 0.5 0.5 0.5
l -3 0 3 0.25 0.25 0.25
sun 0 0 -1 1 1 1
material colour 1 0.5 0.25 ambient 0.5 diffuse 0.75
s 0 0 0 1
material emission 0.25
s -2 0 2 0.5
"""


def run(*arguments, program=QRAY, text=None):
    done = subprocess.run([program, *arguments], input=text, capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def explain(scene, *arguments, program=QRAY):
    status, out, wrong = run("explain", "-q", *arguments, text=scene, program=program)
    assert status == 0 and not wrong, wrong
    return out


def numbers(text):
    return [float(n) for n in re.findall(r"-?\d+\.?\d*(?:e-?\d+)?", text)]


def pixels(out):
    return [tuple(map(int, p)) for p in re.findall(r"^(?:! )?\w+, .*: colour (\d+) (\d+) (\d+)$", out, re.M)]


def rays(out):
    return re.findall(r"^(?:\|  )*(?:\+- )?(\w+) ray, depth (\d+), weight (\S+)$", out, re.M)


class Explain(unittest.TestCase):
    def close(self, text, expected, off):
        found = numbers(text)
        self.assertEqual(len(found), len(expected), text)
        for a, b in zip(found, expected):
            self.assertLess(abs(a - b), off * max(1, abs(b)), text)

    def test_a_ball_by_hand(self):
        for n in NUMBERS:
            out = explain(BALL, "-n", n, "-", "4,4")
            line = {key: next(l for l in out.splitlines() if key in l) for key in
                    ("meets", "normal", "colour (", "ambient", "line 3:", "line 4:", "line 5:", "|  = ")}
            # The eye, 5 before the middle of a unit ball, meets it at (0 0 1); the lamp is (3 0 2) from there.
            cosine, distance = 2 / math.sqrt(13), math.sqrt(13)
            self.close(line["meets"], [7, 4, 0, 0, 1], OFF[n])
            self.assertIn("sphere, line 7 at", line["meets"])
            self.close(line["normal"], [0, 0, 1, -1], OFF[n])
            self.close(line["colour ("], [1, 0.5, 0.25], OFF[n])
            self.close(line["ambient"], [0.1, 0.05, 0.025], OFF[n]) # 0.2 * 0.5
            lamp = [0.75 * 0.5 * cosine * c for c in (1, 0.5, 0.25)]
            self.close(line["line 3:"], [*lamp, 3, cosine, distance], OFF[n])
            # A ball that glows hides the other one, and the sun is behind the surface.
            self.close(line["line 4:"], [0, 4, cosine, distance, 9], OFF[n])
            self.assertIn("light, line 4", line["line 4:"])
            self.assertIn("blocked by sphere, line 9", line["line 4:"])
            self.close(line["line 5:"], [0, 5, -1], OFF[n])
            self.assertIn("behind the surface", line["line 5:"])
            light = [0.1 * c + a for c, a in zip((1, 0.5, 0.25), lamp)]
            self.close(line["|  = "], light, OFF[n])
            self.assertEqual(pixels(out), [tuple(int(255 * c + 0.5) for c in light)])
            self.close(next(l for l in explain(BALL, "-n", n, "-", "0,0").splitlines() if "background" in l),
                       [0.125, 0.25, 0.5], OFF[n])

    # Two panes of glass that also mirror.
    GLASS = VIEW + """b 1 1 1
material colour 0 0 0 mirror 0.5 transmit 0.25
p 4 -9 -9 0 9 -9 0 9 9 0 -9 9 0
p 4 -9 -9 -1 9 -9 -1 9 9 -1 -9 9 -1
"""

    def test_the_tree_and_its_weights(self):
        for n in NUMBERS:
            out = explain(self.GLASS, "-n", n, "-d", "3", "-", "4,4")
            # Of depth 2 the mirrored ray goes to the background, and the refracted one meets the second pane.
            self.assertEqual([(kind, int(depth), float(weight)) for kind, depth, weight in rays(out)],
                             [("eye", 1, 1), ("mirrored", 2, 0.5), ("refracted", 2, 0.25), ("mirrored", 3, 0.125),
                              ("refracted", 3, 0.0625)])
            self.assertEqual(out.count("the background"), 2)
            self.assertEqual(out.count("the greatest depth"), 1) # on the first pane from behind
            out = explain(self.GLASS, "-n", n, "--cutoff", "0.3", "-", "4,4")
            self.assertEqual([kind for kind, _, _ in rays(out)], ["eye", "mirrored"])
            self.assertIn("no refracted ray: weight 0.25, cutoff 0.3", out)

    def test_total_reflection(self):
        # A plane at 45 degrees between glass of index 2 and air, seen from the air and, its corners in the other order,
        # from the glass: 2 sin 45 > 1.
        view = "v from 0 0 0 at 0 0 -1 up 0 1 0 angle 1 hither 1 resolution 1 1\nb 1 1 1\n" \
            "material colour 0 0 0 mirror 0.25 transmit 0.5 ior 2\n"
        for n in NUMBERS:
            out = explain(view + "p 4 -9 -9 8 9 -9 -10 9 9 -10 -9 9 8\n", "-n", n, "-", "0,0")
            self.assertEqual(rays(out), [("eye", "1", "1"), ("mirrored", "2", "0.25"), ("refracted", "2", "0.5")])
            out = explain(view + "p 4 -9 9 8 9 9 -10 9 -9 -10 -9 -9 8\n", "-n", n, "-", "0,0")
            self.assertIn("meets it from behind", out)
            self.assertIn("total internal reflection", out)
            self.assertEqual(rays(out), [("eye", "1", "1"), ("mirrored", "2", "0.75")])

    def test_light_through_glass(self):
        scene = VIEW + """l 0 0 5 1 1 1
material ambient 0 diffuse 0.5
p 4 -9 -9 0 9 -9 0 9 9 0 -9 9 0
material transmit 0.5
disc 0 0 5.5 0 0 1 1
disc 0.5 0 4 1 0 0 1
disc 0.2 0 2 0 0 1 0.1
"""
        for n in NUMBERS:
            out = explain(scene.replace("l 0 0 5", "l 0.4 0 4"), "-n", n, "-", "4,4")
            # From the origin to (0.4 0 4) the way leads through (0.2 0 2), the middle of the last disc.
            line = next(l for l in out.splitlines() if "from light" in l)
            cosine = 10 / math.sqrt(101)
            self.close(line, [*[0.25 * cosine] * 3, 2, cosine, math.sqrt(16.16), 0.5, 8], OFF[n])
            self.assertIn("0.5 of it through disc, line 8", line)

    def test_two_number_systems_part(self):
        # Wherever q16 and double draw other pixels at the edge of a ball, one of them misses it.
        ball = VIEW.replace("resolution 9 9", "resolution 99 99") + "b 1 0 0\nmaterial colour 0 0 0\ns 0 0 0 1\n"
        same = 0
        for x in range(40, 80):
            out = explain(ball, "-n", "q16,double", "-", f"{x},49")
            one, two = pixels(out)
            marked = re.search(r"! q16: meets nothing\n.*! double: meets sphere|"
                               r"! q16: meets sphere.*\n.*! double: meets nothing", out)
            self.assertEqual(one != two, bool(marked), out)
            same += one == two
        self.assertGreater(same, 30)
        # Another ball far away, and one before this that is too small for the steps of q16.
        out = explain(ball + "s 0 0 2 0.001\ns 60 0 0 1\n", "-n", "q16,double", "-", "49,49")
        self.assertIn("! q16: meets sphere, line 4 at", out)
        self.assertIn("! double: meets sphere, line 5 at", out)

    def test_the_pixel_is_the_pictures(self):
        scenes = ("balls", ()), ("glass", ()), ("seethrough", ("-r", "4")), ("lights", ("-a", "2")), ("patches", ()), \
            ("soft", ()), ("images", ())
        with tempfile.TemporaryDirectory() as folder:
            picture = os.path.join(folder, "picture.ppm")
            for name, options in scenes:
                scene = f"{SCENES}/{name}.nff"
                for n in NUMBERS:
                    status, _, wrong = run("-q", "-s", "32x24", "-n", n, *options, "-o", picture, scene)
                    self.assertEqual(status, 0, wrong)
                    with open(picture, "rb") as file:
                        rgb = file.read()[-32 * 24 * 3:]
                    for at in range(5, 32 * 24, 61):
                        _, out, _ = run("explain", "-q", "-s", "32x24", "-n", n, *options, scene,
                                        f"{at % 32},{at // 32}")
                        self.assertEqual(pixels(out), [tuple(rgb[3 * at:3 * at + 3])], (name, n, at))
                        self.assertLessEqual(max(map(len, out.splitlines())), 120)
                        samples = out.count("\nsample at")
                        if options[:1] == ("-a",):
                            self.assertIn(samples, range(4, 21, 4)) # 4, and 4 for each quarter that is cut
                        else:
                            self.assertEqual(samples, 4 if options else 1)

    def test_the_head(self):
        background = VIEW + "b 0 0.5 1\n"
        self.assertEqual(explain(background, "-", "3,4").split("\n")[:2],
                         ["-, 9x9, pixel 3,4", "q32, 1 sample, depth 5, cutoff 0.0014: colour 0 128 255"])
        out = explain(background, "-n", "q16,double", "-s", "6x5", "-a", "1,0.5", "-d", "2", "--cutoff", "0.1", "-",
                      "0,4")
        self.assertEqual(out.split("\n")[:3],
                         ["-, 6x5, pixel 0,4",
                          "q16, adaptive in 1 level from 0.5, depth 2, cutoff 0.1: colour 0 128 255",
                          "double, adaptive in 1 level from 0.5, depth 2, cutoff 0.1: colour 0 128 255"])
        _, out, _ = run("explain", "-q", "-r", "4", f"{SCENES}/balls.nff", "0,0")
        self.assertEqual(out.split("\n")[0], f"{SCENES}/balls.nff, 320x240, pixel 0,0")
        self.assertIn("q32, 4 samples, depth 5", out.split("\n")[1])

    def test_bad_pixels_and_options(self):
        outside = [(["-", at], f"pixel {at} is outside of the picture; expected 0,0 to 8,8")
                   for at in ("9,4", "4,9", "-1,4", "4,-1", "-1,-99", "4294967296,0", "0,99999999999999999999")]
        for arguments, expected in (
                *outside,
                (["-", "4,nan"], "'4,nan' is no pixel; expected X,Y, from 0"),
                (["-", "-,4"], "unknown option '-,4'; 'qray explain -h' lists them"),
                (["-1,4", "-"], "unknown option '-1,4'; 'qray explain -h' lists them"),
                (["-", "4"], "'4' is no pixel; expected X,Y, from 0"),
                (["-", "4,"], "'4,' is no pixel; expected X,Y, from 0"),
                (["-"], "no pixel; expected X,Y behind the scene"),
                (["-", "4,4", "5,5"], "one scene at a time; '5,5' is a second"),
                (["-n", "q16,q8", "-", "4,4"], f"'-n q16,q8': expected {', '.join(NUMBERS[:-1])} or {NUMBERS[-1]}, or "
                                               "two of them with a comma between")):
            self.assertEqual(run("explain", *arguments, text=BALL), (2, "", f"qray: {expected}\n"))
        status, out, wrong = run("explain", "-", "1,1", text="v nonsense\n")
        self.assertEqual((status, out, wrong.count("\n")), (1, "", 1))

    def test_it_is_clean(self):
        for name in "showcase", "glass", "soft", "lights":
            _, out, wrong = run("explain", "-q", "-s", "16x12", "-n", "q16,double", f"{SCENES}/{name}.nff", "8,7",
                                program=SANITIZED)
            self.assertEqual((len(pixels(out)), wrong), (2, ""))


if __name__ == "__main__":
    unittest.main()
