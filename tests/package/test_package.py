"""`make package`: its header makes the same code as the headers that it is made of; its examples, and projects that use
it, are built with nothing but what it holds, and draw the picture. From the top of the repository, after
`make test-programs`: python3 tests/package/test_package.py"""

import json
import os
import re
import subprocess
import sys
import unittest

sys.path.insert(0, "src/study")
import programs  # noqa: E402

FOLDER = os.path.abspath("build/package_test")
PACKAGE = FOLDER + "/package/qray"
FLAGS = ["-std=c++20", "-ffp-contract=off", "-fno-exceptions", "-fno-rtti", "-ffreestanding", "-g0"]
COMPILERS = {
    "microbit": ["arm-none-eabi-g++", "-mcpu=cortex-m0", "-mthumb", "-Os"],
    "rv32": ["riscv64-unknown-elf-g++", "-march=rv32imac", "-mabi=ilp32", "-O2"],
    "desktop": ["g++", "-O1"],
}
FACE = {"qray_width", "qray_height", "qray_row_bytes", "qray_pixel", "qray_rows", "qray_rect"}
DRAW = """#include <qray/qray.hpp>
#include "balls.hpp"
void draw(uint8_t* frame);
void draw(uint8_t* frame)
{
    qray::render_rect<qray::Dithered<qray::Mono>>(scene::scene, 0, 0, scene::width, scene::height, frame);
}
"""
# In C, and in C++ before there was C++20: the picture as rows, as pixels, and in halves.
C = r"""#include <qray_c.h>
#include <stdio.h>
#include <string.h>

static uint8_t rows[64 * 48 * 2], parts[2][32 * 48 * 2];

int main(void)
{
    uint32_t x, y;
    uint8_t rgb[3] = {7, 7, 7};
    if (qray_width() != 64 || qray_height() != 48 || qray_row_bytes(64) != 128)
        return 1;
    if (qray_rows(0, 10, rows) != 10 || qray_rows(10, 1000, rows + 10 * 128) != 38 || qray_rows(48, 1, rows) != 0
        || qray_rows(0xffffffffu, 2, rows) != 0)
        return 2;
    if (!qray_rect(0, 0, 32, 48, parts[0]) || !qray_rect(32, 0, 32, 48, parts[1]) || qray_rect(33, 0, 32, 1, parts[0])
        || qray_rect(0, 1, 1, 48, parts[0]) || qray_rect(1, 0, 0xffffffffu, 1, parts[0]))
        return 3;
    for (y = 0; y < 48; y++)
        for (x = 0; x < 2; x++)
            if (memcmp(rows + y * 128 + x * 64, parts[x] + y * 64, 64) != 0)
                return 4;
    if (qray_pixel(64, 0, rgb) || qray_pixel(0, 48, rgb) || rgb[0] != 7)
        return 5;
    fputs("P6\n64 48\n255\n", stdout);
    for (y = 0; y < 48; y++)
        for (x = 0; x < 64; x++) {
            if (!qray_pixel(x, y, rgb) || rows[y * 128 + x * 2] >> 3 != (rgb[0] * 31 + 127) / 255)
                return 6;
            fwrite(rgb, 1, 3, stdout);
        }
    return 0;
}
"""
# Things that move, in C11: a frame for each line of MOVES.
MOVING = r"""#include <qray_c.h>
#include <stdio.h>

static uint8_t picture[32 * 24 * 3];

static int frame(void)
{
    qray_refit();
    return printf("P6\n32 24\n255\n") > 0 && qray_rows(0, 24, picture) == 24
        && fwrite(picture, 1, sizeof picture, stdout) != 0;
}

int main(void)
{
    const qray_motion shift = {.shift = {QRAY_ONE / 2, QRAY_ONE / 4, -QRAY_ONE}}, none = {0};
    const qray_motion turn = {.about = {QRAY_ONE, 0, 0}, .axis = {QRAY_ONE, 2 * QRAY_ONE, 0}, .angle = qray_turn(1, 7),
                              .scale = QRAY_ONE / 2, .shift = {0, QRAY_ONE / 8, 0}};
    const qray_motion out = {.shift = {100 * QRAY_ONE}};
    const int32_t eye[3] = {QRAY_ONE, 2 * QRAY_ONE, 5 * QRAY_ONE}, at[3] = {0, QRAY_ONE, 0}, up[3] = {0, QRAY_ONE, 0};
    const int32_t place[3] = {-QRAY_ONE, QRAY_ONE * 3 / 2, QRAY_ONE}, colour[3] = {0, QRAY_ONE, QRAY_ONE / 4};
    const int32_t bright[3] = {0, QRAY_ONE + 1, 0};
    uint32_t (*const move[])(uint32_t, uint32_t, const qray_motion*) = {
        qray_move_spheres, qray_move_discs,  qray_move_cones, qray_move_polygons,
        qray_move_patches, qray_move_lights, qray_move_suns,  qray_move_panels};
    const uint32_t things[] = {1, 1, 1, 1, 2, 1, 1, 1};
    unsigned i;
    if (!frame())
        return 1;
    for (i = 0; i < 8; i++) /* shifted, as in the text */
        if (move[i](0, 99, &shift) != things[i] || move[i](things[i], 1, &shift) != 0)
            return 2;
    if (!frame())
        return 3;
    for (i = 0; i < 8; i++) /* and turned, always from where they were; or stay, and go on staying where they are */
        if (move[i](0, 99, &turn) != things[i] || move[i](0, 0, &none) != 0 || (i != 6 && move[i](0, 1, &out) != 0))
            return 4;
    if (qray_look_at(eye, eye, up, 0) || qray_look_at(eye, at, up, qray_turn(1, 2))
        || !qray_look_at(eye, at, up, qray_turn(1, 8)) || !frame())
        return 5;
    if (!qray_look_at(eye, at, up, 0) || !frame())
        return 6;
    for (i = 0; i < 8; i++)
        if (move[i](0, 99, &none) != things[i])
            return 7;
    if (!qray_place_sphere(0, place, QRAY_ONE / 2) || !qray_place_light(0, place) || !qray_place_sun(0, place)
        || !qray_paint(0, colour) || qray_paint(0, bright) || qray_place_sphere(1, place, QRAY_ONE)
        || qray_place_sphere(0, place, 0) || qray_place_light(1, place) || qray_place_sun(1, place)
        || qray_paint(9, colour))
        return 8;
    return !frame();
}
"""
# The same in C++, by the library.
MOVING_CPP = r"""#include <qray/qray.hpp>
#include <stdio.h>
#include "scene.hpp"

using N = scene::Number;

static bool frame()
{
    static uint8_t picture[32 * 24 * 3];
    scene::refit();
    printf("P6\n32 24\n255\n");
    qray::render_rect<qray::Rgb888>(scene::scene, 0, 0, 32, 24, picture);
    return fwrite(picture, 1, sizeof picture, stdout) != 0;
}

static bool move_all(const qray::Motion<N>& m)
{
    using namespace scene;
    const qray::Corners<N> first{first_vertices.data, first_normals.data};
    const qray::MovedCorners<N> now{vertices.data, normals.data};
    bool all = move(first_spheres[0], m, spheres[0]) & move(first_discs[0], m, discs[0])
        & move(first_cones[0], m, cones[0]) & move(first_polygons[0], first, m, polygons[0], now)
        & move(first_lights[0], m, lights[0]) & move(first_suns[0], m, suns[0]) & move(first_panels[0], m, panels[0]);
    for (uint32_t i = 0; i < 2; i++)
        all &= move(first_patches[i], first, m, patches[i], now);
    return all;
}

int main()
{
    const auto c = [](int32_t n, int32_t d = 1) { return qray::coordinate<N>(n, d); };
    qray::Motion<N> none(scene::frame), shift(scene::frame), turn(scene::frame);
    shift.shift({c(1, 2), c(1, 4), c(-1)});
    turn.about({c(1), {}, {}}).turn({c(1), c(2), {}}, qray::part_of_turn(1, 7)).scale(c(1, 2)).shift({{}, c(1, 8), {}});
    bool well = frame() && move_all(shift) && frame() && move_all(turn);
    qray::View<N> view{{c(1), c(2), c(5)}, {{}, c(1), {}}, {{}, c(1), {}}, qray::field<N>(1u << 29)};
    well = well && look_at(scene::camera, scene::frame, view) && frame();
    view.field = scene::view.field;
    well = well && look_at(scene::camera, scene::frame, view) && frame() && move_all(none);
    const qray::ScenePoint<N> at{c(-1), c(3, 2), c(1)};
    return !(well && place(scene::spheres[0], scene::frame, at, c(1, 2)) && place(scene::lights[0], scene::frame, at)
             && place(scene::suns[0], at) && paint(scene::mattes[0], {{}, c(1), c(1, 4)}) && frame());
}
"""
MOVING_SCENE = """v from 0 3 9  at 0 1 0  up 0 1 0  angle 50  hither 1  resolution 32 24
b 0.3 0.4 0.6
l {l}  0.5 0.5 0.5
sun 1 2 1  0.25 0.25 0.25
panel 2  {panel}  1 0 0  0 0 1  0.25 0.25 0.25
material colour 1 0.25 0.25
s {s}  0.75
disc {disc}  0 1 0.5  0.5
c {c0} 0.5  {c1} 0.25
p 4  {p0}  {p1}  {p2}  {p3}
pp 4  {q0} 0 0 1  {q1} 0.25 0 1  {q2} 0 0.25 1  {q3} 0 0 1
"""
MOVING_PLACES = {"l": (3, 6, 4), "panel": (-3, 5, 3), "s": (-2, 1, 0), "disc": (0, 3, 0), "c0": (2, 0.5, 1),
                 "c1": (2, 2, 1), "p0": (-1, 2, -2), "p1": (1, 2, -2), "p2": (1, 4, -2), "p3": (-1, 4, -2),
                 "q0": (0, 0, 2), "q1": (1, 0, 2), "q2": (1, 1, 2), "q3": (0, 1, 2)}
