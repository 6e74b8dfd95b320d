"""make stability: throws the same random rays at qray's forms and at textbook ones, counts the instructions
of both, and writes build/stability.csv, build/stability.md and, between its markers, the page that has them.

    stability.py [--rays N] [--seed N]"""

import argparse
import csv
import glob
import os
import re
import subprocess
import sys
import tempfile
import textwrap

sys.dont_write_bytecode = True
sys.path.insert(0, "src/study")
import report  # noqa: E402
from tables import count, listed, table  # noqa: E402

PROGRAM = "build/stability/stability"
REGIMES = ["ordinary", "small and far", "grazing", "needle"]
FIGURES = ["polygon", "patch"]  # which may be needles
SHAPES = ["sphere", "plane", "disc", "cylinder", "cone"] + FIGURES
# The number systems, and the arithmetic of the textbook beside each.
NUMBERS = {"q16": "Q16.16", "q24": "Q16.16", "q32": "Q8.24", "float": "float", "double": "double"}
FORMS = ["ours", "textbook"]


def regimes(shape):
    return REGIMES if shape in FIGURES else REGIMES[:3]


def per_million(number, of):
    value = 1e6 * number / of if of else 0
    return "0" if value == 0 else f"{value:.1f}" if value < 10 else count(value)


def filled(text):
    """In lines, with numbers like 10 000 in one."""
    whole = re.sub(r"(?<=\d) (?=\d{3}\b)", "_", text)
    return textwrap.fill(whole, 110, break_on_hyphens=False).translate({ord("_"): " "})


def small(value):
    """1.2e-7"""
    digits, exponent = f"{value:.1e}".split("e")
    return "0" if value == 0 else f"{digits}e{int(exponent)}"


class Results:
    def __init__(self, rows, instructions):
        self.at = {(r["shape"], r["number"], r["regime"], r["form"]):
                   {k: float(v) for k, v in r.items() if k not in ("shape", "number", "regime", "form")}
                   for r in rows}
        self.instructions = instructions  # (shape, number, form): a ray

    def wrong(self, *where):
        r = self.at[where]
        return per_million(r["wrong"], r["rays"])

    def share(self, *where):
        r = self.at[where]
        return r["wrong"] / r["rays"]

    def rate(self, what, number):
        """Of the textbook, in a million rays that leave a surface."""
        return per_million(self.total(what, "textbook", number), self.total("rebounds", "textbook", number))

    def total(self, what, form, number=None):
        return sum(r[what] for (_, n, _, f), r in self.at.items() if f == form and number in (None, n))


def columns():
    return [name for number, book in NUMBERS.items() for name in (f"`{number}`", f"{book} textbook")]


def wrong_table(results):
    rows = [[f"{shape}, {regime}"] + [results.wrong(shape, number, regime, form)
                                      for number in NUMBERS for form in FORMS]
            for shape in SHAPES for regime in regimes(shape)]
    return table(["wrong per million"] + columns(), rows)


def cost_table(results):
    rows = [[shape] + [count(results.instructions[shape, number, form])
                       for number in NUMBERS for form in FORMS] for shape in SHAPES]
    return table(["instructions"] + columns(), rows)


def whole_table(results):
    """Everything; in each cell ours and the textbook's."""
    rows = []
    for shape in SHAPES:
        for regime in regimes(shape):
            for number in NUMBERS:
                both = [results.at[shape, number, regime, form] for form in FORMS]
                rows.append([f"{shape}, {regime}", number]
                            + [results.wrong(shape, number, regime, form) for form in FORMS]
                            + [small(r[what]) for what in ("mean error", "worst error") for r in both]
                            + [per_million(r[what], r["rebounds"]) for what in ("self-hits", "leaks")
                               for r in both])
    head = ["shape, regime", "number"] + [f"{what}{form}" for what in (
        "wrong", "mean error of t", "worst error of t", "self-hits", "leaks") for form in ("", ", textbook")]
    return table(head, rows)


def millions(number):
    return f"{number / 1e6:.0f} million" if number >= 1e6 else count(number)


def sentences(results):
    def most(form, numbers, skip=()):
        return max(((results.share(s, n, r, form), s, r) for s in SHAPES for r in regimes(s) for n in numbers
                    if r not in skip))

    out = []
    ours, theirs = most("ours", ["q32"], ["needle"]), most("textbook", ["q32"], ["needle"])
    same = most("ours", ["float"], ["needle"])
    out.append(f"Where `q32` is wrong most often, needles apart ({ours[1]}, {ours[2]}), it is "
               f"{per_million(ours[0], 1)} times in a million; the same 24 bits behind the point in textbook "
               f"forms, {per_million(theirs[0], 1)} times ({theirs[1]}, {theirs[2]}); and `float`, in robust "
               f"forms, {per_million(same[0], 1)} times ({same[1]}, {same[2]}).")
    behind = [f"{s}, {r}" for s in SHAPES for r in regimes(s)
              if results.share(s, "q32", r, "ours") > results.share(s, "float", r, "ours")]
    out.append(f"`q32` is wrong more often than `float` in {'; '.join(behind) or 'no row'}.")
    if all(results.share(s, "q32", r, "ours") == 0 for s in FIGURES for r in regimes(s)):
        out[-1] += (" On which side of an edge a ray passes it knows exactly, however thin the figure: where 64 "
                    "bits leave it open, 128 decide.")
    rebounds = results.total("rebounds", "ours")
    selfs, leaks = results.total("self-hits", "ours"), results.total("leaks", "ours")
    found = [f"{results.rate('self-hits', n)} ({book})" for n, book in NUMBERS.items()]
    lost = results.rate("leaks", "double")
    out.append(f"Of {millions(rebounds)} rays that leave a surface, a quarter of them almost along it, "
               f"{count(selfs)} find it again and {count(leaks)} lose its other side. A textbook ignores "
               "hits nearer than 0.001 instead: of a million rays that leave a surface "
               f"{listed(found)} find it all the same. Wider arithmetic does not mend the form: in double, "
               f"{lost} of a million miss the other side of what is thinner than that.")

    def ratios(number):
        spent = results.instructions
        found = sorted((spent[s, number, "ours"] / spent[s, number, "textbook"], s) for s in SHAPES)
        return " to ".join(f"{ratio:.1f} ({shape})" for ratio, shape in (found[0], found[-1]))

    out.append(f"The price is {ratios('q32')} times the textbook's instructions in `q32`, and "
               f"{ratios('float')} times in `float`.")
    return "\n".join(map(filled, out))


