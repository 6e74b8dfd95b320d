"""The command, from outside: options, errors, files, threads; and the bytes of q32 however it was compiled.
From the top of the repository, after `make test-programs`: python3 tests/test_cli.py"""

import glob
import os
import pathlib
import platform
import pty
import re
import resource
import signal
import stat
import subprocess
import tempfile
import time
import unittest

# As a shell leaves it: in a job in the background of a script, some signals are ignored, which programs inherit.
for number in signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP, signal.SIGINT, signal.SIGPIPE}:
    signal.signal(number, signal.SIG_DFL)
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.pthread_sigmask(signal.SIG_SETMASK, [])

QRAY = os.path.abspath("build/qray")
SANITIZED = os.path.abspath("build/sanitized/qray")
# Has this processor what the command is compiled for twice?
AVX2 = platform.machine() == "x86_64" and {"avx2", "fma", "bmi1", "bmi2"} <= set(open("/proc/cpuinfo").read().split())
VARIANTS = sorted(glob.glob(os.path.abspath("build/variants/*/qray")))
SCENES = sorted(glob.glob(os.path.abspath("scenes/*.nff")))
# Where light is solved for, which takes long, a small room has the same code in all variants.
QUICK_SCENES = [s for s in SCENES if "\nradiosity " not in pathlib.Path(s).read_text()]
QUICK_SCENES.append(os.path.abspath("tests/room.nff"))
NUMBERS = ("q16", "q24", "q32", "float", "double")

# The eye looks along -z at the plane z = 0 from a distance of 1; with an angle of 90 degrees the picture spans -1 to 1.
VIEW = "v from 0 0 1 at 0 0 0 up 0 1 0 angle 90 hither 1 resolution {} {}\n"
WHITE = "ambientlight 1 1 1 material diffuse 0\n"


def view(width=1, height=1):
    return VIEW.format(width, height)


def quad(left, right):
    return f"p 4 {left} -9 0 {right} -9 0 {right} 9 0 {left} 9 0\n"


# All of the picture is a mirror that shows the background.
def mirror(share, background):
    return view() + f"b {background} 0 0 material ambient 0 diffuse 0 mirror {share}\n" + quad(-9, 9)


