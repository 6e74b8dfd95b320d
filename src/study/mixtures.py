"""Scenes to calibrate with: of each kind of shape one, some or many, in chance places and materials."""

import cmath
import os
import random

# Name: how many balls, discs, cones, polygons, patches; what some of them are made of, and whether balls lie
# one in the other, cones are thin or the first stands around the eye, polygons have many corners, the eye
# looks closely; the light, with how many of it.
MIXTURES = {
    "ball": (1, 1, 0, 0, 0, "highlight", "light shadow"),
    "balls": (6, 1, 0, 0, 0, "mirror highlight", "light light shadow"),
    "onion": (5, 1, 0, 0, 0, "glass glass glass nested", "light light shadow"),
    "gravel": (150, 1, 0, 0, 0, "checker", "light sun shadow"),
    "cone": (0, 1, 1, 0, 0, "stripes", "sun shadow"),
    "pipes": (1, 0, 5, 1, 0, "glass highlight", "light light shadow"),
    "forest": (2, 1, 25, 0, 0, "mirror wood", "light shadow"),
    "needles": (1, 1, 16, 1, 0, "highlight mirror thin", "light shadow"),
    "slab": (2, 0, 0, 1, 0, "brick highlight", "light"),
    "panes": (1, 1, 1, 7, 0, "glass noise", "light sun shadow"),
    "shards": (0, 0, 0, 40, 0, "highlight", "light shadow"),
    "rubble": (0, 1, 0, 180, 0, "mirror", "sun shadow"),
    "sail": (1, 1, 0, 0, 2, "highlight rings", "light shadow"),
    "leaves": (0, 0, 0, 1, 24, "mirror marble", "light light shadow"),
    "dome": (0, 0, 0, 0, 16, "glass", "light shadow"),
    "coins": (0, 10, 0, 0, 0, "mirror gradient", "light sun shadow"),
    "trio": (3, 0, 0, 0, 0, "", "sun shadow"),
    "globe": (1, 0, 0, 0, 0, "highlight close", "light*2 shadow"),
    "polish": (4, 1, 0, 0, 0, "fraction fraction close", "light*3"),
    "stadium": (2, 1, 0, 0, 0, "highlight", "light*12 shadow"),
    "billiards": (7, 1, 0, 0, 0, "highlight mirror", "light*5 shadow"),
    "pebbles": (40, 1, 0, 0, 0, "mirror", "light*4 shadow"),
    "lens": (3, 1, 0, 0, 0, "glass checker", "light*6 shadow"),
    "tiles": (0, 5, 0, 0, 0, "highlight fraction", "light*8"),
    "walls": (2, 6, 0, 0, 0, "mirror stripes", "light shadow"),
    "tunnel": (1, 0, 2, 0, 0, "highlight mirror around", "light*2 shadow"),
    "posts": (3, 1, 6, 0, 0, "highlight", "light*3 sun*2 shadow"),
    "stars": (0, 1, 0, 9, 0, "corners close", "light*2 shadow"),
    "gears": (0, 0, 0, 8, 0, "corners close glass fraction", "sun*3 shadow"),
    "vases": (0, 1, 0, 0, 40, "highlight", "light*3 shadow"),
    "jellyfish": (0, 1, 0, 0, 60, "glass mirror", "light shadow"),
    "market": (3, 3, 3, 3, 3, "highlight mirror checker fraction", "light light shadow"),
    "attic": (10, 2, 9, 12, 6, "glass noise highlight", "light shadow"),
}
TEXTURES = {
    "checker": "checker 0.2 0.3 0.2 0.7", "stripes": "stripes 0.9 0.9 0.2 0.4 1 1 0.3",
    "gradient": "gradient 0.2 0.3 0.9 3 0 1 0.2", "rings": "rings 0.9 0.2 0.2 0.4",
    "noise": "noise 0.1 0.2 0.2 0.4", "marble": "marble 0.2 0.2 0.3 0.5 1 0 0.2",
    "wood": "wood 0.3 0.2 0.1 0.4 0.3 1 0.1",
    "brick": "brick 0.8 0.8 0.7 0.6",
}
MATERIALS = {
    "highlight": "diffuse 0.7 highlight 0.6 shine 24", "fraction": "diffuse 0.7 highlight 0.6 shine 17.5",
    "mirror": "diffuse 0.5 mirror 0.4", "glass": "diffuse 0.2 mirror 0.1 transmit 0.7 ior 1.4",
}


