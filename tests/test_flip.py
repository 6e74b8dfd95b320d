"""build/study/flip, the command: values known in closed form, -p, damaged pictures, bad options.
From the top of the repository, after `make test-programs`: python3 tests/test_flip.py"""

import json
import os
import subprocess
import tempfile
import unittest

FLIP = os.path.abspath("build/study/flip")


def ppm(width, height, *colours):
    """Colours take turns, pixel by pixel."""
    pixels = (bytes(colours[(x + y) % len(colours)]) for y in range(height) for x in range(width))
    return f"P6\n{width} {height}\n255\n".encode() + b"".join(pixels)


class Flip(unittest.TestCase):
    def run_it(self, *words, **files):
        with tempfile.TemporaryDirectory() as folder:
            for name, content in files.items():
                with open(f"{folder}/{name}", "wb") as file:
                    file.write(content)
            done = subprocess.run([FLIP, *words], cwd=folder, capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

    def test_values(self):
        green, blue = ppm(9, 7, (0, 255, 0)), ppm(9, 7, (0, 0, 255))
        status, out, wrong = self.run_it("a", "b", "a", a=green, b=blue)
        self.assertEqual((status, wrong), (0, ""))
        # Green and blue are the farthest apart that two colours are.
        self.assertEqual([json.loads(line) for line in out.splitlines()],
                         [{"flip": 1, "seen": 1, "pixels_per_degree": 67},
                          {"flip": 0, "seen": 0, "pixels_per_degree": 67}])

    def test_pixels_per_degree(self):
        fine, plain = ppm(40, 40, (0, 0, 0), (255, 255, 255)), ppm(40, 40, (188, 188, 188))
        found = []
        for words in ([], ["-p", "67"], ["-p", "1"], ["-p", "20.5"], ["-p", "230"]):
            status, out, wrong = self.run_it(*words, "a", "b", a=plain, b=fine)
            self.assertEqual((status, wrong), (0, ""))
            found.append(json.loads(out))
        self.assertEqual([f["pixels_per_degree"] for f in found], [67, 67, 1, 20.5, 230])
        self.assertEqual(found[0], found[1])
        # A chequer of single pixels is grey from afar.
        near, middle, far, farthest = (found[i]["flip"] for i in (2, 3, 1, 4))
        self.assertGreater(near, 0.9)
        self.assertGreater(near, middle)
        self.assertGreater(middle, far)
        self.assertLess(max(far, farthest), 0.1)

    def test_damaged_pictures(self):
        good = ppm(9, 7, (1, 2, 3))
        for bad, said in ((b"", "no binary PPM of 255 levels"), (b"GIF89a", "no binary PPM of 255 levels"),
                          (good[:-1], "ends before its last pixel"), (good[:11], "ends before its last pixel"),
                          (b"P6 32768 32768 255\n123", "ends before its last pixel"),
                          (b"P6 99999 1 255\n123", "no binary PPM of 255 levels"),
                          (b"P6 -1 1 255\n123", "no binary PPM of 255 levels"),
                          (b"P6 0 1 255\n", "no binary PPM of 255 levels"),
                          (b"P6 1 1 65535\n123456", "no binary PPM of 255 levels"),
                          (b"P3 1 1 255\n1 2 3\n", "no binary PPM of 255 levels")):
            self.assertEqual(self.run_it("a", "b", a=good, b=bad), (1, "", f"flip: b: {said}\n"), bad)
            self.assertEqual(self.run_it("b", "a", a=good, b=bad), (1, "", f"flip: b: {said}\n"), bad)
        self.assertEqual(self.run_it("a", "b", a=good, b=ppm(7, 9, (1, 2, 3))), (1, "", "flip: b is 7 x 9, a 9 x 7\n"))
        self.assertEqual(self.run_it("a", "none", a=good), (1, "", "flip: none: No such file or directory\n"))
        self.assertEqual(self.run_it("a", ".", a=good)[0], 1)

    def test_bad_options(self):
        for words in ([], ["a"], ["-p"], ["-p", "67"], ["-p", "67", "a"], ["-q", "a", "a"], *(
                ["-p", bad, "a", "a"] for bad in ("", "0", "-67", "nan", "inf", "231", "67x", "x"))):
            status, out, wrong = self.run_it(*words, a=ppm(2, 2, (0, 0, 0)))
            self.assertEqual((status, out, wrong.count("\n")), (2, "", 1), words)
            self.assertRegex(wrong, "^flip: .*(usage: flip|expected pixels per degree, 1 to 230)")


if __name__ == "__main__":
    unittest.main()
