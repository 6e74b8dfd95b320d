"""The study's plots."""

import io
import math
import os
import re

import matplotlib
import matplotlib.pyplot as plt

import cycles
import pictures
import runs
import settings

FIGURES = "src/study/figures"  # of the pages
matplotlib.use("svg")
# The same bytes at each run, and text that stays text.
plt.rcParams.update({"svg.hashsalt": "qray", "svg.fonttype": "none", "font.size": 9, "axes.grid": True,
                     "font.sans-serif": ["DejaVu Sans", "Verdana"],
                     "axes.axisbelow": True, "grid.color": "#dde", "legend.frameon": False,
                     "figure.constrained_layout.use": True})
COLOURS = {"q16": "#c0392b", "q24": "#d68910", "q32": "#1f5fa8", "float": "#1a8f4c", "double": "#8e44ad"}
MARKS = {"q16": "^", "q24": "v", "q32": "o", "float": "s", "double": "D"}
BITS = {"float": 32, "double": 64}  # of others their names say it
TONES = ["#b9770e", "#1f5fa8", "#8e44ad", "#1a8f4c"]
COST = "instructions/pixel at error size"
CYCLES, WAIT = "cycles/pixel at error size", "cycles/pixel and wait state"


def frontier_of(points):
    """The points that no other is both cheaper and as good as: [(cost, decibels, ...)], cheapest first. Less
    than 0.05 dB is no gain."""
    out = []
    for point in sorted(points, key=lambda p: (p[0], -p[1])):
        if not out or point[1] > out[-1][1] + 0.05:
            out.append(point)
    return out


def name_of(scene):
    return os.path.basename(scene).removesuffix(".nff")


def number_style(number, **more):
    return {"color": COLOURS.get(number, "#117a8b"), "marker": MARKS.get(number, "v"), "linestyle": "", **more}


def save(figure, path, title, note=""):
    figure.suptitle(title, fontweight="bold")
    if note:
        figure.supxlabel(note, fontsize=8, color="#667")
    drawn = io.StringIO()
    figure.savefig(drawn, metadata={"Date": None, "Title": title})
    plt.close(figure)
    with open(path, "w") as file:  # an element in a line, and none that is empty
        file.write(re.sub(r'\n(?=[^ <])|\n *<g id="[^"]*"/>', "", drawn.getvalue()))


def log_axis(axis):
    """Numbers as people write them, and not too many."""
    axis.set_major_formatter(matplotlib.ticker.EngFormatter(sep=""))
    axis.set_minor_formatter(matplotlib.ticker.NullFormatter())
    axis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5)))


WAYS = {"1": "1 sample", "a2,0.0625": "adaptive, 2 levels", "a3,0.03125": "adaptive, 3 levels"}
PICTURE = 160 * 120  # pixels


def means(study, board):
    """{number: [(seconds of a picture, dB, samples), ...]} of depth and cutoff by default: the mean of the scenes."""
    out, part = {}, cycles.PARTS[board]
    for setting in study.settings:
        of = [r for r in study.rows if r["board"] == board and r["setting"] == setting]
        if len(of) == len(study.scenes) and setting[2:] == settings.DEFAULT[2:] and setting.number != "double":
            taken = [r[CYCLES] + part.waits * r[WAIT] for r in of]
            cost = math.exp(sum(map(math.log, taken)) / len(of)) * PICTURE / part.clock
            decibels = sum(r["total psnr"] for r in of) / len(of)
            out.setdefault(setting.number, []).append((cost, decibels, setting.samples))
    return {number: sorted(points) for number, points in out.items()}


def frontier(study, board, path):
    """Accuracy against time, a line for each number system and a point for each way to sample."""
    figure, axes = plt.subplots(figsize=(7.6, 4.4))
    lines = means(study, board)
    best = frontier_of([p for line in lines.values() for p in line])
    axes.step([p[0] for p in best], [p[1] for p in best], "#d5dae6", where="post", linewidth=7, zorder=1)
    last, low = 0, False
    for number, line in sorted(lines.items(), key=lambda item: item[1]):
        style, good = number_style(number), frontier_of(line)
        axes.plot(*zip(*[p[:2] for p in good]), **{**style, "linestyle": "-"}, linewidth=1.2)
        axes.plot(*zip(*[p[:2] for p in line]), **style, fillstyle="none")
        # Names stand below the first points, those that would meet in two rows.
        low, last = line[0][0] < last * 1.35 and not low, line[0][0]
        axes.annotate(number, line[0][:2], (0, -30 if low else -17), textcoords="offset points", ha="center",
                      color=style["color"], fontweight="bold", fontsize=11)
    # What the points are stands once, beside the line that has them all.
    for cost, decibels, samples in max(lines.values(), key=len):
        axes.annotate(WAYS.get(samples, samples + " samples"), (cost, decibels), (8, -4), textcoords="offset points",
                      color="#334")
    part = cycles.PARTS[board]
    waits = f"{part.waits or 'no'} wait state" + "s" * (part.waits != 1)
    axes.set(xscale="log", ylabel="accuracy (dB)",
             xlabel=f"seconds for 160 × 120 pixels at {part.clock / 1e6:.0f} MHz ({part.name})")
    log_axis(axes.xaxis)
    # Room for labels, below and at the right.
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    axes.set(xlim=(left, right * (right / left) ** 0.12), ylim=(low - 0.16 * (high - low), high + 0.05 * (high - low)))
    save(figure, path, f"{runs.BOARDS[board]}: what accuracy costs",
         f"Mean of {listed_names(study)}. Accuracy: PSNR to double with 256 samples. Grey: nothing else is both\n"
         f"cheaper and better. Seconds: cycles as modelled, {waits} for flash.")


