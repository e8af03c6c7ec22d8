"""Benchmark of the strand solver's memory: growth of the process by the number of strands."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from ringlet import Clock, Curves, Material, Strands

SELF = Path("/proc/self/statm")


def run(strands: int = 4000, vertices: int = 60, steps: int = 4) -> dict[str, Any]:
    """Builds and steps ``strands`` coils; the memory of their input curves is not counted."""
    small = Strands(curves(8, vertices), Material())
    small.step(small.positions, 1 / 24)  # allocates memory that does not depend on the number of strands
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
    """Hanging coils [m], side by side."""
    turn = 2 * np.pi * np.arange(vertices) / 12
    coil = np.c_[2.5e-3 * np.cos(turn), -5e-4 * turn, 2.5e-3 * np.sin(turn)]
    points = (coil + np.arange(strands)[:, None, None] * (0.01, 0.0, 0.0)).reshape(-1, 3)
    return Curves(points, np.arange(strands + 1, dtype=np.int32) * vertices, np.arange(strands))


def resident() -> int:
    """Resident memory of the process [bytes]."""
    return int(SELF.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
