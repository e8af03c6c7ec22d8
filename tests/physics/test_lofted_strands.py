"""Lofted strands hang as they were groomed, and are no stiffer for it."""

import numpy as np
import pytest
from coils import helix, rotation
from ringlet.data.curves import Curves
from ringlet.data.groom import Groom
from ringlet.data.mesh import Mesh
from ringlet.rest.rod_strains import measure_strains, shape_of_strains
from ringlet.shot import parse_shot
from ringlet.shot.solver import Solver
from ringlet.sim.motion import make_strands

from ringlet.rest import loft

SHOT = 'ringlet = 1\ngroom = "groom.usdc"\nframes = [1, 1]\n'
GRAVITY = (0.0, -9.81, 0.0)


def scene(*strands, more=""):
    """A shot and a groom of these strands."""
    mesh = Mesh("none", np.zeros((3, 3)), np.array([[0, 1, 2]], np.int32))
    locks = Curves.from_list(list(strands))
    return parse_shot(SHOT + more), Groom(locks, locks, mesh)


def curl():
    """A corkscrew that comes out sideways from its root."""
    return helix(80, radius=4e-3, pitch=6e-3) @ rotation((0, 0, 1), np.radians(70)).T


def arc():
    """A smooth strand of 8 cm that leaves sideways and bends upwards."""
    angle = np.linspace(0, 1.0, 40)
    return 0.08 * np.c_[np.sin(angle), 1 - np.cos(angle), 0 * angle]


def sag(points, groomed):
    return float(np.linalg.norm(points - groomed, axis=1).max())


STRAIGHT = np.c_[np.linspace(0, 0.06, 40), np.zeros((40, 2))]


@pytest.mark.parametrize(
    ("groomed", "continuation"),
    [
        (curl(), "material_frame"),
        (arc(), "material_frame"),
        (STRAIGHT, "material_frame"),
        (curl(), "least_energy"),  # hinges cannot tell which way a straight strand was pre-bent
        (arc(), "least_energy"),
    ],
)
def test_a_lofted_strand_sags_less_than_a_fifth_of_what_it_sagged(groomed, continuation):
    shot, groom = scene(groomed, more=f"[solver]\ncontinuation = '{continuation}'\n")
    made = loft(shot, groom)
    strands = make_strands(shot, groom, made.rest)
    strands.place(groomed)
    assert strands.settle(gravity=GRAVITY, tolerance=1e-8, continuation=continuation)
    assert sag(made.sagged, groomed) > 5e-4
    assert sag(strands.positions, groomed) < 0.2 * sag(made.sagged, groomed)
    assert np.abs(strands.positions - made.lofted).max() < 1e-5


def test_a_lofted_curl_hangs_as_groomed_within_the_tolerance():
    shot, groom = scene(curl())
    made = loft(shot, groom)
    assert made.off.max() < shot.rest.tolerance
    assert sag(made.lofted, curl()) < shot.rest.tolerance


def first_frequency(strands, hanging):
    """Of small swings about where a strand hangs [1/s], from how its tip crosses its mean after a gentle push."""
    dt = 1 / 1000
    strands.place(hanging)
    strands.settle(gravity=GRAVITY, tolerance=1e-9)
    rest = strands.positions.copy()
    strands.velocities[:] = 1e-3 * (rest - rest[0])[:, [1]] * [0, 0, 1] / 0.01
    tip = []
    for _ in range(1500):
        strands.step(rest, dt, gravity=GRAVITY, solver=Solver(newton=20, tolerance=1e-10))
        tip.append(strands.positions[-1, 2] - rest[-1, 2])
    spectrum = np.abs(np.fft.rfft(np.array(tip) * np.hanning(len(tip)), 16 * len(tip)))
    return np.fft.rfftfreq(16 * len(tip), dt)[spectrum.argmax()]


def test_a_lofted_curl_swings_as_fast_as_it_did():
    shot, groom = scene(helix(60, radius=4e-3, pitch=4e-3), more="[strands]\ndamping = 0\ndrag = 0\n")
    made = loft(shot, groom)
    assert made.off.max() < shot.rest.tolerance < 0.2 * sag(made.sagged, groom.locks.points)
    plain = first_frequency(make_strands(shot, groom), made.sagged)
    lofted = first_frequency(make_strands(shot, groom, made.rest), made.lofted)
    assert lofted == pytest.approx(plain, rel=0.1)


def test_gain_is_the_part_of_the_sag_that_is_taken_away():
    groomed = arc()
    sags = []
    for gain in (0.0, 0.5, 1.0):
        shot, groom = scene(groomed, more=f"[strands]\nbend_scale = 20\n[rest]\ngain = {gain}\n")
        sags.append(sag(loft(shot, groom).lofted, groomed))
    assert sags[1] == pytest.approx(0.5 * sags[0], rel=0.1)
    assert sags[2] < 2e-5


def test_gain_by_a_map_lofts_one_lock_and_leaves_the_other():
    shot, groom = scene(arc(), arc() + [0, 0, 0.05], more="[rest]\ngain = { map = 'keep' }\n")
    groom.locks.curve["keep"] = np.array([1.0, 0.0])
    made = loft(shot, groom)
    moved = np.abs(made.rest.points - groom.locks.points).max(axis=1).reshape(2, -1).max(axis=1)
    assert moved[0] > 1e-3 and moved[1] < 1e-12
    assert np.allclose(made.lofted[40:], made.sagged[40:])


def test_a_lock_that_cannot_stand_is_left_no_worse_than_it_was():
    """Upright, straight and ten times as long as one that buckles under its own weight."""
    upright = np.c_[np.zeros(60), np.linspace(0, 0.5, 60), 1e-4 * np.linspace(0, 1, 60) ** 2]
    shot, groom = scene(upright, curl())
    made = loft(shot, groom)
    assert made.off[0] > 0.1 and made.off[1] < shot.rest.tolerance
    away = np.linalg.norm(made.lofted - groom.locks.points, axis=1)[:60].max()
    assert away <= np.linalg.norm(made.sagged - groom.locks.points, axis=1)[:60].max() + 1e-9


def test_joints_give_the_shape_back():
    curves = Curves.from_list([curl(), arc(), np.random.default_rng(1).normal(size=(7, 3))])
    shot, groom = scene()
    groom.locks = curves
    directors = make_strands(shot, groom).directors.copy()
    joints = measure_strains(curves, curves.points, directors)
    points, made = shape_of_strains(curves, joints, directors)
    assert np.abs(points - curves.points).max() < 1e-12
    again = measure_strains(curves, points, made)
    assert np.abs(again.bend - joints.bend).max() < 1e-9 and np.abs(again.minus(joints).twist).max() < 1e-9