def text(results, rays, seed):
    about = (f"{count(rays)} random rays a shape and number system (seed {seed}), divided among the regimes; "
             "the judge works in 64 bits, and in 113 where there is doubt. *Small and far* are objects of "
             "0.005 to 0.05 units from 40 units away, in a world of ±62; *grazing* are rays within a "
             "thousandth of a tangent or a rim; a *needle* is up to a hundred thousand times as long as "
             "wide. A *textbook* solves at² + bt + c = 0 by its discriminant, tests a hit point against a "
             "polygon's edges, takes Möller and Trumbore's triangle, and ignores hits nearer than 0.001; it "
             "does so in arithmetic of the same size, each product rounded, on the same shapes and rays.")
    costs = ("Instructions of one test of a ray against a shape, on x86-64, counted by callgrind: the mean of "
             "ordinary rays, with the shapes' cheap reject:")
    errors = ("Mean and worst error of t where the judge sees a hit too, in a world of ±62; self-hits and "
              "leaks (rays into a curved shape that never come out) per million rays that leave a hit.")
    return "\n\n".join([
        filled(about), sentences(results),
        wrong_table(results) + "\n" + filled(costs), cost_table(results)
        + "\n<details><summary>Errors of t, self-hits and leaks</summary>", filled(errors),
        whole_table(results) + "\n</details>\n"])


def problems(readme):
    """What README's tables lack: a list of rows."""
    found = report.marker("stability").search(readme)
    if found is None:
        return ["no '<!-- report:stability -->' ... '<!-- /report -->'"]
    rows = [[c.strip() for c in line.strip("| ").split("|")] for line in found[0].splitlines()
            if line.startswith("| ")]

    def value(cell):
        try:
            return float(cell.replace(" ", "")) >= 0
        except ValueError:
            return False

    wanted = [([shape], 2 * len(NUMBERS)) for shape in SHAPES]
    wanted += [([f"{s}, {r}"], 2 * len(NUMBERS)) for s in SHAPES for r in regimes(s)]
    wanted += [([f"{s}, {r}", n], 10) for s in SHAPES for r in regimes(s) for n in NUMBERS]
    out = []
    for names, values in wanted:
        same = [r for r in rows if r[:len(names)] == names and len(r) == len(names) + values]
        if len(same) != 1 or not all(map(value, same[0][len(names):])):
            out.append(f"report:stability has not one whole row {' | '.join(names)}; "
                       "`make stability` writes it again")
    return out


def instructions(seed):
    """{(shape, number, form): instructions a ray}, the loop around them taken off."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(["valgrind", "--tool=callgrind", "--collect-atstart=no",
                               "--toggle-collect=measured_loop", "--dump-before=measured_end",
                               f"--callgrind-out-file={folder}/out", PROGRAM, "--cost", "--seed", str(seed)],
                              capture_output=True, text=True)
        names = [line.split(",") for line in done.stdout.splitlines()]
        if done.returncode != 0 or len(glob.glob(f"{folder}/out.*")) < len(names):
            raise SystemExit("stability.py: callgrind failed:\n" + done.stderr)
        counts = {}
        for i, (shape, number, form, tests) in enumerate(names):
            with open(f"{folder}/out.{i + 1}") as file:
                total = next(int(line.split()[1]) for line in file if line.startswith("totals:"))
            counts[shape, number, form] = total / int(tests)
    return {(s, n, f): value - counts[s, n, "nothing"] for (s, n, f), value in counts.items()
            if f != "nothing"}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rays", type=int, default=3000000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    done = subprocess.run([PROGRAM, "--rays", str(options.rays), "--seed", str(options.seed)], check=True,
                          stdout=subprocess.PIPE, text=True)
    rows = list(csv.DictReader(done.stdout.splitlines()))
    costs = instructions(options.seed)
    with open("build/stability.csv", "w", newline="") as file:
        out = csv.DictWriter(file, list(rows[0]) + ["instructions"], lineterminator="\n")
        out.writeheader()
        for row in rows:
            spent = costs[row["shape"], row["number"], row["form"]]
            out.writerow({**row, "instructions": f"{spent:.1f}"})
    made = text(Results(rows, costs), options.rays, options.seed)
    print(made)
    report.put("stability", made, "build/stability.md")


if __name__ == "__main__":
    main()
