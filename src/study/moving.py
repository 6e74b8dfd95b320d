"""What it costs on boards to move something: a firmware that draws one pixel a frame, of the background, and moves so
many times before it, less one that moves nothing; and a whole frame."""

import hashlib
import math
import os

import runs
from settings import fixed_numbers
from tables import count, table

FOLDER = "build/study/moving"
WITHIN, TIMES, FRAMES = "-7,-1,-7,7,7,7", 16, 4
# The scene by what is seen of it, and where the eye looks for that.
SCENES = {f"{FOLDER}/moves.nff": "0 1 0", f"{FOLDER}/moves_behind.nff": "0 4 9"}
BOARDS = ["microbit", "mps2_an385", "rv32_virt"]
TURN = "motion.about(scene::view.at).turn(scene::view.up, qray::part_of_turn(frame * {times} + i, 97));"
CORNERS = ("qray::Corners<N>{{scene::first_vertices.data, scene::first_normals.data}}, motion, scene::{0}[0], "
           "qray::MovedCorners<N>{{scene::vertices.data, scene::normals.data}}")
# A row's name, and what is done.
MOVES = {
    "camera, by `look_at`": "auto view = scene::view; "
                            "view.eye.x = view.eye.x + qray::coordinate<N>(static_cast<int32_t>(i), 64);"
                            " well = look_at(scene::camera, scene::frame, view) && well;",
    "a sphere shifted": "motion.shift({{}, qray::coordinate<N>(static_cast<int32_t>(i), 64), {}});"
                        " well = move(scene::first_spheres[0], motion, scene::spheres[0]) && well;",
    "a sphere turned": TURN + " well = move(scene::first_spheres[0], motion, scene::spheres[0]) && well;",
    "a lamp turned": TURN + " well = move(scene::first_lights[0], motion, scene::lights[0]) && well;",
    "a cone turned": TURN + " well = move(scene::first_cones[0], motion, scene::cones[0]) && well;",
    "a polygon of 4 corners turned": TURN + " well = move(scene::first_polygons[0], " + CORNERS.format("polygons")
                                     + ") && well;",
    "all 48 triangles of a mesh turned": TURN + " for (uint32_t k = 0; k < scene::patches.count; k++) well = move("
                                         "scene::first_patches[k], " + CORNERS.format("patches").replace("[0]", "[k]")
                                         + ") && well;",
    "the tree refitted": "scene::refit();",
}


def scene(at_what):
    """A ball, a cone, a polygon and a ball of 48 triangles, lit by one lamp."""
    def at(ring, k):
        polar, around = math.pi * ring / 4, 2 * math.pi * k / 12
        n = (math.sin(polar) * math.cos(around), math.cos(polar), math.sin(polar) * math.sin(around))
        return " ".join(f"{v:.4f}" for v in (1.5 * n[0], 1 + 0.75 * n[1], 2 + 0.75 * n[2]) + n)
    lines = [f"v from 0 3 6  at {at_what}  up 0 1 0  angle 50  hither 0  resolution 24 18", "b 0.3 0.4 0.6", "l 3 6 4",
             "material diffuse 0.8", "plane 0 0 0  0 1 0", "s -2 1 0 0.75", "c 2 0.5 1 0.5  2 2 1 0.25",
             "p 4  -1 2 -2  1 2 -2  1 4 -2  -1 4 -2"]
    for k in range(12):
        for ring in (0, 1, 2, 3):
            across = (ring + 1, k + 1) if ring < 3 else (ring, k + 1)
            lines.append(f"pp 3 {at(ring, k)} {at(ring + 1, k)} {at(*across)}")
    return "\n".join(lines) + "\n"


def animation(what, times=TIMES):
    """The name of one that does so, from where make looks for them."""
    code = ("// Moves: all\nbool animate([[maybe_unused]] uint32_t frame, uint32_t)\n{\n    using N = scene::Number;\n"
            f"    bool well = true;\n    for (uint32_t i = 0; i < {times}; i++) {{\n"
            "        [[maybe_unused]] qray::Motion<N> motion(scene::frame);\n"
            f"        {what.replace('{times}', str(times))}\n"
            "    }\n    return well;\n}\n")
    name = hashlib.sha256(code.encode()).hexdigest()[:12]
    with open(f"{FOLDER}/{name}.cpp", "w") as file:
        file.write(code)
    return f"../../../{FOLDER}/{name}"


def measured(columns):
    """What each move costs in these, and a whole frame."""
    os.makedirs(FOLDER, exist_ok=True)
    for path, at_what in SCENES.items():
        with open(path, "w") as file:
            file.write(scene(at_what))
    seen, behind = SCENES

    def run(board, number, what, path, size):
        return runs.Run(board, path, number, size, ANIMATION=animation(what), FRAMES=FRAMES, WITHIN=WITHIN)
    plan = {(what, *column): run(*column, what, behind, "1x1") for what in ["", *MOVES.values()] for column in columns}
    whole = {column: run(*column, "", seen, "24x18") for column in columns}
    runs.perform([*plan.values(), *whole.values()])

    def cost(run):
        return run.result["instructions/frame"]
    rows = {name: [(cost(plan[(what, *c)]) - cost(plan[("", *c)])) / TIMES for c in columns]
            for name, what in MOVES.items()}
    rows["a frame, 24 × 18 pixels"] = [cost(whole[c]) for c in columns]
    return rows


def report():
    columns = [(board, number) for board in BOARDS for number in fixed_numbers()]
    rows = measured(columns)
    return ("Instructions, in a scene of a ball, a cone, a polygon, a floor and a mesh of 48 triangles, all of which "
            "move:\n\n" + table(["move", *(f"{runs.BOARDS[b]} {n}" for b, n in columns)],
                            [[name, *map(count, costs)] for name, costs in rows.items()]))


def moves():
    camera, shifted, turned, lamp, *_, frame = (count(cost) for cost, in measured([("microbit", "q32")]).values())
    return (f"A move costs an M0 {shifted} instructions (a ball shifted) to {turned} (turned), {lamp} (a lamp) or "
            f"{camera} (the camera) in `q32`; a frame of 24 × 18 pixels has {frame}. "
            "[The study](src/study/README.md#scenes-that-move) has others.\n")


REPORTS = {"moving": (report, lambda: [f"| {name} |" for name in MOVES]),
           "moves": (moves, lambda: ["A move costs an M0"])}
