"""How the time of a step in contact grows with the number of strands: the twirl scene in several sizes."""

from __future__ import annotations

from itertools import takewhile
from typing import Any

import numpy as np

from ringlet import UserError, run_bench

COUNTS = ("contacts", "candidates", "linear_iterations")


def run(
    least: int = 64, most: int = 512, friction: float = 0.3, newton: int = 3, extra: int = 60, steps: int = 90
) -> dict[str, Any]:
    """Runs ``ringlet bench twirl --contacts on`` with ``least`` strands, twice as many, and so on up to ``most``.

    ``exponent`` is the slope of the line that fits the logarithms: CPU time of a step grows as strands to that power.

    least:    strands of the smallest scene
    most:     strands of the largest scene, at most
    friction: of what touches; the published scene has none
    newton:   iterations of every step
    extra:    iterations more for what was held back and is stretched; the published code has none
    steps:    how many of the scene's 340 frames are run
    """
    if not 0 < least <= most / 2:
        raise UserError(f"bench growth: least is {least} and most {most}; most must be at least twice least")
    sizes = list(takewhile(lambda size: size <= most, (least << doubled for doubled in range(32))))
    runs = [
        run_bench("twirl", strands=size, contacts="on", friction=friction, newton=newton, extra=extra, steps=steps)
        for size in sizes
    ]
    times = [run["cpu_ms"]["median"] for run in runs]
    return {
        **runs[-1],
        "name": "growth",
        "params": {
            "least": least,
            "most": most,
            "friction": friction,
            "newton": newton,
            "extra": extra,
            "steps": steps,
        },
        "exponent": float(np.polyfit(np.log(sizes), np.log(times), 1)[0]),
        "sizes": [
            {"strands": size, "cpu_ms": time, **{name: run[name] for name in COUNTS}}
            for size, time, run in zip(sizes, times, runs, strict=True)
        ],
    }
