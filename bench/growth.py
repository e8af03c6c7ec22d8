"""Benchmark of scaling: time of a step in contact by the number of strands, for the twirl scene in several sizes."""

from __future__ import annotations

from itertools import takewhile
from typing import Any, Literal, get_args

import numpy as np
from twirl import RADIUS

from ringlet import UserError, run_bench

Kept = Literal["sphere", "density", "heads"]
CROWD = 256  # wisps on the published sphere
COUNTS = ("contacts", "candidates", "linear_iterations")


def run(
    least: int = 64,
    most: int = 512,
    kept: Kept = "sphere",
    friction: float = 0.3,
    newton: int = 3,
    extra: int = 60,
    steps: int = 90,
    turns: int = 1,
) -> dict[str, Any]:
    """Runs ``ringlet bench twirl --contacts on`` with ``least`` strands, twice as many, and so on up to ``most``.

    ``exponent`` is the slope in log-log scale: the CPU time of a step grows as strands to that power.
    ``contacts_exponent`` is the same for contacts. On one sphere, more strands are denser and have more contacts each.
    On a sphere that grows with the strands, roots keep the density of the published scene, but tips spread less. On
    more spheres, the contacts of a strand stay the same.

    least:    strands of the smallest scene
    most:     upper bound of the strands of the largest scene
    kept:     constant of all sizes: the ``sphere``, the ``density`` of roots, or ``heads``: spheres of ``least``
              strands each, all in one scene
    friction: coefficient of friction; 0 in the published scene
    newton:   iterations of every step
    extra:    further iterations for stretched strands whose motion was limited; none in the published code
    steps:    number of frames, of the scene's 340
    turns:    runs of each size, interleaved; the fastest counts, since a shared machine is slow for minutes at a time
    """
    if not 0 < least <= most / 2:
        raise UserError(f"bench growth: least is {least} and most {most}; most must be at least twice least")
    if turns < 1:
        raise UserError(f"bench growth: turns is {turns}; must be at least 1")
    if kept not in get_args(Kept):
        raise UserError(f"bench growth: kept is {kept}; must be {' or '.join(get_args(Kept))}")
    sizes = list(takewhile(lambda size: size <= most, (least << doubled for doubled in range(32))))
    common = {"contacts": "on", "friction": friction, "newton": newton, "extra": extra, "steps": steps}

    def run_size(size: int) -> dict[str, Any]:
        radius = RADIUS * (size / CROWD) ** 0.5 if kept == "density" else RADIUS
        heads = size // least if kept == "heads" else 1
        return run_bench("twirl", strands=size, radius=radius, heads=heads, **common)

    rounds = [[run_size(size) for size in sizes] for _ in range(turns)]
    runs = [min(same, key=cpu_time) for same in zip(*rounds, strict=True)]
    times = [cpu_time(run) for run in runs]
    return {
        **runs[-1],
        "name": "growth",
        "params": {
            "least": least,
            "most": most,
            "kept": kept,
            "friction": friction,
            "newton": newton,
            "extra": extra,
            "steps": steps,
            "turns": turns,
        },
        "exponent": power(sizes, times),
        "contacts_exponent": power(sizes, [run["contacts"] for run in runs]),
        "sizes": [
            {"strands": size, "cpu_ms": time, **{name: run[name] for name in COUNTS}}
            for size, time, run in zip(sizes, times, runs, strict=True)
        ],
    }


def cpu_time(run: dict[str, Any]) -> float:
    """Median CPU time of a step in a run [ms]."""
    return run["cpu_ms"]["median"]


def power(sizes: list[int], values: list[float]) -> float | None:
    """Exponent of the growth of values with sizes, by least squares of the logarithms; None when a value is 0."""
    if min(values) <= 0:
        return None
    return float(np.polyfit(np.log(sizes), np.log(values), 1)[0])
