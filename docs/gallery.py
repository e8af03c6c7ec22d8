"""Makes the pictures of the gallery: every preset on the example head in the same light, and single locks of each.

.venv/bin/python docs/gallery.py [PRESET …]
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from PIL import Image

import ringlet
from ringlet import Mesh
from ringlet.groom import PRESETS, make_groom, make_hairs, parse_recipe

HEAD = Path(__file__).parents[1] / "examples" / "child" / "head.usdc"
IMAGES = Path(__file__).parent / "images" / "gallery"

# How hair of a type stands and holds together: straight hair lies, parts, hangs and spreads; tight coils carry
# themselves, stand as a ball, and hold together in locks so thin that their turns are seen.
STAND = {
    "1": {"length": 15, "lift": 0.06, "droop": 6, "felt": 5, "fringe": 0.6, "brow": 0.5, "fall": 0.35, "vary": 0.1}
    | {"clump": 0.25, "wander": 0.3, "locks": 1300, "per_lock": 26, "radius": 2.6, "tip": 0.3}
    | {"blend": 0.6, "frizz": 0.12},
    "2": {"length": 15, "lift": 0.12, "droop": 4.5, "felt": 5, "fringe": 0.6, "brow": 0.5, "fall": 0.35, "vary": 0.1}
    | {"clump": 0.35, "wander": 0.4, "locks": 1300, "per_lock": 26, "radius": 2.2, "tip": 0.3}
    | {"blend": 0.3, "frizz": 0.15},
    "3": {"length": 15, "lift": 0.6, "droop": 1.1, "felt": 1, "fringe": 0.55, "brow": 1, "fall": 1, "vary": 0.12}
    | {"clump": 0.35, "wander": 0.7, "locks": 1300, "per_lock": 22, "radius": 1.6, "tip": 0.3}
    | {"blend": 0, "frizz": 0.35},
    "4": {"length": 11, "lift": 0.85, "droop": 0.3, "felt": 0.1, "fringe": 0.7, "brow": 1, "fall": 1.3, "vary": 0.05}
    | {"clump": 0.15, "wander": 1.4, "locks": 2200, "per_lock": 12, "radius": 1.1, "tip": 0.7}
    | {"blend": 0, "frizz": 0.25},
}

RECIPE = """
ringlet = 1
seed = 3
[scalp]
file = '{head}'
mesh = "/child/skin"
region = "scalp"
[guides]
count = 160
length = {{ value = {length}, vary = {vary}, noise = {vary}, noise_size = 4 }}
lift = {{ value = {lift}, noise = 0.15 }}
droop = {droop}
part = {{ offset = 1.5, reach = {felt} }}
zone = [
    {{ toward = [0, 0.2, 1], spread = 55, length = {fringe}, droop = {fall} }},
    {{ toward = [0.15, 0.6, 1], spread = 34, length = {brow} }}, # not over the eyes
    {{ toward = [0, -0.8, -1], spread = 55, length = 0.8 }},
]
[locks]
count = {locks}
points = {points}
[[shape]]
op = "clump"
size = 2.4
amount = {clump}
[[shape]]
op = "scraggle"
amount = {wander}
size = 3
[curl]
preset = "{preset}"
keep = "length"
[hairs]
per_lock = {per_lock}
radius = {{ value = "{radius} mm", vary = 0.3, ramp = [[0, 0.9], [0.25, 1], [0.75, 0.9], [1, {tip}]] }}
spread = "4 mm"
frizz = "{frizz} mm"
blend = {blend}
"""


LOCKS = """
ringlet = 1
seed = 5
[scalp]
[guides]
count = 40
length = 15
lift = 1
droop = 0
[locks]
count = 40
points = 500
[curl]
preset = "{preset}"
[hairs]
per_lock = 40
radius = "0.6 mm"
frizz = "0.2 mm"
"""


def picture(preset: str, folder: Path) -> None:
    """Writes the picture of one preset."""
    stand = STAND[preset[0]]
    pitch = float(PRESETS[preset]["pitch"]["value"].split()[0])
    recipe = folder / f"{preset}.recipe.toml"
    points = int(np.clip(105 * stand["length"] / pitch, 64, 220))
    recipe.write_text(RECIPE.format(head=HEAD.as_posix(), preset=preset, points=points, **stand))
    groom, hair, still = (folder / f"{preset}.{kind}" for kind in ("usdc", "hair.usdc", "png"))
    ringlet.write_groom(ringlet.build_groom(recipe), groom)
    ringlet.write_hairs(groom, hair)
    ringlet.write_still(hair, still, width=480, height=540, samples=8)
    head = Image.open(still).convert("RGB").crop((40, 0, 440, 450))
    head.resize((320, 360), Image.Resampling.LANCZOS).save(IMAGES / f"{preset}.jpg", quality=82)


def locks(preset: str) -> None:
    """Draws two locks of one preset, hanging side by side: 60 mm by 68 mm."""
    corners = np.array([[-0.03, 0, -0.03], [-0.03, 0, 0.03], [0.03, 0, 0.03], [0.03, 0, -0.03]])
    floor = Mesh("sheet", corners, np.array([[0, 1, 2], [0, 2, 3]]))
    hairs = make_hairs(make_groom(parse_recipe(LOCKS.format(preset=preset)), floor)).curves
    figure, place = plt.subplots(figsize=(3.2, 3.6), dpi=100)
    for number, lock in enumerate((3, 4)):
        own = np.flatnonzero(hairs.curve["lock"] == lock)
        lines = [1e3 * (hairs[hair] - hairs[own[0]][0]) * [1, -1, 1] + [30 * number, 0, 0] for hair in own]
        shades = np.linspace(0.25, 0.6, len(own))
        colors = [(shade, 0.6 * shade, 0.4 * shade) for shade in shades]
        place.add_collection(LineCollection([line[:, :2] for line in lines], colors=colors, linewidths=0.6))
    place.set(xlim=(-15, 45), ylim=(-66, 1.5), aspect="equal")
    place.axis("off")
    figure.subplots_adjust(0, 0, 1, 1)
    figure.savefig(IMAGES / f"{preset}_locks.jpg", pil_kwargs={"quality": 82})
    plt.close(figure)


if __name__ == "__main__":
    IMAGES.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        for preset in sys.argv[1:] or PRESETS:
            locks(preset)
            picture(preset, Path(name))