class Cli(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        self.write("ok.nff", view(4, 3))

    def write(self, name, text):
        with open(name, "wb") as file:
            file.write(text if isinstance(text, bytes) else text.encode())
        return name

    def read(self, name):
        with open(name, "rb") as file:
            return file.read()

    def run_qray(self, *arguments, program=QRAY, **options):
        done = subprocess.run([program, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              timeout=120, **options)
        return done.returncode, done.stdout, done.stderr.decode()

    # The picture's bytes behind its head, of a scene that is drawn without a word.
    def pixels(self, text, *arguments, **options):
        self.write("scene.nff", text)
        status, out, err = self.run_qray("scene.nff", "-o", "-", *arguments, **options)
        self.assertEqual((status, err), (0, ""))
        head = re.match(rb"P6\n(\d+) (\d+)\n255\n", out)
        body = out[head.end():]
        self.assertEqual(len(body), 3 * int(head[1]) * int(head[2]))
        return body

    def fails(self, status, pattern, *arguments, **options):
        before = sorted(os.listdir())
        found, out, err = self.run_qray(*arguments, **options)
        self.assertRegex(err, r"\A(?:" + pattern + r")[^\n]*\n\Z", arguments)
        self.assertEqual((found, out), (status, b""), arguments)
        self.assertEqual(sorted(os.listdir()), before, arguments)


class Options(Cli):
    def test_help(self):
        for arguments in (["-h"], ["--help"], ["-q", "-h", "ok.nff"]):
            status, out, err = self.run_qray(*arguments)
            self.assertEqual((status, err), (0, ""))
            for text in ("usage: qray [options] SCENE", "example: qray scenes/showcase.nff ", "-o ", "-s ", "-n ",
                         "-r ", "-a ", "-d ", "--cutoff ", "-j ", "--stats", "-q ", "-h", "--version"):
                self.assertIn(text, out.decode())
        for command, most in ([], 100), (["explain"], 100), (["compile"], 120): # the last lists the shapes
            _, out, _ = self.run_qray(*command, "-h")
            self.assertLessEqual(max(map(len, out.decode().splitlines())), most)
        self.assertEqual(os.listdir(), ["ok.nff"])

    def test_version(self):
        status, out, err = self.run_qray("--version")
        self.assertEqual((status, err), (0, ""))
        self.assertRegex(out, rb"\Aqray \d+\.\d+\.\d+\n\Z")

    def test_bad(self):
        bad = {
            "-s": ["", "5", "5x", "x5", "0x5", "5x0", "32769x1", "1x32769", "-4x3", "4x-3", "4.5x3", "axb", "4x3x2"],
            "-n": ["", "Q32", "q64", "q3", "floats"],
            "-r": ["", "0", "2", "3", "5", "15", "4095", "4225", "-1", "1.5", "x", "nan", "4 "],
            "-a": ["", "0", "7", "-1", "x", "2,", ",0.5", "2,1.01", "2,-0.5", "2,nan", "2,0.5,1", "1.5"],
            "-d": ["", "0", "65", "-1", "2.5", "x"],
            "--cutoff": ["", "-0.1", "1.1", "nan", "inf", "x", "1e400"],
            "--light-bits": ["", "0", "1", "3", "6", "16", "x"],
            "--within": ["", "1,2,3", "1,2,3,4,5,x", "1,2,3,4,5,6,7", "1,2,3,4,5,", ",,,,,", "1 2 3 4 5 6",
                         "0,0,0,1,1,nan", "0,0,0,1,1,inf", "0,0,0,1,1,1e16", "-1e16,0,0,1,1,1"],
            "-j": ["", "0", "257", "-1", "1.5", "x"],
            "-o": [""],
        }
        for option, values in bad.items():
            self.fails(2, f"qray: '{option}' is followed by nothing; expected ", "ok.nff", option)
            for value in values:
                self.fails(2, f"qray: '{option} {re.escape(value)}': expected ", "ok.nff", option, value)
        option = "--moving"  # of compile
        self.fails(2, f"qray: '{option}' is followed by nothing; expected ", "compile", "ok.nff", option)
        for value in ["", "x", "sphere", "Camera", "camera,", ",camera", "camera,,spheres", "spheres lights", "all,x",
                      "vertices", "entries", "triangles", "spheres,smooth_triangles", "texels", "highlights", " all"]:
            self.fails(2, f"qray: '{option} {re.escape(value)}': expected 'all', or a list, with commas, of: camera, ",
                       "compile", "ok.nff", option, value)

    def test_unknown(self):
        for option in ("-x", "--statistics", "--cut", "--cutoff5", "-qs", "-q1", "--version=1", "---"):
            self.fails(2, f"qray: unknown option '{option}'; 'qray -h' lists them", option, "ok.nff")

    def test_one_scene(self):
        self.fails(2, "qray: no scene; ")
        self.fails(2, "qray: no scene; ", "-q")
        self.fails(2, "qray: one scene at a time; 'b.nff' is a second", "ok.nff", "b.nff")

    def test_samples_exclude_adaptive(self):
        self.fails(2, "qray: '-a' and '-r' exclude each other", "-a", 2, "-r", 4, "ok.nff")
        self.fails(2, "qray: '-a' and '-r' exclude each other", "-r", 1, "-a", "2,0.5", "ok.nff")

    def test_ways_to_write_them(self):
        expected = self.pixels(view(4, 3) + "b 1 0.5 0", "-s", "6x5", "-j", "1", "--cutoff", "0.5")
        self.assertEqual(len(expected), 90)
        for arguments in (["-s6x5", "-j1", "--cutoff=0.5"], ["-s", "9x9", "-s", "6x5"], ["-s", "+6.0x5e0"]):
            self.assertEqual(self.pixels(view(4, 3) + "b 1 0.5 0", *arguments), expected)
        self.write("-x.nff", view(4, 3))
        status, _, err = self.run_qray("-q", "--", "-x.nff")
        self.assertEqual((status, err), (0, ""))
        self.assertEqual(len(self.read("-x.ppm")), 11 + 36)

    def test_size(self):
        for size in ((1, 1), (7, 2), (32768, 1), (1, 32768)):
            picture = self.pixels(view(4, 3) + "b 0 1 0", "-s", "%dx%d" % size)
            self.assertEqual(picture, b"\0\xff\0" * size[0] * size[1])
        self.assertEqual(len(self.pixels(view(4, 3))), 36)

    # White left of x = -0.1, in a picture of one pixel: all samples left of the middle, but for three of 64 columns.
    def test_samples(self):
        for number in NUMBERS:
            for samples, level in ((1, 0), (4, 128), (16, 128), (9, 85), (4096, 116)):
                text = view() + WHITE + quad(-9, -0.1)
                self.assertEqual(self.pixels(text, "-n", number, "-r", samples), bytes([level] * 3), samples)
            self.assertEqual(self.pixels(text, "-n", number, "-a", 1), bytes([128] * 3))
            # The two quarters at the edge have other samples than their neighbours: cut once more, 1 of 2 is white.
            text = view() + WHITE + quad(-9, -0.3)
            self.assertEqual(self.pixels(text, "-n", number, "-a", "1,1"), bytes([128] * 3))

    def test_depth(self):
        for depth, level in ((1, 0), (2, 128), (5, 128), (64, 128)):
            self.assertEqual(self.pixels(mirror(1, 0.5), "-d", depth), bytes([level, 0, 0]))

    def test_cutoff(self):
        for cutoff, level in ((0, 128), (0.5, 128), (0.51, 0), (1, 0)):
            self.assertEqual(self.pixels(mirror(0.5, 1), "--cutoff", cutoff), bytes([level, 0, 0]))
        self.assertEqual(self.pixels(mirror(0.0015, 64)), bytes([24, 0, 0]))
        self.assertEqual(self.pixels(mirror(0.0013, 64)), bytes([0, 0, 0]))

    def test_stats(self):
        self.write("s.nff", "# A mirror # in the light\n" + view(8, 6) + "l 0 0 9 sun 0 0 1 f 1 1 1 0.5 0.25 3.5 0 1\n"
                   + quad(-99, 99) + "s 0 0 -99 1 s 0 0 -99 0 c 0 0 -98 1 0 0 -97 0\n")
        for number in ("q32", "float", "double"):
            status, out, err = self.run_qray("s.nff", "--stats", "-o", "-", "-r", 4, "-j", 2, "-n", number, "-q")
            self.assertEqual((status, len(out)), (0, 11 + 8 * 6 * 3))
            found = dict(re.fullmatch(r"([a-z_/]+): (.*)", line).groups() for line in err.splitlines())
            for name, value in {"scene": "s.nff", "title": "A mirror # in the light", "objects": "3", "spheres": "1",
                                "polygons": "1", "cones": "1", "patches": "0", "planes": "0", "discs": "0",
                                "vertices": "4", "materials": "1", "lights": "1", "suns": "1", "panels": "0",
                                "dropped": "1",
                                "vanished": "0", "number": number, "width": "8", "height": "6", "samples": "4",
                                "depth": "5", "cutoff": "0.0014", "threads": "2", "camera_rays": "192",
                                "shadow_rays": "384", "mirrored_rays": "192", "refracted_rays": "0",
                                "rays": "768"}.items():
                self.assertEqual(found[name], value, name)
            effects = "sphere cone polygon light sun shadow highlight fractional_shine mirror grid"
            self.assertEqual([e for e in found["effects"].split() if e != "tree"], effects.split())
            self.assertRegex(found["kernel"], r"^\w+$")
            self.assertEqual(found["lanes"], "avx2" if AVX2 and number != "double" else "none")
            self.assertGreater(float(found["rays/second"]), 0)
            for name in ("seconds", "reading_seconds"):
                self.assertTrue(0 <= float(found[name]) < 60)

    # What solving says of itself, and that its bytes do not depend on threads.
    def test_radiosity(self):
        lamp = "material diffuse 0 emission 4 p 4 -1 3 -1 1 3 -1 1 3 1 -1 3 1\n"
        self.write("r.nff", view(8, 6) + "radiosity 1 material colour 0.5 0.5 0.5 " + quad(-2, 3) + lamp)
        status, out, err = self.run_qray("r.nff", "--stats", "-o", "-", "-j", 1, "-q")
        found = dict(re.fullmatch(r"([a-z_/]+): (.*)", line).groups() for line in err.splitlines())
        self.assertEqual((status, found["radiosity_cells"]), (0, "188"))
        self.assertIn("light_map", found["effects"])
        for name in ("rays", "rounds", "seconds", "nodes"):
            self.assertGreater(float(found["radiosity_" + name]), 0, name)
        self.assertLess(float(found["radiosity_change"]), 1e-5)
        for threads in (2, 5):
            self.assertEqual(self.run_qray("r.nff", "-o", "-", "-j", threads, "-q")[1], out)
        self.write("r.nff", view(8, 6) + "radiosity 0.01 material colour 0.5 0.5 0.5 " + quad(-2, 3) + lamp)
        self.fails(1, "r.nff:2:1: 'radiosity 0.01' needs 1880000 cells of light; "
                      "expected at most 32768 \\(limit 'cells'\\)", "r.nff")

    def test_warnings(self):
        # A scene of radius 1e9 has steps of 1 in q32; what is 0 wide has no extent.
        text = view() + "s 1e9 0 0 9 s -1e9 0 0 9 s 0 0 0 0.1 s 0 0 0 1e-9 s 0 0 0 0 s 0 0 0 0 p 3 0 0 0 1 1 1 2 2 2\n"
        self.write("w.nff", text)
        status, _, err = self.run_qray("w.nff")
        self.assertEqual((status, err.splitlines()),
                         (0, ["w.nff:2: warning: a sphere of radius 0, left out; 2 objects in all",
                              "w.nff:2: warning: a sphere too small for steps of 1, left out; 2 warnings in all"]))
        status, _, err = self.run_qray("w.nff", "-n", "double")
        self.assertEqual((status, err), (0, "w.nff:2: warning: a sphere of radius 0, left out; 2 objects in all\n"))
        self.assertEqual(self.run_qray("w.nff", "-q")[2], "")
        self.write("w.nff", view() + "s 0 0 0 1\ns 0 0 0 0")
        self.assertEqual(self.run_qray("w.nff")[2], "w.nff:3: warning: a sphere of radius 0, left out\n")
        # Steps of 2^-15. Two of three balls fall together with one before, the last with two: warnings are counted.
        self.write("w.nff", view() + "s 0 0 0 0.5\nmaterial colour 1 0 0\ns 0 0 0 0.50001\n"
                   "material colour 0 1 0\ns 0 0 0 0.50002\n")
        self.assertEqual(self.run_qray("w.nff", "-n", "q16")[2],
                         "w.nff:4: warning: a sphere falls together with another surface, that of line 2, 1e-05 off, "
                         "where steps are 3.05e-05; 3 warnings in all\n")
        # A unit square with a corner 1/4 above it, across a box of a diagonal of 1.436; twice.
        bent = "p 4 0 0 0 1 0 0 1 1 0 0 1 0.25\n"
        self.write("w.nff", view() + bent + "p 4 0 0 0 1 0 0 1 1 0 0 1 0.01\n" + bent)
        for number in NUMBERS:
            self.assertEqual(self.run_qray("w.nff", "-n", number)[2],
                             "w.nff:2: warning: a polygon with a corner 0.25 off its plane, 17.4 % of its size; "
                             "2 objects in all\n")


    # NFF bounds neither Kd, Ks and T nor the index of refraction.
    def test_fills_out_of_range(self):
        for fill, same, warning in (
                ("1 1 1 1.5 0 5 0 1", "1 1 1 1 0 5 0 1",
                 "2:9: warning: Kd of a fill is 1.5, outside of 0 to 1; 1 is taken"),
                ("1 1 1 0.5 2 5 -1 99", "1 1 1 0.5 1 5 0 8",
                 r"2:13: warning: Ks of a fill is 2, outside of 0 to 1; 1 is taken \(and so for 2 more\)")):
            text = view(9, 9) + "f {}\ns 0 0 0 0.7\n"
            expected = self.pixels(text.format(same))
            self.write("f.nff", text.format(fill))
            status, out, err = self.run_qray("f.nff", "-o", "-")
            self.assertEqual((status, out[11:]), (0, expected))
            self.assertRegex(err, r"\Af\.nff:" + warning + r"\n\Z")
            self.assertEqual(self.run_qray("f.nff", "-q")[2], "")


class Files(Cli):
    def test_default_name(self):
        os.makedirs("a.b/c")
        for scene, picture in (("a.b/c/x.nff", "x.ppm"), ("a.b/y", "y.ppm"), ("a.b/p.q.nff", "p.q.ppm"),
                               (".z", ".z.ppm")):
            self.write(scene, view())
            self.assertEqual(self.run_qray(scene), (0, b"", ""))
            self.assertEqual(self.read(picture), b"P6\n1 1\n255\n\0\0\0")
        self.assertEqual(sorted(os.listdir("a.b")), ["c", "p.q.nff", "y"])

    def test_standard_input_and_output(self):
        text = (view(3, 2) + "b 0 0 1").encode()
        expected = b"P6\n3 2\n255\n" + b"\0\0\xff" * 6
        self.write("s.nff", text)
        self.assertEqual(self.run_qray("-", input=text), (0, expected, ""))
        self.assertEqual(self.run_qray("-", "-o", "-", input=text), (0, expected, ""))
        self.assertEqual(self.run_qray("s.nff", "-o", "-"), (0, expected, ""))
        self.assertEqual(self.run_qray("-", "-o", "out", input=text), (0, b"", ""))
        self.assertEqual(self.read("out"), expected)
        self.fails(1, "-:1:5: expected green of the background", "-", input=b"b 0 x")

    def test_not_to_a_terminal(self):
        master, slave = pty.openpty()
        done = subprocess.run([QRAY, "ok.nff", "-o", "-"], stdout=slave, stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, rb"\Aqray: the picture would go to the terminal[^\n]*\n\Z")
        os.close(master)
        os.close(slave)

    def test_not_over_the_scene(self):
        text = self.read("ok.nff")
        os.link("ok.nff", "hard")
        os.symlink("ok.nff", "soft")
        for name in ("ok.nff", "./ok.nff", "hard", "soft"):
            self.fails(2, f"qray: '{name}' is the scene itself", "ok.nff", "-o", name)
            self.assertEqual(self.read("ok.nff"), text)
        os.rename("ok.nff", "ok.ppm")
        self.fails(2, "qray: 'ok.ppm' is the scene itself", "ok.ppm")

    def test_unreadable(self):
        self.fails(1, "none.nff: cannot open: No such file", "none.nff")
        self.fails(1, "ok.nff/x: cannot open: Not a directory", "ok.nff/x")
        self.fails(1, r"\.: cannot open: Is a directory", ".")
        self.fails(1, r"a\\x0ab: cannot open: No such file", "a\nb")
        os.chmod("ok.nff", 0)
        if not os.access("ok.nff", os.R_OK):
            self.fails(1, "ok.nff: cannot open: Permission denied", "ok.nff")

    def test_unwritable(self):
        os.mkdir("folder")
        self.fails(1, "none/x: cannot open: No such file", "ok.nff", "-o", "none/x")
        self.fails(1, "folder: cannot open: Is a directory", "ok.nff", "-o", "folder")
        self.fails(1, "ok.nff/x: cannot open: Not a directory", "ok.nff", "-o", "ok.nff/x")
        self.fails(1, r"[a/.]+: cannot open: File name too long", "ok.nff", "-o", "a/" * 4000 + "a")
        self.fails(1, "/dev/full: cannot write: No space left", "ok.nff", "-o", "/dev/full")
        self.fails(1, "/dev/full: cannot write: No space left", "ok.nff", "-o", "/dev/full", "-s", "2000x2000",
                   "-j", 8)
        self.assertEqual(self.run_qray("ok.nff", "-o", "/dev/null"), (0, b"", ""))
        self.write("kept", b"old")
        os.chmod("kept", 0o444)
        if not os.access("kept", os.W_OK):
            self.fails(1, "kept: cannot open: Permission denied", "ok.nff", "-o", "kept")

    def test_closed_pipe(self):
        read, write = os.pipe()
        os.close(read)
        done = subprocess.run([QRAY, "ok.nff", "-o", "-"], stdout=write, stderr=subprocess.PIPE)
        os.close(write)
        self.assertEqual((done.returncode, done.stderr), (1, b"-: cannot write: Broken pipe\n"))

    def test_other_formats(self):
        for name, how in (("a.png", "pnmtopng picture.ppm > picture.png"),
                          ("b.JPG", "pnmtojpeg picture.ppm > picture.jpg"),
                          ("x/c.webp", "convert picture.ppm picture.webp")):
            self.fails(2, f"qray: '{name}': qray writes PPM; give '-o picture.ppm', then: {how}", "ok.nff", "-o", name)
        self.assertEqual(self.run_qray("ok.nff", "-o", "a.png.ppm"), (0, b"", ""))

    def test_byte_order_marks(self):
        text = view(4, 3) + "b 0 0 1\n"
        expected = self.pixels(text)
        self.assertEqual(self.pixels(b"\xef\xbb\xbf" + text.encode()), expected)
        for encoding, name in (("utf-16", "UTF-16"), ("utf-16-le", "UTF-16"), ("utf-16-be", "UTF-16"),
                               ("utf-32", "UTF-32")):
            self.write("wide.nff", text.encode(encoding))
            self.fails(1, f"wide.nff:1:1: the text is in {name}", "wide.nff")
            self.fails(1, f"-:1:1: the text is in {name}", "-", input=text.encode(encoding))

    # Standard output or error that is closed is no other file.
    def test_closed_standard_files(self):
        for closed, status in (("0", 0), ("2", 0), ("1", 0)):
            done = subprocess.run(["sh", "-c", f'exec "$0" ok.nff --stats -o x {closed}>&-', QRAY],
                                  stderr=subprocess.PIPE)
            self.assertEqual(done.returncode, status)
            self.assertEqual(self.read("x"), b"P6\n4 3\n255\n" + bytes(36))
        for command, message in (("ok.nff -o - >&-", b"-: cannot write: Bad file"),
                                 ("-h >&-", b"qray: cannot write: Bad file"),
                                 ("-h > /dev/full", b"qray: cannot write: No space"),
                                 ("- <&-", b"-: cannot read: Bad file"),
                                 ("- < x.nff 1<> x.nff", b"qray: '-' is the scene itself")):
            self.write("x.nff", view())
            done = subprocess.run(["sh", "-c", f'exec "$0" {command}', QRAY], stderr=subprocess.PIPE)
            self.assertEqual(done.returncode, 2 if b"itself" in message else 1, command)
            self.assertEqual(done.stderr.count(b"\n"), 1, command)
            self.assertTrue(done.stderr.startswith(message), done.stderr)

    def test_follows_a_link_to_nothing(self):
        os.mkdir("to")
        os.symlink("to/second", "first")
        os.symlink("picture", "to/second")
        os.symlink("b", "a")
        os.symlink("a", "b")
        os.symlink("none/x", "c")
        self.assertEqual(self.run_qray("ok.nff", "-o", "first"), (0, b"", ""))
        self.assertEqual(self.read("to/picture"), b"P6\n4 3\n255\n" + bytes(36))
        self.assertEqual(sorted(os.listdir("to")), ["picture", "second"])
        self.assertTrue(os.path.islink("first") and os.path.islink("to/second"))
        self.fails(1, "a: cannot open: Too many levels", "ok.nff", "-o", "a")
        self.fails(1, "c: cannot open: No such file", "ok.nff", "-o", "c")

    def test_file_that_grows_too_large(self):
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1024, 1024))
        self.fails(1, "x: cannot write: File too large", "ok.nff", "-s", "99x99", "-o", "x", preexec_fn=limit)
        self.fails(1, "x: cannot write: File too large", "compile", SCENES[0], "-o", "x", preexec_fn=limit)
        with open("out", "wb") as file:
            done = subprocess.run([QRAY, "ok.nff", "-s", "99x99", "-o", "-"], stdout=file, stderr=subprocess.PIPE,
                                  preexec_fn=limit)
        self.assertEqual((done.returncode, done.stderr), (1, b"-: cannot write: File too large\n"))

    # From where it can start at all, to where there is enough: one line or a picture.
    def test_little_memory(self):
        self.write("many.nff", view(9, 9) + "".join(f"s {i % 99} {i % 98} 9 1\n" for i in range(20000)) + "p 9 "
                   + "0 0 0 1 0 0 1 1 0 " * 3)
        os.remove("ok.nff")
        programs = [["many.nff", "-q", "-o", "-", "-j", "64", "-s", "400x400"],
                    ["many.nff", "-q", "-o", "-", "-n", "double"],
                    ["compile", "many.nff", "-q", "-o", "-"], ["--help"]]
        for arguments in programs:
            found = set()
            start = os.path.getsize(QRAY) // 1024 + 100
            more = 200, 1000, 2000, 3000, 4000, 6000, 8000, 12000, 28000, 60000
            for kilobytes in (start, *(start + k for k in more)):
                limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (kilobytes << 10, kilobytes << 10))
                status, out, err = self.run_qray(*arguments, preexec_fn=limit)
                found.add(status)
                with self.subTest(arguments=arguments, kilobytes=kilobytes):
                    self.assertEqual((status, err.count("\n"), out == b""), (1, 1, True) if err else (0, 0, False))
                    self.assertTrue(not err or "memory" in err, err)
            self.assertEqual(status, 0)
        status, *_ = self.run_qray("many.nff", "-j", 256, "-s", "400x400", "-q", preexec_fn=lambda: resource.setrlimit(
            resource.RLIMIT_AS, (150 << 20, 150 << 20)))
        self.assertEqual(status, 0)

    def test_replaces_files(self):
        picture = b"P6\n4 3\n255\n" + bytes(36)
        self.write("old", b"x" * 1000)
        os.chmod("old", 0o640)
        os.symlink("old", "link")
        self.assertEqual(self.run_qray("ok.nff", "-o", "link"), (0, b"", ""))
        self.assertEqual(self.read("old"), picture)
        self.assertTrue(os.path.islink("link"))
        self.assertEqual(stat.S_IMODE(os.stat("old").st_mode), 0o640)
        self.write("bad.nff", view() + "x")
        self.fails(1, "bad.nff:2:1: unknown entity 'x'", "bad.nff", "-o", "old")
        self.assertEqual(self.read("old"), picture)
        self.assertEqual(sorted(os.listdir()), ["bad.nff", "link", "ok.nff", "old"])


