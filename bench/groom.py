"""Benchmark of grooming: recipe to groom guides to hairs, and deformation of hairs by moved guides."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from ringlet import Clock, build_groom, build_hairs, read_recipe

HEAD = Path(__file__).parents[1] / "examples" / "child" / "head.usdc"

RECIPE = """
ringlet = 2
[scalp]
file = '{head}'
mesh = "/child/skin"
region = "scalp"
[guides]
count = {guides}
length = {{ value = 8, vary = 0.1, noise = 0.2 }}
[locks]
count = {locks}
points = {points}
[[shape]]
op = "clump"
[[shape]]
op = "scraggle"
[curl]
preset = "3C"
width = {{ value = "{width} mm", vary = 0.2, ramp = [[0, 0.8], [0.3, 1], [1, 0.8]] }}
curls = {{ value = {curls}, vary = 0.1 }}
[hairs]
per_lock = {per_lock}
"""


def recipe_text(guides: int, locks: int, points: int, hairs: int, width: float = 9.0) -> str:
    """Recipe of the example head, with curls of ``width`` [mm] and 12 points a curl."""
    return RECIPE.format(
        head=HEAD.as_posix(),
        guides=guides,
        locks=locks,
        points=points,
        curls=points / 12,
        per_lock=max(1, round(hairs / locks)),
        width=width,
    )


def run(locks: int = 2000, points: int = 60, hairs: int = 50_000, repeat: int = 5) -> dict[str, Any]:
    """Grooms the example head ``repeat`` times.

    locks:  groom guides
    points: points of a guide and of a hair
    hairs:  total number of render hairs
    repeat: timed evaluations, after one to warm up
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bench.recipe.toml"
        path.write_text(recipe_text(100, locks, points, hairs))
        recipe = read_recipe(path)

    clock = Clock()
    for _ in range(repeat + 1):
        with clock("groom and hairs"):
            with clock("groom"):
                groom = build_groom(recipe)
            with clock("hairs"):
                hair = build_hairs(groom)
        guides = groom.locks.points.astype(np.float32)
        with clock("warp"):
            hair.deformed(guides, groom.scalp.points)
    return clock.result(
        "groom",
        {"locks": locks, "points": points, "hairs": hairs, "repeat": repeat},
        per="groom and hairs",
        warm_up=1,
        strands=len(groom.locks),
        vertices=len(groom.locks.points),
        hairs=len(hair.curves),
        hair_vertices=len(hair.curves.points),
        nan=int(np.count_nonzero(~np.isfinite(hair.curves.points))),
    )
