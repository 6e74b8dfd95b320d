"""The price of each bit: how far pictures are off where a step of the tracer rounds to so many bits, and what the step
takes on boards (bits.cpp, steps.cpp; stepped.hpp says how steps are told apart)."""

import concurrent.futures
import csv
import glob
import json
import math
import os
import statistics
import sys

import figures
import pictures
import runs
from programs import fail, make, message_of, output_of
from settings import BOARDS, board_facts, fixed_numbers
from tables import count, listed, table

sys.path.insert(0, "src/boards/common")
import run as boards_run  # noqa: E402

SIZE, TARGET = "320x240", 60
COSTS = ["microbit", "mps2_an385"]
PROGRAM, NOTHING = "build/study/bits", "build/study/none"
SOURCES = ["include", "src/scene", "src/cli",
           *(f"src/study/{name}" for name in ("bits.cpp", "stepped.hpp", "steps.hpp", "widths.hpp"))]


def scenes():
    return sorted(glob.glob("scenes/*.nff"))


def measured(paths, size):
    """{scene: what bits.cpp says}; two at a time, kept."""
    sources, flags = runs.tree_hash(*SOURCES), runs.text_of("build/obj/flags")

    def one(scene):
        path = f"{runs.CACHE}/{runs.hash_of(sources, flags, runs.scene_text(scene), size)}.json"
        if not os.path.exists(path):
            runs.keep(path, json.loads(output_of(PROGRAM, "-s", size, scene)))
            print(f"bits of {scene}", file=sys.stderr, flush=True)
        return runs.kept(path)

    os.makedirs(runs.CACHE, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(runs.JOBS) as pool:
        return dict(zip(paths, pool.map(one, paths)))


class Bits:
    """What was measured, in decibels by bits: of a step `at[name]` for each scene that has it, of all `together`."""

    def __init__(self, paths, size):
        self.size, self.found = size, measured(paths, size)
        first = next(iter(self.found.values()))
        self.larger = math.isqrt(first["larger"])
        self.bits, self.what = first["bits"], {s["name"]: s["what"] for s in first["steps"]}
        self.fractions = [s["name"] for s in first["steps"] if s["of"] not in ("Quotient", "Row", "Cell")]
        self.numbers = list(dict.fromkeys(n for f in self.found.values() for n in f["reached"]))
        self.at = {name: {scene: self.row(scene, f["steps"][i]["squares"]) for scene, f in self.found.items()
                          if any(f["steps"][i]["squares"][0])} for i, name in enumerate(self.what)}
        self.together = {scene: self.row(scene, f["together"]) for scene, f in self.found.items()}

    def decibels(self, scene, squares):
        return pictures.decibels(squares / self.found[scene]["levels"])

    def row(self, scene, squares):
        return [self.decibels(scene, shade + other) for shade, other, _ in squares]

    def median(self, of):
        """By bits, over scenes."""
        return [statistics.median(row) for row in zip(*of.values())]

    def needed(self, row, target=TARGET):
        """The least bits from which on all have the target; None where the widest has not."""
        out = None
        for bits, value in zip(reversed(self.bits), reversed(row)):
            if value < target:
                break
            out = bits
        return out

    def needs(self, name):
        """Those bits, over scenes: (median, most); what is not enough counts as two more."""
        own = [self.needed(row) or self.bits[-1] + 2 for row in self.at[name].values()]
        return (statistics.median_high(own), max(own)) if own else (None, None)

    def sums(self, scene, number):
        """What the errors of all steps, each alone, add up to. Squares of shades are added. Where edges move, squares
        grow with how far, and ways that know nothing of each other add up to the root of their squares. With a bit
        fewer they move twice as far: so is known what few pixels show. None are predicted where none are more likely
        than some."""
        found = self.found[scene]
        shades, others, pixels = zip(*[(own[0], fewer[1] / 2 ** bits, fewer[2] / 2 ** bits)
                                       for own, fewer, bits in found["alone"][number]])
        likely_none = math.exp(-math.hypot(*pixels) * found["larger"]) > 0.5
        return sum(shades) + (0 if likely_none else math.hypot(*others))

    def predicted(self, scene, number):
        """Decibels: (reached, all steps rounded together, the sum of each alone)."""
        found = self.found[scene]
        return (*(self.decibels(scene, (shade + other) / found["larger"])
                  for shade, other, _ in found["reached"][number]),
                self.decibels(scene, self.sums(scene, number)))

    def agree(self, number, kind):
        """In how many scenes what is predicted is within 3 dB, of how many."""
        own = [self.predicted(scene, number) for scene, f in self.found.items() if number in f["reached"]]
        return sum(abs(p[0] - p[kind]) <= 3 for p in own), len(own)

    def shares(self, number):
        """Of each step, in the sum of squares of a number system; the mean of all scenes."""
        alone = [[own[0] + fewer[1] / 2 ** bits for own, fewer, bits in f["alone"][number]]
                 for f in self.found.values() if number in f["alone"]]
        scaled = [[squares / sum(a) for squares in a] for a in alone if sum(a)]
        return {name: sum(own) / len(scaled) for name, own in zip(self.what, zip(*scaled))}


def costs(numbers):
    """Instructions of one call, {(board, number): {step: instructions}}, from firmware that calls nothing else."""
    out = {}
    for board in COSTS:
        facts = board_facts(board)
        for number in numbers:
            image = f"build/{board}/steps-{number}.elf"
            status, said = make(image, f"BOARD={board}", f"NUMBER={number}", "NAME=steps",
                                "FW_MAIN=src/study/steps.cpp", f"FW_EXTRA=-DQRAY_NUMBER={number}")
            if status != 0:
                fail(message_of(said))
            ticks = boards_run.run_semihosting(facts["qemu"].split(), image, NOTHING, 60)
            calls, empty = ticks.pop("calls"), ticks.pop("nothing")
            out[board, number] = {name: (t - empty) * float(facts["tick"]) / calls for name, t in ticks.items()}
    return out


def shown(b, bits):
    return "–" if bits is None else f"> {b.bits[-1]}" if bits > b.bits[-1] else str(bits)


def steps_table(b, cost):
    rows = []
    for name, what in b.what.items():
        medians = [f"{v:.0f}" for v in b.median(b.at[name])] or ["–"] * len(b.bits)
        # What stands in tables takes nothing on boards.
        price = [count(own[name]) if own[name] >= 0.5 else "–" for own in cost.values()]
        rows.append([what, *medians, *(shown(b, bits) for bits in b.needs(name)), *price])
    rows.append(["all together", *(f"{v:.0f}" for v in b.median(b.together)), *[""] * (2 + len(cost))])
    return table(["what is rounded", *map(str, b.bits), f"{TARGET} dB", "everywhere",
                  *(f"{BOARDS[board]} {number}" for board, number in cost)], rows)


def numbers_table(b):
    rows = [[f"`{scene}`"] + [f"{v:.0f}" for n in b.numbers
                              for v in (b.predicted(scene, n) if n in f["reached"] else [math.nan] * 3)]
            for scene, f in b.found.items()]
    return table(["dB", *(f"{n} {kind}" for n in b.numbers for kind in ("reaches", "together", "sum"))], rows)


def sentences(b, cost):
    """Five."""
    needs = sorted(((b.needs(name)[0], name) for name in b.fractions if b.at[name]), key=lambda n: -n[0])
    (most, first), middle, least = needs[0], needs[len(needs) // 2][0], needs[-1][0]

    def named(bits):
        own = [b.what[n] for value, n in needs if value == bits]
        return f"{listed(own)} {'need' if len(own) > 1 or own[0][-1] == 's' else 'needs'} {shown(b, bits)}"

    def gain(name, low, high):
        row = b.median(b.at[name])
        return (row[b.bits.index(high)] - row[b.bits.index(low)]) / (high - low)

    def largest(of, how_many):
        return sorted(of, key=of.get, reverse=True)[:how_many]

    narrow, wide, board = b.numbers[0], b.numbers[-1], COSTS[0]
    times = [sum(cost[c, wide].values()) / sum(cost[c, narrow].values()) for c in COSTS]
    more = {name: cost[board, wide][name] - cost[board, narrow][name] for name in b.what}
    dear = listed([f"{b.what[n]} (+{more[n]:.0f} instructions)" for n in largest(more, 4)])

    def worst(number):
        shares = b.shares(number)
        own = largest(shares, 3)
        return f"`{number}`, {100 * sum(shares[n] for n in own):.0f} % is that of {listed([b.what[n] for n in own])}"

    each, at_once = (listed(["%d of %d scenes (`%s`)" % (*b.agree(n, kind), n) for n in b.numbers]) for kind in (2, 1))
    return "\n".join([
        f"For {TARGET} dB, {named(most)} bits behind the point (median of {len(b.found)} scenes), {named(least)}, and "
        f"half of all steps at most {middle}: one width for all is too narrow for the first or wasted on the last.",
        f"Where a step moves edges, a bit halves the pixels that show something else, which is "
        f"{gain(first, 8, 16):.1f} dB ({b.what[first]}, from 8 to 16 bits); where it only shades, a bit is worth "
        f"{gain('colour', 4, 8):.1f} dB (colours, from 4 to 8) until the picture's own 8 bits hide it: "
        "accuracy wants bits of directions and lengths.",
        f"The bits of `{wide}` cost {times[0]:.1f} times the instructions of `{narrow}` on the {BOARDS[board]}, which "
        f"multiplies to 32 bits alone, but {times[1]:.1f} times on the {BOARDS[COSTS[1]]} (a call of each step); "
        f"dearest on the {BOARDS[board]} are {dear}.",
        f"Of the error of {'; of that of '.join(map(worst, b.numbers[:-1]))} (mean of the scenes' shares): a bit more "
        "buys most there.",
        f"The errors of all steps, each alone, predict what a number system reaches within 3 dB in {each}, and all "
        f"steps rounded at once in {at_once}: a new one can be judged by this table before it is written."])


def study(folder, quick):
    """For make study: the table as CSV, and the plot."""
    b = Bits(["scenes/floor.nff", "scenes/glass.nff"], "64x48") if quick else Bits(scenes(), SIZE)
    figures.steps(b, {} if quick else costs(b.numbers), TARGET, f"{folder}/steps.svg")
    with open(f"{folder}/steps.csv", "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["scene", "size", "step", "bits", "psnr"])
        for name, of in [*b.at.items(), ("together", b.together)]:
            for scene, row in of.items():
                out.writerows([scene, b.size, name, bits, f"{value:.3f}"] for bits, value in zip(b.bits, row))


def report():
    b = Bits(scenes(), SIZE)
    cost = costs(b.numbers)
    figures.steps(b, cost, TARGET, f"{figures.FIGURES}/steps.svg")
    return f"""![Accuracy by step and bits]({figures.FIGURES}/steps.svg)

{sentences(b, cost)}

PSNR in dB to `double`, {b.size.replace('x', ' × ')} pixels, one sample, where one step alone rounds to so many bits
behind the point and all else is `double`: the median of the scenes that have the step, then the bits for {TARGET} dB in
half of these scenes, and in all. Lengths are scene units after the builder's scale, which makes a scene fill ±62. The
bits of quotients and of texture rows are all that these have, those of texture coordinates are parts of a cell. With
coordinates go radii, with v·d what cones find in their own frame, with hit points how far off these new rays start,
with curved normals what they are found from (offset / radius of a sphere, weights of a patch's corners), with cosines
the shares of light that are made of them, with weights the coefficients of materials; shares of colours are what a
colour is multiplied by. At the right, instructions of one call of the step's operations, loads
and stores included, in firmware that calls nothing else (`steps.cpp`); what stands in tables takes none.

{steps_table(b, cost)}
What a number system reaches, and what its widths say: all steps rounded to its bits at once (together), and the errors
of each alone, added (sum): squares of bytes that are off by up to 2 levels, and of others, which lie where edges have
moved, the root of the sum of the squares of these, as ways that know nothing of each other add up. One pixel beside an
edge may be 10 dB of a small picture: so what is reached, and together, are of {b.larger} times the columns and rows,
and edges that move in few pixels were measured with 4 or 8 bits less, which move them by 16 or 256 times as much. All
these pictures are rolled by 3 degrees, as an edge along a row of pixels moves over all of them or over none.

{numbers_table(b)}"""


REPORTS = {"bits": (report, lambda: ["figures/steps.svg", "| all together |"] 
                    + [f"{n} reaches" for n in fixed_numbers()] + [f"| `{scene}` |" for scene in scenes()])}
