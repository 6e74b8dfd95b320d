"""make calibrate: what each of src/cli/counts.hpp's operations costs on each board in each number system,
from traces of small pictures. Writes src/study/calibration.hpp, from which `qray plan` predicts.

The trace says how many instructions each step of the tracer took (cycles.py), and the desktop how often each
operation was asked for; the costs of a step's operations are those not below 0 that leave the least squares
of differences, each as a share of its whole picture, over all scenes: mixtures.py's and some of scenes/. No
scene that predictions are tried on may be among these."""

import os
import re
import sys

sys.dont_write_bytecode = True
import cycles  # noqa: E402
import mixtures  # noqa: E402
import runs  # noqa: E402
from settings import STUDIED as BOARDS  # noqa: E402

OUTPUT = "src/study/calibration.hpp"
OPERATIONS = "build/study/operations"
# The slower the arithmetic, the smaller the picture that is traced.
SIZES = {"float": "8x6", "double": "6x4"}
SIZE = "12x9"
# Beside mixtures.py's.
SCENES = ["floor", "showcase", "glass", "castle", "patches", "materials", "polygons", "lights"]
# Double is float's library with longer numbers: what it costs is what soft float does, times a factor for
# each step that these scenes tell.
DOUBLE = "double"
DOUBLE_SCENES = ["floor", "showcase", "market", "attic"]
SOFT = {"mps2_an386": "mps2_an385"}
# A program with several samples is compiled into other code: its instructions by those that are predicted,
# and the bytes that it takes more, from these.
SAMPLED = {"grid": ["floor", "showcase", "market", "gravel", "shards"],
           "adaptive": ["floor", "market", "shards"]}
SAMPLINGS = {"grid": ("4", {"SAMPLES": 4}), "adaptive": ("a2,0.0625", {"ADAPTIVE": "2,0.0625"})}

FEW_BALLS = 8  # that compilers are asked to unroll a loop over: QRAY_UNROLL
LISTED = ["single", "several", "many"]


def of(kind, *what):
    return [f"{kind}_{w}" for w in what]


# The operations that a step's instructions are shared out to. What a step of shapes takes for each test
# differs with the length of their list, as compilers unroll short ones; so does finding the nearest.
STEPS = {
    "camera": ["sample", "pixel"], "output": ["sample", "pixel"],
    "spheres": of("sphere", "test", *LISTED, "ahead", "line", "met", "seen"),
    "discs": of("disc", "test", *LISTED, "ahead", "met", "seen"),
    "cones": of("cone", "test", *LISTED, "ahead", "line", "near", "met", "inward", "seen"),
    "polygons": of("polygon", "test", *LISTED, "ahead", "line", "near", "met", "corner", "edge", "inside",
                   "found", "seen"),
    "patches": of("patch", "test", *LISTED, "ahead", "line", "near", "met", "found", "seen"),
    "nearest hit": ["ray", "shadow_ray", "veiled_ray", "test", "nearest_test", "veiled_test", "found"]
    + [f"{kind}_{w}" for kind in ("sphere", "disc", "cone", "polygon", "patch") for w in LISTED]
    + [f"{kind}_opaque" for kind in ("cone", "polygon", "patch")],
    "shading": ["ray", "shadow_ray", "hit", "lamp", "lamp_several", "sun_lamp", "lit", "shine",
                "shine_square", "shine_fraction", "mirrored", "refracted", "glass"],
    **{texture: [texture] for texture in cycles.TEXTURES},
}


def least_squares(rows, wanted, ridge=1e-4):
    """x >= 0 that makes |rows x - wanted|^2 least, by coordinate descent; a little ridge shares out what the
    rows cannot tell apart. Columns are scaled to their largest."""
    columns = range(len(rows[0]))
    scale = [max(r[k] for r in rows) or 1 for k in columns]
    a = [[r[k] / scale[k] for k in columns] for r in rows]
    square = [[sum(r[j] * r[k] for r in a) + ridge * (j == k) for j in columns] for k in columns]
    left = [sum(r[k] * v for r, v in zip(a, wanted)) for k in columns] # of the normal equations
    x = [0.0 for k in columns]
    for _ in range(3000):
        most = 0
        for k in columns:
            step = max(left[k] / square[k][k], -x[k])
            if step:
                x[k] += step
                most = max(most, abs(step))
                left = [v - step * s for v, s in zip(left, square[k])]
        if most < 1e-9:
            break
    return [v / s for v, s in zip(x, scale)]


def size_of(board, number):
    return SIZE if number == "float" and board == "mps2_an386" else SIZES.get(number, SIZE)


def operations(number, scene, size, samples="1"):
    text = runs.output_of(OPERATIONS, number, scene, size, samples)
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


def rows_of(measured, counted, parts):
    return [[counted[scene][p] / m["instructions"] for p in parts] for scene, m in measured.items()]


