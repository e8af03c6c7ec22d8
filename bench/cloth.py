"""Speed of the cloth solver: a square sheet that hangs from two corners in a wind, without contact."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import Clock, Cloth, ClothMaterial, ClothSolver, Mesh


def run(side: int = 100, newton: int = 2, steps: int = 24, bend: float = 1e-5, fps: float = 24.0) -> dict[str, Any]:
    """Lets a sheet of ``side`` × ``side`` vertices, one metre wide, swing from two corners, all iterations spent.

    bend: resistance to bend [N m]
    fps:  steps per second, one per frame
    """
    mesh = sheet(side)
    moving = Cloth(mesh, ClothMaterial(bend=bend), np.array([side * (side - 1), side * side - 1]))
    solver = ClothSolver(newton=newton, tolerance=1e-12)  # never reached: what is timed is the work that was asked for
    clock = Clock()
    reports = []
    for _ in range(steps):
        with clock("step"):
            report = moving.step(mesh.points, 1 / fps, gravity=(0.0, -9.81, 0.0), wind=(0.5, 0.0, 2.0), solver=solver)
        reports.append(report)
    return clock.result(
        "cloth",
        {"side": side, "newton": newton, "steps": steps, "bend": bend, "fps": fps},
        per="step",
        warm_up=2,
        vertices=len(mesh.points),
        contacts=0,
        newton=float(np.mean([report["newton"] for report in reports])),
        linear_iterations=float(np.mean([report["linear"] for report in reports])),
        line_search_cuts=int(sum(report["cuts"] for report in reports)),
        nan=int(sum(report["nan"] for report in reports)),
        max_stretch=float(max(report["max_stretch"] for report in reports)),
    )


def sheet(side: int) -> Mesh:
    """A square metre in the plane of x and y, cut into squares and each of these into two triangles."""
    x, y = np.meshgrid(np.linspace(0, 1, side), np.linspace(0, 1, side))
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    triangles: NDArray[np.int32] = np.concatenate(
        [
            np.c_[corner, corner + 1, corner + side + 1],
            np.c_[corner, corner + side + 1, corner + side],
        ]
    ).astype(np.int32)
    return Mesh("sheet", np.c_[x.ravel(), y.ravel(), np.zeros(x.size)], triangles)