class Scenes(Cli):
    # Column and line of what is marked with '@' stand in the message.
    def bad(self, text, message):
        before, after = text.split("@")
        line = before.count("\n") + 1
        column = len(before) - (before.rfind("\n") + 1) + 1
        self.write("bad.nff", before + after)
        self.fails(1, f"bad.nff:{line}:{column}: [^\\n]*{re.escape(message)}", "bad.nff")

    def test_errors(self):
        v = view()
        head, tail = "v from 0 0 1 at 0 0 ", " hither 1 resolution "
        for text, message in (
                ("@", "the file ends without a view"),
                (v + "@ball 0 0 0 1", "unknown entity 'ball'"),
                (v + "s 0 0 0@", "the file ends where the radius of a sphere was expected"),
                (v + "s 0 0 @l 0 0 0", "expected z of the centre of a sphere, found 'l'"),
                (v + "s 0 0 0 @1.2.3", "'1.2.3', which is not a number"),
                (v + "s 0 0 0 @nan", "'nan', which is not a finite number"),
                (v + "s 0 @-inf 0 1", "'-inf', which is not a finite number"),
                (v + "s 0 0 0 @1e400", "'1e400', which is too large"),
                (v + "p @2 0 0 0 1 0 0", "is 2; expected at least 3"),
                (v + "p @3.5 0 0 0 1 0 0", "'3.5', which is not a whole number"),
                (v + "plane 0 0 0 @0 0 0", "the normal of a plane is zero"),
                (v + "disc 0 0 0 @0 0 0 1", "the normal of a disc is zero"),
                (v + "texture wood 1 1 1 1 @0 0 0", "the axis of a texture is zero"),
                (v + "c 1 1 1 1 @1 1 1 1", "the apex of a cone is where its base is"),
                ("v from 0 0 1 at @0 0 1 up 0 1 0 angle 9" + tail + "1 1", "'at' is where 'from' is"),
                (head + "0 up @0 0 1 angle 9" + tail + "1 1", "'up' lies along the view"),
                (head + "0 up 0 1 0 angle @0" + tail + "1 1", "'angle' is 0; expected a number above 0 and below 180"),
                (head + "0 up 0 1 0 angle @180" + tail + "1 1", "'angle' is 180; expected"),
                (head + "0 up 0 1 0 angle 9" + tail + "@0 1", "the width of 'resolution' is 0"),
                (head + "0 up 0 1 0 angle 9" + tail + "1 @32769", "expected at most 32768 (limit 'resolution')"),
                ("@s 0 0 0 1 " + v, "an object before the view"),
                (v + "s 0 0 0 1 @l 0 0 0", "a light after the first object"),
                (v + "@v", "a second view"),
                (v + "f 1 1 @1.5 1 0 0 0 1", "blue of the colour of a fill is 1.5; expected a number from 0 to 1"),
                (v + "material @color 1 0 0",
                 "unknown word 'color' in 'material'; did you mean 'colour'? expected one of colour"),
                (v + "l 0 0 0 1 @65 1", "green of the colour of a light is 65; expected a number from 0 to 64"),
                (v + "material shine @1e7", "'shine' is 1e7; expected a number from 0 to 1e6"),
                (v + "material ior @0.1", "'ior' is 0.1; expected a number from 0.125 to 8"),
                (v + "texture noise 0 0 0 @0", "the size of a texture is 0; expected a number above 0"),
                (v + "shadows @maybe", "expected 'on' or 'off' after 'shadows', found 'maybe'"),
                (v + 64 * "l 0 0 0 " + "@l 0 0 0", "expected at most 64 (limit 'lights')")):
            with self.subTest(text=text[-60:]):
                self.bad(text, message)
        self.write("bad.nff", v.encode() + b"s 0 0 0 \xff")
        self.fails(1, "bad.nff:2:9: found the byte 0xff", "bad.nff")

    # Images are looked for beside the scene, or where the command runs if that comes from standard input.
    def test_images_stand_beside_the_scene(self):
        os.makedirs("folder/pictures", exist_ok=True)
        text = view() + "ambientlight 1 1 1 material texture globe pictures/one.ppm 0 0 0 s 0 0 0 1 "
        self.write("folder/scene.nff", text)
        self.write("folder/pictures/one.ppm", b"P6 1 1 255 \xff\x80\x00")
        drawn = (0, b"P6\n1 1\n255\n\xff\x80\x00", "")
        self.assertEqual(self.run_qray("folder/scene.nff", "-q", "-o", "-"), drawn)
        self.assertEqual(self.run_qray("-", "-q", "-o", "-", cwd="folder", input=text.encode()), drawn)
        self.write("folder/pictures/one.ppm", b"P6 1 1 255 \xff\x80")
        self.fails(1, "folder/scene.nff:2:43: 'pictures/one.ppm' is short: it has 13 bytes, and its texels end at 14",
                   "folder/scene.nff")
        os.remove("folder/pictures/one.ppm")
        self.fails(1, "folder/scene.nff:2:43: cannot read 'pictures/one.ppm': No such file or directory",
                   "folder/scene.nff")

    # The radius of the first scenes is 1/2: planes as far as 64 leave q16 steps of 1/512, as far as 128 of 1/256. That
    # of the others is 1.03: its steps are 2^-15, and the limit for a texture is 2^-27. q24's are 64 times as fine.
    def test_refused_by_q16_and_q24(self):
        plane = view() + "plane 0 0 0 0 1 0 far {}"
        fine = view() + "texture checker 0 0 0 {} s 0 0 0 0.5"
        far = r"steps of 0\.00391 .* radius of 0\.5 is less than 256 of them"
        small = r"steps of %s .* size of %s is less than 1/4096 of one"
        for number, text, value, refusal in (
                ("q16", plane, 64, None), ("q16", plane, 128, far),
                ("q24", plane, 64 * 64, None), ("q24", plane, 64 * 128, far),
                ("q16", fine, 2.0 ** -27, None), ("q16", fine, 2.0 ** -28, small % (r"3\.05e-05", r"3\.73e-09")),
                ("q24", fine, 2.0 ** -33, None), ("q24", fine, 2.0 ** -34, small % (r"4\.77e-07", r"5\.82e-11"))):
            with self.subTest(number=number, text=text[-40:], value=value):
                self.write("bad.nff", text.format(value))
                if refusal:
                    self.fails(1, f"bad.nff: {number} has lengths in {refusal}", "-n", number, "bad.nff")
                else:
                    self.assertEqual(self.run_qray("-q", "-n", number, "bad.nff")[0], 0)
                self.assertEqual(self.run_qray("-q", "bad.nff")[0], 0)

    def test_text_limit(self):
        for size, message in ((256 << 20, "bad.nff:1:1: found the byte 0x00"),
                              ((256 << 20) + 1, r"bad.nff:1:1: a text of more than 268435456 bytes \(limit 'text'\)")):
            self.write("bad.nff", b"")
            os.truncate("bad.nff", size)
            self.fails(1, message, "bad.nff")


