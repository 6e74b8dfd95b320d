"""The study's plots; see svg.py for how they are drawn."""

import math
import os
import subprocess

import runs
import settings
import svg

COLOURS = {"q16": "#c0392b", "q32": "#1f5fa8", "float": "#1a8f4c", "double": "#8e44ad"}
OTHERS = ["#b9770e", "#117a8b"]
SHAPES = {"q16": "triangle", "q32": "circle", "float": "square", "double": "diamond"}
COST = "instructions/pixel at error size"
BITS = {"q16": 16, "q32": 32, "float": 32, "double": 64}


def colour(number):
    return COLOURS.get(number, OTHERS[hash(number) % 2])


def frontier_of(points):
    """The points that no other is both cheaper and as good as: [(cost, decibels, ...)], cheapest first. Less
    than 0.05 dB is no gain."""
    out = []
    for point in sorted(points, key=lambda p: (p[0], -p[1])):
        if not out or point[1] > out[-1][1] + 0.05:
            out.append(point)
    return out


def range_of(values, log=False, room=0.12):
    low, high = min(values), max(values)
    if log:
        room = (high / low) ** room * 1.15
        return low / room, high * room, True
    room = max(0.5, (high - low) * room)
    return low - room, high + room, False


def name_of(scene):
    return os.path.basename(scene).removesuffix(".nff")


def frontier(study, board, path):
    """Accuracy against instructions, a plot for each scene."""
    scenes, width = list(study.scenes), 330
    out = svg.Svg(max(60 + len(scenes) * (width + 20), 760), 440)
    rows = [r for r in study.rows if r["board"] == board]
    y_range = range_of([r["total psnr"] for r in rows])
    for k, scene in enumerate(scenes):
        points = [(r[COST], r["total psnr"], r) for r in rows if r["scene"] == scene]
        best = frontier_of(points)
        plot = svg.Plot(out, (60 + k * (width + 20), 70, width, 290), range_of([p[0] for p in points], True),
                        y_range, name_of(scene), "instructions a pixel", "accuracy (dB)" if k == 0 else None)
        steps = []
        for i, (a, b, _) in enumerate(best):
            if i:
                steps.append((a, best[i - 1][1]))
            steps.append((a, b))
        steps.append((plot.x.high, best[-1][1]))
        plot.line(steps, "#223", 1.4, keep_clear=True)
        for a, b, r in sorted(points, key=lambda p: any(p[2] is q[2] for q in best)):
            pale = not any(r is q[2] for q in best)
            plot.mark(a, b, SHAPES.get(r["number"], "circle"), colour(r["number"]),
                      settings.label(r["setting"]), pale)
        plot.finish()
    out.text(60, 24, f"{runs.BOARDS[board]}: what accuracy costs", 16, weight="bold")
    x = 60
    numbers = list(dict.fromkeys(r["number"] for r in rows))
    for n in numbers:
        out.mark(x + 5, 40, SHAPES.get(n, "circle"), colour(n))
        out.text(x + 14, 44, n, 12)
        x += 30 + 8 * len(n)
    out.line([(x, 40), (x + 24, 40)], "#223", 1.4)
    out.text(x + 30, 44, "nothing else is both cheaper and better;  pale: something is", 12)
    size = study.error_size.replace("x", " × ")
    out.text(60, 412, f"Accuracy: PSNR to double with 256 samples and depth 8, {size} pixels. Instructions: of "
             "its rays, each as in a small picture.", 11, colour=svg.GREY)
    out.text(60, 427, "What a label does not say is q32, 1 sample, depth 5, cutoff 0.0014; a2 and a3 sample "
             "adaptively.", 11, colour=svg.GREY)
    out.write(path, f"{runs.BOARDS[board]}: accuracy against instructions")


