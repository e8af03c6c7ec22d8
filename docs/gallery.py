"""Makes the pictures of the gallery: every preset on the example head, with hair of the same length in the same light.

.venv/bin/python docs/gallery.py [PRESET …]
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

import ringlet
from ringlet.groom import PRESETS

HEAD = Path(__file__).parents[1] / "examples" / "child" / "head.usdc"
IMAGES = Path(__file__).parent / "images" / "gallery"

# How hair of a type stands and holds together: straight hair lies, hangs and spreads, tight coils carry themselves.
STAND = {
    "1": {"lift": 0.3, "droop": 2.2, "fringe": 0.24, "wander": 0.5, "radius": 2.6, "blend": 0.3, "frizz": 0.15},
    "2": {"lift": 0.4, "droop": 1.8, "fringe": 0.26, "wander": 0.5, "radius": 2.4, "blend": 0.2, "frizz": 0.2},
    "3": {"lift": 0.7, "droop": 0.9, "fringe": 0.6, "wander": 0.7, "radius": 1.6, "blend": 0, "frizz": 0.4},
    "4": {"lift": 0.85, "droop": 0.3, "fringe": 0.7, "wander": 1.6, "radius": 1.8, "blend": 0, "frizz": 0.5},
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
length = {{ value = 15, vary = 0.12, noise = 0.12, noise_size = 4 }}
lift = {{ value = {lift}, noise = 0.15 }}
droop = {droop}
zone = [
    {{ toward = [0, 0.2, 1], spread = 55, length = {fringe}, droop = 1.3 }},
    {{ toward = [0, -0.8, -1], spread = 55, length = 0.8 }},
]
[locks]
count = 1300
points = {points}
[[shape]]
op = "clump"
size = 2.4
amount = 0.35
[[shape]]
op = "scraggle"
amount = {wander}
size = 3
[curl]
preset = "{preset}"
keep = "length"
[hairs]
per_lock = 22
radius = {{ value = "{radius} mm", vary = 0.3, ramp = [[0, 0.9], [0.25, 1], [0.75, 0.9], [1, 0.3]] }}
spread = "4 mm"
frizz = "{frizz} mm"
blend = {blend}
"""


def picture(preset: str, folder: Path) -> None:
    """Writes the picture of one preset."""
    pitch = float(PRESETS[preset]["pitch"]["value"].split()[0])
    recipe = folder / f"{preset}.recipe.toml"
    points = int(np.clip(1600 / pitch, 64, 220))
    recipe.write_text(RECIPE.format(head=HEAD.as_posix(), preset=preset, points=points, **STAND[preset[0]]))
    groom, hair, still = (folder / f"{preset}.{kind}" for kind in ("usdc", "hair.usdc", "png"))
    ringlet.write_groom(ringlet.build_groom(recipe), groom)
    ringlet.write_hairs(groom, hair)
    ringlet.write_still(hair, still, width=400, height=450, samples=10)
    IMAGES.mkdir(exist_ok=True)
    Image.open(still).convert("RGB").resize((320, 360), Image.Resampling.LANCZOS).save(
        IMAGES / f"{preset}.jpg", quality=82
    )


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        for preset in sys.argv[1:] or PRESETS:
            picture(preset, Path(name))