# What Arduino includes before a sketch, and runs it with.
ARDUINO = """#include <stdio.h>
#include <string.h>
#include <stdint.h>
struct Port {
    void begin(long) {}
    void print(const char* text) { fputs(text, stdout); }
    void print(char c) { putchar(c); }
    void print(unsigned n) { printf("%u", n); }
    size_t write(const uint8_t* bytes, size_t size) { return fwrite(bytes, 1, size, stdout); }
};
static Port Serial;
void setup();
void loop();
int main() { setup(); loop(); }
"""
# ESP-IDF and Zephyr, as far as a component meets them.
IDF = """cmake_minimum_required(VERSION 3.13)
project(idf CXX)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(ESP_PLATFORM 1)
function(idf_component_register)
    cmake_parse_arguments(IDF "" "" "SRCS;INCLUDE_DIRS;REQUIRES" ${ARGN})
    get_filename_component(name ${CMAKE_CURRENT_SOURCE_DIR} NAME)
    if(IDF_SRCS)
        add_library(${name} OBJECT ${IDF_SRCS})
        target_link_libraries(${name} PRIVATE ${IDF_REQUIRES})
    else()
        add_library(${name} INTERFACE)
        target_include_directories(${name} INTERFACE ${IDF_INCLUDE_DIRS})
    endif()
    set(COMPONENT_LIB ${name} PARENT_SCOPE)
endfunction()
include(PACKAGE/project_include.cmake)
add_subdirectory(PACKAGE/examples/esp-idf/main main)
add_subdirectory(PACKAGE qray)
"""
ZEPHYR = """cmake_minimum_required(VERSION 3.13)
project(zephyr CXX)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CONFIG_QRAY y)
add_library(app OBJECT PACKAGE/examples/zephyr/src/main.cpp)
function(zephyr_include_directories)
    target_include_directories(app PRIVATE ${ARGN})
endfunction()
function(zephyr_compile_options)
    target_compile_options(app PRIVATE ${ARGN})
endfunction()
add_subdirectory(PACKAGE/zephyr qray)
qray_scene(app PACKAGE/examples/zephyr/src/balls.nff NUMBER q32 SIZE 64x48)
"""
CROSS = """cmake_minimum_required(VERSION 3.13)
project(cross CXX)
add_subdirectory(PACKAGE qray)
qray_object(face "SCENE" SIZE 8x6 FORMAT "Dithered<Mono>")
qray_object(moving "SCENE" SIZE 8x6 MOVING camera)
add_library(picture OBJECT draw.cpp)
target_link_libraries(picture qray::qray)
qray_scene(picture "SCENE" NUMBER q16 SIZE 8x6 SAMPLES 4 NAME scene)
"""


