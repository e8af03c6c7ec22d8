"""Speed of grooming: from a recipe to groom guides to hairs, and hairs carried by guides that moved."""

from __future__ import annotations

import statistics
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

import ringlet

HEAD = Path(__file__).parents[1] / "examples" / "child" / "head.usdc"

RECIPE = """
ringlet = 1
[scalp]
file = '{head}'
mesh = "/child/skin"
region = "scalp"
[guides]
count = 100
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
curls = {{ value = {curls}, vary = 0.1 }}
[hairs]
per_lock = {per_lock}
"""


def run(locks: int = 2000, points: int = 60, hairs: int = 50_000, repeat: int = 5) -> dict[str, Any]:
    """Grooms the example head ``repeat`` times.

    locks:  groom guides
    points: points of a guide and of a hair
    hairs:  render hairs in all
    repeat: evaluations that the times are taken over, after one that warms up
    """
    per_lock = max(1, round(hairs / locks))
    text = RECIPE.format(head=HEAD.as_posix(), locks=locks, points=points, curls=points / 12, per_lock=per_lock)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bench.recipe.toml"
        path.write_text(text)
        recipe = ringlet.read_recipe(path)

    clock = Clock()
    for _ in range(repeat + 1):
        with clock("total"):
            with clock("groom"):
                groom = ringlet.build_groom(recipe)
            with clock("hairs"):
                hair = ringlet.build_hairs(groom)
        guides = groom.locks.points.astype(np.float32)
        with clock("warp"):
            hair.at(guides, groom.scalp.points)
    return {
        "name": "groom",
        "params": {"locks": locks, "points": points, "hairs": hairs, "repeat": repeat},
        "threads": ringlet._core.thread_count(),
        "simd": ringlet._core.simd(),
        "cpu_ms": spread(clock.cpu["total"]),
        "wall_ms": spread(clock.wall["total"]),
        "stages": {name: spread(clock.cpu[name])["median"] for name in ("groom", "hairs", "warp")},
        "strands": len(groom.locks),
        "vertices": len(groom.locks.points),
        "hairs": len(hair.curves),
        "hair_vertices": len(hair.curves.points),
        "nan": int(np.count_nonzero(~np.isfinite(hair.curves.points))),
    }


class Clock:
    """Times of named stages [ms], evaluation by evaluation."""

    def __init__(self) -> None:
        self.cpu: dict[str, list[float]] = {}
        self.wall: dict[str, list[float]] = {}

    @contextmanager
    def __call__(self, stage: str) -> Iterator[None]:
        """Adds the time that the block takes."""
        cpu, wall = time.process_time(), time.perf_counter()
        yield
        self.cpu.setdefault(stage, []).append(1e3 * (time.process_time() - cpu))
        self.wall.setdefault(stage, []).append(1e3 * (time.perf_counter() - wall))


def spread(times: list[float]) -> dict[str, float]:
    """Median, least and most of all but the first, which warmed up."""
    taken = times[1:]
    return {"median": statistics.median(taken), "min": min(taken), "max": max(taken)}
