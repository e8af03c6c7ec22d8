"""Contact without intersections, judged by linking numbers and ipctk, which are independent of the solver."""

import os
import pathlib
import subprocess
import sys
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from contact_scenes import SCENES as PROVED
from contact_scenes import run_through, tightened
from ringlet.data.curves import Curves
from ringlet.shot import Material, Solver
from ringlet.shot.contact import Contact
from ringlet.sim import Strands
from ringlet.sim.scene import Scene
from ringlet.validate.friction import CREEP, STEP, on_a_slope
from surfaces import sheet
from trial import judged_run

SCENES = PROVED | {"run_through": lambda: run_through(63, 101)}  # of 12 500 triangles; tests/proof has 50 000
outcome = cache(lambda name, newton: judged_run(SCENES[name](), newton))


@pytest.mark.parametrize("newton", [1, 5])
@pytest.mark.parametrize("name", SCENES)
def test_contact_scenes_have_no_crossings_and_keep_their_linking_numbers(name, newton):
    result = outcome(name, newton)
    assert result.finite
    assert result.crossings == 0
    assert np.abs(result.links[1] - result.links[0]).max(initial=0.0) < 1e-6


@pytest.mark.parametrize("newton", [1, 5])
@pytest.mark.parametrize("name", SCENES)
def test_edges_stretch_to_less_than_three_times_their_length(name, newton):
    """Scenes pull strands to at most twice their length, so a stretch of 3 means strain concentrated on one edge."""
    assert outcome(name, newton).stretch < 3.0


def test_a_shrinking_ring_of_cloth_gathers_curls():
    """All curls stay inside the ring, within less than half of their initial distance from its centre."""
    trial = tightened()
    curls, ring = trial.scene.strands, trial.scene.cloths[0]

    def reach():  # largest distance of a curl from the centre of the ring, in the plane of the ring
        middle = ring.positions.mean(axis=0)
        strands = np.split(curls.positions - middle, curls.curves.offsets[1:-1])
        through = [strand[:-1][strand[:-1, 1] * strand[1:, 1] <= 0] for strand in strands]
        return max(np.hypot(points[:, 0], points[:, 2]).min() for points in through)

    before = reach()
    for k in range(1, trial.steps + 1):
        trial.step(k, Solver())
    assert reach() < before / 2.5


@pytest.mark.parametrize("load", [0.1, 0.5, 0.9])
def test_sticking_contact_creeps_below_its_bound_and_stops(load):
    """The bound is W ε h / 2μN for a load W, a creep speed ε and a step h; the next second adds under 1 %."""
    (soon, _), (late, _) = on_a_slope(0.4, 0.4 * load, (0.25, 1.25))
    assert 0 < soon < 0.5 * load * CREEP * STEP
    assert abs(late - soon) < 0.01 * soon


@pytest.mark.parametrize(("name", "pace", "exact"), [("chain_of_loops", 1.0, 60), ("hooked_strands", 0.02, 12)])
def test_contact_is_invariant_under_uniform_motion(name, pace, exact):
    """Interlocked strands at rest and at 100 m/s, air included; steps converge, so only rounding differs.

    pace:  of the prescribed motion; pulled at full pace, hooked strands do not converge in 150 iterations
    exact: steps before contacts turn a corner, where rounding grows
    """

    def trial(velocity):
        still = SCENES[name]()
        still.scene.strands.velocities[:] += velocity
        return replace(still, targets=lambda t: still.targets(pace * t)).moved(velocity)

    velocity, contacts = np.array([100.0, 0, 0]), 0
    at_rest, moving = trial(np.zeros(3)), trial(velocity)
    for k in range(1, at_rest.steps + 1):
        reports = [each.step(k, Solver(newton=150, tolerance=1e-12)) for each in (at_rest, moving)]
        off = np.abs(moving.scene.positions - velocity * k * moving.dt - at_rest.scene.positions).max()
        if k <= exact:
            assert not any(report["unconverged"] for report in reports)
            assert off < 2e-12  # positions round to 2e-16 m and edge vectors to twice that; k dt² / m is about 1e6
            contacts += reports[0]["contacts"]
    assert contacts > 8
    assert off < 8e-9  # tens of metres away positions round to 4e-15 m


@pytest.mark.parametrize("name", ["squeezed", "tightened"])
def test_a_recalled_scene_takes_the_same_next_step(name):
    """Bit identical, with the friction state."""
    trial, other = SCENES[name](), SCENES[name]()
    for k in range(1, 9):
        report = trial.step(k, Solver())
    assert report["contacts"] > 0
    other.scene.strands.recall(trial.scene.strands.memory)
    other.scene.recall(trial.scene.memory)
    for each in (trial, other):
        each.step(9, Solver())
    assert (trial.scene.positions == other.scene.positions).all()


def test_contact_scenes_are_bit_identical_for_any_number_of_threads():
    program = """
import hashlib
from contact_scenes import SCENES
from ringlet.shot import Solver
for name in ("combed", "spun_head", "wound_coils"):
    trial = SCENES[name]()
    for k in range(1, 8):
        trial.step(k, Solver())
    print(name, hashlib.sha256(trial.scene.positions.tobytes()).hexdigest())
"""
    hashes = []
    for threads in ("1", "2", "5"):
        environment = {**os.environ, "OMP_NUM_THREADS": threads, "OMP_WAIT_POLICY": "passive"}
        done = subprocess.run(
            [sys.executable, "-c", program],
            env=environment,
            cwd=pathlib.Path(__file__).parents[2] / "tools/proof",
            capture_output=True,
            text=True,
            check=True,
        )
        hashes.append(done.stdout)
    assert hashes[0].count("\n") == 3
    assert hashes[0] == hashes[1] == hashes[2]


@pytest.mark.parametrize("scale", [1.0, 1e4])
def test_a_strand_leaves_a_body_slowly_at_any_stiffness(scale):
    """A strand that starts 8 mm below the ground is lifted at 2 cm/s; no vertex exceeds 15 cm/s."""
    along = np.linspace(0.0, 0.1, 41)
    points = np.c_[along, 0.004 - 0.12 * along, 0 * along]
    strand = Strands(Curves.from_list([points]), Material(bend_scale=scale), 3)
    ground = sheet([-0.1, 0, -0.1], [0, 0, 0.4], [0.4, 0, 0], 1)
    scene = Scene(strand, [ground], Contact(radius=5e-4))
    scene.allow_penetration(np.flatnonzero(points[:, 1] < 1e-3), 0)
    fastest = 0.0
    for _ in range(24):
        scene.step(None, 1 / 24, gravity=(0, -9.81, 0))
        fastest = max(fastest, float(np.linalg.norm(strand.velocities, axis=1).max()))
    assert fastest < 0.15
    assert scene.penetrating == 0
    assert strand.positions[:, 1].min() > 5e-4
