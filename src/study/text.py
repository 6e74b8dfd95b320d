"""What README.md says of the study: tables and sentences around measured numbers."""

import glob
import math
import os
import subprocess

import cycles
import figures
import pictures
import runs
import settings
import study as study_file
from figures import FIGURES
from settings import DEFAULT
from tables import count, listed, table


class Numbers:
    """Look-up in the study's rows."""

    def __init__(self, study):
        self.study = study
        self.at = {(r["scene"], r["board"], r["setting"]): r for r in study.rows}

    def ratio(self, board, one, other, what=figures.COST):
        """The mean over scenes of one setting's cost by another's (geometric), or None."""
        logs = [math.log(self.at[scene, board, one][what] / self.at[scene, board, other][what])
                for scene in self.study.scenes
                if (scene, board, one) in self.at and (scene, board, other) in self.at]
        return math.exp(sum(logs) / len(logs)) if logs else None

    def gain(self, one, other):
        """Decibels of accuracy that one setting has over another, on the mean of the scenes."""
        errors = [e for e in self.study.errors.values() if e.get(one) and e.get(other)]
        gains = [e[one]["total psnr"] - e[other]["total psnr"] for e in errors]
        return sum(gains) / len(gains) if gains else None

    def seen(self, of, name, setting):
        """The share of pixels where an eye sees a difference, on the mean of the scenes."""
        known = [e[setting][name] for e in of.values() if e.get(setting)]
        return f"{100 * sum(known) / len(known):.0f} %"

    def arithmetic(self, number):
        """(least, median) decibels of the arithmetic alone, over all scenes."""
        setting = DEFAULT._replace(number=number)
        known = sorted(e[setting]["arithmetic psnr"] for e in self.study.everywhere.values() if e.get(setting))
        return (known[0], known[len(known) // 2]) if known else None


def sentences(n):
    """Four, and one for each number system that is narrower than the default."""
    out = []
    soft = [b for b in study_file.BOARDS if b != "mps2_an386"]
    single = DEFAULT._replace(number="float")
    ratios = [f"{n.ratio(b, single, DEFAULT):.0f} ({runs.BOARDS[b]})" for b in soft]
    out.append(f"Without an FPU, `float` takes {listed(ratios)} times the instructions of `q32`, which has "
               f"{n.arithmetic('q32')[1]:.0f} dB against {n.arithmetic('float')[1]:.0f} dB of the arithmetic "
               "alone (median of all scenes; 99 is equal to `double`): there is nothing to be had from "
               "`float` there.")
    share = n.ratio("mps2_an386", single, DEFAULT)
    cycles = n.ratio("mps2_an386", single, DEFAULT, "cycles/pixel at error size")
    verdict = ("`float` is the choice" if cycles < 0.95 else "either will do" if cycles < 1.05
               else "`q32` is the choice there too")
    out.append(f"With the M4's FPU `float` takes {100 * share:.0f} % of the instructions of `q32` and "
               f"{100 * cycles:.0f} % of its modelled cycles: {verdict}.")
    many, adaptive = DEFAULT._replace(samples="16"), DEFAULT._replace(samples="a2,0.0625")
    out.append(f"Samples buy most: 16 instead of 1 gain {n.gain(many, DEFAULT):.1f} dB for "
               f"{n.ratio('microbit', many, DEFAULT):.1f} times the instructions (M0), adaptive sampling in two levels "
               f"{n.gain(adaptive, DEFAULT):.1f} dB for {n.ratio('microbit', adaptive, DEFAULT):.1f} times. "
               "An eye sees the error of {} of the pixels with 1, of {} with 16, of {} with adaptive sampling."
               .format(*(n.seen(n.study.errors, "total seen", s) for s in (DEFAULT, many, adaptive))))
    saved = [f"{100 * (1 - n.ratio('microbit', dial, DEFAULT)):.0f} % for {-n.gain(dial, DEFAULT):.1f} dB"
             for dial in (DEFAULT._replace(depth=3), DEFAULT._replace(depth=1), DEFAULT._replace(cutoff=0.02))]
    out.append(f"Less depth saves instructions (M0) at a price in accuracy: 3 instead of 5 {saved[0]}, 1 "
               f"instead of 5 {saved[1]}; a cutoff of 0.02 instead of 0.0014 saves {saved[2]}.")
    for number in runs.numbers()[:runs.numbers().index(DEFAULT.number)]:
        least, middle = n.arithmetic(number)
        narrow = DEFAULT._replace(number=number)
        share = [f"{100 * n.ratio(b, narrow, DEFAULT):.0f} % ({runs.BOARDS[b]})" for b in soft]
        out.append(f"`{number}` takes {listed(share)} of the instructions of `{DEFAULT.number}`, and its arithmetic "
                   f"has {middle:.0f} dB on the scenes of `scenes/` (median; {least:.0f} at least there: where many "
                   "mirrors show one another, it has less): an eye sees "
                   f"{n.seen(n.study.everywhere, 'arithmetic seen', narrow)} of the pixels differ from `double`'s.")
    return "\n".join(out)


def costs(n):
    """Each board and number system, on each scene."""
    rows = []
    scenes = list(n.study.scenes)
    for board in study_file.BOARDS:
        for number in runs.numbers():
            found = [n.at.get((scene, board, DEFAULT._replace(number=number))) for scene in scenes]
            if not any(found):
                continue
            rows.append([runs.BOARDS[board], number]
                        + [count(r[what]) if r else "–" for r in found
                           for what in (figures.COST, "cycles/pixel at error size")])
    head = ["board", "number"] + [f"{figures.name_of(s)}: {what}" for s in scenes
                                  for what in ("instructions/pixel", "cycles/pixel")]
    return table(head, rows)


def time_report():
    """Cycles and energy of a traced picture on each core, with memory that waits."""
    scene, each = "scenes/showcase.nff", {}
    plan = {(board, n): runs.Run(board, scene, n, study_file.traced_size(board, n), profile=True)
            for board in runs.BOARDS for n in runs.numbers()}
    runs.perform(list(plan.values()))
    rows = []
    for (board, number), run in plan.items():
        r, part, pixels = run.result, cycles.PARTS[board], math.prod(map(int, run.size.split("x")))
        if "refused" in r:
            rows.append([runs.BOARDS[board], number] + ["–"] * 5)
            continue
        each[board, number] = own = r["cycles"] / pixels
        waited = [" to ".join(dict.fromkeys(count(cycles.waiting(r, waits, prefetch) / pixels)
                                            for prefetch in (True, False))) for waits in (2, 5)]
        energy = part.charge and cycles.waiting(r, part.waits) / pixels * part.charge * part.volts * 1e-6
        rows.append([runs.BOARDS[board], number, count(r["instructions"] / pixels),
                     f"{count(own)} (−{1 - r['least'] / r['cycles']:.0%}, +{r['most'] / r['cycles'] - 1:.0%})", *waited,
                     f"{energy:.{0 if energy > 10 else 1}f}" if energy else "–"])
    parts = [f"{runs.BOARDS[b]} {p.name} at {p.clock / 1e6:.0f} MHz, wait states {p.waits}, {p.charge:.3g} µA/MHz at "
             f"{p.volts} V" for b, p in cycles.PARTS.items() if p.charge]
    head = ["core", "number", "instructions/pixel", "cycles/pixel", "2 wait states", "5 wait states", "µJ/pixel"]
    quicker = each["mps2_an386", DEFAULT.number] / each["mps2_an500", DEFAULT.number]
    return (f"`{scene}`. In brackets: how far a manual's range of timings reaches. With wait states: cycles a pixel "
            f"behind a prefetch buffer, and without one.\n\n{table(head, rows)}\n"
            f"Energy is that of the part's data sheet: {'; '.join(parts)}.\n"
            f"The M7's model is {quicker:.2f} times as quick as the M4's in `{DEFAULT.number}`; in CoreMark, as "
            f"published, an M7 is {cycles.COREMARK:.2f} times as quick.\n")


def seen(study):
    """How far each setting's picture is off, and what an eye sees of it."""
    rows = []
    for setting in study.settings:
        found = [study.errors[scene][setting] for scene in study.scenes]
        rows.append([settings.label(setting)] + [form.format(e[name]) if e else "–" for e in found
                    for name, form in (("total psnr", "{:.1f}"), ("total flip", "{:.3f}"), ("total seen", "{:.1%}"))])
    head = ["setting"] + [f"{figures.name_of(s)}: {what}" for s in study.scenes for what in ("dB", "FLIP", "seen")]
    return ("How far each setting is off the best picture: PSNR, the mean of FLIP, and the share of pixels whose "
            f"difference an eye sees.\n\n{table(head, rows)}")


def steps(study):
    """Where the instructions of q32 and of soft float go on the M0 and the M3."""
    scene = list(study.scenes)[-1]
    columns = [(b, n) for b in ("microbit", "mps2_an385") for n in ("q32", "float")]
    found = [study.profiles.get((scene, b, n)) for b, n in columns]
    if not all(found):
        return ""
    pixels = [math.prod(map(int, study_file.traced_size(b, n).split("x"))) for b, n in columns]
    rows = []
    for step in ["camera", *cycles.SHAPES.values(), *list(cycles.FILES)[1:]]:
        rows.append([step] + [count(p["steps"].get(step, 0) / area) for p, area in zip(found, pixels)])
    rows.append(["all"] + [count(sum(p["steps"].values()) / area) for p, area in zip(found, pixels)])
    rows.append(["of these, roots and quotients"]
                + [count(p["roots"] / area) for p, area in zip(found, pixels)])
    head = ["instructions/pixel"] + [f"{runs.BOARDS[b]} {n}" for b, n in columns]
    return f"Where the instructions go, `{scene}`:\n\n{table(head, rows)}"


def conclusions_report():
    study = study_file.run()
    study.draw(FIGURES)
    return f"![M0: accuracy against instructions]({FIGURES}/m0.svg)\n\n{sentences(Numbers(study))}\n"


def study_report():
    study = study_file.run()
    study.draw(FIGURES)
    n = Numbers(study)
    shown = [runs.BOARDS[b] for b in study_file.BOARDS]
    plots = "".join(f"![{name}: accuracy against instructions]({FIGURES}/{name.lower()}.svg)\n"
                    for name in shown)
    return (f"{plots}\n{costs(n)}\n{seen(study)}\n"
            f"![Error against bits]({FIGURES}/bits.svg)\n"
            f"![Time and error against samples]({FIGURES}/samples.svg)\n"
            f"![The showcase in each number system]({FIGURES}/panel.svg)\n\n{steps(study)}")


def judged():
    """The scenes that the independent renderer draws: those without radiosity."""
    return [scene for scene in sorted(glob.glob("scenes/*.nff")) if "\nradiosity " not in runs.text_of(scene)]


def accuracy_report():
    """Each scene in each number system against the independent renderer."""
    rows, numbers, size, to = [], runs.numbers(), "160x120", "build/study/accuracy.ppm"
    os.makedirs("build/study", exist_ok=True)
    for scene in judged():
        subprocess.run(["build/oracle", scene, "-o", to, "-s", size], check=True)
        truth = pictures.read(to)
        row = [f"`{scene}`"]
        for number in numbers:
            if pictures.draw(scene, size, DEFAULT._replace(number=number), to=to):
                own = pictures.read(to)
                off = (own != truth).any(2).sum()
                row.append(f"{pictures.errors(own, truth)['psnr']:.0f} dB, {off}" if off else "equal")
            else:
                row.append("–")
        rows.append(row)
    pixels = count(math.prod(map(int, size.split("x"))))
    return (f"PSNR in dB, and how many of {pixels} pixels differ at all; one sample, "
            f"{size.replace('x', ' × ')}:\n\n" + table(["scene"] + numbers, rows))


REPORTS = {
    "time": (time_report, lambda: [f"| {short} | {n} |" for short in runs.BOARDS.values() for n in runs.numbers()]),
    "accuracy": (accuracy_report,
                 lambda: judged() + [f"| {n} |" for n in runs.numbers()]),
    "conclusions": (conclusions_report, lambda: ["figures/m0.svg"]),
    "study": (study_report, lambda: [f"figures/{s.lower()}.svg" for b, s in runs.BOARDS.items()
                                     if b in study_file.BOARDS]
              + [f"| {runs.BOARDS[b]} | {n} |" for b in study_file.BOARDS for n in runs.numbers()]
              + [figures.name_of(s) for s in study_file.SCENES]),
}
