"""Where the instructions of a ray go, step by step, and the fewest that its arithmetic would take: what each
operation of a tracer of balls on a plane has to compute (operations.cpp counts them), in q32, by the
formulas that include/qray uses, priced by what a core's instructions can do. Not counted: moving values between
registers and memory beyond a scene's own numbers, calls, steps off surfaces, block scales, restored lengths. So it
is a bound below, which no compiler reaches.

    floor.py [SCENE [WxH]]    prints README's table, for any scene of balls, planes and checkers"""

import collections
import os
import subprocess
import sys
import textwrap

sys.dont_write_bytecode = True
import runs  # noqa: E402
from text import count, listed, table  # noqa: E402

SCENE, SIZE = "scenes/floor.nff", "64x48"
BOARDS = ["microbit", "mps2_an385", "rv32_virt"]
STEPS = ["camera", "nearest hit", "spheres", "discs", "shading", "textures", "output"]

# Instructions of the parts that operations consist of. `wide` and `square` are 32 x 32 -> 64 bits, `sum` adds
# such a product to another, `high` is the upper half alone, `round` takes 64 bits to 32; `word` is one of
# several that are loaded or stored together. On the M0 the products are those of include/qray/number/wide.hpp, the
# shortest known.
PARTS = {
    "microbit": {"wide": 18, "square": 11, "sum": 2, "high": 17, "round": 3, "clz": 18, "word": 1 / 3},
    "mps2_an385": {"wide": 1, "square": 1, "sum": 0, "high": 1, "round": 2, "clz": 1, "word": 1 / 3},
    "rv32_virt": {"wide": 2, "square": 2, "sum": 4, "high": 1, "round": 5, "clz": 18, "word": 1},
}
SIMPLE = 1  # a 32-bit product, sum, shift, comparison or branch


def parts(**counts):
    return collections.Counter(counts)


def times(number, of):
    return collections.Counter({k: number * v for k, v in of.items()})


DOT = parts(wide=3, sum=2, round=1)
NORM2 = parts(square=3, sum=2)
SCALE = parts(wide=3, round=3)                 # a vector by a number
SEED = parts(simple=9, word=2)                 # of 1/sqrt, by a table
RSQRT = parts(clz=1, simple=20) + SEED         # to a whole register: one step of second order
ROOT = RSQRT + parts(high=1, simple=8)         # and which way the root is off
QUOTIENT = parts(clz=1, high=1, wide=1, simple=24) + SEED
UNIT = NORM2 + RSQRT + SCALE + parts(clz=1, simple=6)


def operations(narrow):
    """{operation: (step, parts)}; `narrow` where a wide product is dear, and the reject does without."""
    behind = parts(simple=6 + 5 + 3) if narrow else parts(simple=3 + 3) + parts(high=3)
    aside = parts(simple=6 + 6 + 5 + 3) if narrow else parts(simple=4) + parts(high=4)
    plane = parts(simple=3 + 6 + 6 + 4 + 3) if narrow else parts(simple=3 + 3) + parts(high=6)
    return {
        "ray": ("nearest hit", parts(simple=(9 if narrow else 0) + 4)),
        "shadow": ("nearest hit", parts(simple=(9 if narrow else 0) + 2)),
        "test": ("nearest hit", parts(simple=2 if narrow else 0)),  # a loop over shapes, or none
        "sphere_test": ("spheres", behind + parts(word=4)),
        "sphere_ahead": ("spheres", aside),
        # v, v.d, p, |p|^2, the root, and t.
        "sphere_met": ("spheres", parts(simple=3 + 8, word=6) + DOT + SCALE + NORM2 + ROOT),
        "sphere_seen": ("spheres", parts(simple=9, word=6) + SCALE + SCALE),
        "disc_test": ("discs", plane + parts(word=6)),
        "disc_met": ("discs", parts(simple=6 + 4) + DOT + DOT + QUOTIENT + SCALE + NORM2),
        "disc_seen": ("discs", parts(simple=3, word=3)),
        # n.d, and the sum by the colour; towards the light, its distance, n.l.
        "hit": ("shading", parts(simple=6, word=6) + DOT + SCALE),
        "lamp": ("shading", parts(simple=3, word=3) + UNIT + DOT + DOT),
        "lit": ("shading", parts(simple=9, wide=1, round=1) + SCALE),
        "shine": ("shading", parts(simple=6, wide=2, round=2) + DOT + SCALE),
        "shine_square": ("shading", parts(high=1, simple=3)),
        "mirrored": ("shading", parts(simple=12 + 3, wide=1, round=1) + SCALE),
        "light weighed": ("shading", parts(simple=3) + SCALE),
        "checker": ("textures", parts(wide=3, simple=9, word=6)),
        "sample": ("camera", parts(simple=6 + 9) + UNIT),
        "pixel": ("output", parts(simple=3 * 5, word=0)),
    }


