"""Locks in equilibrium stay exactly where they were groomed, stand, and are no less lively for it."""

import numpy as np
import pytest
from coils import helix, rotation
from ringlet.curves import Curves
from ringlet.errors import UserError
from ringlet.shot import Material, equilibrium, loft
from ringlet.shot.balance import balance
from ringlet.shot.joints import Joints, measure, shape
from ringlet.shot.simulate import make_strands
from ringlet.shot.strands import Solver, Strands
from test_lofted_strands import GRAVITY, STRAIGHT, arc, curl, first_frequency, sag, scene

MODE = "[rest]\nmode = 'equilibrium'\n"


@pytest.mark.parametrize("points", [curl(), arc(), STRAIGHT, helix(30, per_turn=5, hand=-1)])
def test_balance_is_the_gradient_of_the_energy_turned_round(points):
    """Strands that remember what balance says of random loads have those loads as their gradient."""
    curves, material = Curves.from_list([points]), Material(bend_scale=1e3, correct_resolution=False)
    strands = Strands(curves, material)
    loads = 1e-5 * np.random.default_rng(3).normal(size=points.shape)
    frames = strands.directors.copy()
    forces = balance(curves, points, frames, loads, 3)
    for _ in range(3):  # a rest shape has other lengths, and stiffness with them
        stretch, bend, twist = (np.where(stiffness > 0, stiffness, np.inf) for stiffness in strands.stiffness)
        strain = Joints(forces.length / stretch, forces.bend / bend[:, None], forces.twist / twist)
        rest, _ = shape(curves, measure(curves, points, frames).plus(strain, -1.0), frames)
        strands = Strands(curves.with_points(rest), material)
    strands.place(points)
    _, gradient, _ = strands.energy(points)
    assert np.abs(gradient - loads)[3:].max() < 1e-6 * np.abs(loads).max()


def test_locks_stay_where_they_were_groomed_for_ten_seconds():
    shot, groom = scene(curl(), arc(), STRAIGHT, helix(60) * [1, 1, 1], more=MODE)
    made = equilibrium(shot, groom)
    strands = make_strands(shot, groom, made.rest, made.stiffened)
    strands.place(groom.locks.points)
    for _ in range(240):
        strands.step(groom.locks.points, 1 / 24, gravity=GRAVITY)
    assert sag(made.sagged, groom.locks.points) > 1e-3
    assert sag(strands.positions, groom.locks.points) < 0.1 * shot.strands.radius


def test_a_lock_that_would_fall_is_stiffened_until_it_stands():
    """A coil that stands upright; nudged, it comes back."""
    standing = helix(100) * [1, -1, 1]
    shot, groom = scene(standing, curl(), more=MODE)
    made = equilibrium(shot, groom)
    assert made.stiffened[0] > 1.5 and made.stiffened[1] == 1.0
    strands = make_strands(shot, groom, made.rest, made.stiffened)
    strands.place(groom.locks.points + np.where(strands.held[:, None], 0, 1e-4 * rotation((0, 1, 0), 0.3)[0]))
    assert strands.settle(gravity=GRAVITY, tolerance=1e-8)
    assert sag(strands.positions, groom.locks.points) < 1e-6
    soft = make_strands(shot, groom, equilibrium(*scene(standing, curl(), more=MODE + "stiffen = 1")).rest)
    soft.place(groom.locks.points)
    soft.settle(gravity=GRAVITY, tolerance=1e-8)
    assert sag(soft.positions, groom.locks.points) > 0.01


def test_what_falls_however_stiff_it_may_be_keeps_its_shape_and_is_told():
    upright = np.c_[np.zeros(60), np.linspace(0, 0.5, 60), 1e-4 * np.linspace(0, 1, 60) ** 2]
    shot, groom = scene(upright, curl(), more=MODE)
    made = equilibrium(shot, groom)
    assert made.off[0] > 0.1 and made.off[1] < 1e-6
    assert (made.rest.points[:60] == upright).all() and made.stiffened[0] == 1.0


def test_a_curl_in_equilibrium_swings_as_fast_as_it_did():
    shot, groom = scene(helix(60, radius=4e-3, pitch=4e-3), more="[strands]\ndamping = 0\ndrag = 0\n" + MODE)
    made = equilibrium(shot, groom)
    plain = first_frequency(make_strands(shot, groom), made.sagged)
    balanced = first_frequency(make_strands(shot, groom, made.rest, made.stiffened), made.lofted)
    assert balanced == pytest.approx(plain, rel=0.1)


def test_it_takes_up_what_the_loft_leaves():
    """The loft corrects a shape by how it hangs, and cannot where it falls."""
    standing = helix(80, radius=4e-3, pitch=6e-3) @ rotation((0, 0, 1), np.radians(110)).T
    lofted, balanced = loft(*scene(standing)), equilibrium(*scene(standing, more=MODE))
    assert balanced.off[0] < 1e-6 < lofted.off[0]


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (MODE + "[solver]\ncontinuation = 'history'\n", "solver.continuation"),
        (MODE + "gain = 0.5\n", "rest.gain"),
        ("held = 2\n" + MODE, "held is 2"),
    ],
)
def test_what_it_cannot_do_is_refused(more, words):
    with pytest.raises(UserError, match=words):
        equilibrium(*scene(curl(), more=more))


def test_bdf2_keeps_it_still_as_well():
    shot, groom = scene(curl(), more=MODE)
    made = equilibrium(shot, groom)
    strands = make_strands(shot, groom, made.rest, made.stiffened)
    strands.place(groom.locks.points)
    for _ in range(48):
        strands.step(groom.locks.points, 1 / 24, gravity=GRAVITY, solver=Solver(integrator="bdf2"))
    assert sag(strands.positions, groom.locks.points) < 1e-6
