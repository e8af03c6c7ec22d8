"""Benchmark of convergence: what coils in contact that can move together keep of their swing at few iterations."""

from __future__ import annotations

from typing import Any

import numpy as np

from ringlet import Clock, Solver, swing_nest


def run(rings: int = 3, newton: int = 5, linear_tolerance: float = 0.4, friction: float = 0.0) -> dict[str, Any]:
    """Swings a nest of equal coils for 8 frames, at these settings and converged.

    rings:            of coils about the one in the middle: 1, 3, 5 and 8 are 7, 37, 91 and 217 coils
    newton:           iterations of every step
    linear_tolerance: ``solver.linear_tolerance``
    friction:         coefficient of friction of the coils
    """
    clock = Clock()
    with clock("converged"):
        expected = swing_nest(rings, friction=friction)
    with clock("few iterations"):
        got = swing_nest(rings, Solver(newton=newton, linear_tolerance=linear_tolerance), friction)
    swing, converged = (float(np.ptp(ends[:, :, 0].mean(axis=1))) for ends in (got, expected))
    off = 1e3 * np.linalg.norm(got[1:] - expected[1:], axis=-1)  # of each tip in each frame
    return clock.result(
        "nest",
        {"rings": rings, "newton": newton, "linear_tolerance": linear_tolerance, "friction": friction},
        per="few iterations",
        warm_up=0,
        coils=got.shape[1],
        kept=swing / converged,
        tips_off_mm=dict(zip(("median", "p95", "max"), np.percentile(off, [50, 95, 100]).tolist(), strict=True)),
    )
