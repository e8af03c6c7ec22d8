"""Locks in contact that can move together: what they keep of their motion, and that a far nest has no effect on it."""

import numpy as np
from ringlet.validate import nest

from ringlet import Curves, Solver


def play(nests: list[np.ndarray], solver: Solver, frames: int = 4) -> tuple[np.ndarray, list[dict]]:
    """Positions of all locks by frame, and the reports of the steps."""
    grown = [nest.locks(places, nest.WIDTH) for places in nests]
    curves = Curves.from_list(
        [curve.points[a:b] for curve in grown for a, b in zip(curve.offsets, curve.offsets[1:], strict=False)]
    )
    scene = nest.scene(curves, friction=0.3)
    positions, reports = [], []
    for _ in range(frames):
        report, _ = scene.step(curves.points, nest.DT, gravity=nest.GRAVITY, solver=solver)
        positions.append(scene.strands.positions.copy())
        reports.append(report)
    return np.array(positions), reports


def test_a_far_nest_changes_no_bit():
    """Clusters are searched, solved and stopped by themselves."""
    near, far = nest.hexagon(1), nest.hexagon(2) + 0.5
    alone, _ = play([near], Solver())
    together, _ = play([near, far], Solver())
    assert np.array_equal(together[:, : alone.shape[1]], alone)


def test_coils_keep_nine_tenths_of_their_converged_swing():
    """With five iterations; before the coarse space it was 0.58 for 37 coils, with three to a tenth of the residual."""
    places = nest.hexagon(3)
    curves = nest.locks(places, nest.WIDTH)
    converged, got = (nest.swing(nest.tips(curves, solver)) for solver in (nest.CONVERGED, Solver()))
    assert 0.9 < got / converged < 1.02


def test_a_converged_step_has_nothing_left():
    """The motion that a step has not made, as its last search direction tells, is rounding once it has converged."""
    few, many = (play([nest.hexagon(1)], Solver(newton=newton))[1] for newton in (1, 100))
    few, many = (sum(step["left"] for step in steps) / sum(step["moved"] for step in steps) for steps in (few, many))
    assert few > 1e-3
    assert abs(many) < 1e-6
