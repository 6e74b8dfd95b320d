"""make calibrate: what each of src/cli/counts.hpp's operations costs on each board in each number system,
from traces of small pictures. Writes src/study/calibration.hpp, from which `qray plan` predicts.

The trace says how many instructions each step of the tracer took (cycles.py), and the desktop how often each
operation was asked for; the costs of a step's operations are those not below 0 that leave the least squares
of differences, each as a share of its whole picture, over all scenes."""

import glob
import os
import re
import subprocess
import sys

sys.dont_write_bytecode = True
import cycles  # noqa: E402
import ladder  # noqa: E402
import runs  # noqa: E402

OUTPUT = "src/study/calibration.hpp"
OPERATIONS = "build/study/operations"
BOARDS = ["microbit", "mps2_an385", "mps2_an386", "rv32_virt"]
# The slower the arithmetic, the smaller the picture that is traced.
SIZES = {"float": "8x6", "double": "6x4"}
SIZE = "12x9"
# A number system whose arithmetic is all the compiler's library is the same everywhere: fewer scenes do.
SCENES = ["floor", "showcase", "glass", "castle", "patches", "materials", "polygons", "phong",
          "textures", "lights"]
FEW = SCENES[:5]
# A program with several samples is compiled into other code: its instructions by those that are predicted,
# from these.
SAMPLED = ["floor", "showcase", "castle"]
SAMPLINGS = {"grid": ("4", {"SAMPLES": 4}), "adaptive": ("a2,0.0625", {"ADAPTIVE": "2,0.0625"})}

# The operations that a step's instructions are shared out to.
STEPS = {
    "camera": ["sample", "pixel"], "output": ["sample", "pixel"],
    "spheres": ["sphere_test", "sphere_ahead", "sphere_met", "sphere_seen"],
    "discs": ["disc_test", "disc_ahead", "disc_seen"],
    "cones": ["cone_test", "cone_near", "cone_met", "cone_seen"],
    "polygons": ["polygon_test", "polygon_ahead", "polygon_corner", "polygon_seen"],
    "patches": ["patch_test", "patch_ahead", "patch_met", "patch_seen"],
    "nearest hit": ["ray", "shadow_ray", "test"],
    "shading": ["ray", "shadow_ray", "hit", "lit", "shine", "shine_square", "shine_fraction", "mirrored",
                "refracted"],
    **{texture: [texture] for texture in cycles.TEXTURES},
}


def least_squares(rows, wanted, ridge=1e-5):
    """x >= 0 that makes |rows x - wanted|^2 least, by coordinate descent; a little ridge shares out what the
    rows cannot tell apart. Columns are scaled to their largest."""
    columns = len(rows[0])
    scale = [max((r[k] for r in rows), default=0) or 1 for k in range(columns)]
    a = [[r[k] / scale[k] for k in range(columns)] for r in rows]
    x = [0.0] * columns
    left = list(wanted)
    for _ in range(3000):
        for k in range(columns):
            square = sum(r[k] * r[k] for r in a) + ridge
            step = (sum(r[k] * v for r, v in zip(a, left)) - ridge * x[k]) / square
            step = max(step, -x[k])
            if step:
                x[k] += step
                left = [v - step * r[k] for r, v in zip(a, left)]
    return [v / s for v, s in zip(x, scale)]


def size_of(board, number):
    return SIZE if number == "float" and board == "mps2_an386" else SIZES.get(number, SIZE)


def operations(scene, size, samples="1"):
    text = runs.output_of(OPERATIONS, scene, size, samples)
    return {k: float(v) for k, v in re.findall(r"^(\w+): ([\d.]+)$", text, re.M)}


def names():
    """The operations in their order."""
    with open("src/cli/counts.hpp") as file:
        return re.findall(r'"(\w+)"', re.search(r"operation_names\[\] = \{(.*?)\};", file.read(), re.S)[1])


def memory(board):
    """Bytes of flash and of RAM, from the linker script."""
    with open(f"src/boards/{board}/board.ld") as file:
        found = dict(re.findall(r"^ *(flash|ram) .*LENGTH *= *(\d+[KM]?)", file.read(), re.M))
    unit = {"K": 1024, "M": 1024 * 1024}
    return [int(found[k].rstrip("KM")) * unit.get(found[k][-1], 1) for k in ("flash", "ram")]


def fit(measured, counted):
    """{operation: instructions} of one board and number system."""
    cost = {}
    for step, parts in STEPS.items():
        rows, wanted = [], []
        for scene, m in measured.items():
            rows.append([counted[scene][p] / m["instructions"] for p in parts])
            wanted.append(m["steps"].get(step, 0) / m["instructions"])
        for part, value in zip(parts, least_squares(rows, wanted)):
            cost[part] = cost.get(part, 0) + value
    return cost


def predict(cost, counts):
    return sum(cost.get(k, 0) * counts[k] for k in counts if not k.startswith("effect_"))


