"""Nothing passes through anything: so say linking numbers and ipctk, which know nothing of the solver."""

import os
import pathlib
import subprocess
import sys
from functools import cache

import numpy as np
import pytest
from coils import helix
from contact_scenes import SCENES, act, hooked_strands, onto_a_sheet, sheet, tightened
from crossings import Judge
from linking import linking
from ringlet.data.curves import Curves
from ringlet.shot import Material, Solver
from ringlet.shot.contact import Contact
from ringlet.sim import Strands
from ringlet.sim.scene import Scene
from ringlet.validate.friction import CREEP, STEP, on_a_slope

outcome = cache(lambda name, newton: act(SCENES[name](), newton))


@pytest.mark.parametrize("newton", [1, 5])
@pytest.mark.parametrize("name", SCENES)
def test_nothing_passes_through_anything(name, newton):
    result = outcome(name, newton)
    assert result.crossings == 0
    assert np.abs(result.links[1] - result.links[0]).max(initial=0.0) < 1e-6


@pytest.mark.parametrize("newton", [1, 5])
@pytest.mark.parametrize("name", SCENES)
def test_no_edge_is_torn(name, newton):
    """What is pulled is pulled to less than twice its length: no edge may take all of it."""
    assert outcome(name, newton).stretch < 3.0


@pytest.mark.parametrize("name", SCENES)
def test_positions_stay_finite(name):
    assert outcome(name, 1).finite
    assert outcome(name, 5).finite


def test_a_tie_that_tightens_gathers_curls():
    """All of them go through it to the end, and where it is they are in a third of the room."""
    play = tightened()
    curls, ring = play.scene.strands, play.scene.cloths[0]

    def reach():  # of the curl that is farthest from the ring's middle where it goes through its plane
        middle = ring.positions.mean(axis=0)
        strands = np.split(curls.positions - middle, curls.curves.offsets[1:-1])
        through = [strand[:-1][strand[:-1, 1] * strand[1:, 1] <= 0] for strand in strands]
        return max(np.hypot(points[:, 0], points[:, 2]).min() for points in through)

    before = reach()
    for k in range(1, play.steps + 1):
        play.step(k, Solver())
    assert reach() < before / 2.5


@pytest.mark.parametrize("load", [0.1, 0.5, 0.9])
def test_what_sticks_gives_way_a_little_and_stays_there(load):
    """By less than W ε / 2μN for a load W and a creep speed ε times a step; a hundred times less in the next second."""
    (soon, _), (late, _) = on_a_slope(0.4, 0.4 * load, (0.25, 1.25))
    assert 0 < soon < 0.5 * load * CREEP * STEP
    assert abs(late - soon) < 0.01 * soon


@pytest.mark.parametrize("turns", [1, 2, 3])
def test_the_linking_number_counts_turns(turns):
    """Of a coil round a ring; none where it is beside it."""
    angle = 2 * np.pi * np.arange(40) / 40
    ring = np.c_[np.cos(angle), np.sin(angle), 0 * angle]
    coil = helix(12 * turns, radius=0.4, pitch=0.0) + [1, 0, 0]
    assert abs(linking(ring, coil)) == pytest.approx(turns, abs=1e-9)
    assert linking(ring, coil + [2, 0, 0]) == pytest.approx(0, abs=1e-9)


def test_the_judge_sees_what_passes():
    """It can say no: the hooked strands carried through each other."""
    play = hooked_strands()
    judge, before = Judge(play.scene), play.scene.positions.copy()
    after = before.copy()
    after[: len(after) // 2] += [0, 0.05, 0]
    assert judge.crossings(before, before) == 0
    assert judge.crossings(before, after) > 0
    assert judge.crossings(before, before + [0, 0.05, 0]) == 0


def test_a_scene_that_moves_as_a_whole_does_the_same():
    """At 100 m/s, with the air, to rounding: a strand that hits a sheet. Steps converge; else rounding decides."""
    positions = []
    for speed in (np.zeros(3), np.array([100.0, 0, 0])):
        play = onto_a_sheet()
        play.scene.strands.velocities[:] += speed
        play, contacts = play.moved(speed), 0
        for k in range(1, play.steps + 1):
            contacts += play.step(k, Solver(newton=150, tolerance=1e-12))["contacts"]
        assert contacts > 0
        positions.append(play.scene.positions - speed * k * play.dt)
    # It ends 21 m away, where positions are rounded to 4e-15 m, and an edge, a difference of two, to twice that; its
    # k dt² / m is about a million.
    assert np.abs(positions[1] - positions[0]).max() < 8e-9


@pytest.mark.parametrize("name", ["squeezed", "tightened"])
def test_what_a_scene_remembers_is_all_that_its_next_step_depends_on(name):
    """To the last bit, friction included."""
    play, other = SCENES[name](), SCENES[name]()
    for k in range(1, 9):
        report = play.step(k, Solver())
    assert report["contacts"] > 0
    other.scene.recall(play.scene.memory)
    other.scene.strands.recall(play.scene.strands.memory)
    for each in (play, other):
        each.step(9, Solver())
    assert (play.scene.positions == other.scene.positions).all()


def test_the_number_of_threads_does_not_matter():
    """To the last bit."""
    program = """
import hashlib
from contact_scenes import SCENES
from ringlet.shot import Solver
for name in ("combed", "spun_head", "wound_coils"):
    play = SCENES[name]()
    for k in range(1, 8):
        play.step(k, Solver())
    print(name, hashlib.sha256(play.scene.positions.tobytes()).hexdigest())
"""
    said = []
    for threads in ("1", "2", "5"):
        environment = {**os.environ, "OMP_NUM_THREADS": threads, "OMP_WAIT_POLICY": "passive"}
        done = subprocess.run(
            [sys.executable, "-c", program],
            env=environment,
            cwd=pathlib.Path(__file__).parent,
            capture_output=True,
            text=True,
            check=True,
        )
        said.append(done.stdout)
    assert said[0].count("\n") == 3
    assert said[0] == said[1] == said[2]


@pytest.mark.parametrize("scale", [1.0, 1e4])
def test_what_begins_inside_a_body_comes_out_gently_however_stiff_it_is(scale):
    """A strand from above the ground into it, 8 mm deep: lifted at 2 cm/s, its tip hardly faster, and out then."""
    along = np.linspace(0.0, 0.1, 41)
    points = np.c_[along, 0.004 - 0.12 * along, 0 * along]
    strand = Strands(Curves.from_list([points]), Material(bend_scale=scale), 3)
    ground = sheet([-0.1, 0, -0.1], [0, 0, 0.4], [0.4, 0, 0], 1)
    scene = Scene(strand, [ground], Contact(radius=5e-4))
    scene.excuse(np.flatnonzero(points[:, 1] < 1e-3), 0)
    fastest = 0.0
    for _ in range(24):
        scene.step(None, 1 / 24, gravity=(0, -9.81, 0))
        fastest = max(fastest, float(np.linalg.norm(strand.velocities, axis=1).max()))
    assert fastest < 0.15
    assert scene.excused == 0
    assert strand.positions[:, 1].min() > 5e-4
