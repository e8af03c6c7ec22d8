"""Lofted strands hang as they were groomed and keep their stiffness."""

import numpy as np
import pytest
from coils import helix
from locks import GRAVITY, STRAIGHT, arc, curl, first_frequency, sag, scene
from ringlet.data.curves import Curves
from ringlet.rest.rod_strains import measure_strains, shape_of_strains
from ringlet.sim.shot_strands import make_strands

from ringlet.rest import loft


@pytest.mark.parametrize(
    ("groomed", "continuation"),
    [
        (curl(), "material_frame"),
        (arc(), "material_frame"),
        (STRAIGHT, "material_frame"),
        (curl(), "least_energy"),  # hinges cannot store the pre-bend of a straight strand
        (arc(), "least_energy"),
    ],
)
def test_loft_reduces_sag_to_less_than_a_fifth(groomed, continuation):
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


def test_loft_keeps_the_natural_frequency_of_a_curl():
    shot, groom = scene(helix(60, radius=4e-3, pitch=4e-3), more="[strands]\ndamping = 0\ndrag = 0\n")
    made = loft(shot, groom)
    assert made.off.max() < shot.rest.tolerance < 0.2 * sag(made.sagged, groom.locks.points)
    plain = first_frequency(make_strands(shot, groom), made.sagged)
    lofted = first_frequency(make_strands(shot, groom, made.rest), made.lofted)
    assert lofted == pytest.approx(plain, rel=0.1)


def test_gain_is_the_fraction_of_sag_that_loft_removes():
    groomed = arc()
    sags = []
    for gain in (0.0, 0.5, 1.0):
        shot, groom = scene(groomed, more=f"[strands]\nbend_scale = 20\n[rest]\ngain = {gain}\n")
        sags.append(sag(loft(shot, groom).lofted, groomed))
    assert sags[1] == pytest.approx(0.5 * sags[0], rel=0.1)
    assert sags[2] < 2e-5


def test_a_gain_map_lofts_one_lock_and_leaves_the_other():
    shot, groom = scene(arc(), arc() + [0, 0, 0.05], more="[rest]\ngain = { map = 'keep' }\n")
    groom.locks.curve["keep"] = np.array([1.0, 0.0])
    made = loft(shot, groom)
    moved = np.abs(made.rest.points - groom.locks.points).max(axis=1).reshape(2, -1).max(axis=1)
    assert moved[0] > 1e-3 and moved[1] < 1e-12
    assert np.allclose(made.lofted[40:], made.sagged[40:])


def test_loft_does_not_increase_the_sag_of_an_unstable_lock():
    """An upright straight lock, ten times as long as the buckling length under its own weight."""
    upright = np.c_[np.zeros(60), np.linspace(0, 0.5, 60), 1e-4 * np.linspace(0, 1, 60) ** 2]
    shot, groom = scene(upright, curl())
    made = loft(shot, groom)
    assert made.off[0] > 0.1 and made.off[1] < shot.rest.tolerance
    away = np.linalg.norm(made.lofted - groom.locks.points, axis=1)[:60].max()
    assert away <= np.linalg.norm(made.sagged - groom.locks.points, axis=1)[:60].max() + 1e-9


def test_joint_strains_reproduce_the_shape():
    curves = Curves.from_list([curl(), arc(), np.random.default_rng(1).normal(size=(7, 3))])
    shot, groom = scene()
    groom.locks = curves
    directors = make_strands(shot, groom).directors.copy()
    joints = measure_strains(curves, curves.points, directors)
    points, made = shape_of_strains(curves, joints, directors)
    assert np.abs(points - curves.points).max() < 1e-12
    again = measure_strains(curves, points, made)
    assert np.abs(again.bend - joints.bend).max() < 1e-9 and np.abs(again.minus(joints).twist).max() < 1e-9
