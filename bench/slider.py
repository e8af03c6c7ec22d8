"""Benchmark of a slider: time from a change of the curl width to new hairs, and time of a cold start."""

from __future__ import annotations

import statistics
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from groom import recipe_text

from ringlet import Clock, Memory, build_groom, build_hairs, read_recipe


def run(
    guides: int = 500, locks: int = 2000, points: int = 60, hairs: int = 50_000, moves: int = 10, recipe: str = ""
) -> dict[str, Any]:
    """Grooms the example head, or a recipe, then moves the slider ``moves`` times.

    guides: guides that the locks are interpolated from
    locks:  groom guides
    points: points of a guide and of a hair
    hairs:  total number of render hairs
    moves:  timed moves of the slider, after two to warm up
    recipe: file whose locks and hairs are taken instead
    """
    clock, cold = Clock(), Clock()
    given = read_recipe(recipe) if recipe else None
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "slider.recipe.toml"

        def evaluate(width: float, memory: Memory, clock: Clock, name: str) -> Any:
            if given is None:
                path.write_text(recipe_text(guides, locks, points, hairs, width))
            stages = Stages(clock)
            with clock(name):
                with clock("recipe"):
                    recipe = read_recipe(path) if given is None else with_width(given, width / 9.0)
                with clock("groom"):
                    groom = build_groom(recipe, memory=memory, progress=stages)
                with clock("hairs"):
                    hair = build_hairs(groom, memory=memory)
            return groom, hair

        evaluate(9.0, Memory(), Clock(), "cold")  # loads libraries and memory pages
        for _ in range(3):
            memory = Memory()
            evaluate(9.0, memory, cold, "cold")
        for width in np.linspace(6.0, 12.0, moves + 2):
            groom, hair = evaluate(float(width), memory, clock, "slider")
            before = hair.curves.points
            with clock("warp"):
                hair.deformed(groom.locks.points, groom.scalp.points, out=before)

    count = len(hair.curves)
    traffic = 12.0 * len(hair.curves.points) + 12.0 * len(groom.locks.points) + 4.0 * count * (2 + 1 + 1 + 16 + 3)
    warp_rate = traffic / (1e-3 * statistics.median(clock.cpu["warp"][2:]))
    memory_rate = copy_rate()
    return clock.result(
        "slider",
        {"recipe": recipe, "moves": moves}
        if recipe
        else {"guides": guides, "locks": locks, "points": points, "hairs": hairs, "moves": moves},
        per="slider",
        warm_up=2,
        cold_cpu_ms=statistics.median(cold.cpu["cold"]),
        cold_wall_ms=statistics.median(cold.wall["cold"]),
        cold_stages={name: statistics.median(times) for name, times in cold.cpu.items()},
        locks=len(groom.locks),
        hairs=count,
        hair_vertices=len(hair.curves.points),
        warp_gb_per_cpu_s=1e-9 * warp_rate,
        copy_gb_per_cpu_s=1e-9 * memory_rate,
        bandwidth_share=warp_rate / memory_rate,
        nan=int(np.count_nonzero(~np.isfinite(hair.curves.points))),
    )


def with_width(recipe: Any, factor: float) -> Any:
    """A recipe whose curls are wider by a factor."""
    width = recipe.curl.width
    wider = width.model_copy(update={"value": factor * width.value})
    return recipe.model_copy(update={"curl": recipe.curl.model_copy(update={"width": wider})})


class Stages:
    """Progress callback that times the stages of a groom."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self.running: Any = None

    def __call__(self, stage: str, done: int, total: int) -> None:
        """Starts the clock before a stage and stops it after."""
        if done == 0:
            self.running = self.clock(stage)
            self.running.__enter__()
        elif self.running is not None:
            self.running.__exit__(None, None, None)
            self.running = None


def copy_rate(megabytes: int = 256) -> float:
    """Memory bandwidth of one thread that copies, read plus write [bytes/s]; the best of five."""
    source = np.ones(megabytes * 2**17)
    target = np.empty_like(source)
    target[:] = source
    best = np.inf
    for _ in range(5):
        start = time.thread_time()
        np.copyto(target, source)
        best = min(best, time.thread_time() - start)
    return 2.0 * source.nbytes / best