def listed_names(study):
    return ", ".join(map(name_of, study.scenes))


def bits(study, path):
    """Arithmetic error of each number system: a mark for each scene."""
    figure, axes = plt.subplots(figsize=(6.4, 4))
    numbers = [n for n in runs.numbers() if n != "double"]
    for k, n in enumerate(numbers):
        setting = settings.DEFAULT._replace(number=n)
        of = sorted((v[setting]["arithmetic psnr"], scene) for scene, v in study.everywhere.items() if v.get(setting))
        if of:
            style = number_style(n)
            axes.plot([k + 0.02 * (i - len(of) / 2) for i in range(len(of))], [p for p, _ in of], **style)
            axes.hlines(of[len(of) // 2][0], k - 0.4, k + 0.4, style["color"], "--", linewidth=1)
            axes.annotate(name_of(of[0][1]) if of[0][0] < 99 else "", (k - 0.01 * len(of), of[0][0]), (6, -8),
                          textcoords="offset points", fontsize=7)
    axes.set_xticks(range(len(numbers)), [f"{n}: {BITS.get(n) or n[1:]} bits" for n in numbers])
    axes.set_ylabel("accuracy (dB)")
    save(figure, path, "Error of the arithmetic alone: a mark for each scene",
         f"PSNR to double at the same settings, {study.error_size} pixels; 99: not a byte differs. Dashed: the median.")


def mean_samples(study, scene, setting):
    """Samples a pixel, from the rays of each: adaptive sampling has no number of its own."""
    if setting.samples[0] != "a":
        return float(setting.samples)
    e = study.errors[scene]
    return e[setting]["rays"] / e[settings.DEFAULT]["rays"]


def samples(study, path):
    """Instructions and error against samples."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 4.2))

    def draw(axes, name, tone, points):
        """Of [(samples, value, whether adaptive)]."""
        own = sorted(p[:2] for p in points if not p[2])
        axes.plot(*zip(*own), "o-", color=tone, label=name, linewidth=1)
        axes.plot([p[0] for p in points if p[2]], [p[1] for p in points if p[2]], "D", color=tone)

    scene = list(study.scenes)[-1]
    for board, tone in zip(settings.STUDIED, TONES):
        chosen = [r for r in study.rows if r["scene"] == scene and r["board"] == board and r["number"] == "q32"
                  and r["setting"][2:] == settings.DEFAULT[2:]]
        base = next(r[COST] for r in chosen if r["samples"] == "1")
        draw(left, runs.BOARDS[board], tone, [(mean_samples(study, scene, r["setting"]), r[COST] / base,
                                               r["samples"][0] == "a") for r in chosen])
    left.axline((1, 1), (2, 2), color="#aab", linestyle="--", linewidth=1)
    left.set(title=f"time, {name_of(scene)}", ylabel="instructions, 1 sample = 1")
    for at, tone in zip(study.scenes, TONES):
        draw(right, name_of(at), tone, [(mean_samples(study, at, s), e["total rms"], s[1][0] == "a")
                                        for s, e in study.errors[at].items()
                                        if s[0] == "q32" and s[2:] == settings.DEFAULT[2:] and e])
    right.set(title="error", ylabel="levels, rms")
    for axes in (left, right):
        axes.set(xscale="log", yscale="log", xlabel="samples a pixel")
        log_axis(axes.xaxis)
        log_axis(axes.yaxis)
        axes.legend()
    save(figure, path, "Time and error against samples, q32",
         "Diamonds: adaptive sampling, at the mean of its samples. Dashed: time that grows as the samples do.")


def panel(study, path):
    """The showcase in each number system beside its error, and what one sample costs."""
    size = "64x48" if study.quick else "160x120"

    def draw(**dials):
        to, setting = f"{study.folder}/panel.ppm", settings.DEFAULT._replace(**dials)
        return pictures.draw("scenes/showcase.nff", size, setting, to=to) and pictures.read(to)

    exact, best = draw(number="double"), draw(number="double", samples="256", depth=8)
    shown = [(n, draw(number=n), exact, "double") for n in runs.numbers() if n != "double"]
    shown += [("q32, 1 sample", draw(), best, "256 samples"),
              ("q32, 16 samples", draw(samples="16"), best, "256 samples")]
    shown = [p for p in shown if p[1] is not None]
    figure, plots = plt.subplots(2, len(shown), figsize=(2.2 * len(shown), 4.4))
    for (above, below), (name, picture, truth, against) in zip(plots.T, shown):
        apart = pictures.errors(picture, truth)
        off = f"{apart['psnr']:.0f} dB, {apart['seen']:.0%} seen" if apart["rms"] else "equal"
        above.set_title(f"{name}: {off}", fontsize=9)
        above.imshow(picture, interpolation="none")
        below.set_title(f"off {against} by", fontsize=8)
        errors = below.imshow(abs(picture - truth).max(2), interpolation="none", cmap="inferno",
                             norm=matplotlib.colors.SymLogNorm(1, vmin=0, vmax=255))
        above.axis("off")
        below.axis("off")
    bar = figure.colorbar(errors, ax=plots.ravel().tolist(), orientation="horizontal", fraction=0.04, pad=0.02,
                          ticks=[0, 1, 4, 16, 64, 255], format="%d", label="levels")
    bar.minorticks_off()
    save(figure, path, "The showcase in each number system, and how far it is off")


def steps(b, cost, target, path):
    """Of bits.py: accuracy by step and bits, those that need the most first, and what a step takes on boards."""
    boards = list(dict.fromkeys(board for board, _ in cost))
    figure, ((heat, *prices),) = plt.subplots(1, 1 + len(boards), figsize=(8.6 + 2.6 * len(boards), 8), sharey=True,
                                              squeeze=False, width_ratios=[6] + [2] * len(boards))
    medians = {name: b.median(row) for name, row in b.at.items() if row}
    names = sorted(medians, key=lambda name: (-(b.needed(medians[name]) or math.inf), sum(medians[name])))
    values = [b.median(b.together), *(medians[name] for name in names)]
    # Few tones, so that one tells them apart: each is worth 10 dB.
    levels = [0, 20, 30, 40, 50, target, 100]
    tones = matplotlib.colors.ListedColormap(["#a63603", "#e6550d", "#fd8d3c", "#fdbe85", "#feedde", "#c7e0f1"])
    picture = heat.imshow(values, aspect="auto", cmap=tones,
                          norm=matplotlib.colors.BoundaryNorm(levels, len(tones.colors)))
    for y, row in enumerate(values):
        for x, value in enumerate(row):
            heat.text(x, y, f"{math.floor(value)}", ha="center", va="center", fontsize=10,
                      color="white" if value < 30 else "black")
        enough = b.needed(row)
        if enough:
            at = b.bits.index(enough) - 0.5
            heat.plot([at, at], [y - 0.5, y + 0.5], color="black", linewidth=2.5)
    heat.axhline(0.5, color="white", linewidth=4)
    heat.set_xticks(range(len(b.bits)), b.bits, fontsize=10)
    heat.set_yticks(range(len(values)), ["all together", *(b.what[name] for name in names)], fontsize=10)
    heat.set_xlabel("bits behind the point of this step alone", fontsize=10)
    heat.set_title(f"PSNR in dB, median of scenes; {target} or more from the black line on", fontsize=10)
    heat.grid(False)
    heat.tick_params(length=0)
    figure.colorbar(picture, ax=heat, orientation="horizontal", fraction=0.03, pad=0.01, ticks=levels[1:-1],
                    label="dB")
    for axes, board in zip(prices, boards):
        own = {number: cost[board, number] for of, number in cost if of == board}
        for y, name in enumerate(names, 1):
            row = [of[name] for of in own.values() if of[name] >= 0.5]
            axes.plot(row, [y] * len(row), color="#99a", linewidth=1, zorder=1)
        for number, of in own.items():
            axes.plot(*zip(*((of[name], y) for y, name in enumerate(names, 1) if of[name] >= 0.5)),
                      **number_style(number, label=number, markersize=7))
        axes.set_xscale("log")
        log_axis(axes.xaxis)
        axes.set_title(f"instructions a call, {runs.BOARDS[board]}", fontsize=10)
        axes.tick_params(axis="y", length=0)
    if prices:
        prices[0].legend(loc="upper center", ncols=3, fontsize=9, columnspacing=0.8, handletextpad=0.1, borderpad=0)
    save(figure, path, "What each bit of each step buys, and what a step takes",
         f"One step rounds, all else is double; PSNR to double, {b.size} pixels. No instructions: stands in tables.")


def growth(lines, path):
    """Instructions a ray against shapes: {(board, number): {shapes: instructions}}."""
    figure, axes = plt.subplots(figsize=(7.6, 4.6))
    tones = dict(zip(dict.fromkeys(board for board, _ in lines), TONES))
    for (board, number), line in lines.items():
        axes.plot(*zip(*sorted(line.items())), color=tones[board], marker=MARKS[number], linewidth=1,
                  linestyle="-" if number == "q32" else "--", label=f"{board} {number}")
    axes.set(xscale="log", yscale="log", xlabel="balls", ylabel="instructions a ray")
    log_axis(axes.xaxis)
    log_axis(axes.yaxis)
    axes.legend(ncols=2, fontsize=8)
    save(figure, path, "Growth of cost with the number of shapes",
         "Balls on balls. A board's line ends where its flash does.")