def shares_of(measured, step):
    return [m["steps"].get(step, 0) / m["instructions"] for m in measured.values()]


def fit(measured, counted):
    """{step: {operation: (instructions, and how many more for each effect)}} of one board and number system:
    in a scene that calls for more effects compilers have fewer registers for each."""
    out = {}
    effects = [effects_in(counted[scene]) for scene in measured]
    for step, parts in STEPS.items():
        rows, shares = rows_of(measured, counted, parts), shares_of(measured, step)
        values = least_squares(rows, shares)
        plain, more = 1, 0
        if step not in cycles.TEXTURES: # which few scenes call for
            sums = [sum(v * x for v, x in zip(values, row)) for row in rows]
            plain, more = least_squares([[s, e * s] for s, e in zip(sums, effects)], shares)
        out[step] = {part: (plain * v, more * v) for part, v in zip(parts, values)}
    return out


def scaled(cost, measured, counted):
    """As fit(), where the operations of a step are known but for a factor."""
    factors = {}
    for step, known in cost.items():
        rows = [[sum((known[p][0] + known[p][1] * effects_in(counted[scene])) * share
                     for p, share in zip(known, row))]
                for scene, row in zip(measured, rows_of(measured, counted, known))]
        # Of a step that none of these takes, as of all that they take.
        factors[step] = least_squares(rows, shares_of(measured, step))[0] if any(r[0] for r in rows) else None
    found = [f for f in factors.values() if f]
    common = sum(found) / len(found)
    return {step: {p: tuple(v * (factors[step] or common) for v in values) for p, values in known.items()}
            for step, known in cost.items()}


def effects_in(counts):
    """How many, but for those of sampling, which have factors of their own."""
    return sum(counts[e] for e in effects_of(counts) if e not in ("effect_grid", "effect_adaptive"))


def effects_of(counts):
    return [k for k in counts if k.startswith("effect_") and k not in ("effect_tree", "effect_eye_surface")]


class Costs:
    """Of one board and number system, as fit() finds them: of each operation in all steps."""

    def __init__(self, steps):
        self.of, self.more = {}, {}
        for parts in steps.values():
            for part, (value, more) in parts.items():
                self.of[part] = self.of.get(part, 0) + value
                self.more[part] = self.more.get(part, 0) + more

    def predict(self, counts):
        effects = effects_in(counts)
        return sum((v + self.more[k] * effects) * counts[k] for k, v in self.of.items())


def fit_bytes(measured, counted, what, number):
    """Bytes of flash or of stack: of every program, of each effect, and of flash, of a kind of shapes beyond
    the first and of a ball where they are few, for which compilers may write code of its own. The tables
    that a scene is in come to that."""
    rows, wanted = [], []
    for scene, m in measured.items():
        c = counted[scene]
        row, tables = [1.0] + [c[e] for e in effects_of(c)], 0
        if what == "flash":
            tables = c[f"tables_{number}"]
            row += [c["kinds"] - 1, c["balls"] if c["balls"] <= FEW_BALLS else 0]
        rows.append([v / m[what] for v in row])
        wanted.append((m[what] - tables) / m[what])
    return least_squares(rows, wanted)


