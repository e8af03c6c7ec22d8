"""Safeguards of `history`: each has a scene that succeeds with it and fails without it."""

import numpy as np
import pytest
from coils import helix, jittered, rotation
from releases import CLOSE, PRESCRIBED, flattened, straightened
from ringlet.data.curves import Curves
from ringlet.shot import Material, Solver
from ringlet.sim import Strands

FRAME = 1 / 24
SAFEGUARDS = ("flip_history", "winding_number", "straight_fade")


def history(*, without=()):
    return Solver(continuation="history", safeguards=[name for name in SAFEGUARDS if name not in without])


def released(rest, start, solver, *, steps, variation=None, **material):
    """Final distance from rest [m] and largest energy increase in a step, relative to the initial energy."""
    strand = Strands(Curves.from_list([rest]), Material(**material), PRESCRIBED, variation or {})
    strand.place(start)
    first = before = strand.energy(start, continuation="history")[0]
    gain = 0.0
    for _ in range(steps):
        report = strand.step(rest, FRAME, solver=solver)
        energy = sum(report[name][0] for name in ("stretch", "bend", "twist", "kinetic"))
        gain, before = max(gain, (energy - before) / first), energy
    return np.abs(strand.positions - rest).max(), gain


@pytest.mark.parametrize("limit_twist", [True, False])
def test_twist_stiffer_than_bend_gains_energy_unless_limited(limit_twist):
    """A flattened coil with twist ten times as stiff as bend, from six perturbed initial shapes."""
    rest = helix(100)
    stiff = {"twist": np.full(len(rest), 10 / 0.72)}
    starts = [jittered(flattened(rest), 1e-8, seed) for seed in range(6)]
    gains = [
        released(rest, start, history(), steps=40, variation=stiff, limit_twist=limit_twist)[1] for start in starts
    ]
    assert max(gains) < 1e-2 if limit_twist else min(gains) > 2e-2


@pytest.mark.parametrize("without", [(), ("flip_history",)])
def test_a_kink_pushed_through_straight_returns_only_with_flip_history(without):
    """Without the history the mirrored kink has its rest angle and is in equilibrium."""
    rest = 0.01 * np.array([[0, 0, 0], [0, -1, 0], [0, -2, 0], [0.6, -2.8, 0]])
    strand = Strands(Curves.from_list([rest]), Material(twist_ratio=0.0, mass_damping=20.0), 3)
    push = np.zeros_like(rest)
    for step in range(480):
        push[3, 0] = -2e-4 if step < 120 else 0.0
        strand.step(rest, FRAME, forces=push, solver=history(without=without))
        if step == 119:
            assert strand.positions[3, 0] < -0.004, "the kink is on the other side"
    mirrored = rest[3] * [-1, 1, 1]
    assert np.abs(strand.positions[3] - (mirrored if without else rest[3])).max() < CLOSE


@pytest.mark.parametrize("without", [(), ("winding_number",)])
def test_twist_accumulates_over_turns_only_with_the_winding_number(without):
    """The end is rotated twice about the middle edge, a torsion spring of energy ½ k Δφ²."""
    rest = helix(6)
    strand = Strands(Curves.from_list([rest]), Material(), np.ones(6, bool))
    energies = []
    for angle in np.linspace(0, 4 * np.pi, 49)[1:]:
        turned = rest.copy()
        turned[4:] = rest[3] + (rest[4:] - rest[3]) @ rotation(rest[3] - rest[2], angle).T
        energies.append(strand.step(turned, FRAME, solver=history(without=without))["twist"][0])
    quarter, whole, two = (energies[k - 1] for k in (6, 24, 48))
    if without:
        assert whole < 1e-6 * quarter and two < 1e-6 * quarter
    else:
        assert whole == pytest.approx(16 * quarter, rel=1e-6)
        assert two == pytest.approx(64 * quarter, rel=1e-6)


@pytest.mark.parametrize("without", [(), ("straight_fade",)])
def test_a_straightened_coil_returns_only_with_the_straight_fade(without):
    """Collinear edges have an undefined dihedral angle with an unbounded gradient, which locks the strand."""
    rest = helix(100, per_turn=5)
    away, _ = released(rest, straightened(rest), history(without=without), steps=400)
    assert (away < CLOSE) == (not without)
    assert not without or away > 0.1
