"""Ties hold strands together as springs do, and braids by the bands at their ends."""

import numpy as np
import pytest
from ringlet.data.curves import Curves
from ringlet.shot.contact import Contact
from ringlet.shot.material import Material
from ringlet.shot.solver import Solver
from ringlet.sim.scene import Scene
from ringlet.sim.strands import Strands
from ringlet.sim.ties import Ties

LENGTH, APART, STIFFNESS = 0.05, 4e-3, 3.0  # [m], [m], [N/m]


def hanging(ties):
    """Two straight strands that hang side by side, and their scene."""
    z = np.linspace(0.0, -LENGTH, 11)
    strands = Strands(
        Curves.from_list([np.c_[np.full(11, x), 0 * z, z] for x in (0.0, APART)]),
        Material(damping=0.0, drag=0.0),
        2,
    )
    return Scene(strands, contact=Contact(radius=5e-4), ties=ties)


def settled(scene, force):
    """The scene after forces (n, 3) [N] have acted for long."""
    for _ in range(60):
        scene.strands.velocities[:] = 0.0
        scene.step(None, 1.0, forces=force, solver=Solver(newton=20, tolerance=1e-13))
    return scene.strands.positions


def test_a_tie_is_drawn_out_by_the_force_that_pulls_it():
    tie = Ties(np.array([[10, 21]], np.int32), np.array([APART]), np.array([STIFFNESS]))
    pull = 2e-3
    force = np.zeros((22, 3))
    force[10, 0], force[21, 0] = -pull, pull
    points = settled(hanging(tie), force)
    free = settled(hanging(None), force)
    gap = np.linalg.norm(points[21] - points[10]) - APART
    assert free[21, 0] - free[10, 0] > 10 * LENGTH / 11  # nothing else holds them
    # The strands resist so small an angle with next to nothing.
    assert gap == pytest.approx(pull / STIFFNESS, rel=0.02)


def test_ties_keep_momentum_and_turn_with_the_strands():
    """Free of forces, a tied pair that is thrown moves on with its momentum."""
    z = np.linspace(0.0, -LENGTH, 11)
    soft = np.where(np.arange(22) % 11 < 2, 1e-14, 1.0)
    strands = Strands(
        Curves.from_list([np.c_[np.full(11, x), 0 * z, z] for x in (0.0, APART)]),
        Material(damping=0.0, drag=0.0),
        1,
        {"stretch": soft, "bend": soft, "twist": soft},
    )
    tie = Ties(np.array([[10, 21], [9, 20]], np.int32), np.array([APART, APART]), np.array([STIFFNESS, STIFFNESS]))
    scene = Scene(strands, contact=Contact(radius=5e-4), ties=tie)
    free = np.arange(22) % 11 >= 1
    strands.velocities[free] = [0.05, 0.0, 0.0]
    strands.velocities[21] = [0.05, 0.1, 0.0]
    mass = strands.masses[free, None]
    before = (mass * strands.velocities[free]).sum(axis=0)
    for _ in range(20):
        scene.step(None, 1e-3, solver=Solver(newton=30, tolerance=1e-14))
    after = (mass * strands.velocities[free]).sum(axis=0)
    assert np.abs(after - before).max() < 1e-6 * np.abs(before).max()
    assert strands.velocities[10, 1] > 0.0  # the other strand is taken along


def test_ties_of_other_than_strands_are_refused():
    with pytest.raises(ValueError, match="ties join vertices of strands"):
        hanging(Ties(np.array([[10, 22]], np.int32), np.array([APART]), np.array([STIFFNESS])))
