"""Benchmark of equilibrium rest shapes: of a whole groom, after a change of material, and after edits of some locks."""

from __future__ import annotations

import statistics
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ringlet import Clock, Groom, build_groom, loft, read_shot, write_loft

HEAD = Path(__file__).parents[1] / "examples" / "child" / "head.usdc"
LEAN = 0.01  # displacement of the tip of an edited lock [m]

RECIPE = """
ringlet = 2
seed = 7
[scalp]
file = '{head}'
mesh = "/child/skin"
region = "scalp"
[guides]
count = 110
length = {{ value = 8.4, vary = 0.08, noise = 0.13, noise_wavelength = 4 }}
lift = {{ value = 0.86, noise = 0.12 }}
gravity_bend = 0.48
zone = [{{ toward = [0, 0.4, 1], angle = 50, length = 0.5, lift = 0.85, gravity_bend = 1.6 }}]
[locks]
count = {locks}
points = {points}
[[shape]]
op = "scraggle"
magnitude = 0.5
wavelength = 3
[curl]
width = 1.12
curls = {{ value = 6, vary = 0.1 }}
"""

SHOT = """
ringlet = 2
groom = "rest.recipe.toml"
frames = [1, 2]
preroll = 0
[strands]
bend_scale = {bend_scale}
[rest]
mode = "equilibrium"
file = "rest.usdc"
[contact]
radius = 4e-4
[[collider]]
mesh = "/child/skin"
thickness = 2e-3
"""


def run(
    locks: int = 2000, points: int = 60, few: int = 20, many: int = 200, bend_scale: float = 6.0, repeats: int = 3
) -> dict[str, Any]:
    """Solves for the rest shapes of curls like the demo's, in contact with each other and the head, and again.

    few, many:  numbers of edited locks
    bend_scale: bend scale of the shot, 1.5 times that after the change of material
    repeats:    number of measurements
    """
    clock = Clock()
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        recipe, previous = folder / "rest.recipe.toml", folder / "rest.usdc"
        recipe.write_text(RECIPE.format(head=HEAD.as_posix(), locks=locks, points=points))
        shots = []
        for name, value in (("rest", bend_scale), ("stiffer", 1.5 * bend_scale)):
            path = folder / f"{name}.shot.toml"
            path.write_text(SHOT.format(bend_scale=value))
            shots.append(read_shot(path))
        shot, stiffer = shots
        groom = build_groom(recipe)
        found = {}
        for _ in range(repeats):
            with clock("whole"):
                found["whole"] = loft(shot, groom)
            write_loft(found["whole"], shot, previous)
            for what, changed_shot, changed_groom in (
                ("bend_scale", stiffer, groom),
                ("few", shot, leant(groom, few)),
                ("many", shot, leant(groom, many)),
            ):
                with clock(what):
                    found[what] = loft(changed_shot, changed_groom, known=previous)
    return clock.result(
        "rest",
        {"locks": len(groom.locks), "points": points, "few": few, "many": many, "bend_scale": bend_scale},
        per="whole",
        warm_up=0,
        wall_stages={stage: statistics.median(times) for stage, times in clock.wall.items()},
        stiffened={what: int(np.count_nonzero(one.stiffened > 1.0)) for what, one in found.items()},
        off_um={what: 1e6 * float(np.percentile(one.off, 99)) for what, one in found.items()},
    )


def leant(groom: Groom, count: int) -> Groom:
    """Displaces some locks, spread over the head, to the side, quadratically towards the tip."""
    points, offsets = np.array(groom.locks.points), groom.locks.offsets
    for lock in np.linspace(0, len(groom.locks) - 1, count).astype(int):
        rows = slice(offsets[lock], offsets[lock + 1])
        points[rows, 0] += LEAN * np.linspace(0.0, 1.0, offsets[lock + 1] - offsets[lock]) ** 2
    return replace(groom, locks=groom.locks.with_points(points))
