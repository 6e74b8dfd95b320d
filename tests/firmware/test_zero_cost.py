"""What a scene does not call for costs nothing: with the header of that effect reduced to bare declarations,
the firmware is the same, byte for byte. From the top of the repository:
python3 tests/firmware/test_zero_cost.py"""

import concurrent.futures
import glob
import itertools
import os
import re
import shutil
import sys
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = ["src/boards/common", "src/study", "tests/firmware"]
import elf  # noqa: E402
import reduce  # noqa: E402
from programs import make  # noqa: E402
from settings import told  # noqa: E402

TOLD = told()
SHAPE, TEXTURE = TOLD["shapes"], TOLD["textures"]  # {name: (text, a place on it)}, {name: what stands behind its name}
VIEW = "v from %s at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 8 6\n"
LIGHT = {"light": "l 3 4 5\n", "sun": "sun 1 2 3\n", "panel": "panel 2  3 4 5  0.5 0 0  0 0.2 0.5\n"}
MATERIAL = {
    "highlight": "highlight 0.5 shine 3.5", "mirror": "mirror 0.3", "transmit": "transmit 0.4 ior 1.5",
}
# All but what has no header of its own, and but those that the text does not say.
UNSAID = {"tree", "flat_tree", "triangle", "smooth_triangle"}
EFFECTS = [effect for effect in TOLD["effects"] if effect not in UNSAID | {"fractional_shine"}]
# What a scene lacks beside an effect: light comes through surfaces that transmit; samples are taken in one way; the
# places of a panel are lights.
WITHOUT = {effect: {"adaptive"} for effect in [*EFFECTS, *UNSAID]} | {"grid": set(), "adaptive": set()}
WITHOUT["light"] |= {"light_surface", "panel"}
WITHOUT["shadow"] |= {"see_through", "light_surface"}
WITHOUT["see_through"] |= {"transmit"}
WITHOUT["transmit"] |= {"see_through"}
# What is absent together: a texture, which knows nothing of other rooms, beside something else; and what no text says.
GROUPS = [*itertools.zip_longest([e for e in EFFECTS if e not in TEXTURE], TEXTURE), sorted(UNSAID)]
FOLDER = "build/zero_cost"
HEADERS = f"{FOLDER}/include"  # one state of them for all


def scene(absent):
    """A scene that calls for all effects but these, and but what cannot be without them."""
    shapes, places = zip(*(told for name, told in SHAPE.items() if name not in absent))
    lights = [text for name, text in LIGHT.items() if name not in absent]
    lights += [] if "light_surface" in absent else [f"l {places[0]}\n"]
    parts = [text for name, text in MATERIAL.items() if name not in absent]
    eye = "0 0 5" if "eye_surface" in absent else places[0]
    text = VIEW % eye + "".join(lights) + ("shadows off\n" if "shadow" in absent else "")
    text += "" if "light_map" in absent else "radiosity 1\n"
    text += "material colour 0.5 0.6 0.7 diffuse 0.5 " + " ".join(parts) + "\n" + "\n".join(shapes) + "\n"
    for name, numbers in TEXTURE.items():
        if name not in absent:
            text += f"material colour 0 0 1 texture {name} {numbers}\n{shapes[0]}\n"
    return text


def compile_scene(name, absent, include, level="-Og"):
    """Of the tracer's object file what ends in memory, by section, and the names in it; or make's output. -Og takes
    half of -Os' time, and drops less: where its code is the same, the compiler was told the same functions."""
    with open(f"{FOLDER}/{name}.part", "wb") as file:
        file.write(b"P6 2 2 255\n" + bytes(range(12)))
    os.replace(f"{FOLDER}/{name}.part", f"{FOLDER}/image.ppm")  # others may be reading it
    with open(f"{FOLDER}/{name}.nff", "w") as file:
        file.write(scene(absent))
    path = f"build/microbit/zero_{name}-q32.obj/main.o"
    if os.path.exists(path):
        os.remove(path)
    sampling = ["SAMPLES=4"] if "grid" not in absent else ["ADAPTIVE=2"] if "adaptive" not in absent else []
    status, said = make("-o", "build/qray", path, "BOARD=microbit", f"NAME=zero_{name}", f"SCENE={FOLDER}/{name}.nff",
                        f"FW_INCLUDE={include}", f"FW_EXTRA=-g0 {level}", *sampling)
    if status != 0:
        return said
    found = elf.Elf(path)
    loaded = [(s.name, found.contents(s)) for s in found.sections
              if ("A" in s.flags and s.type != "NOBITS") or s.name.startswith(".rel.")]
    return [part for part in loaded if "debug" not in part[0]], [symbol.name for symbol in found.symbols]


def effects_of(name):
    with open(f"build/microbit/zero_{name}-q32.hpp") as file:
        return set(re.findall(r"^    \.(\w+) = true", file.read(), re.M))


def reduced(effects, name):
    """A copy of the headers in which those of these effects are reduced."""
    folder = f"{FOLDER}/{name}"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(HEADERS, folder)
    for effect in effects:
        path, = glob.glob(f"{folder}/qray/*/{effect}.hpp")
        with open(path) as file:
            text = file.read()
        with open(path, "w") as file:
            file.write(reduce.reduce(text))
    return folder


class ZeroCost(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)
        shutil.copytree("include", HEADERS)

    def compiled(self, *arguments):
        result = compile_scene(*arguments)
        self.assertNotIsInstance(result, str, result)
        return result

    # Everything but a group, and what cannot be without it.
    def test_each_effect(self):
        def check(group):
            absent = set(group).union(*(WITHOUT[effect] for effect in group))
            whole = self.compiled(group[0], absent, HEADERS)
            self.assertEqual(effects_of(group[0]) - {"fractional_shine"}, set(EFFECTS) - absent)
            self.assertEqual(self.compiled(group[0], absent, reduced(group, group[0])), whole)

        groups = [[effect for effect in group if effect] for group in GROUPS]
        self.assertEqual(sorted(sum(groups, [])), sorted(WITHOUT))
        with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
            for group, done in [(group, pool.submit(check, group)) for group in groups]:
                with self.subTest(group=group):
                    done.result()

    # One ball of one colour, ray cast: none of the others.
    def test_all_effects_at_once(self):
        absent = set(EFFECTS) - {"sphere", "light"}
        whole = self.compiled("least", absent, HEADERS, "-Os")
        self.assertEqual(effects_of("least"), {"sphere", "light"})
        self.assertEqual(self.compiled("least", absent, reduced([*absent, *UNSAID], "least_reduced"), "-Os"), whole)

    # What a scene does call for cannot be reduced.
    def test_it_can_fail(self):
        absent = set(EFFECTS) - {"sphere", "light"}
        for effect in ("sphere", "light"):
            self.assertIsInstance(compile_scene("fail", absent, reduced([effect], "fail")), str)


if __name__ == "__main__":
    unittest.main()
