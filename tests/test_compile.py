"""Compiled scenes: with the library alone, the header that `qray compile` writes draws the bytes that `qray`
draws, and compiles without a warning. From the top of the repository: python3 tests/test_compile.py"""

import concurrent.futures
import glob
import os
import pathlib
import re
import shutil
import subprocess
import unittest

FOLDER = "build/compile"
NUMBERS = ["q16", "q24", "q32", "float", "double"]
FLAGS = ["-std=c++20", "-O1", "-Wall", "-Wextra", "-Wconversion", "-Wsign-conversion", "-Wshadow",
         "-Wdouble-promotion", "-Werror", "-ffp-contract=off", "-Iinclude"]
PROGRAM = """#include <qray/qray.hpp>

#include "%s"

#include <stdio.h>

int main()
{
    static uint8_t row[3 * scene::width];
    printf("P6\\n%%u %%u\\n255\\n", unsigned{scene::width}, unsigned{scene::height});
    const auto sink = [](uint32_t, uint32_t, const uint8_t* rgb, uint32_t bytes) {
        return fwrite(rgb, 1, bytes, stdout) == bytes;
    };
    return qray::render<qray::Rgb888>(scene::scene, row, 1, sink) ? 0 : 1;
}
"""
# Rows, and a rectangle from (5, 3) on, against pixels.
ROWS = """#include <qray/qray.hpp>

#include "rows.hpp"

int main()
{
    using F = qray::Rgb888;
    static uint8_t row[3 * scene::width], rect[3 * (scene::width - 5) * (scene::height - 3)];
    render_rect<F>(scene::scene, 5, 3, scene::width - 5, scene::height - 3, rect);
    for (uint32_t y = 0; y < scene::height; y++) {
        qray::render_row<F>(scene::scene, y, row);
        for (uint32_t x = 0; x < scene::width; x++) {
            uint8_t rgb[3];
            F::put(qray::render_pixel(scene::scene, x, y), x, y, rgb);
            for (uint32_t i = 0; i < 3; i++)
                if (rgb[i] != row[3 * x + i]
                    || (x >= 5 && y >= 3 && rgb[i] != rect[3 * ((y - 3) * (scene::width - 5) + x - 5) + i]))
                    return 1;
        }
    }
    return 0;
}
"""
VIEW = "v from 0 0 5 at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 16 12\n"