class Threads(Cli):
    def test_same_bytes(self):
        scene = [s for s in SCENES if s.endswith("showcase.nff")][0]
        text = self.read(scene).decode()
        for size in ("97x61", "3x300", "300x3", "1x8200"):
            pictures = {self.pixels(text, "-s", size, "-j", n) for n in (1, 2, 3, 8, 256)}
            self.assertEqual(len(pictures), 1, size)

    def wait(self, process, condition):
        for _ in range(3000):
            if condition():
                return
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        self.fail("not in 30 s")

    def test_threads_are_as_many_as_asked_for(self):
        for threads in (1, 3):
            process = subprocess.Popen([QRAY, "ok.nff", "-s", "400x9999", "-r", "400", "-o", "x", "-j", str(threads)])
            self.addCleanup(process.kill)
            tasks = f"/proc/{process.pid}/task"
            parts = lambda: [name for name in os.listdir() if name.endswith(".part") and os.stat(name).st_size > 2000]
            self.wait(process, parts)
            self.assertEqual(len(os.listdir(tasks)), threads)
            process.send_signal(signal.SIGTERM)
            self.assertEqual(process.wait(), -signal.SIGTERM)
            self.assertEqual(os.listdir(), ["ok.nff"])

    def test_nothing_is_left_after_a_signal(self):
        for number in sorted(signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP, signal.SIGCHLD, signal.SIGCONT,
                                                       signal.SIGTSTP, signal.SIGTTIN, signal.SIGTTOU, signal.SIGURG,
                                                       signal.SIGWINCH}):
            process = subprocess.Popen([QRAY, "ok.nff", "-s", "400x9999", "-r", "400", "-q", "-o", "x", "-j", "2"])
            self.addCleanup(process.kill)
            self.wait(process, lambda: [name for name in os.listdir() if name.endswith(".part")])
            process.send_signal(number)
            self.assertEqual(process.wait(30), -number)
            self.assertEqual(os.listdir(), ["ok.nff"], number)

    def test_a_signal_that_is_ignored_stays_so(self):
        process = subprocess.Popen(["nohup", QRAY, "ok.nff", "-s", "400x9999", "-r", "400", "-q", "-o", "x"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.kill)
        self.wait(process, lambda: [name for name in os.listdir() if name.endswith(".part")])
        process.send_signal(signal.SIGHUP)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(), -signal.SIGTERM)  # not -SIGHUP, which came first
        self.assertEqual(os.listdir(), ["ok.nff"])

    def on_a_terminal(self, *arguments):
        master, slave = pty.openpty()
        process = subprocess.Popen([QRAY, "ok.nff", "-o", "x", *arguments], stderr=slave, stdout=subprocess.DEVNULL)
        os.close(slave)
        self.addCleanup(process.kill)
        os.set_blocking(master, False)
        self.addCleanup(os.close, master)
        return process, master

    def test_progress(self):
        process, master = self.on_a_terminal("-s", "400x9999", "-r", "400")
        shown = bytearray()

        def progress():
            try:
                shown.extend(os.read(master, 1000))
            except BlockingIOError:
                pass
            return re.search(rb"\r *\d+ %, \d+ (s|min|h)( \d+ (s|min))? left", shown)

        self.wait(process, progress)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(), -signal.SIGINT)
        self.assertEqual(os.listdir(), ["ok.nff"])

    def test_no_progress_if_quiet(self):
        process, master = self.on_a_terminal("-s", "400x9999", "-r", "400", "-q")
        time.sleep(1.5)
        process.send_signal(signal.SIGINT)
        process.wait()
        with self.assertRaises(OSError):  # nothing was written, and nobody is left to write
            os.read(master, 1000)


