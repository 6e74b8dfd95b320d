"""The ladder of effects: one small scene, and then the same calling for one effect more at a time."""

import os
import shutil

TITLE = "Three balls and a pane on a floor, then with one effect more in each row;"

# In each part `{name}` is the empty text until the step of that name, and what it says there from then on.
SCENE = """\
v from 0 1.6 6  at 0 0.7 0  up 0 1 0
  angle 40  hither 1  resolution 32 24
b 0.4 0.6 0.9
ambientlight 0.2 0.2 0.2
shadows {shadow}
l 5 8 6  0.8 0.8 0.8
{second light}
{panel of 4}
{panel of 16}
{radiosity}
material colour 0.8 0.8 0.8 diffuse 0.8 {checker}
disc 0 0 0  0 1 0  8
material colour 0.9 0.3 0.2 diffuse 0.8 {highlight} {mirror} {noise}
s -1.2 0.8 0  0.8
s 1.1 0.6 0.6  0.6
material colour 0.3 0.5 0.9 diffuse 0.5 {glass} {globe}
s 0.1 0.4 1.8  0.4
material colour 0.9 0.9 0.3 diffuse 0.6 {see-through shadow} {emission}
disc 0.4 1.2 -0.8  0 0 1  0.7
material colour 0.3 0.8 0.4 diffuse 0.8 {image}
{cone}
{polygon}
"""

# Name, what it writes into the scene (of `shadow`: off before), options of make. A transmit below the cutoff
# lets light through and has no refracted ray.
STEPS = [
    ("matte balls", "", {}),
    ("shadow", "on", {}),
    ("highlight", "highlight 0.8 shine 32", {}),
    ("mirror", "mirror 0.3", {}),
    ("see-through shadow", "transmit 0.001", {}),
    ("glass", "transmit 0.8 ior 1.5", {}),
    ("checker", "texture checker 0.2 0.2 0.2 1", {}),
    ("noise", "texture noise 0.9 0.8 0.2 0.3", {}),
    ("cone", "c 2.2 0 -0.8 0.5  2.2 1.4 -0.8 0", {}),
    ("polygon", "p 4  -3 0 -2  3 0 -2  3 2 -2  -3 2 -2", {}),
    ("second light", "l -6 5 3  0.4 0.4 0.4", {}),
    ("image", "texture image tile.bmp 0 0 0 1 0 0 0 1 0", {}),
    ("globe", "texture globe globe.ppm 0.1 0.4 1.8", {}),
    ("emission", "emission 0.5", {}),
    ("panel of 4", "panel 2  -2 5 4  0.5 0 0  0 0 0.5  0.3 0.3 0.3", {}),
    ("panel of 16", "panel 4  2 5 4  0.5 0 0  0 0 0.5  0.3 0.3 0.3", {}),
    ("radiosity", "radiosity 1", {}),
    ("4 samples", "", {"SAMPLES": 4}),
]


def write(folder):
    """The scenes of all steps, as (name, file, options of make)."""
    os.makedirs(folder, exist_ok=True)
    for image in ("tile.bmp", "globe.ppm"):
        shutil.copy(f"scenes/{image}", folder)
    out, options = [], {}
    for last, (name, _, more) in enumerate(STEPS):
        text = SCENE.replace("{shadow}", "on" if last >= 1 else "off")
        for i, (known, words, _) in enumerate(STEPS):
            text = text.replace("{" + known + "}", words if i <= last else "")
        options = {**options, **more}
        path = f"{folder}/{last:02}-{name.replace(' ', '-')}.nff"
        with open(path, "w") as file:
            file.write(text)
        out.append((name, path, options))
    return out