def median(values, otherwise):
    return sorted(values)[len(values) // 2] if values else otherwise


class Calibration:
    """All runs, and what they tell."""

    def __init__(self):
        self.scenes = {name: f"scenes/{name}.nff" for name in SCENES}
        self.scenes.update(mixtures.write("build/study/mixtures"))
        self.counts, self.traced, self.sampled, self.costs = {}, {}, {}, {}
        for number in runs.numbers():
            for board in BOARDS:
                size = size_of(board, number)
                for name in DOUBLE_SCENES if number == DOUBLE else self.scenes:
                    self.traced[board, number, name] = runs.Run(board, self.scenes[name], number, size,
                                                                profile=True)
                for kind, (_, options) in SAMPLINGS.items() if number != DOUBLE else ():
                    for name in SAMPLED[kind]:
                        self.sampled[board, number, name, kind] = runs.Run(board, self.scenes[name], number,
                                                                           size, **options)

    def perform(self):
        runs.perform(list(self.traced.values()) + list(self.sampled.values()))

    def counted(self, number, name, size, samples="1"):
        key = number, name, size, samples
        if key not in self.counts:
            self.counts[key] = operations(number, self.scenes[name], size, samples)
        return self.counts[key]

    def measured(self, board, number):
        """{scene: what was measured}, {scene: what was counted}"""
        found = {n: run.result for (b, s, n), run in self.traced.items()
                 if (b, s) == (board, number) and "refused" not in run.result}
        return found, {n: self.counted(number, n, size_of(board, number)) for n in found}

    def fit(self, board, number):
        measured, counted = self.measured(board, number)
        if number == DOUBLE:
            soft = self.measured(SOFT.get(board, board), "float")
            steps = scaled(fit(*soft), measured, counted)
        else:
            steps = fit(measured, counted)
        self.costs[board, number] = Costs(steps)

    def several(self, board, number, kind):
        """Instructions by those predicted, flash and stack beyond those of one sample."""
        ratio, flash, stack = [], [], []
        for name in SAMPLED[kind]:
            run = self.sampled.get((board, number, name, kind))
            if run is None or "refused" in run.result:
                continue
            one = self.traced[board, number, name].result
            counts = self.counted(number, name, run.size, SAMPLINGS[kind][0])
            ratio.append(run.result["instructions"] / self.costs[board, number].predict(counts))
            flash.append(max(run.result["flash"] - one["flash"], 0))
            stack.append(max(run.result["stack_bound"] - one["stack_bound"], 0))
        return sum(ratio) / len(ratio) if ratio else 1, median(flash, 600), median(stack, 60)

    def entry(self, board, number):
        """Of calibration.hpp."""
        measured, counted = self.measured(board, number)
        costs = self.costs[board, number]
        several = {kind: self.several(board, number, kind) for kind in SAMPLINGS}
        names_of = effects_of(next(iter(counted.values())))
        flash = fit_bytes(measured, counted, "flash", number)
        stack = fit_bytes(measured, counted, "stack_bound", number)
        for kind, (_, flash_more, stack_more) in several.items():
            at = 1 + names_of.index("effect_" + kind)
            flash[at], stack[at] = flash_more, stack_more
        cycles_each = (sum(m["cycles"] for m in measured.values())
                       / sum(m["instructions"] for m in measured.values()))
        size, ram = memory(board)
        effects = ", ".join(f"{v:.0f}" for v in flash[:-2])
        stacks = ", ".join(f"{v:.0f}" for v in stack)
        each = ", ".join(f"{costs.of.get(name, 0):.1f}" for name in names())
        more = ", ".join(f"{costs.more.get(name, 0):.2f}" for name in names())
        return (f'    {{"{board}", "{number}", {size}, {ram}, {cycles_each:.3f}, '
                f'{several["grid"][0]:.3f}, {several["adaptive"][0]:.3f},'
                f"\n     {{{each}}},\n     {{{more}}},\n"
                f"     {{{effects}}}, {flash[-2]:.0f}, {flash[-1]:.0f},\n     {{{stacks}}}}},\n")

    def text(self):
        for board in BOARDS:
            for number in runs.numbers():
                self.fit(board, number)
        entries = [self.entry(board, number) for board in BOARDS for number in runs.numbers()]
        order = [e.removeprefix("effect_") for e in effects_of(next(iter(self.counts.values())))]
        quoted = ", ".join(f'"{e}"' for e in order)
        return f"""// Made by `make calibrate`; not to be edited. Costs of each board and number system:
// of every operation of src/cli/counts.hpp in instructions, of every effect in bytes of flash and of stack.
#pragma once

namespace qray::study {{

struct Calibration {{
    const char* board;
    const char* number;
    unsigned flash, ram;   // bytes that the board has
    double cycles;         // an instruction, modelled
    double grid, adaptive; // instructions with several samples, by what the operations cost with one
    double cost[{len(names())}];
    double more[{len(names())}]; // for each effect that the scene calls for, but those of sampling
    double flash_bytes[{len(order) + 1}]; // of every program, then of each effect
    double kind_bytes, ball_bytes; // of a kind of shapes beyond the first; of a ball, up to few_balls
    double stack_bytes[{len(order) + 1}];
}};

inline constexpr unsigned few_balls = {FEW_BALLS};
inline constexpr const char* effect_order[] = {{{quoted}}};

inline constexpr Calibration calibrations[] = {{
{"".join(entries)}}};

}} // namespace qray::study
"""

    def shares_off(self):
        """What the costs tell of the pictures that they were made from: (off, board, number, scene)."""
        out = []
        for (board, number), costs in self.costs.items():
            measured, counted = self.measured(board, number)
            out += [(abs(costs.predict(counted[n]) / m["instructions"] - 1), board, number, n)
                    for n, m in measured.items()]
        return sorted(out)


def main():
    calibration = Calibration()
    calibration.perform()
    text = "\n".join(wrap(line) for line in calibration.text().split("\n"))
    with open(OUTPUT + ".part", "w") as file:
        file.write(text)
    os.replace(OUTPUT + ".part", OUTPUT)
    off = calibration.shares_off()
    print(f"{OUTPUT}: {len(calibration.costs)} boards and number systems; of the pictures that it was made "
          f"from it tells the instructions within {100 * off[len(off) // 2][0]:.0f} % (median), "
          f"{100 * off[-1][0]:.0f} % at worst ({' '.join(off[-1][1:])})")


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
