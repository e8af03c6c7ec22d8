"""How strands move: what a step conserves, what it never does, and that it is the same however it is computed."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from coils import helix, jittered, rotation
from ringlet.data.curves import Curves
from ringlet.shot import Material, Solver
from ringlet.sim import Strands
from ringlet.sim.scene import Scene

from ringlet import _core

CONTINUATIONS = ["history", "least_energy", "material_frame"]
FRAME = 1 / 24


def one(points, held=4, **material):
    defaults = {"damping": 0.0, "drag": 0.0}
    return Strands(Curves.from_list([points]), Material(**{**defaults, **material}), held)


def total_energy(report):
    return float(sum(report[name][0] for name in ("stretch", "bend", "twist", "gravity", "kinetic")))


@pytest.mark.parametrize("continuation", CONTINUATIONS)
@pytest.mark.parametrize("newton", [1, 5])
def test_at_rest_it_stays_at_rest(continuation, newton):
    rest = helix()
    strand = one(rest)
    for _ in range(20):
        strand.step(rest, FRAME, solver=Solver(newton=newton, continuation=continuation))
    assert np.abs(strand.positions - rest).max() < 1e-12


@pytest.mark.parametrize("hand", [1, -1])
@pytest.mark.parametrize("per_turn", [5, 12])
@pytest.mark.parametrize("amount", [5e-4, 2e-3, 5e-3, 1e-2])
@pytest.mark.parametrize("newton", [1, 5])
def test_a_disturbed_coil_gains_no_energy(hand, per_turn, amount, newton):
    """A root that does not move does no work, and there is no gravity: the sum of energies falls.

    A step that is not solved to the end may give a little of its loss back: at most a 10 000th of what the start held.
    """
    rest = helix(per_turn=per_turn, hand=hand)
    strand = one(rest)
    strand.place(jittered(rest, amount))
    start = before = strand.energy(strand.positions)[0]
    for _ in range(60):
        report = strand.step(rest, FRAME, solver=Solver(newton=newton))
        assert report["nan"][0] == 0
        now = total_energy(report)
        assert now <= before + 1e-4 * start
        before = now


@pytest.mark.parametrize("hand", [1, -1])
@pytest.mark.parametrize("amount", [5e-4, 2e-3, 5e-3, 1e-2])
def test_a_disturbed_coil_of_twelve_vertices_a_turn_comes_back(hand, amount):
    rest = helix(hand=hand)
    strand = one(rest)
    strand.place(jittered(rest, amount))
    for _ in range(400):
        strand.step(rest, FRAME)
    assert np.abs(strand.positions - rest).max() < 1e-5


def test_a_straightened_coil_springs_back():
    rest = helix()
    straight = rest.copy()
    length = np.linalg.norm(rest[1] - rest[0])
    straight[4:] = rest[3] + np.array([0, -length, 0]) * np.arange(1, len(rest) - 3)[:, None]
    strand = one(rest)
    strand.place(straight)
    for _ in range(400):
        strand.step(rest, FRAME)
    assert np.abs(strand.positions - rest).max() < 1e-5


@pytest.mark.parametrize("continuation", CONTINUATIONS)
def test_a_rigid_jump_of_the_root_carries_the_strand_along(continuation):
    """A teleport by half a turn and a metre in one frame is a rigid motion: no sign flips, nothing is bent."""
    rest = helix()
    strand = one(rest)
    there = rest @ rotation([1, 2, 3], np.pi).T + np.array([1.0, -0.5, 0.3])
    report = strand.step(there, FRAME, solver=Solver(newton=20, continuation=continuation))
    assert report["flips"][0] == 0 and report["winding_changes"][0] == 0
    for _ in range(400):
        strand.step(there, FRAME, solver=Solver(newton=20, continuation=continuation))
    assert np.abs(strand.positions - there).max() < 1e-5


def test_the_motion_does_not_depend_on_where_and_how_the_scene_stands():
    rest = helix(60)
    turn, shift = rotation([3, -1, 2], 1.1), np.array([0.3, -0.2, 0.5])
    here, there = one(rest), one(rest @ turn.T + shift)
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
    a, b = one(left), one(right)
    a.place(jittered(right, 1e-3) * mirror)
    b.place(jittered(right, 1e-3))
    for _ in range(10):
        a.step(left, FRAME, gravity=(1.0, -9.0, 2.0), solver=solver)
        b.step(right, FRAME, gravity=(1.0, -9.0, -2.0), solver=solver)
    assert np.abs(a.positions - b.positions * mirror).max() < 1e-8


def test_free_fall_is_uniformly_accelerated():
    """A strand whose root falls with it feels nothing: backward Euler gives g h² k (k + 1) / 2 after k steps."""
    rest = helix(40)
    strand = one(rest)
    fallen = 0.0
    for k in range(1, 11):
        fallen = -9.81 * FRAME**2 * k * (k + 1) / 2
        strand.step(rest + [0, fallen, 0], FRAME, gravity=(0, -9.81, 0))
    assert np.abs(strand.positions - rest - [0, fallen, 0]).max() < 1e-9


def shaken(strand, rest, steps, integrator, dt=FRAME):
    """Positions after so many steps in which the root is pulled to the side."""
    solver = Solver(newton=50, tolerance=1e-12, integrator=integrator)
    for k in range(1, steps + 1):
        strand.step(rest + [0.01 * np.sin(0.3 * k), 0, 0], dt, gravity=(0, -9.81, 0), solver=solver)
    return strand.positions.copy()


def test_the_first_step_of_bdf2_is_one_of_backward_euler():
    rest = helix(40)
    first = [shaken(one(rest, damping=0.01), rest, 1, integrator) for integrator in ("backward_euler", "bdf2")]
    second = [shaken(one(rest, damping=0.01), rest, 2, integrator) for integrator in ("backward_euler", "bdf2")]
    assert (first[0] == first[1]).all()
    assert np.abs(second[0] - second[1]).max() > 1e-5


def test_bdf2_begins_anew_when_a_strand_is_placed():
    rest = helix(40)
    fresh, moved = one(rest, damping=0.01), one(rest, damping=0.01)
    shaken(moved, rest, 3, "bdf2")
    moved.place(rest)
    assert (shaken(moved, rest, 3, "bdf2") == shaken(fresh, rest, 3, "bdf2")).all()


def test_bdf2_takes_a_step_of_backward_euler_when_the_time_step_changes():
    rest = helix(40)
    a, b = one(rest, damping=0.01), one(rest, damping=0.01)
    shaken(a, rest, 3, "bdf2")
    shaken(b, rest, 3, "bdf2")
    assert (shaken(a, rest, 1, "bdf2", FRAME / 2) == shaken(b, rest, 1, "backward_euler", FRAME / 2)).all()


def test_bdf2_follows_a_falling_root_to_second_order():
    """In free fall nothing is bent; only its one step of backward Euler is off, and that by g h² / 2 at most."""
    rest = helix(40)
    strand = one(rest)
    for k in range(1, 11):
        targets = rest - [0, 0.5 * 9.81 * (k * FRAME) ** 2, 0]
        strand.step(targets, FRAME, gravity=(0, -9.81, 0), solver=Solver(newton=50, integrator="bdf2"))
    assert np.abs(strand.positions - targets).max() < 0.5 * 9.81 * FRAME**2
    assert np.abs(strand.velocities[4:] - [0, -9.81 * 10 * FRAME, 0]).max() < 0.02 * 9.81 * 10 * FRAME


@pytest.mark.parametrize("integrator", ["backward_euler", "bdf2"])
def test_a_scene_in_which_nothing_touches_moves_with_the_same_integrator(integrator):
    rest = helix(20)
    alone, among = one(rest, damping=0.01), one(rest, damping=0.01)
    scene = Scene(among)
    solver = Solver(until_converged=True, tolerance=1e-11, linear_tolerance=1e-12, integrator=integrator)
    for k in range(1, 6):
        targets = rest + [0.002 * k, 0, 0]
        alone.step(targets, FRAME, gravity=(0, -9.81, 0), solver=solver)
        scene.step(targets, FRAME, gravity=(0, -9.81, 0), solver=solver)
    assert np.abs(scene.positions - alone.positions).max() < 1e-9


def test_until_converged_goes_on_where_five_iterations_are_not_enough():
    rest = helix()
    there = rest @ rotation([0, 0, 1], 1.0).T
    for solver, unsolved in ((Solver(), 1), (Solver(until_converged=True), 0)):
        report = one(rest).step(there, FRAME, gravity=(0, -9.81, 0), solver=solver)
        assert report["unconverged"][0] == unsolved
        assert (report["residual"][0] > solver.tolerance) == unsolved


def test_five_iterations_follow_a_head_that_turns_nearly_as_converged_ones_do():
    """Were edges that turn to get longer, the search would keep little of any direction."""
    rest = helix(60)

    def tip_of(solver):
        strand, tips = one(rest), []
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


def test_a_material_frame_leaves_no_eigenvalue_out_but_of_compressed_edges():
    rest = helix(40)
    for continuation in ("material_frame", "least_energy"):
        strand = one(rest)
        assert strand.step(rest, FRAME, solver=Solver(continuation=continuation))["clamped"][0] == 0
    short = one(rest)
    short.place(0.9 * rest)
    report = short.step(0.9 * rest, 1e-6)
    assert report["clamped"][0] == 2 * (len(rest) - 4), "two across every edge with a free end"
    bent = one(rest)
    bent.place(jittered(rest, 1e-3))
    counts = [
        bent.step(rest, 1e-6, solver=Solver(continuation=continuation))["clamped"][0]
        for continuation in ("material_frame", "least_energy")
    ]
    assert counts[1] > counts[0]


def test_drag_carries_a_strand_to_the_speed_of_the_wind():
    """With its root free to follow, a coil ends up moving as the air does."""
    rest = helix(30)
    strand = one(rest, drag=1e-2)
    wind = (0.5, 0.0, 0.2)
    for k in range(1, 200):
        strand.step(rest + np.array(wind) * FRAME * k, FRAME, wind=wind)
    assert np.abs(strand.velocities[4:] - wind).max() < 1e-6


def test_damping_does_not_hold_a_rigid_turn_back():
    rest = helix(60)
    strand = one(rest, damping=10.0)
    step = 0.05
    strand.velocities[:] = (rest @ rotation([0, 1, 0], step).T - rest) / FRAME
    strand.step(rest @ rotation([0, 1, 0], step).T, FRAME, solver=Solver(newton=50, tolerance=1e-13))
    assert np.abs(strand.positions - rest @ rotation([0, 1, 0], step).T).max() < 2e-5


def test_held_vertices_are_exactly_where_they_are_told_to_be():
    rest = helix(40)
    strand = one(rest)
    targets = rest + [0.01, 0.02, -0.03]
    strand.step(targets, FRAME)
    assert (strand.positions[:4] == targets[:4]).all()


def test_strands_of_different_lengths_move_as_if_each_were_alone():
    counts = [20, 57, 33, 100, 8, 41, 64, 12, 29, 5]
    curves = [helix(n, hand=(-1) ** k, per_turn=8 + k) + [0.1 * k, 0, 0] for k, n in enumerate(counts)]
    material = Material()
    together = Strands(Curves.from_list(curves), material, 3)
    for _ in range(5):
        together.step(together.curves.points, FRAME, gravity=(2.0, -9.81, 0.0))
    for k, curve in enumerate(curves):
        alone = Strands(Curves.from_list([curve]), material, 3)
        for _ in range(5):
            alone.step(curve, FRAME, gravity=(2.0, -9.81, 0.0))
        assert (alone.positions == together.curves.with_points(together.positions)[k]).all()


def test_the_result_is_bit_for_bit_the_same_for_any_number_of_threads():
    curves = Curves.from_list([helix(50, hand=(-1) ** k) + [0.1 * k, 0, 0] for k in range(40)])
    before = _core.thread_count()
    results = []
    try:
        for threads in (1, 2, 5):
            _core.set_thread_count(threads)
            strands = Strands(curves, Material())
            for _ in range(5):
                strands.step(curves.points, FRAME, gravity=(3.0, -9.81, 0.0))
            results.append(strands.positions.copy())
    finally:
        _core.set_thread_count(before)
    assert (results[0] == results[1]).all() and (results[0] == results[2]).all()


SCRIPT = """
import sys; sys.path.insert(0, sys.argv[1])
import numpy as np
from coils import helix
from ringlet.data.curves import Curves
from ringlet.shot import Material, Solver, Strands
curves = Curves.from_list([helix(50, hand=(-1) ** k) + [0.1 * k, 0, 0] for k in range(11)])
strands = Strands(curves, Material())
for _ in range(5):
    strands.step(curves.points, 1 / 24, gravity=(3.0, -9.81, 0.0), solver=Solver(newton=30, tolerance=1e-12))
np.save(sys.argv[2], strands.positions)
"""


def test_every_instruction_set_gives_the_same_motion(tmp_path):
    results = []
    for simd in ("baseline", "avx2", "avx512"):
        environment = {**os.environ, "RINGLET_SIMD": simd}
        out = tmp_path / f"{simd}.npy"
        subprocess.run([sys.executable, "-c", SCRIPT, Path(__file__).parent, out], env=environment, check=True)
        results.append(np.load(out))
    assert np.abs(results[1] - results[0]).max() < 1e-9
    assert np.abs(results[2] - results[0]).max() < 1e-9


def test_a_start_that_is_not_finite_is_reported_and_harms_no_other_strand():
    curves = Curves.from_list([helix(30) + [0.1 * k, 0, 0] for k in range(3)])
    strands = Strands(curves, Material())
    start = curves.points.copy()
    start[45] = np.nan
    strands.place(start)
    report = strands.step(curves.points, FRAME)
    assert list(report["nan"]) == [0, 1, 0]
    assert np.isfinite(strands.positions[:30]).all() and np.isfinite(strands.positions[60:]).all()
