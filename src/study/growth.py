"""Cost against the number of shapes: balls on balls, 10 to 66,430 of them, on boards as far as their flash holds."""

import math
import os
import re
import subprocess

import figures
import runs
from pictures import draw
from programs import environment
from settings import DEFAULT
from tables import count, table

FOLDER = "build/study/growth"
SIZE = "32x24"
BOARDS = {board: runs.BOARDS[board] for board in ("microbit", "mps2_an385", "rv32_virt")}
NUMBERS = ["q32", "float"]
FACTS = ["instructions/ray", "flash", "stack"]
SCENES = ["knot", "patches", "shadows", "castle"]
VIEW = """v from 2.1 1.3 1.7  at 0 0 0  up 0 0 1
  angle 45  hither 0.01  resolution 512 512
b 0.1 0.3 0.7
l 4 3 2  0.6 0.6 0.6
l 1 -4 4  0.4 0.4 0.4
material colour 0.6 0.6 0.55 diffuse 0.8
p 4  4 4 -0.5  -4 4 -0.5  -4 -4 -0.5  4 -4 -0.5
material colour 1 0.8 0.4 diffuse 0.6 highlight 0.5 shine 20 mirror 0.3
"""


def balls(steps):
    """A ball; on each ball of the step before nine of a third of its radius: six around it, three above."""
    out, last = [], [((0, 0, 0), 0.5, (0, 0, 1))]
    for step in range(steps + 1):
        out += last
        following = []
        for centre, r, (nx, ny, nz) in last if step < steps else []:
            # Two axes beside the one that points away from the ball below.
            ux, uy, uz = (0, -nz, ny) if abs(nx) < 0.6 else (nz, 0, -nx)
            length = math.sqrt(ux * ux + uy * uy + uz * uz)
            u = ux, uy, uz = ux / length, uy / length, uz / length
            v = (ny * uz - nz * uy, nz * ux - nx * uz, nx * uy - ny * ux)
            for turn, rise in [(i * 60, 0) for i in range(6)] + [(i * 120 + 30, 54.7356) for i in range(3)]:
                a, b = math.radians(turn), math.radians(rise)
                way = tuple(math.cos(b) * (math.cos(a) * p + math.sin(a) * q) + math.sin(b) * n
                            for p, q, n in zip(u, v, (nx, ny, nz)))
                following.append((tuple(c + r * 4 / 3 * w for c, w in zip(centre, way)), r / 3, way))
        last = following
    return out


def write():
    """{number of balls: scene}"""
    os.makedirs(FOLDER, exist_ok=True)
    out = {}
    for steps in range(1, 6):
        all_balls = balls(steps)
        out[len(all_balls)] = path = f"{FOLDER}/balls-{len(all_balls)}.nff"
        with open(path, "w") as file:
            file.write(VIEW + "".join("s {:.7g} {:.7g} {:.7g} {:.7g}\n".format(*c, r) for c, r, _ in all_balls))
    return out


def on_desktop(scene, number):
    """Instructions a ray of one thread, by callgrind: the difference of two sizes, which is without reading."""
    def of(size):
        to = f"{FOLDER}/callgrind.{os.getpid()}"
        done = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={to}", "build/qray", scene, "-q",
                               "-j", "1", "-n", number, "-s", size, "-o", "/dev/null"],
                              capture_output=True, text=True, check=True, env=environment())
        os.remove(to)
        return (int(re.search(r"Collected : (\d+)", done.stderr)[1]),
                draw(scene, size, DEFAULT._replace(number=number))["rays"])

    (few, rays), (many, more) = of("8x6"), of("64x48")
    return (many - few) / (more - rays)


def report():
    grown = write()
    shown = {f"`scenes/{name}.nff`": f"scenes/{name}.nff" for name in SCENES}
    shown.update({f"{count(n)} balls": grown[n] for n in (91, 820)})
    lines = {(BOARDS[board], number): {n: runs.Run(board, scene, number, SIZE) for n, scene in grown.items()}
             for board in BOARDS for number in NUMBERS}
    rows = {(scene, board): runs.Run(board, scene, "q32", SIZE) for scene in shown.values() for board in BOARDS}
    runs.perform([run for line in lines.values() for run in line.values()] + list(rows.values()))
    fitting = {key: {n: run.result["instructions/ray"] for n, run in line.items() if "refused" not in run.result}
               for key, line in lines.items()}
    for number in NUMBERS:
        fitting["desktop", number] = {n: on_desktop(scene, number) for n, scene in grown.items()}
    figures.growth(fitting, f"{figures.FIGURES}/growth.svg")

    ends = ", ".join(f"{b} after {count(max(line))}" for (b, n), line in fitting.items()
                     if n == "q32" and len(line) < len(grown))
    first = min(grown)
    times = ", ".join(f"{line[max(line)] / line[first]:.1f} ({b}, {count(max(line))} balls)"
                      for (b, n), line in fitting.items() if n == "q32")
    made = [[name, count(draw(scene, "8x6", DEFAULT)["objects"])]
            + [count(rows[scene, b].result[f]) if "refused" not in rows[scene, b].result else "–"
               for b in BOARDS for f in FACTS] for name, scene in shown.items()]
    head = ["scene", "shapes"] + [f"{b} {f}" for b in BOARDS.values() for f in FACTS]
    return (f"![Instructions a ray against the number of balls]({figures.FIGURES}/growth.svg)\n\n"
            f"A ray in `q32` takes so many times the instructions of one among {count(first)} balls: {times}.\n"
            f"A line ends where the next scene is larger than the board's flash: {ends or 'none'}.\n\n"
            f"`q32`, {SIZE.replace('x', ' × ')} pixels:\n\n{table(head, made)}")


REPORTS = {"growth": (report, lambda: ["figures/growth.svg"] + [f"scenes/{name}.nff" for name in SCENES])}
