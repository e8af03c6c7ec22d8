"""Benchmark of the strand solver: coils that hang from a swinging root frame, without contact."""

from __future__ import annotations

from typing import Any

import numpy as np

from ringlet import Clock, Curves, Material, Solver, Strands, solver_counts


def run(
    strands: int = 500, vertices: int = 60, newton: int = 5, steps: int = 48, per_turn: int = 12, fps: float = 24.0
) -> dict[str, Any]:
    """Swings ``strands`` 4A coils by ±45° at 1 Hz about a horizontal axis, with a fixed number of iterations.

    newton:   iterations of every step
    per_turn: vertices a turn
    fps:      steps per second, one per frame
    """
    rest = np.concatenate([coil(k, vertices, per_turn) for k in range(strands)])
    curves = Curves(rest, np.arange(strands + 1, dtype=np.int32) * vertices, np.arange(strands))
    moving = Strands(curves, Material())
    solver = Solver(newton=newton, tolerance=1e-12)  # never reached, so that all iterations are run
    clock = Clock()
    reports = []
    for step in range(steps):
        turn = np.radians(45) * np.sin(2 * np.pi * step / fps)
        swing = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
        # Without @: threads of the BLAS library would spin on the processors that are timed.
        targets = np.einsum("ij,kj->ik", rest, swing)
        with clock("step"):
            reports.append(moving.step(targets, 1 / fps, gravity=(0.0, -9.81, 0.0), solver=solver))
    return clock.result(
        "strands",
        {"strands": strands, "vertices": vertices, "newton": newton, "steps": steps, "per_turn": per_turn, "fps": fps},
        per="step",
        warm_up=2,
        strands=strands,
        vertices=len(rest),
        **solver_counts(reports),
    )


def coil(index: int, vertices: int, per_turn: int) -> np.ndarray:
    """A hanging 4A curl (radius 2.5 mm, pitch 3 mm) with its own phase [m]; odd ones are right-handed."""
    hand = 1 if index % 2 else -1
    turn = 2 * np.pi * np.arange(vertices) / per_turn + index
    return np.c_[2.5e-3 * np.cos(turn), -3e-3 * (turn - index) / (2 * np.pi), hand * 2.5e-3 * np.sin(turn)]
