"""Motion of strands: equilibrium, energy, invariance and prescribed motion."""

import numpy as np
import pytest
from coils import helix, jittered, rotation
from releases import straightened
from ringlet.shot import Solver
from undamped import undamped_strand

CONTINUATIONS = ["history", "least_energy", "material_frame"]
FRAME = 1 / 24


def total_energy(report):
    return float(sum(report[name][0] for name in ("stretch", "bend", "twist", "gravity", "kinetic")))


@pytest.mark.parametrize("continuation", CONTINUATIONS)
@pytest.mark.parametrize("newton", [1, 5])
def test_a_strand_at_rest_stays_at_rest(continuation, newton):
    rest = helix()
    strand = undamped_strand(rest)
    for _ in range(20):
        strand.step(rest, FRAME, solver=Solver(newton=newton, continuation=continuation))
    assert np.abs(strand.positions - rest).max() < 1e-12


@pytest.mark.parametrize("hand", [1, -1])
@pytest.mark.parametrize("per_turn", [5, 12])
@pytest.mark.parametrize("amount", [5e-4, 2e-3, 5e-3, 1e-2])
@pytest.mark.parametrize("newton", [1, 5])
def test_a_disturbed_coil_gains_no_energy(hand, per_turn, amount, newton):
    """Without gravity and root motion the total energy decreases.

    An unconverged step may return part of the loss: at most 1e-4 of the initial energy.
    """
    rest = helix(per_turn=per_turn, hand=hand)
    strand = undamped_strand(rest)
    strand.place(jittered(rest, amount))
    start = before = strand.energy(strand.positions)[0]
    for _ in range(60):
        report = strand.step(rest, FRAME, solver=Solver(newton=newton))
        assert report["nan"][0] == 0
        now = total_energy(report)
        assert now <= before + 1e-4 * start
        before = now


@pytest.mark.parametrize("hand", [1, -1])
@pytest.mark.parametrize("start", ["straightened", 5e-4, 2e-3, 5e-3, 1e-2])
def test_an_undamped_coil_returns_to_rest(hand, start):
    """From the straightened coil and from random displacements [m], by the dissipation of backward Euler alone."""
    rest = helix(hand=hand)
    strand = undamped_strand(rest)
    strand.place(straightened(rest) if start == "straightened" else jittered(rest, start))
    for _ in range(400):
        strand.step(rest, FRAME)
    assert np.abs(strand.positions - rest).max() < 1e-5


@pytest.mark.parametrize("continuation", CONTINUATIONS)
def test_a_rigid_jump_of_the_root_moves_the_strand_rigidly(continuation):
    """A jump by half a turn and a metre within a step is a rigid motion without sign flips or bending."""
    rest = helix()
    strand = undamped_strand(rest)
    there = rest @ rotation([1, 2, 3], np.pi).T + np.array([1.0, -0.5, 0.3])
    report = strand.step(there, FRAME, solver=Solver(newton=20, continuation=continuation))
    assert report["flips"][0] == 0 and report["winding_changes"][0] == 0
    for _ in range(400):
        strand.step(there, FRAME, solver=Solver(newton=20, continuation=continuation))
    assert np.abs(strand.positions - there).max() < 1e-5


def test_motion_is_invariant_under_rigid_transforms():
    rest = helix(60)
    turn, shift = rotation([3, -1, 2], 1.1), np.array([0.3, -0.2, 0.5])
    here, there = undamped_strand(rest), undamped_strand(rest @ turn.T + shift)
    here.place(jittered(rest, 1e-3))
    there.place(jittered(rest, 1e-3) @ turn.T + shift)
    gravity = np.array([0, -9.81, 0])
    solver = Solver(newton=50, tolerance=1e-12)
    for _ in range(10):
        here.step(rest, FRAME, gravity=tuple(gravity), solver=solver)
        there.step(rest @ turn.T + shift, FRAME, gravity=tuple(turn @ gravity), solver=solver)
    assert np.abs(here.positions @ turn.T + shift - there.positions).max() < 1e-8


