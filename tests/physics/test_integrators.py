"""Second-order backward differences: start, restart, accuracy, and agreement of strands and scenes."""

import numpy as np
import pytest
from coils import helix
from ringlet.shot import Solver
from ringlet.sim.scene import Scene
from undamped import undamped_strand

FRAME = 1 / 24


def shaken(strand, rest, steps, integrator, dt=FRAME):
    """Positions after ``steps`` steps with a lateral motion of the root."""
    solver = Solver(newton=50, tolerance=1e-12, integrator=integrator)
    for k in range(1, steps + 1):
        strand.step(rest + [0.01 * np.sin(0.3 * k), 0, 0], dt, gravity=(0, -9.81, 0), solver=solver)
    return strand.positions.copy()


def test_the_first_step_of_bdf2_is_one_of_backward_euler():
    rest = helix(40)
    first = [
        shaken(undamped_strand(rest, damping=0.01), rest, 1, integrator) for integrator in ("backward_euler", "bdf2")
    ]
    second = [
        shaken(undamped_strand(rest, damping=0.01), rest, 2, integrator) for integrator in ("backward_euler", "bdf2")
    ]
    assert (first[0] == first[1]).all()
    assert np.abs(second[0] - second[1]).max() > 1e-5


def test_bdf2_restarts_when_a_strand_is_placed():
    rest = helix(40)
    fresh, moved = undamped_strand(rest, damping=0.01), undamped_strand(rest, damping=0.01)
    shaken(moved, rest, 3, "bdf2")
    moved.place(rest)
    assert (shaken(moved, rest, 3, "bdf2") == shaken(fresh, rest, 3, "bdf2")).all()


def test_bdf2_takes_a_step_of_backward_euler_when_the_time_step_changes():
    rest = helix(40)
    a, b = undamped_strand(rest, damping=0.01), undamped_strand(rest, damping=0.01)
    shaken(a, rest, 3, "bdf2")
    shaken(b, rest, 3, "bdf2")
    assert (shaken(a, rest, 1, "bdf2", FRAME / 2) == shaken(b, rest, 1, "backward_euler", FRAME / 2)).all()


def test_bdf2_follows_a_falling_root_to_second_order():
    """In free fall only the first step, of backward Euler, has an error, at most g h² / 2."""
    rest = helix(40)
    strand = undamped_strand(rest)
    for k in range(1, 11):
        targets = rest - [0, 0.5 * 9.81 * (k * FRAME) ** 2, 0]
        strand.step(targets, FRAME, gravity=(0, -9.81, 0), solver=Solver(newton=50, integrator="bdf2"))
    assert np.abs(strand.positions - targets).max() < 0.5 * 9.81 * FRAME**2
    assert np.abs(strand.velocities[4:] - [0, -9.81 * 10 * FRAME, 0]).max() < 0.02 * 9.81 * 10 * FRAME


@pytest.mark.parametrize("integrator", ["backward_euler", "bdf2"])
def test_a_scene_without_contact_moves_like_its_strands_alone(integrator):
    rest = helix(20)
    alone, among = undamped_strand(rest, damping=0.01), undamped_strand(rest, damping=0.01)
    scene = Scene(among)
    solver = Solver(until_converged=True, tolerance=1e-11, linear_tolerance=1e-12, integrator=integrator)
    for k in range(1, 6):
        targets = rest + [0.002 * k, 0, 0]
        alone.step(targets, FRAME, gravity=(0, -9.81, 0), solver=solver)
        scene.step(targets, FRAME, gravity=(0, -9.81, 0), solver=solver)
    assert np.abs(scene.positions - alone.positions).max() < 1e-9