def price(board, of):
    return sum(number * PARTS[board].get(name, SIMPLE) for name, number in of.items())


def counts(scene, size):
    """What drawing the scene asks for."""
    done = subprocess.run(["build/study/operations", scene, size], capture_output=True, text=True)
    if done.returncode != 0:
        runs.fail(done.stderr.strip())
    return {name.rstrip(":"): int(value) for name, value in map(str.split, done.stdout.splitlines())}


def floor(board, found, rays):
    """({step: instructions a ray}, wide products a ray)"""
    asked = {**found, "shadow": rays - found["ray"], "light weighed": found["mirrored"]}
    out, products = collections.Counter(), 0.0
    for name, (step, of) in operations(board == "microbit").items():
        out[step] += asked.get(name, 0) * price(board, of) / rays
        products += asked.get(name, 0) * sum(of[k] for k in ("wide", "square", "high")) / rays
    return out, products


def text(scene, size, measured, found):
    """measured: {board: (rays, {step: instructions})}"""
    rows, sums, products = [], {}, {}
    least = {}
    for board in BOARDS:
        rays, steps = measured[board]
        least[board], products[board] = floor(board, found, rays)
        sums[board] = sum(steps.values()) / rays, sum(least[board].values())
    for step in STEPS:
        row = [step]
        for board in BOARDS:
            rays, steps = measured[board]
            row += [count(steps.get("checker" if step == "textures" else step, 0) / rays), count(least[board][step])]
        rows.append(row)
    rows.append(["all"] + [count(v) for board in BOARDS for v in sums[board]])
    named = {b: runs.BOARDS[b] for b in BOARDS}
    most = {b: listed(sorted(STEPS, key=lambda s, b=b: -measured[b][1].get(s, 0))[:2]) for b in BOARDS}
    part = {b: sum(v for s, v in measured[b][1].items() if s in most[b].split(" and ")) for b in BOARDS}
    where = [f"{100 * part[b] / sum(measured[b][1].values()):.0f} % ({named[b]}, {most[b]})" for b in BOARDS]
    share = [f"{sums[b][0] / sums[b][1]:.1f} ({named[b]})" for b in BOARDS]
    wide = [f"{products[b]:.0f} ({named[b]})" for b in BOARDS]
    head = ["instructions/ray"] + [f"{named[b]}{what}" for b in BOARDS for what in ("", ", floor")]
    about = (f"Where the instructions of a ray go, `{scene}` at {size.replace('x', ' × ')} in `q32`, and the floor: "
             "the fewest that the same arithmetic would take on that core, were every number in a register when it is "
             "needed (counted in `src/study/floor.py`).")
    verdict = (f"The two largest steps take {listed(where)} of all. A ray needs {listed(wide)} products of more than "
               f"32 bits; one takes {PARTS['microbit']['wide']} instructions on the M0, which has only the lower half "
               "of products and rejects balls without any, and one or two on the others. What is drawn takes "
               f"{listed(share)} times the floor; the rest is registers stored and loaded again, and what robustness "
               "adds.")
    return f"{filled(about)}\n\n{table(head, rows)}\n{filled(verdict)}\n"


def filled(words):
    return textwrap.fill(words, 110, break_on_hyphens=False, break_long_words=False)


def measure(scene, size):
    pairs = {b: (runs.Run(b, scene, "q32", size, rays=True), runs.Run(b, scene, "q32", size, profile=True))
             for b in BOARDS}
    runs.perform([run for pair in pairs.values() for run in pair])
    if runs.failures:
        runs.fail(f"{runs.failures[0][0]}: {runs.failures[0][1]}")
    return {b: (counted.result["rays"], traced.result["steps"]) for b, (counted, traced) in pairs.items()}


def floor_report(scene=SCENE, size=SIZE):
    return text(scene, size, measure(scene, size), counts(scene, size))


REPORTS = {"floor": (floor_report, lambda: [SCENE] + [f"| {step} |" for step in STEPS + ["all"]]
                     + [f"{runs.BOARDS[b]}, floor" for b in BOARDS] + ["times the floor"])}

if __name__ == "__main__":
    os.makedirs("build/study", exist_ok=True)
    print(floor_report(*sys.argv[1:]))