def test_a_mirrored_coil_moves_as_the_mirror_image():
    left, right = helix(60, hand=-1), helix(60, hand=1)
    mirror = np.array([1, 1, -1])
    solver = Solver(newton=50, tolerance=1e-12)
    a, b = undamped_strand(left), undamped_strand(right)
    a.place(jittered(right, 1e-3) * mirror)
    b.place(jittered(right, 1e-3))
    for _ in range(10):
        a.step(left, FRAME, gravity=(1.0, -9.0, 2.0), solver=solver)
        b.step(right, FRAME, gravity=(1.0, -9.0, -2.0), solver=solver)
    assert np.abs(a.positions - b.positions * mirror).max() < 1e-8


def test_free_fall_is_uniformly_accelerated():
    """With a falling root backward Euler gives a fall of g h² k (k + 1) / 2 after k steps."""
    rest = helix(40)
    strand = undamped_strand(rest)
    fallen = 0.0
    for k in range(1, 11):
        fallen = -9.81 * FRAME**2 * k * (k + 1) / 2
        strand.step(rest + [0, fallen, 0], FRAME, gravity=(0, -9.81, 0))
    assert np.abs(strand.positions - rest - [0, fallen, 0]).max() < 1e-9


def test_until_converged_iterates_beyond_five_iterations():
    rest = helix()
    there = rest @ rotation([0, 0, 1], 1.0).T
    for solver, unsolved in ((Solver(), 1), (Solver(until_converged=True), 0)):
        report = undamped_strand(rest).step(there, FRAME, gravity=(0, -9.81, 0), solver=solver)
        assert report["unconverged"][0] == unsolved
        assert (report["residual"][0] > solver.tolerance) == unsolved


def test_five_iterations_follow_a_turning_root_within_one_percent():
    """The line search rotates edges, so that a rotation of the root costs no stretch."""
    rest = helix(60)

    def tip_of(solver):
        strand, tips = undamped_strand(rest), []
        for k in range(1, 25):
            turned = rest @ rotation([0, 0, 1], 0.8 * np.sin(2 * np.pi * k / 24)).T
            strand.step(turned, FRAME, solver=solver)
            tips.append(strand.positions[-1].copy())
        return np.array(tips)

    right = tip_of(Solver(newton=300))
    off = {n: np.linalg.norm(tip_of(Solver(newton=n)) - right, axis=1).max() for n in (1, 5)}
    moved = np.linalg.norm(right - rest[-1], axis=1).max()
    assert moved > 0.01
    assert off[5] < 0.01 * moved
    assert off[1] < 0.3 * moved


def test_the_material_frame_clamps_only_eigenvalues_of_compressed_edges():
    rest = helix(40)
    for continuation in ("material_frame", "least_energy"):
        strand = undamped_strand(rest)
        assert strand.step(rest, FRAME, solver=Solver(continuation=continuation))["clamped"][0] == 0
    short = undamped_strand(rest)
    short.place(0.9 * rest)
    report = short.step(0.9 * rest, 1e-6)
    assert report["clamped"][0] == 2 * (len(rest) - 4), "two transverse eigenvalues for every edge with a free end"
    bent = undamped_strand(rest)
    bent.place(jittered(rest, 1e-3))
    counts = [
        bent.step(rest, 1e-6, solver=Solver(continuation=continuation))["clamped"][0]
        for continuation in ("material_frame", "least_energy")
    ]
    assert counts[1] > counts[0]


def test_drag_accelerates_a_strand_to_the_speed_of_the_wind():
    """A coil whose root moves with the wind reaches its velocity."""
    rest = helix(30)
    strand = undamped_strand(rest, drag=1e-2)
    wind = (0.5, 0.0, 0.2)
    for k in range(1, 200):
        strand.step(rest + np.array(wind) * FRAME * k, FRAME, wind=wind)
    assert np.abs(strand.velocities[4:] - wind).max() < 1e-6


def test_damping_does_not_resist_rigid_rotation():
    rest = helix(60)
    strand = undamped_strand(rest, damping=10.0)
    step = 0.05
    strand.velocities[:] = (rest @ rotation([0, 1, 0], step).T - rest) / FRAME
    strand.step(rest @ rotation([0, 1, 0], step).T, FRAME, solver=Solver(newton=50, tolerance=1e-13))
    assert np.abs(strand.positions - rest @ rotation([0, 1, 0], step).T).max() < 2e-5


def test_prescribed_vertices_reach_their_targets():
    rest = helix(40)
    strand = undamped_strand(rest)
    targets = rest + [0.01, 0.02, -0.03]
    strand.step(targets, FRAME)
    assert (strand.positions[:4] == targets[:4]).all()
