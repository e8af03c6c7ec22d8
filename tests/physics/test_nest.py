"""Locks in contact that can move together: what they keep of their motion, and that a far nest has no part in it."""

import numpy as np
from ringlet.validate import nest

from ringlet import Contact, Curves, Material, Scene, Solver, Strands

GRAVITY = (5.5, -8.1, 0.0)


def play(nests: list[np.ndarray], solver: Solver, frames: int = 4) -> tuple[np.ndarray, list[dict]]:
    """Positions of all locks by frame, and the reports of the steps."""
    grown = [nest.locks(places, nest.WIDTH) for places in nests]
    curves = Curves.from_list(
        [curve.points[a:b] for curve in grown for a, b in zip(curve.offsets, curve.offsets[1:], strict=False)]
    )
    strands = Strands(curves, Material(bend_scale=6.0, damping=0.004, drag=0.0), 2)
    scene = Scene(strands, contact=Contact(radius=nest.RADIUS, friction=0.3))
    positions, reports = [], []
    for _ in range(frames):
        report, _ = scene.step(curves.points, nest.DT, gravity=GRAVITY, solver=solver)
        positions.append(strands.positions.copy())
        reports.append(report)
    return np.array(positions), reports


def test_a_far_nest_changes_no_bit():
    """Clusters are searched, solved and stopped by themselves."""
    near, far = nest.hexagon(1), nest.hexagon(2) + 0.5
    alone, _ = play([near], Solver())
    beside, _ = play([near, far], Solver())
    assert np.array_equal(beside[:, : alone.shape[1]], alone)


def test_coils_keep_three_quarters_of_their_converged_swing():
    """With five iterations; before the coarse space it was 0.58 for 37 coils, with three to a tenth of the residual."""
    places = nest.hexagon(3)
    curves = nest.locks(places, nest.WIDTH)
    converged, got = (nest.swing(nest.tips(curves, solver)) for solver in (nest.CONVERGED, Solver()))
    assert 0.75 < got / converged < 1.02


def test_what_is_left_falls_with_iterations():
    """The motion that a step has not made yet, as its last search direction tells."""
    left = []
    for newton in (2, 5, 20):
        _, reports = play([nest.hexagon(1)], Solver(newton=newton))
        left.append(sum(report["left"] for report in reports) / sum(report["moved"] for report in reports))
    assert left[0] > left[1] > abs(left[2])
    assert left[2] < 0.02