def run(*command, **options):
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
    assert result.returncode == 0, result.stdout.decode()
    return result.stdout


def write(name, text):
    path = f"{FOLDER}/{name}"
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as file:
        file.write(text.replace("PACKAGE", PACKAGE))
    return path


def read(path):
    with open(path, "rb") as file:
        return file.read()


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        run("python3", "src/package/package.py", FOLDER + "/package")
        cls.header = read(PACKAGE + "/src/qray/qray.hpp")
        number = int(re.search(rb"#define QRAY_VERSION (\d+)", cls.header)[1])
        cls.version = f"{number // 10000}.{number // 100 % 100}.{number % 100}"
        cls.picture = run("build/qray", "scenes/balls.nff", "-s", "64x48", "-q", "-o", "-")

    def test_the_header_makes_the_same_code(self):
        self.assertEqual(read(FOLDER + "/package/qray.hpp"), self.header)
        self.assertEqual(set(re.findall(rb'^#include (.*)$', self.header, re.M)),
                         {b"<stdint.h>", b"<stddef.h>", b'"qray needs -std=c++20" // ends the compilation, before '
                          b"hundreds of errors more"})
        run("build/qray", "compile", "scenes/balls.nff", "-s", "8x6", "-o", FOLDER + "/balls.hpp")
        source = write("draw.cpp", DRAW)
        for name, compiler in COMPILERS.items():
            with self.subTest(compiler=name):
                objects = []
                for include in ("include", PACKAGE + "/src"):
                    run(*compiler, *FLAGS, "-I", include, "-c", source, "-o", FOLDER + "/draw.o")
                    objects.append(read(FOLDER + "/draw.o"))
                self.assertEqual(*objects)

    def cmake(self, source, *options):
        build = f"{FOLDER}/build_{os.path.basename(source)}"
        run("cmake", "-S", source, "-B", build, *options)
        return build

    def test_find_package(self):
        build = self.cmake(PACKAGE + "/examples/cmake", f"-DCMAKE_PREFIX_PATH={PACKAGE}")
        run("cmake", "--build", build)
        head, *values = run(build + "/picture").split()
        self.assertEqual((head, values[:3]), (b"P3", [b"64", b"48", b"255"]))
        self.assertEqual(bytes(map(int, values[3:])), self.picture.removeprefix(b"P6\n64 48\n255\n"))

    # Compilers for parts, by add_subdirectory(); a scene whose path has a space in it.
    def test_add_subdirectory(self):
        write("cross/draw.cpp", DRAW)
        scene = write("cross/the scenes/balls.nff", read("scenes/balls.nff").decode())
        write("cross/CMakeLists.txt", CROSS.replace("SCENE", scene))
        expected = run("build/qray", "compile", "scenes/balls.nff", "-n", "q16", "-s", "8x6", "-r", "4", "-o", "-")
        for compiler, *flags in (COMPILERS["rv32"], COMPILERS["microbit"]):
            build = self.cmake(FOLDER + "/cross", "--fresh", "-DCMAKE_SYSTEM_NAME=Generic",
                               "-DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY", f"-DCMAKE_CXX_COMPILER={compiler}",
                               "-DCMAKE_CXX_FLAGS=" + " ".join([*flags, "-ffreestanding"]))
            self.assertIn(b"balls.hpp", run("cmake", "--build", build, "--clean-first"))
            symbols = run("nm", f"{build}/CMakeFiles/face.dir{PACKAGE}/c/qray_c.cpp.obj").decode()
            self.assertEqual(set(re.findall(r" T (\w+)", symbols)), FACE)
            symbols = run("nm", f"{build}/CMakeFiles/moving.dir{PACKAGE}/c/qray_c.cpp.obj").decode()
            self.assertIn("T qray_look_at\n", symbols)
            self.assertEqual(read(build + "/qray/picture/balls.hpp"), expected)
        self.assertNotIn(b"Generating", run("cmake", "--build", build))
        os.utime(scene)
        self.assertIn(b"Generating", run("cmake", "--build", build))

    def make(self, *arguments):
        status, said = programs.make(*arguments)
        self.assertEqual(status, 0, said)

    def test_c(self):
        arguments = ["-o", "build/qray", "object", "SCENE=scenes/balls.nff", "SIZE=64x48", "FORMAT=Rgb565Big"]
        self.make(*arguments)
        write("face.c", C)
        for compiler in (["gcc", "-std=c99"], ["g++", "-std=c++11", "-x", "c++"]):
            run(*compiler, "-pedantic", "-Wall", "-Wextra", "-Werror", "-Ibuild/object/balls", FOLDER + "/face.c", "-x",
                "none", "build/object/balls/qray.o", "-o", FOLDER + "/face")
            self.assertEqual(run(FOLDER + "/face"), self.picture)
        example = "".join(re.findall(r"^```c\n(.*?)^```$", read("src/package/README.md").decode(), re.M | re.S))
        run("gcc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-Ibuild/object/balls", "-fsyntax-only", "-x", "c", "-",
            input=b"#include <stdint.h>\nvoid show(uint32_t, const uint8_t*, uint32_t);\n" + example.encode())
        self.make(*arguments, "BOARD=microbit", "NAME=face_m0")
        symbols = run("arm-none-eabi-nm", "build/object/face_m0/qray.o").decode()
        self.assertEqual(set(re.findall(r" T (\w+)", symbols)), FACE)
        self.assertEqual([name for name in re.findall(r" U (\w+)", symbols)
                          if not re.match("mem(cpy|set)$|__(aeabi|gnu)_", name)], [])
        self.assertEqual(re.findall(r" [bBdD] \w+", symbols), [], "it has no state")
        self.assertNotIn("srgb", symbols)

    # The same bytes as by C++; and what is shifted as in the text with the other numbers.
    def test_moving_in_c(self):
        def scene(name, by):
            places = {k: " ".join(str(v + d) for v, d in zip(at, by)) for k, at in MOVING_PLACES.items()}
            return write(f"{name}.nff", MOVING_SCENE.format(**places))
        path, within, out = scene("moving", (0, 0, 0)), "-7,-7,-7,7,7,9", "build/object/moving"
        program, other = write("moving.c", MOVING), write("moving.cpp", MOVING_CPP)
        for number in ("q32", "float"):
            with self.subTest(number=number):
                arguments = ["-o", "build/qray", "object", f"SCENE={path}", f"NUMBER={number}", "OPTIMISE=-O0",
                             "MOVING=all", f"WITHIN={within}"]
                self.make(*arguments)
                run("gcc", "-std=c11", "-pedantic", "-Wall", "-Wextra", "-Werror", "-I" + out, program,
                    out + "/qray.o", "-o", FOLDER + "/moving")
                frames = run(FOLDER + "/moving")
                run("g++", *FLAGS, "-Iinclude", "-I" + out, other, "-o", FOLDER + "/moving_cpp")
                self.assertEqual(frames, run(FOLDER + "/moving_cpp"))
                size = len(frames) // 5
                self.assertEqual(len({frames[i * size:(i + 1) * size] for i in range(5)}), 5)
                for i, by in enumerate([(0, 0, 0), (0.5, 0.25, -1)]):
                    expected = run("build/qray", scene(f"moving_{i}", by), "-q", "-n", number, "--within", within,
                                   "-o", "-")
                    self.assertEqual(frames[i * size:(i + 1) * size], expected)
        self.make(*arguments, "BOARD=microbit", "NAME=moving_m0")
        symbols = run("arm-none-eabi-nm", "build/object/moving_m0/qray.o").decode()
        header = read("src/package/c/qray_c.h").decode()
        declared = set(re.findall(r"^(?:int|uint32_t|void) (qray_\w+)\(", header, re.M))
        self.assertEqual(set(re.findall(r" T (\w+)", symbols)), declared)
        self.assertGreater(declared, FACE)

    def test_a_scene_of_an_unknown_option(self):
        write("wrong/CMakeLists.txt", CROSS.replace("SAMPLES", "SAMPLE").replace("SCENE", "x.nff"))
        write("wrong/draw.cpp", "")
        with self.assertRaisesRegex(AssertionError, "unknown: SAMPLE;4"):
            self.cmake(FOLDER + "/wrong")

    # With stand-ins for what ESP-IDF and Zephyr bring, the standard among it.
    def test_components(self):
        for name, text in (("idf", IDF), ("zephyr", ZEPHYR)):
            with self.subTest(name=name):
                write(name + "/CMakeLists.txt", text)
                build = self.cmake(FOLDER + "/" + name, "-DCMAKE_CXX_STANDARD=20")
                command, = [entry["command"] for entry in json.loads(read(build + "/compile_commands.json"))]
                self.assertIn(f"{PACKAGE}/", command)
                self.assertIn("-ffp-contract=off", command)
                run("cmake", "--build", build)

    def test_arduino(self):
        told = dict(line.split("=", 1) for line in read(PACKAGE + "/library.properties").decode().splitlines())
        self.assertEqual(set(told), {"name", "version", "author", "maintainer", "sentence", "paragraph", "category",
                                     "url", "architectures", "includes"})
        self.assertEqual((told["name"], told["version"]), ("qray", self.version))
        self.assertTrue(os.path.exists(f"{PACKAGE}/src/{told['includes']}"))
        said = {}
        for sketch in ("Picture", "Text"):
            write("Arduino.h", ARDUINO)
            run("g++", "-std=gnu++20", "-Os", "-Wall", "-Wextra", "-Werror", "-include", FOLDER + "/Arduino.h", "-I",
                PACKAGE + "/src", "-x", "c++", f"{PACKAGE}/examples/{sketch}/{sketch}.ino", "-o", f"{FOLDER}/{sketch}")
            said[sketch] = run(f"{FOLDER}/{sketch}")
        self.assertEqual(said["Picture"], self.picture)
        lines = said["Text"].decode().splitlines()
        self.assertEqual([len(line) for line in lines], [64] * 24)
        rgb = self.picture.removeprefix(b"P6\n64 48\n255\n")
        for y, line in enumerate(lines):
            for x, shown in enumerate(line):
                r, g, b = rgb[3 * (128 * y + x):][:3]
                level = 9 * ((299 * r + 587 * g + 114 * b + 500) // 1000) / 255
                self.assertLess(abs(" .:-=+*#%@".index(shown) - level), 1, (x, y))

    def test_platformio(self):
        told = json.loads(read(PACKAGE + "/library.json"))
        self.assertEqual((told["name"], told["version"]), ("qray", self.version))
        self.assertTrue(os.path.exists(f"{PACKAGE}/{told['build']['srcDir']}/{told['headers']}"))
        for example in told["examples"]:
            for file in example["files"]:
                self.assertTrue(os.path.exists(f"{PACKAGE}/{example['base']}/{file}"), file)

        class Environment:
            def __init__(self):
                self.flags = ["-std=gnu++11"]

            def Append(self, CXXFLAGS):
                self.flags += CXXFLAGS
        environments = {"env": Environment(), "projenv": Environment(), "Import": lambda *names: None}
        exec(read(f"{PACKAGE}/{told['build']['extraScript']}"), environments)
        for name in ("env", "projenv"):
            self.assertEqual([f for f in environments[name].flags if "-std" in f][-1], "-std=gnu++20")

    def test_versions(self):
        self.assertEqual(run(PACKAGE + "/bin/qray", "--version").decode(), f"qray {self.version}\n")
        self.assertIn(f'version: "{self.version}"\n', read(PACKAGE + "/idf_component.yml").decode())
        for path, _, files in os.walk(PACKAGE):
            for file in files:
                self.assertNotIn(b"@VERSION@", read(os.path.join(path, file)), file)


if __name__ == "__main__":
    unittest.main()
