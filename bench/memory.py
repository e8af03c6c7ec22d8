"""Memory of the strand solver: how much the process grows with the strands that it steps."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from ringlet import Clock, Curves, Material, Strands

SELF = Path("/proc/self/statm")


def run(strands: int = 4000, vertices: int = 60, steps: int = 4) -> dict[str, Any]:
    """Builds and steps ``strands`` coils; the curves they are made from were there before and are not counted."""
    once = Strands(curves(8, vertices), Material())
    once.step(once.positions, 1 / 24)  # what is there whatever the number of strands
    hair = curves(strands, vertices)
    before = resident()
    clock = Clock()
    with clock("build"):
        moving = Strands(hair, Material())
    targets = hair.points
    for _ in range(steps):
        with clock("step"):
            moving.step(targets, 1 / 24, gravity=(0.0, -9.81, 0.0))
    return clock.result(
        "memory",
        {"strands": strands, "vertices": vertices, "steps": steps},
        per="step",
        warm_up=0,
        strands=strands,
        vertices=len(hair.points),
        megabytes=1e-6 * (resident() - before),
        bytes_per_vertex=(resident() - before) / len(hair.points),
    )


def curves(strands: int, vertices: int) -> Curves:
    """Coils that hang down [m], one beside the other."""
    turn = 2 * np.pi * np.arange(vertices) / 12
    coil = np.c_[2.5e-3 * np.cos(turn), -5e-4 * turn, 2.5e-3 * np.sin(turn)]
    points = (coil + np.arange(strands)[:, None, None] * (0.01, 0.0, 0.0)).reshape(-1, 3)
    return Curves(points, np.arange(strands + 1, dtype=np.int32) * vertices, np.arange(strands))


def resident() -> int:
    """Memory that the process holds now [bytes]."""
    return int(SELF.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
