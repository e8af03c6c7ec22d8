"""Draws single locks of each type and locks with and without a curl of their hairs (curls.md), and stages (groom.md).

.venv/bin/python docs/lock_pictures.py [TYPE …]
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from numpy.typing import NDArray
from ringlet.data.quantities import Varied
from ringlet.groom.hair_settings import HairSettings
from ringlet.groom.operators import Grown, Locks

from ringlet import Curves, Mesh, build_groom, build_hairs
from ringlet.groom import PRESETS, Recipe, make_groom, make_hairs, read_recipe

TYPES = Path(__file__).parents[1] / "examples" / "types"
IMAGES = Path(__file__).parent / "images"
PAIRS = ("2B", "3A", "3C", "4A", "4C")  # locks with and without a curl of their hairs


def hanging(recipe: Recipe, per_lock: int) -> Curves:
    """Hairs of 40 locks of a recipe that stand straight on a sheet, 12 cm tall, without its operators."""
    corners = np.array([[-0.03, 0, -0.03], [-0.03, 0, 0.03], [0.03, 0, 0.03], [0.03, 0, -0.03]])
    floor = Mesh("sheet", corners, np.array([[0, 1, 2], [0, 2, 3]]))
    assert recipe.curl is not None
    upright = {
        "seed": 5,
        "guides": Grown(count=40, length=Varied(value=0.12), lift=Varied(value=1.0), gravity_bend=Varied(value=0.0)),
        "locks": Locks(count=40),
        "shape": [],
        "scalp": recipe.scalp.model_copy(update={"region": None}),
        "curl": recipe.curl.model_copy(update={"keep": "silhouette", "phase_groups": None}),
        "hairs": recipe.hairs.model_copy(
            update={
                "density": None,
                "root_radius": HairSettings().root_radius,
                "per_lock": Varied(value=per_lock),
                "points": None,
            }
        ),
    }
    return make_hairs(make_groom(recipe.model_copy(update=upright), floor)).curves


def bundles(recipe: Recipe, numbers: tuple[int, ...]) -> list[list[NDArray[np.floating]]]:
    """Hairs of hanging locks of a recipe, from the root of their lock [mm]."""
    hairs = hanging(recipe, 50)
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


def stages() -> None:
    """Draws the stages of a groom in profile: guides, shapes of locks, curled locks, hairs."""
    recipe = read_recipe(TYPES.parent / "child" / "light.recipe.toml")
    groom = build_groom(recipe)
    head, random = groom.scalp.points[:, [2, 1]], np.random.default_rng(1)
    figure = Figure(figsize=(12, 3.8), dpi=100)
    figure.subplots_adjust(0.0, 0.0, 1.0, 0.92, 0.0)
    for axes, (title, curves, width) in zip(
        figure.subplots(1, 4, sharex=True, sharey=True),
        (
            (f"{len(groom.guides)} guides", groom.guides, 1.2),
            (f"{len(groom.shapes)} locks in shape", groom.shapes, 0.8),
            ("curled", groom.locks, 0.6),
            ("with hairs", build_hairs(groom).curves, 0.2),
        ),
        strict=True,
    ):
        lines = [line for line in np.split(curves.points, curves.offsets[1:-1]) if line[0, 0] < 0]  # of the near side
        lines.sort(key=lambda line: -line[:, 0].mean())
        shades = 0.3 + 0.4 * random.random(len(lines))
        axes.tripcolor(*head.T, groom.scalp.triangles, np.ones(len(head)), cmap=ListedColormap(["#e6ddd4"]))
        colors = np.column_stack([shades, 0.62 * shades, 0.45 * shades])
        axes.add_collection(LineCollection([line[:, [2, 1]] for line in lines], colors=colors, linewidths=width))
        axes.set_aspect("equal")
        axes.axis("off")
        axes.set_title(title, fontsize=11, y=1.02)
    figure.savefig(IMAGES / "stages.jpg", pil_kwargs={"quality": 82})


if __name__ == "__main__":
    (IMAGES / "gallery").mkdir(exist_ok=True)
    stages()
    pairs()
    for kind in sys.argv[1:] or PRESETS:
        locks(kind)