def scene(name):
    balls, discs, cones, polygons, patches, kinds, light = MIXTURES[name]
    chance = random.Random(name)
    u = chance.uniform

    def text(*values):
        return " ".join(f"{v:.3f}" for v in values)

    def place(count):
        spread = min(1, 0.3 + count / 12)
        return [u(-3, 3) * spread, 1.2 + u(-1.3, 1.6) * spread, u(-3, 2) * spread]

    def direction():
        return [u(-1, 1), u(0.1, 1), u(-1, 1)]

    # What there is more of is smaller, but not so much that all of it is seen.
    def size(count):
        return u(0.6, 1.4) * 1.3 / (count + 1) ** 0.4

    materials = [""]
    shaped = ("nested", "thin", "around", "corners", "close")
    nested, thin, around, cornered, close = (word in kinds for word in shaped)
    for kind in kinds.split():
        if kind in shaped:
            continue
        materials.append(MATERIALS.get(kind) or f"diffuse 0.8 texture {TEXTURES[kind]}")
    lines = ["v from 0 2.2 8.5  at 0 1.1 0  up 0 1 0",
             f"  angle {20 if close else 38}  hither 1  resolution 32 24", "b 0.4 0.6 0.9",
             f"shadows {'on' if 'shadow' in light else 'off'}"]
    lights = [word.split("*") for word in light.split()]
    for kind in [word[0] for word in lights for _ in range(int(word[-1]) if word[1:] else 1)]:
        if kind == "light":
            lines.append("l " + text(u(-6, 6), u(4, 9), u(3, 8)) + " 0.6 0.6 0.6")
        elif kind == "sun":
            lines.append("sun " + text(u(-1, 1), 1, u(0, 1)) + " 0.5 0.5 0.5")
    objects = []
    for i in range(balls):
        ball = [0, 1.3, 0, 0.5 * 1.33 ** i] if nested else place(balls) + [size(balls)]
        objects.append("s " + text(*ball))
    for i in range(discs):
        floor = [0, 0, 0, 0, 1, 0, 9]
        objects.append("disc " + text(*(floor if i == 0 else place(discs) + direction() + [size(discs)])))
    for i in range(cones):
        foot, radius, length = place(cones), size(cones) / 2, 2 * size(cones)
        if thin:
            radius, length = 0.03, 2.5
        top = [v + length * d for v, d in zip(foot, direction())]
        if around and i == 0:
            foot, top, radius = [0, 1, -12], [0, 1, 12], 6
        objects.append("c " + text(*foot, radius, *top, radius * (1, 0, 0.6)[i % 3]))
    for _ in range(polygons):
        middle, r = place(polygons), size(polygons)
        a, b = [r * v for v in direction()], [r * v for v in direction()]
        corners = [[m - p - q for m, p, q in zip(middle, a, b)], [m + p - q for m, p, q in zip(middle, a, b)],
                   [m + p + q for m, p, q in zip(middle, a, b)], [m - p + q for m, p, q in zip(middle, a, b)]]
        corners = corners[:chance.choice((3, 3, 4))]
        if cornered:
            count = chance.choice((12, 24, 48))
            corners = [cmath.rect(r * (1 - 0.3 * (k % 2)), 2 * cmath.pi * k / count) for k in range(count)]
            corners = [[middle[0] + c.real, middle[1] + c.imag, middle[2]] for c in corners]
        objects.append(f"p {len(corners)} " + " ".join(text(*c) for c in corners))
    for _ in range(patches):
        middle, r = place(patches), size(patches)
        corners = [(r * x, r * y) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))[:chance.choice((3, 4))]]
        lean = u(-0.7, 0.7)
        objects.append(f"pp {len(corners)} " + " ".join(
            text(middle[0] + x, middle[1] + y, middle[2] + lean * x, 0.4 * x - lean, 0.4 * y, 1)
            for x, y in corners))
    for i, thing in enumerate(objects):
        # The first of each material, then by chance.
        material = materials[i % len(materials)] if i < len(materials) else chance.choice(materials)
        lines.append("material colour " + text(u(0.3, 1), u(0.3, 1), u(0.3, 1)) + " " + material)
        lines.append(thing)
    return "\n".join(lines) + "\n"


def write(folder):
    """{name: file} of all."""
    os.makedirs(folder, exist_ok=True)
    out = {}
    for name in MIXTURES:
        path = f"{folder}/{name}.nff"
        with open(path, "w") as file:
            file.write(scene(name))
        out[name] = path
    return out
