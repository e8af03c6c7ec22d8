"""Draws single locks of every type of hair, and locks with and without a curl of their hairs, for docs/curls.md.

.venv/bin/python docs/lock_pictures.py [TYPE …]
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray
from ringlet.data.quantities import Varied
from ringlet.groom.hair_settings import HairSettings
from ringlet.groom.operators import Grown, Locks

from ringlet import Mesh
from ringlet.groom import PRESETS, Recipe, make_groom, make_hairs, read_recipe

TYPES = Path(__file__).parents[1] / "examples" / "types"
IMAGES = Path(__file__).parent / "images"
PAIRS = ("2B", "3A", "3C", "4A", "4C")  # locks with and without a curl of their hairs


def bundles(recipe: Recipe, numbers: tuple[int, ...]) -> list[list[NDArray[np.floating]]]:
    """Hairs of hanging locks of a recipe, from the root of their lock [mm]."""
    corners = np.array([[-0.03, 0, -0.03], [-0.03, 0, 0.03], [0.03, 0, 0.03], [0.03, 0, -0.03]])
    floor = Mesh("sheet", corners, np.array([[0, 1, 2], [0, 2, 3]]))
    assert recipe.curl is not None
    upright = {
        "seed": 5,
        "guides": Grown(count=40, length=Varied(value=0.12), lift=Varied(value=1.0), gravity_bend=Varied(value=0.0)),
        "locks": Locks(count=40, points=500),
        "shape": [],
        "scalp": recipe.scalp.model_copy(update={"region": None}),
        "curl": recipe.curl.model_copy(update={"keep": "silhouette", "phase_groups": None}),
        "hairs": recipe.hairs.model_copy(
            update={
                "density": None,
                "root_radius": HairSettings().root_radius,
                "per_lock": Varied(value=50),
                "points": 900,
            }
        ),
    }
    hairs = make_hairs(make_groom(recipe.model_copy(update=upright), floor)).curves
    locks = [np.flatnonzero(hairs.curve["lock"] == number).tolist() for number in numbers]
    return [[1e3 * (hairs[hair] - hairs[own[0]][0]) * [1, -1, 1] for hair in own] for own in locks]


def draw(axes: Axes, lines: list[NDArray[np.floating]], x: float, width: float) -> None:
    """Draws the hairs of a lock, centred at x [mm]."""
    shades = np.linspace(0.25, 0.6, len(lines))
    colors = [(shade, 0.6 * shade, 0.4 * shade) for shade in shades]
    axes.add_collection(LineCollection([line[:, :2] + [x, 0] for line in lines], colors=colors, linewidths=width))


def locks(name: str) -> None:
    """Draws two locks of one type, hanging side by side: 76 mm by 86 mm."""
    figure = Figure(figsize=(3.2, 3.6), dpi=100)
    axes = figure.add_axes((0, 0, 1, 1))
    for number, lines in enumerate(bundles(read_recipe(TYPES / f"{name}.recipe.toml"), (3, 4))):
        draw(axes, lines, 36 * number, 0.6)
    axes.set(xlim=(-20, 56), ylim=(-84, 1.5), aspect="equal")
    axes.axis("off")
    figure.savefig(IMAGES / "gallery" / f"{name}_locks.jpg", pil_kwargs={"quality": 82})


def pairs() -> None:
    """Draws locks of several types twice: with hairs that only follow them, and with a curl of hairs."""
    figure = Figure(figsize=(10, 4.6), dpi=100)
    axes = figure.add_axes((0, 0, 1, 0.94))
    for number, name in enumerate(PAIRS):
        recipe = read_recipe(TYPES / f"{name}.recipe.toml")
        plain = recipe.hairs.model_copy(update={"families": None, "curl": None, "coil": None})
        for side, hairs in enumerate((plain, recipe.hairs)):
            lines = bundles(recipe.model_copy(update={"hairs": hairs}), (3,))[0]
            draw(axes, lines, 62 * number + 28 * side, 0.5)
        axes.text(62 * number + 14, 6, name, ha="center")
    axes.set(xlim=(-18, 62 * len(PAIRS) - 15), ylim=(-128, 2), aspect="equal")
    axes.axis("off")
    figure.savefig(IMAGES / "hair_curl.jpg", pil_kwargs={"quality": 82})


if __name__ == "__main__":
    (IMAGES / "gallery").mkdir(exist_ok=True)
    pairs()
    for kind in sys.argv[1:] or PRESETS:
        locks(kind)