def bits(study, path):
    """Arithmetic error of each number system: a mark for each scene."""
    numbers = runs.numbers()
    out = svg.Svg(640, 400)
    values = {n: [(v[n, *settings.DEFAULT[1:]].get("arithmetic psnr"), scene)
                  for scene, v in study.everywhere.items() if v.get((n, *settings.DEFAULT[1:]))]
              for n in numbers if n != "double"}
    known = [p for v in values.values() for p, _ in v]
    low, _, _ = range_of(known + [99])
    plot = svg.Plot(out, (60, 60, 550, 270), (0, len(values), False), (low, 103, False),
                    "Error of the arithmetic alone: a mark for each scene", None, "accuracy (dB)")
    for k, (n, points) in enumerate(values.items()):
        for i, (p, scene) in enumerate(sorted(points)):
            spread = (i - (len(points) - 1) / 2) * min(0.05, 0.7 / max(len(points), 1))
            plot.mark(k + 0.5 + spread, p, SHAPES.get(n, "circle"), colour(n), size=4.5,
                      label=name_of(scene) if p == min(points)[0] and p < 99 and i == 0 else "")
        if points:
            middle = sorted(p for p, _ in points)[len(points) // 2]
            plot.line([(k + 0.1, middle), (k + 0.9, middle)], colour(n), 1.2, "4 3")
        out.text(plot.x(k + 0.5), 347, f"{n}: {BITS.get(n, '?')} bits", 13, "middle", colour(n), "bold")
    plot.finish()
    out.text(60, 24, "Error against bits", 16, weight="bold")
    out.text(60, 378, f"PSNR to double at the same settings, {study.error_size.replace('x', ' × ')} pixels; "
             "99: not a byte differs. Dashed: the median.", 11, colour=svg.GREY)
    out.write(path, "Arithmetic error of each number system")


def mean_samples(study, scene, setting):
    """Samples a pixel, from the rays of each: adaptive sampling has no number of its own."""
    if setting[1][0] != "a":
        return float(setting[1])
    e = study.errors[scene]
    return e[setting]["rays"] / e[settings.DEFAULT]["rays"]


def samples(study, path):
    """Instructions and error against samples."""
    out = svg.Svg(860, 430)
    boards = {b: i for i, b in enumerate(settings.STUDIED)}
    tones = ["#b9770e", "#1f5fa8", "#8e44ad", "#1a8f4c"]
    scene = list(study.scenes)[-1]
    chosen = [r for r in study.rows if r["scene"] == scene and r["number"] == "q32"
              and r["setting"][2:] == settings.DEFAULT[2:]]
    base = {r["board"]: r[COST] for r in chosen if r["samples"] == "1"}
    points = [(mean_samples(study, scene, r["setting"]), r[COST] / base[r["board"]], r)
              for r in chosen]
    x_range = range_of([p[0] for p in points], True, 0.08)
    left = svg.Plot(out, (60, 70, 345, 290), x_range, range_of([p[1] for p in points], True, 0.08),
                    f"time, {name_of(scene)}", "samples a pixel", "instructions, 1 sample = 1")
    left.line([(max(left.x.low, left.y.low), max(left.x.low, left.y.low)),
               (min(left.x.high, left.y.high), min(left.x.high, left.y.high))], "#aab", 1, "4 3")
    for board, i in boards.items():
        own = sorted(p[:2] for p in points if p[2]["board"] == board and p[2]["samples"][0] != "a")
        for a, b, r in points:
            if r["board"] == board:
                adaptive = r["samples"][0] == "a"
                left.mark(a, b, "diamond" if adaptive else "circle", tones[i],
                          r["samples"].split(",")[0] if adaptive and i == 0 else "", size=6 - i)
        left.line(own, tones[i], 1)
        out.mark(70, 88 + 18 * i, "circle", tones[i])
        out.text(80, 92 + 18 * i, runs.BOARDS[board], 12)
    left.finish()
    errors = []
    for k, at in enumerate(study.scenes):
        for setting, e in study.errors[at].items():
            if setting[0] == "q32" and setting[2:] == settings.DEFAULT[2:] and e:
                errors.append((mean_samples(study, at, setting), e["total rms"], setting, k))
    right = svg.Plot(out, (470, 70, 345, 290), x_range, range_of([e[1] for e in errors], True, 0.08),
                     "error", "samples a pixel", "levels, rms")
    for k, at in enumerate(study.scenes):
        own = sorted(e[:2] for e in errors if e[3] == k and e[2][1][0] != "a")
        right.line(own, tones[k], 1.2)
        for a, b, setting, which in errors:
            if which == k:
                adaptive = setting[1][0] == "a"
                right.mark(a, b, "diamond" if adaptive else "circle", tones[k],
                           setting[1].split(",")[0] if adaptive else "")
        out.mark(480, 320 + 18 * k - 18, "circle", tones[k])
        out.text(490, 324 + 18 * k - 18, name_of(at), 12)
    right.finish()
    out.text(60, 24, "Time and error against samples, q32", 16, weight="bold")
    out.text(60, 412, "Diamonds: adaptive sampling, at the mean of its samples. Dashed: time that grows as "
             "the samples do.", 11, colour=svg.GREY)
    out.write(path, "Time and error against samples")


def read_ppm(path):
    with open(path, "rb") as file:
        data = file.read()
    width, height = map(int, data.split(b"\n")[1].split())
    return width, height, data[-3 * width * height:]


# Colours of a difference in levels: black 0, then doubling.
HEAT = [(0, (0, 0, 0)), (1, (40, 60, 160)), (2, (30, 150, 190)), (4, (60, 190, 90)), (8, (240, 220, 60)),
        (16, (245, 140, 40)), (32, (230, 50, 40)), (64, (255, 190, 220)), (128, (255, 255, 255))]


def heat(level):
    at = 0
    while at + 1 < len(HEAT) and HEAT[at + 1][0] <= level:
        at += 1
    return bytes(HEAT[at][1])


def difference(a, b):
    table = [heat(level) for level in range(256)]
    return b"".join(table[max(abs(a[i] - b[i]), abs(a[i + 1] - b[i + 1]), abs(a[i + 2] - b[i + 2]))]
                    for i in range(0, len(a), 3))


def panel(study, path):
    """The showcase in each number system beside its error, and what one sample costs."""
    scene = "scenes/showcase.nff"
    size = "64x48" if study.quick else "160x120"

    def draw(name, *options):
        to = f"{study.folder}/panel-{name}.ppm"
        done = subprocess.run(["build/qray", scene, "-q", "-s", size, "-o", to, *options],
                              capture_output=True)
        return read_ppm(to) if done.returncode == 0 else None

    exact = draw("double", "-n", "double")
    pictures = [(n, draw(n, "-n", n), exact, "double") for n in runs.numbers() if n != "double"]
    best = draw("best", "-n", "double", "-r", "256", "-d", "8")
    pictures.append(("q32, 1 sample", draw("q32", "-n", "q32"), best, "256 samples"))
    pictures.append(("q32, 16 samples", draw("many", "-n", "q32", "-r", "16"), best, "256 samples"))
    wide, high, gap = 200, 150, 12
    out = svg.Svg(gap + len(pictures) * (wide + gap), 2 * high + 120)
    out.text(gap, 22, "The showcase in each number system, and how far it is off", 16, weight="bold")
    for k, (name, picture, truth, against) in enumerate(pictures):
        x = gap + k * (wide + gap)
        out.text(x, 44, name, 13, weight="bold")
        if picture is None:
            out.text(x, 64, "does not fit", 12)
            continue
        width, height, rgb = picture
        rms = math.sqrt(sum((p - q) ** 2 for p, q in zip(rgb, truth[2])) / len(rgb))
        out.text(x + wide, 44, f"{20 * math.log10(255 / rms):.0f} dB" if rms > 0 else "equal", 12, "end",
                 svg.GREY)
        out.image(x, 52, wide, high, svg.png(width, height, rgb))
        out.image(x, 52 + high + 20, wide, high, svg.png(width, height, difference(rgb, truth[2])))
        out.text(x, 52 + high + 14, f"off {against} by", 11, colour=svg.GREY)
    y = 52 + 2 * high + 32
    out.text(gap, y + 12, "levels", 12)
    for k, (level, rgb) in enumerate(HEAT):
        out.rect(gap + 52 + 58 * k, y, 24, 16, "#%02x%02x%02x" % rgb, "#889")
        end = f"{level}" if k < 2 else f"{level}+"
        out.text(gap + 80 + 58 * k, y + 12, end, 11, colour=svg.GREY)
    out.write(path, "The showcase in each number system")
