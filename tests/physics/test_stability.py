"""Strands released far from rest return, gain no energy and have bounded excursions."""

import numpy as np
import pytest
from coils import helix, rotation
from releases import CLOSE, PRESCRIBED, release, scenes
from ringlet.data.curves import Curves
from ringlet.shot import Material, Solver
from ringlet.sim import Strands

NAMES = [name for name, _, _ in scenes()]


@pytest.fixture(
    scope="module",
    params=[(24.0, "backward_euler"), (12.0, "backward_euler"), (24.0, "bdf2"), (12.0, "bdf2")],
    ids=lambda param: f"{param[0]:g} steps a second, {param[1]}",
)
def released(request):
    fps, integrator = request.param
    return release(fps=fps, integrator=integrator)


def listed(bad):
    return [name for name, is_bad in zip(NAMES, bad, strict=True) if is_bad]


def test_every_scene_returns_to_rest(released):
    assert not listed(~(released.away < CLOSE))


def test_no_scene_gains_energy(released):
    """Relative to the initial energy, to one part in a million; non-finite states count as an infinite gain."""
    assert not listed(~(released.gain < 1e-6))


def test_excursions_stay_within_reach(released):
    """An unstretched strand that swings to the other side of its root is that far from its rest shape."""
    rests = [rest for _, rest, _ in scenes()]
    lengths = np.array([np.linalg.norm(np.diff(rest, axis=0), axis=1).sum() for rest in rests])
    spans = np.array([np.linalg.norm(rest - rest[0], axis=1).max() for rest in rests])
    assert not listed(released.excursion > lengths + spans)


def test_one_newton_iteration_per_step_is_stable():
    """The return may take longer, without energy gain and with finite positions."""
    result = release(newton=1, steps=300)
    assert not listed(~(result.gain < 1e-6))
    assert np.isfinite(result.away).all()


def test_least_energy_loses_a_coil_with_a_straight_middle():
    """Signs of dihedral angles cannot restore the twist of a straight section; the material frame can."""
    middle = [name.startswith("coil with straight middle") for name in NAMES]
    assert (release(continuation="least_energy").away[middle] > 10 * CLOSE).any()


def shaken(time):
    """±10 cm at 4 Hz, along x."""
    return np.eye(3), np.array([0.1 * np.sin(2 * np.pi * 4 * time), 0, 0])


def spun(time):
    """Three turns a second about a vertical axis 10 cm away."""
    return rotation([0, 1, 0], 2 * np.pi * 3 * time), np.zeros(3)


def teleported(time):
    """A jump by a metre and a half turn within one step."""
    return (rotation([1, 0, 0.3], 3.0), np.array([1.0, 0.5, -0.4])) if time > 0.25 else (np.eye(3), np.zeros(3))


@pytest.mark.parametrize("motion", [shaken, spun, teleported])
@pytest.mark.parametrize("per_turn", [5, 12])
@pytest.mark.parametrize("newton", [1, 5])
def test_a_coil_returns_to_rest_after_violent_root_motion(motion, per_turn, newton):
    rest = Curves.from_list([helix(per_turn=per_turn, hand=hand) + [0.1, 0, 0.1 * k] for k, hand in enumerate((1, -1))])
    strands = Strands(rest, Material(), PRESCRIBED)
    reach = rest.lengths().max()
    for step in range(1, 25):
        turn, shift = motion(step / 24)
        targets = rest.points @ turn.T + shift
        report = strands.step(targets, 1 / 24, solver=Solver(newton=newton))
        assert not report["nan"].any()
        assert np.linalg.norm(strands.positions - targets, axis=1).max() < 2 * reach
    for _ in range(1200):
        strands.step(targets, 1 / 24, solver=Solver(newton=newton))
    assert np.abs(strands.positions - targets).max() < CLOSE
