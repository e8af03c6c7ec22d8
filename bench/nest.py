"""Benchmark of convergence: what coils in contact that can move together keep of their swing at few iterations."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import Clock, Contact, Curves, Material, Scene, Solver, Strands

RADIUS = 4e-4  # of contact [m]
FRAMES, DT = 8, 1 / 24  # [s]
GRAVITY = (5.54, -8.1, 0.0)  # m/s², at an angle to the coils


def run(rings: int = 3, newton: int = 5, linear_tolerance: float = 0.2, friction: float = 0.0) -> dict[str, Any]:
    """Swings a nest of equal coils for 8 frames, at these settings and with 100 iterations to 0.01.

    rings:            of coils about the one in the middle: 1, 3, 5 and 8 are 7, 37, 91 and 217 coils
    newton:           iterations of every step
    linear_tolerance: ``solver.linear_tolerance``
    friction:         coefficient of friction of the coils
    """
    clock = Clock()
    with clock("converged"):
        expected = tips(rings, Solver(newton=100, linear_tolerance=0.01), friction)
    with clock("few iterations"):
        got = tips(rings, Solver(newton=newton, linear_tolerance=linear_tolerance), friction)
    swing, converged = (float(np.ptp(ends[:, :, 0].mean(axis=1))) for ends in (got, expected))
    return clock.result(
        "nest",
        {"rings": rings, "newton": newton, "linear_tolerance": linear_tolerance, "friction": friction},
        per="few iterations",
        warm_up=0,
        coils=got.shape[1],
        kept=swing / converged,
        worst_tip_mm=1e3 * float(abs(got - expected).max()),
    )


def tips(rings: int, solver: Solver, friction: float) -> NDArray[np.float64]:
    """Displacement of each tip by frame [m], shape (frames, coils, 3)."""
    cells = [(a, b) for a in range(-rings, rings + 1) for b in range(-rings, rings + 1) if abs(a + b) <= rings]
    places = 1.02 * 2 * RADIUS * np.array([(a + 0.5 * b, b * np.sqrt(0.75)) for a, b in cells])
    y = -np.linspace(0.0, 0.1, 96)
    turn, wide = 2 * np.pi * y / 0.012, 0.004 * np.clip(-y / 0.01, 0.0, 1.0)
    curves = Curves.from_list([np.c_[x + wide * np.cos(turn), y, z + wide * np.sin(turn)] for x, z in places])
    strands = Strands(curves, Material(bend_scale=6.0, damping=0.004, drag=0.0), 2)
    scene = Scene(strands, contact=Contact(radius=RADIUS, friction=friction))
    frames = []
    for _ in range(FRAMES):
        scene.step(curves.points, DT, gravity=GRAVITY, solver=solver)
        frames.append((strands.positions - curves.points)[curves.offsets[1:] - 1])
    return np.array(frames)
