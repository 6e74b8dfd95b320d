"""The price of each bit: how far each scene's picture is off where a step of the tracer rounds to so many bits, and what the
step takes on boards (bits.cpp, steps.cpp; stepped.hpp says how steps are told apart)."""

import concurrent.futures
import csv
import glob
import json
import math
import os
import statistics
import subprocess
import sys

import figures
import pictures
import runs
from programs import environment, fail, message_of, output_of
from settings import BOARDS, board_facts
from text import FIGURES, count, listed, table

sys.path.insert(0, "src/boards/common")
import run as boards_run  # noqa: E402

SIZE, TARGET = "320x240", 60
COSTS = ["microbit", "mps2_an385"]
PROGRAM, FOLDER = "build/study/bits", "build/study/bits-of"


def measured(scenes, size):
    """{scene: what bits.cpp says}; two at a time, kept."""
    sources = runs.tree_hash("include", "src/scene", "src/cli", "src/study/bits.cpp", "src/study/stepped.hpp",
                             "src/study/steps.hpp")

    def one(scene):
        path = f"{runs.CACHE}/{runs.hash_of(sources, runs.text_of('build/obj/flags'), runs.scene_text(scene), size)}.json"
        if not os.path.exists(path):
            runs.keep(path, json.loads(output_of(PROGRAM, "-s", size, scene)))
            print(f"bits of {scene}", file=sys.stderr, flush=True)
        return runs.kept(path)

    os.makedirs(runs.CACHE, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(runs.JOBS) as pool:
        return dict(zip(scenes, pool.map(one, scenes)))


class Bits:
    """What was measured, in decibels: of a step `at[name]` by bits for each scene that has it, of all `together`."""

    def __init__(self, scenes, size):
        self.size, self.found = size, measured(scenes, size)
        first = next(iter(self.found.values()))
        self.bits, self.steps = first["bits"], first["steps"]
        self.names = [s["name"] for s in self.steps]
        self.numbers = list(dict.fromkeys(n for f in self.found.values() for n in f["numbers"]))
        self.at = {name: {scene: [self.decibels(scene, sum(v)) for v in f["steps"][i]["squares"]]
                          for scene, f in self.found.items() if any(f["steps"][i]["squares"][0])}
                   for i, name in enumerate(self.names)}
        self.together = {scene: [self.decibels(scene, sum(v)) for v in f["together"]] for scene, f in self.found.items()}

    def decibels(self, scene, squares):
        return pictures.decibels(squares / self.found[scene]["levels"])

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

    def predicted(self, scene, number):
        """Decibels: (reached, all steps rounded together, the sum of each alone). Squares of shades are added. Where edges
        move, their squares grow with how far, and ways that know nothing of each other add up to the root of their squares."""
        n = self.found[scene]["numbers"][number]
        shades, others = zip(*n["alone"])
        added = sum(shades) + math.hypot(*others)
        return tuple(self.decibels(scene, v) for v in (sum(n["reached"]), sum(n["together"]), added))

    def agree(self, number, kind):
        """In how many scenes what is predicted is within 3 dB, of how many."""
        all_of = [self.predicted(scene, number) for scene, f in self.found.items() if number in f["numbers"]]
        return sum(abs(p[0] - p[kind]) <= 3 for p in all_of), len(all_of)

    def shares(self, number):
        """The share of each step in the sum of squares that all scenes have, each scene counting alike."""
        out = dict.fromkeys(self.names, 0.0)
        used = [f["numbers"][number]["alone"] for f in self.found.values() if number in f["numbers"]]
        used = [squares for squares in ([sum(s) for s in alone] for alone in used) if any(squares)]
        for squares in used:
            for name, own in zip(self.names, squares):
                out[name] += own / sum(squares) / len(used)
        return out


def costs(numbers):
    """Instructions of one call, {(board, number): {step: instructions}}, from firmware that calls nothing else."""
    out = {}
    os.makedirs(FOLDER, exist_ok=True)
    for board in COSTS:
        facts = board_facts(board)
        for number in numbers:
            image = f"build/{board}/steps-{number}.elf"
            done = subprocess.run(["make", "--no-print-directory", image, f"BOARD={board}", f"NUMBER={number}", "NAME=steps",
                                        "FW_MAIN=src/study/steps.cpp", f"FW_EXTRA=-DQRAY_NUMBER={number}"],
                                       capture_output=True, text=True, env=environment())
            if done.returncode != 0:
                fail(message_of(done))
            ticks = boards_run.run_semihosting(facts["qemu"].split(), image, f"{FOLDER}/none", 60)
            calls, empty = ticks.pop("calls"), ticks.pop("nothing")
            out[board, number] = {name: (t - empty) * float(facts["tick"]) / calls for name, t in ticks.items()}
    return out


def scenes():
    return sorted(glob.glob("scenes/*.nff"))


def steps_table(b, cost):
    rows = []
    for step in b.steps:
        name, row = step["name"], b.at[step["name"]]
        middle, most = b.needs(name)
        rows.append([step["what"], *(f"{v:.0f}" if row else "–" for v in (b.median(row) if row else b.bits)),
                     shown(b, middle), shown(b, most), *price(cost, name)])
    rows.append(["all together", *(f"{v:.0f}" for v in b.median(b.together)), *[""] * (2 + len(cost))])
    return table(["what is rounded", *map(str, b.bits), f"{TARGET} dB", "everywhere",
                  *(f"{BOARDS[board]} {number}" for board, number in cost)], rows)


def shown(b, bits):
    return "–" if bits is None else f"> {b.bits[-1]}" if bits > b.bits[-1] else str(bits)


def price(cost, name):
    """Nothing on boards of what is in tables."""
    return [count(own[name]) if own[name] >= 0.5 else "–" for own in cost.values()]


def numbers_table(b):
    rows = [[f"`{scene}`"] + [f"{v:.0f}" for n in b.numbers for v in (b.predicted(scene, n) if n in f["numbers"] else ())]
            for scene, f in b.found.items()]
    return table(["dB", *(f"{n} {kind}" for n in b.numbers for kind in ("reaches", "together", "sum"))], rows)


def gain(b, name, low, high):
    """Decibels a bit, of the median between these bits."""
    row = b.median(b.at[name])
    return (row[b.bits.index(high)] - row[b.bits.index(low)]) / (high - low)


def sentences(b, cost):
    what = {s["name"]: s["what"] for s in b.steps}
    fraction = {s["name"] for s in b.steps if s["of"] in ("Length", "Unit", "Colour")}
    needs = sorted(((b.needs(name)[0], name) for name in fraction if b.at[name]), key=lambda n: (-n[0], b.names.index(n[1])))
    most = [what[n] for bits, n in needs if bits == needs[0][0]]
    least = [what[n] for bits, n in needs if bits == needs[-1][0]]
    between = sorted(bits for bits, _ in needs)
    out = [f"For {TARGET} dB, {listed(most)} {'needs' if len(most) == 1 else 'need'} {shown(b, needs[0][0])} bits behind the point "
           f"(median of {len(b.found)} scenes), {listed(least)} {'needs' if len(least) == 1 else 'need'} {needs[-1][0]}, and half of all "
           f"steps at most {between[(len(between) - 1) // 2]}: one width for all is "
           "either too narrow for the first or wasted on the last."]
    first = needs[0][1]
    out.append(f"Where a step moves edges, a bit halves the pixels that show something else, which is {gain(b, first, 8, 16):.1f} dB "
               f"({what[first]}, from 8 to 16 bits); where it only shades, a bit is worth {gain(b, 'colour', 4, 8):.1f} dB ({what['colour']}, "
               "from 4 to 8) until the picture's own 8 bits hide it: bits of directions and lengths are what accuracy wants, and those "
               "of colours it hardly sees.")
    narrow, wide = b.numbers[0], b.numbers[-1]

    def total(board, number):
        return sum(cost[board, number].values())

    more = {name: cost[COSTS[0], wide][name] - cost[COSTS[0], narrow][name] for name in b.names}
    dear = sorted(more, key=more.get, reverse=True)[:4]
    out.append(f"The bits of `{wide}` cost {total(COSTS[0], wide) / total(COSTS[0], narrow):.1f} times the instructions of `{narrow}` on the "
               f"{BOARDS[COSTS[0]]}, which multiplies to 32 bits alone, but {total(COSTS[1], wide) / total(COSTS[1], narrow):.1f} times on the "
               f"{BOARDS[COSTS[1]]} (a call of each step); dearest on the {BOARDS[COSTS[0]]} are "
               + listed([f"{what[n]} (+{more[n]:.0f} instructions)" for n in dear]) + ".")
    shares = b.shares(narrow)
    large = sorted(shares, key=shares.get, reverse=True)[:3]
    out.append(f"Of the error of `{narrow}`, {100 * sum(shares[n] for n in large):.0f} % is that of {listed([what[n] for n in large])} "
               "(mean of the scenes' shares); each bit more there is worth more than any elsewhere.")
    each, at_once = (listed(["%d of %d scenes (`%s`)" % (*b.agree(n, kind), n) for n in b.numbers]) for kind in (2, 1))
    out.append(f"The errors of all steps, each alone, predict what a number system reaches within 3 dB in {each}, and all steps rounded at "
               f"once in {at_once}: a new one can be judged by this table before it is written.")
    return "\n".join(out)


def write_csv(b, path):
    with open(path, "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["scene", "size", "step", "bits", "psnr"])
        for name, of in [*b.at.items(), ("together", b.together)]:
            for scene, row in of.items():
                out.writerows([scene, b.size, name, bits, f"{value:.3f}"] for bits, value in zip(b.bits, row))


def study(folder, quick):
    """For make study: the table as CSV, and the plot."""
    b = Bits(["scenes/floor.nff", "scenes/glass.nff"], "64x48") if quick else Bits(scenes(), SIZE)
    write_csv(b, f"{folder}/steps.csv")
    figures.steps(b, {} if quick else costs(b.numbers), f"{folder}/steps.svg")


def report():
    b = Bits(scenes(), SIZE)
    cost = costs(b.numbers)
    figures.steps(b, cost, f"{FIGURES}/steps.svg")
    return (f"![Accuracy by step and bits]({FIGURES}/steps.svg)\n\n{sentences(b, cost)}\n\n"
            f"PSNR in dB to `double`, {b.size.replace('x', ' × ')} pixels, one sample, where one step alone rounds to so many bits "
            "behind the point and all else is `double`: the median of the scenes that have the step, then the bits for "
            f"{TARGET} dB in half of these scenes, and in all. Lengths are scene units after the builder's scale, which makes them fill "
            "±62. A quotient's and a texture row's bits are all that it has, a texture coordinate's are parts of a cell. At the right, "
            "instructions of one call of the step's operations, loads and stores included, in firmware that calls nothing else "
            "(`steps.cpp`); what stands in tables has none.\n\n"
            + steps_table(b, cost)
            + "\nWhat a number system reaches, and what its widths say: all steps rounded to its bits at once (together), and the errors of "
            "each alone, added (sum): squares of bytes off by up to 2 levels, and of others, which lie where edges have moved, the root "
            "of the sum of the squares of these, as ways that know nothing of each other add up. What light maps round (`cornell`) is no "
            "step.\n\n" + numbers_table(b))


REPORTS = {"bits": (report, lambda: ["figures/steps.svg", "| all together |"] + [f"{n} reaches" for n in ("q16", "q32")]
                    + [f"| `{scene}` |" for scene in scenes()])}