def qray(*arguments):
    return subprocess.run(["build/qray", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def compile_and_draw(scene, number, compiler="g++", options=(), moving=()):
    """(picture of the compiled scene, of the command)"""
    name = "-".join([os.path.basename(scene).removesuffix(".nff"), number, compiler, *options, *moving])
    name = f"{FOLDER}/{name}"
    options = ["-n", number, *options]
    made = qray("compile", scene, *options, *moving, "-o", name + ".hpp")
    assert made.returncode == 0 and not made.stdout, made.stderr
    with open(name + ".cpp", "w") as file:
        file.write(PROGRAM % os.path.basename(name + ".hpp"))
    built = subprocess.run([compiler, *FLAGS, name + ".cpp", "-o", name], stdout=subprocess.PIPE,
                           stderr=subprocess.STDOUT, text=True)
    assert built.returncode == 0, built.stdout
    drawn = subprocess.run([name], stdout=subprocess.PIPE, check=True).stdout
    return drawn, qray(scene, *options, "-q", "-o", "-").stdout


def write(name, text):
    path = f"{FOLDER}/{name}.nff"
    with open(path, "w") as file:
        file.write(text)
    return path


class Compile(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)
        os.makedirs(FOLDER)

    def same(self, cases):
        with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
            for case, pictures in [(case, pool.submit(compile_and_draw, *case)) for case in cases]:
                with self.subTest(case=case):
                    drawn, expected = pictures.result()
                    self.assertEqual(drawn, expected)

    def test_everything_in_each_number_system(self):
        self.same([("scenes/showcase.nff", number, compiler, ("-s", "32x24"))
                   for number in NUMBERS for compiler in ("g++", "clang++")])

    def test_each_scene(self):
        scenes = [s for s in sorted(glob.glob("scenes/*.nff")) if "\nradiosity " not in pathlib.Path(s).read_text()]
        self.assertGreater(len(scenes), 10)
        scenes.append("tests/room.nff")  # where light is solved for, which takes long in others
        options = [("-r", "4"), ("-a", "3,0.1"), ("-d", "9", "--cutoff", "0.3")]
        self.same([(scene, NUMBERS[k % len(NUMBERS)], "g++", ("-s", "32x24", *options[k % 3]))
                   for k, scene in enumerate(scenes)])

    # Glass that mirrors too little for a ray, but for total reflection, where all adds up.
    def test_weights_about_the_cutoff(self):
        self.same([("scenes/glass.nff", "q32", "g++", ("-s", "32x24", "--cutoff", cutoff))
                   for cutoff in ("0", "0.3", "0.98", "0.98000000001", "1")])

    # A sphere, and what may be lacking around one.
    def test_little_scenes(self):
        ball = "s 0 0 0 1\n"
        scenes = {
            "nothing": "b 0.2 0.4 0.6\n", "unlit": ball, "lamp_only": "l 1 2 3\n",
            "dropped": "l 1 2 3\np 3 0 0 0 1 1 1 2 2 2\nf 1 1 1 1 0 0 0 0\n" + ball,
            "far_lamp": "l 1e9 2e9 3e9\n" + ball, "farther_lamp": "l 1e14 2e14 3e14\n" + ball,
        }
        self.same([(write(name, VIEW + text), number) for number in ("q32", "float")
                   for name, text in scenes.items()])

    def header(self, text, *options):
        made = qray("compile", write("header", text), *options, "-o", f"{FOLDER}/header.hpp")
        self.assertEqual(made.returncode, 0, made.stderr)
        with open(f"{FOLDER}/header.hpp") as file:
            return file.read()

    def test_the_header_opens_with_the_scenes_comment(self):
        text = self.header("\n#\n#  One ball. \\\n# More.\n" + VIEW)
        self.assertEqual(text.split("\n")[0], "// One ball. \\.")
        self.assertRegex(self.header(VIEW), r"^// header.nff by qray compile: q32, 16 x 12 pixels, ")

    # In files of their own, under one name, which the linker must not take for one and the same; and in
    # one file, under two.
    def test_a_program_holds_several_scenes(self):
        draw = ("    qray::render<qray::Rgb888>(%s::scene, row, 1, "
                "[](uint32_t, uint32_t, const uint8_t* rgb, uint32_t bytes) {"
                " return fwrite(rgb, 1, bytes, stdout) == bytes; });\n")
        scenes = [("scenes/balls.nff", "q32"), ("scenes/phong.nff", "q32"), ("scenes/phong.nff", "q16")]
        include, expected, files = "#include <stdio.h>\n", b"", {}
        for k, (scene, number) in enumerate(scenes):
            options = ("-n", number, "-s", "32x24")
            for name, out in (((), f"apart{k}"), (("--name", f"part_{k}"), f"together{k}")):
                made = qray("compile", scene, *options, *name, "-o", f"{FOLDER}/{out}.hpp")
                self.assertEqual((made.returncode, made.stderr), (0, b""))
            expected += qray(scene, *options, "-q", "-o", "-").stdout.removeprefix(b"P6\n32 24\n255\n")
            files[f"apart{k}"] = (include + f'#include "apart{k}.hpp"\nvoid draw{k}();\nvoid draw{k}()\n{{\n'
                                  "    static uint8_t row[3 * scene::width];\n" + draw % "scene" + "}\n")
        order = range(len(scenes))
        files["apart"] = ("".join(f"void draw{k}();\n" for k in order) + "int main()\n{\n"
                          + "".join(f"    draw{k}();\n" for k in order) + "}\n")
        files["together"] = (include + "".join(f'#include "together{k}.hpp"\n' for k in order) + "int main()\n{\n"
                             "    static uint8_t row[3 * part_0::width];\n"
                             + "".join(draw % f"part_{k}" for k in order) + "}\n")
        for name, text in files.items():
            with open(f"{FOLDER}/{name}.cpp", "w") as file:
                file.write(text)
        apart = [f"apart{k}" for k in order]
        for names in (["apart", *apart], ["apart", *reversed(apart)], ["together"]):
            with self.subTest(names=names):
                built = subprocess.run(["g++", *FLAGS, *[f"{FOLDER}/{name}.cpp" for name in names],
                                        "-o", f"{FOLDER}/several"], stdout=subprocess.PIPE,
                                       stderr=subprocess.STDOUT, text=True)
                self.assertEqual(built.returncode, 0, built.stdout)
                drawn = subprocess.run([f"{FOLDER}/several"], stdout=subprocess.PIPE)
                self.assertEqual((drawn.returncode, drawn.stdout), (0, expected))

    def test_names(self):
        for name in ("", "2nd", "a b", "a-b", "a::b", "\u00e9", "x" * 65, "class", "int", "co_await", "xor", "new"):
            made = qray("compile", "scenes/balls.nff", "--name", name, "-o", "-")
            self.assertEqual((made.returncode, made.stdout), (2, b""), name)
            self.assertIn(b"expected", made.stderr)
            self.assertEqual(made.stderr.count(b"\n"), 1)
        for name in ("classes", "in", "_a"): # keywords but for a letter
            self.assertEqual(qray("compile", "scenes/balls.nff", "--name", name, "-o", "-").returncode, 0, name)

    def test_the_header_holds_what_the_scene_calls_for(self):
        text = self.header("shadows off\n" + VIEW + "l 1 2 3\ns 0 0 0 1\ns 1 0 0 1\n", "-s", "64x48")
        self.assertEqual(re.findall(r"\.(\w+) = true", text), ["sphere", "light"])
        self.assertEqual(re.findall(r"constexpr qray::(\w+)<Number>", text), ["Sphere", "Matte", "Light"])
        self.assertIn("width = 64, height = 48;", text)
        self.assertRegex(text, r"\.spheres = \{spheres, 2\}")
        for word in ("shadow", "max_depth", "cutoff", "threshold", "disc"):
            self.assertNotIn(word, text.split("#pragma once")[1])

    def test_errors_are_those_of_the_command(self):
        bad = write("bad", VIEW + "s 0 0 0 x\n")
        for arguments, status in (((bad,), 1), (("no_such.nff",), 1), ((), 2), ((bad, "-r", "3"), 2),
                                  ((bad, "-n", "q8"), 2), ((bad, "-a", "2", "-r", "4"), 2)):
            drawn = qray(*arguments, "-o", f"{FOLDER}/bad.ppm")
            made = qray("compile", *arguments, "-o", f"{FOLDER}/bad.hpp")
            self.assertEqual((made.returncode, made.stdout), (status, b""), arguments)
            self.assertEqual(made.stderr.replace(b"qray compile", b"qray"), drawn.stderr, arguments)
            self.assertEqual(made.stderr.count(b"\n"), 1)
            self.assertFalse(os.path.exists(f"{FOLDER}/bad.hpp"))
        self.assertEqual([name for name in os.listdir(FOLDER) if name.startswith(".")], [])

    # What is lit is solved where it stands.
    def test_radiosity_stands_still(self):
        lit = write("lit", VIEW + "radiosity 1\nl 0 2 2\np 3 -1 0 0 1 0 0 0 1 0\np 3 -1 0 1 1 0 1 0 0 2\n")
        moved = qray("compile", lit, "--moving", "lights", "-o", f"{FOLDER}/lit.hpp")
        self.assertEqual(moved.returncode, 1)
        self.assertRegex(moved.stderr,
                         rb"\A[^\n]*lit.nff:2:1: light between surfaces is [^\n]*'--moving camera'[^\n]*\n\Z")
        self.assertFalse(os.path.exists(f"{FOLDER}/lit.hpp"))
        self.assertEqual(qray("compile", lit, "--moving", "camera", "-o", f"{FOLDER}/lit.hpp").returncode, 0)

    def said(self, text, *moving, number="q32"):
        """What the command says of a scene, whose first line is VIEW, with what moves in it."""
        path = write("said", VIEW + text)
        made = qray("compile", path, "-n", number, "--moving", *moving, "-o", f"{FOLDER}/said.hpp")
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertLessEqual(made.stderr.count(b"\n"), 1)
        return made.stderr.decode().removeprefix(path + ":")

    # What a scene that moves cannot do, in one line.
    def test_what_does_not_move_is_said(self):
        ceiling, ball = "p 4 -3 2 -3 3 2 -3 3 2 3 -3 2 3\n", "s 0 0 0 1\n"
        for number in NUMBERS:
            self.assertEqual(self.said("l 1 1 4\n" + ceiling + ball, "all", number=number), "")
            at = "5.0002" if number == "q16" else "5"
            eye = self.said(f"l 1 1 4\n{ball}p 3 -1 -1 {at} 1 -1 {at} 0 2 {at}\n", "camera", number=number)
            self.assertRegex(eye, r"\A4: warning: the eye, [^ ]* off a polygon, does not know of it .* expected ")
        lamp = "l 0 2 0\n"
        for moving in ("lights", "polygons", "all", "spheres,polygons"):
            self.assertRegex(self.said(lamp + ceiling + ball, moving),
                             r"\A2: warning: a light on a polygon, .* of which one moves: .* expected a light ")
        for moving in ("camera", "spheres", "mattes"):
            self.assertEqual(self.said(lamp + ceiling + ball, moving), "")
        panel = "panel 4 0 2 0 1 0 0 0 0 1 1 1 1\n"
        self.assertRegex(self.said(panel + ceiling, "panels"), r"\A2: warning: a light on a polygon")
        self.assertEqual(self.said(panel + ceiling + ball, "spheres"), "")
        self.assertEqual(self.said("l 1e4 0 0\n" + ball, "spheres"), "")
        self.assertEqual(self.said("l 1e4 0 0\n" + ball, "lights"),
                         "2: warning: a lamp far outside of the scene: place() moves it, move() does not\n")
        self.assertEqual(self.said(ball, "spheres,cones"), " warning: there are no cones to be moved\n")
        self.assertEqual(self.said(ball, "cones,suns"),
                         " warning: there are no cones to be moved; 2 warnings about '--moving' in all\n")

    # Every table that can be named stands in the help, and nothing else.
    def test_what_can_be_named(self):
        text = qray("compile", "-h").stdout.decode()
        names = re.search(r"of: camera,\s+(.*)", text)[1].split(", ")
        ball = write("ball", VIEW + "s 0 0 0 1\n")
        for name in [*names, "camera", "all"]:
            self.assertEqual(qray("compile", ball, "--moving", name, "-q", "-o", "-").returncode, 0, name)
        for name in ("triangles", "smooth_triangles", "entries", "vertices", "mirrors", "textures", "planes", "", ","):
            made = qray("compile", ball, "--moving", name, "-o", "-")
            self.assertEqual((made.returncode, made.stderr.count(b"\n")), (2, 1), name)
            self.assertIn(", ".join(names[:1]), made.stderr.decode())
        self.assertLessEqual({"spheres", "discs", "cones", "polygons", "patches", "mattes", "lights", "suns", "panels"},
                             set(names))

    # Where the camera is in RAM a row steps from pixel to pixel; pixels are made one by one.
    def test_rows_of_what_moves_are_its_pixels(self):
        text = "v from 3 2 5 at 0.1 0 0 up 0.2 1 0.1 angle 40 hither 1 resolution 31 23\nl 1 2 5\ns 0 0 0 1\n"
        with open(f"{FOLDER}/rows.cpp", "w") as file:
            file.write(ROWS)
        for number in NUMBERS:
            made = qray("compile", write("rows", text), "-n", number, "--moving", "all", "-o", f"{FOLDER}/rows.hpp")
            self.assertEqual((made.returncode, made.stderr), (0, b""))
            built = subprocess.run(["g++", *FLAGS, "-fsanitize=undefined", "-fno-sanitize-recover=all",
                                    f"{FOLDER}/rows.cpp", "-o", f"{FOLDER}/rows"])
            self.assertEqual(built.returncode, 0)
            self.assertEqual(subprocess.run([f"{FOLDER}/rows"]).returncode, 0, number)

    # A lamp on a surface, where neither moves, shines as where nothing does.
    def test_a_lamp_on_what_stands_still(self):
        room = write("ceiling", VIEW + "l 0.1 1.65 0.3\nf 1 1 1 1 0 0 0 1\n"
                     "p 4 -3 2.27 -3 3 1.07 -3 3 1.07 3 -3 2.27 3\nplane 0 -1 0 0 1 0\ns 0 0 0 0.7\n")
        within = ("--within", "-3,-3,-3,3,3,6")
        for number in NUMBERS:
            drawn, expected = compile_and_draw(room, number, "g++", within, ("--moving", "spheres"))
            self.assertEqual(drawn, expected, number)

    def test_the_header_is_whole_or_as_it_was(self):
        good = write("good", VIEW + "s 0 0 0 1\n")
        out = f"{FOLDER}/whole.hpp"
        self.assertEqual(qray("compile", good, "-o", out).returncode, 0)
        with open(out) as file:
            before = file.read()
        self.assertEqual(qray("compile", write("bad", "v from"), "-o", out).returncode, 1)
        with open(out) as file:
            self.assertEqual(file.read(), before)
        self.assertEqual(qray("compile", good, "-o", "-").stdout.decode(), before)
        self.assertEqual(qray("compile", good, "-o", "/dev/full").returncode, 1)


if __name__ == "__main__":
    unittest.main()