class Builds(unittest.TestCase):
    def picture(self, program, *arguments):
        done = subprocess.run([program, *arguments, "-q", "-o", "-"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              timeout=120)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        self.assertTrue(done.stdout.startswith(b"P6\n"))
        return done.stdout

    def test_variants(self):
        self.assertEqual(len(VARIANTS), 4)

    # Fixed point by other compilers, at other levels, and with sanitizers that stop at the first fault.
    def test_same_bytes(self):
        self.assertGreaterEqual(len(SCENES), 10)
        for scene in QUICK_SCENES:
            for arguments in (["-s", "80x60"], ["-s", "24x18", "-r", "4", "-d", "9"], ["-s", "24x18", "-a", "2"],
                              ["-s", "40x30", "-n", "q16"], ["-s", "40x30", "-n", "q24"]):
                expected = self.picture(QRAY, scene, *arguments)
                for program in [*VARIANTS, SANITIZED]:
                    with self.subTest(scene=scene, program=program, arguments=arguments):
                        self.assertEqual(self.picture(program, scene, *arguments), expected)

    # Floating point with vectors by parts, as the sanitized program has them, and in lanes, where this processor has
    # those.
    def test_sanitizers_report_nothing(self):
        for scene in QUICK_SCENES:
            for number in ("float", "double"):
                with self.subTest(scene=scene, number=number):
                    arguments = ["-n", number, "-s", "40x30"]
                    self.assertEqual(self.picture(SANITIZED, scene, *arguments), self.picture(QRAY, scene, *arguments))


if __name__ == "__main__":
    unittest.main()