def fit_effects(measured, counted, what, other):
    """Bytes of flash or of stack: a constant, and what each of these effects adds; `other` is what one that no
    scene here calls for (sampling) is taken to add."""
    effects = [k for k in next(iter(counted.values())) if k.startswith("effect_") and k != "effect_tree"]
    rows = [[1.0] + [counted[s][e] for e in effects] for s in measured]
    bytes_of = [1000 * v for v in least_squares(rows, [m[what] / 1000 for m in measured.values()], 1e-3)]
    return [other if not any(r[k] for r in rows) else v for k, v in enumerate(bytes_of)], effects


def main():
    scenes = [f"scenes/{name}.nff" for name in SCENES]
    steps = ladder.write("build/study/ladder")
    scenes += [path for name, path, _ in steps if name in ("shadow", "glass")]
    counted_at = {(scene, size): operations(scene, size)
                  for scene in scenes for size in {SIZE, *SIZES.values()}}
    plan = {}
    for number in runs.numbers():
        for board in BOARDS:
            for scene in scenes:
                if number != "double" or os.path.basename(scene).removesuffix(".nff") in FEW:
                    plan[board, number, scene] = runs.Run(board, scene, number,
                                                                   size_of(board, number), profile=True)
    sampled = {(board, number, name, kind): runs.Run(board, f"scenes/{name}.nff", number,
                                                     size_of(board, number), **o)
               for number in runs.numbers() if number != "double" for board in BOARDS for name in SAMPLED
               for kind, (_, o) in SAMPLINGS.items()}
    runs.perform(list(plan.values()) + list(sampled.values()))
    lines, shares = [], []
    for board in BOARDS:
        for number in runs.numbers():
            measured = {s: plan[board, number, s].result for s in scenes
                        if (board, number, s) in plan and "refused" not in plan[board, number, s].result}
            if not measured:
                continue
            counted = {s: counted_at[s, size_of(board, number)] for s in scenes}
            cost = fit(measured, counted)
            for scene, m in measured.items():
                off = predict(cost, counted[scene]) / m["instructions"] - 1
                shares.append((abs(off), board, number, scene))
            flash, effects = fit_effects(measured, counted, "flash", 600)
            stack, _ = fit_effects(measured, counted, "stack_bound", 60)
            per = (sum(m["cycles"] for m in measured.values())
                   / sum(m["instructions"] for m in measured.values()))
            size, ram = memory(board)
            several = []
            for kind, (samples, _) in SAMPLINGS.items():
                known = []
                for name in SAMPLED:
                    run = sampled.get((board, number, name, kind))
                    if run is not None and "refused" not in run.result:
                        counts = operations(run.scene, run.size, samples)
                        known.append(run.result["instructions"] / predict(cost, counts))
                several.append(sorted(known)[len(known) // 2] if known else 1)
            costs = ", ".join(f"{cost.get(name, 0):.1f}" for name in names())
            flashes, stacks = (", ".join(f"{v:.0f}" for v in effect) for effect in (flash, stack))
            lines.append(f'    {{"{board}", "{number}", {size}, {ram}, {per:.3f}, '
                         f'{several[0]:.3f}, {several[1]:.3f},\n     {{{costs}}},\n'
                         f"     {{{flashes}}},\n     {{{stacks}}}}},\n")
    shares.sort()
    order = ", ".join(f'"{e.removeprefix("effect_")}"' for e in effects)
    text = f"""// Made by `make calibrate`; not to be edited. Costs of each board and number system: of every
// operation of src/cli/counts.hpp in instructions, and of every effect in bytes of flash.
#pragma once

namespace qray::study {{

struct Calibration {{
    const char* board;
    const char* number;
    unsigned flash, ram;  // bytes that the board has
    double cycles;        // an instruction, modelled
    double grid, adaptive; // instructions with several samples, by what the operations cost with one
    double cost[{len(names())}];
    double flash_bytes[{len(effects) + 1}], stack_bytes[{len(effects) + 1}]; // of every program, then of each effect
}};

inline constexpr const char* effect_order[] = {{{order}}};

inline constexpr Calibration calibrations[] = {{
{"".join(lines)}}};

}} // namespace qray::study
"""
    text = "\n".join(wrap(line) for line in text.split("\n"))
    with open(OUTPUT + ".part", "w") as file:
        file.write(text)
    os.replace(OUTPUT + ".part", OUTPUT)
    print(f"{OUTPUT}: {len(lines)} boards and number systems; of the pictures that it was made from it "
          f"tells the instructions within {100 * shares[len(shares) // 2][0]:.0f} % (median), "
          f"{100 * shares[-1][0]:.0f} % at worst ({' '.join(shares[-1][1:])})")


def wrap(line):
    out = []
    while len(line) > 108:
        at = line.rindex(" ", 0, 108)
        out.append(line[:at])
        line = "      " + line[at + 1:]
    return "\n".join(out + [line])


if __name__ == "__main__":
    main()
    sys.exit(runs.failures != [])
