"""Locks in equilibrium stay as groomed, are stable and keep their natural frequencies."""

import numpy as np
import pytest
from coils import helix, rotation
from locks import GRAVITY, STRAIGHT, arc, curl, first_frequency, sag, scene
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip, Mesh
from ringlet.rest.inverse_statics import internal_forces
from ringlet.rest.rod_strains import RodStrains, measure_strains, shape_of_strains
from ringlet.shot import Material
from ringlet.shot.solver import Solver
from ringlet.sim import Obstacle
from ringlet.sim.hair_pins import spring_forces
from ringlet.sim.scene import Scene
from ringlet.sim.shot_strands import make_strands
from ringlet.sim.strands import Strands

from ringlet.rest import equilibrium, loft, with_sag

MODE = "[rest]\nmode = 'equilibrium'\n"
BARELY = MODE + "spring = 0.1\n"  # only the stiffness that stability needs


@pytest.mark.parametrize("points", [curl(), arc(), STRAIGHT, helix(30, per_turn=5, hand=-1)])
def test_balanced_strands_have_the_loads_as_their_gradient(points):
    """With the strains of `balance` as rest state, the gradient of the energy equals the given random loads."""
    curves, material = Curves.from_list([points]), Material(bend_scale=1e3, correct_resolution=False)
    strands = Strands(curves, material)
    loads = 1e-5 * np.random.default_rng(3).normal(size=points.shape)
    frames = strands.directors.copy()
    forces = internal_forces(curves, points, frames, loads, 3)
    for _ in range(3):  # the lengths of the rest shape change the stiffness
        stretch, bend, twist = (np.where(stiffness > 0, stiffness, np.inf) for stiffness in strands.stiffness)
        strain = RodStrains(forces.length / stretch, forces.bend / bend[:, None], forces.twist / twist)
        rest, _ = shape_of_strains(curves, measure_strains(curves, points, frames).plus(strain, -1.0), frames)
        strands = Strands(curves.with_points(rest), material)
    strands.place(points)
    _, gradient, _ = strands.energy(points)
    assert np.abs(gradient - loads)[3:].max() < 1e-6 * np.abs(loads).max()


def test_locks_in_equilibrium_stay_as_groomed_for_ten_seconds():
    shot, groom = scene(curl(), arc(), STRAIGHT, helix(60) * [1, 1, 1], more=MODE)
    made = with_sag(equilibrium(shot, groom), shot)
    strands = make_strands(shot, groom, made.rest, made.stiffened)
    strands.place(groom.locks.points)
    for _ in range(240):
        strands.step(groom.locks.points, 1 / 24, gravity=GRAVITY)
    assert sag(made.sagged, groom.locks.points) > 1e-3
    assert sag(strands.positions, groom.locks.points) < 0.1 * shot.strands.radius


def test_an_unstable_lock_is_stiffened_until_it_stands():
    """A coil that stands upright returns after a perturbation."""
    standing = helix(100) * [1, -1, 1]
    shot, groom = scene(standing, curl(), more=BARELY)
    made = equilibrium(shot, groom)
    assert made.stiffened[0] > 1.5 and made.stiffened[1] == 1.0
    strands = make_strands(shot, groom, made.rest, made.stiffened)
    strands.place(groom.locks.points + np.where(strands.held[:, None], 0, 1e-4 * rotation((0, 1, 0), 0.3)[0]))
    assert strands.settle(gravity=GRAVITY, tolerance=1e-8)
    assert sag(strands.positions, groom.locks.points) < 1e-6
    soft = make_strands(shot, groom, equilibrium(*scene(standing, curl(), more=BARELY + "stiffen = 1")).rest)
    soft.place(groom.locks.points)
    soft.settle(gravity=GRAVITY, tolerance=1e-8)
    assert sag(soft.positions, groom.locks.points) > 0.01


def test_a_lock_that_cannot_stand_keeps_its_shape_and_is_reported():
    upright = np.c_[np.zeros(60), np.linspace(0, 0.5, 60), 1e-4 * np.linspace(0, 1, 60) ** 2]
    shot, groom = scene(upright, curl(), more=MODE)
    made = equilibrium(shot, groom)
    assert made.off[0] > 0.1 and made.off[1] < 1e-6
    assert (made.rest.points[:60] == upright).all() and made.stiffened[0] == 1.0


def test_equilibrium_keeps_the_natural_frequency_of_a_curl():
    shot, groom = scene(helix(60, radius=4e-3, pitch=4e-3), more="[strands]\ndamping = 0\ndrag = 0\n" + MODE)
    made = with_sag(equilibrium(shot, groom), shot)
    plain = first_frequency(make_strands(shot, groom), made.sagged)
    balanced = first_frequency(make_strands(shot, groom, made.rest, made.stiffened), made.lofted)
    assert balanced == pytest.approx(plain, rel=0.1)


def stiffness_at(strands, points):
    """Hessian of the energy with adapted frames over the free coordinates [N/m], by finite differences."""
    step, size = 1e-6, points.size
    rows = np.empty((size - 9, size))
    for row, i in enumerate(range(9, size)):
        aside = step * np.eye(1, size, i).reshape(points.shape)
        there, back = strands.energy(points + aside)[1], strands.energy(points - aside)[1]
        rows[row] = ((there - back) / (2 * step)).ravel()
    return 0.5 * (rows[:, 9:] + rows[:, 9:].T)


@pytest.mark.parametrize(("angle", "slower"), [(110, True), (0, False)])
def test_gravity_shifts_squared_frequencies_independently_of_stiffness(angle, slower):
    """Gravity lowers the squared frequency of a standing lock and raises that of a hanging one, by g over a length."""
    groomed, added = helix(20, radius=4e-3, pitch=6e-3, per_turn=10) @ rotation((0, 0, 1), np.radians(angle)).T, []
    for scale in (8, 32):
        shot, groom = scene(groomed, more=MODE + f"[strands]\nbend_scale = {scale}\ncorrect_resolution = false\n")
        made = equilibrium(shot, groom)
        assert made.stiffened[0] == 1
        plain, balanced = make_strands(shot, groom), make_strands(shot, groom, made.rest)
        balanced.place(groomed)
        mass = np.repeat(plain.masses[3:], 3)
        before, after = stiffness_at(plain, groomed), stiffness_at(balanced, groomed)
        mode = np.linalg.eigh(before / np.sqrt(np.outer(mass, mass)))[1][:, 0] / np.sqrt(mass)
        added.append(mode @ (after - before) @ mode)
    assert (added[0] < 0) == slower and abs(added[0]) > 9.81 / 0.1
    assert added[1] == pytest.approx(added[0], rel=0.02)


STANDING = helix(70, pitch=9e-3) * [1, -1, 1]
LEANING = helix(50, pitch=9e-3, per_turn=8) @ rotation((0, 0, 1), 2).T


def balanced_at(scale, points):
    """A lock of the given ``bend_scale`` in equilibrium as groomed, stable or unstable."""
    shot, groom = scene(points, more=f"[strands]\ncorrect_resolution = false\nbend_scale = {scale}\n")
    strands, locks = make_strands(shot, groom), groom.locks
    frames = strands.directors.copy()
    for _ in range(4):  # the lengths of the rest shape change the stiffness
        forces = internal_forces(locks, points, frames, strands.loads(GRAVITY), 3)
        stretch, bend, twist = (np.where(stiffness > 0, stiffness, np.inf) for stiffness in strands.stiffness)
        strain = RodStrains(forces.length / stretch, forces.bend / bend[:, None], forces.twist / twist)
        rest, _ = shape_of_strains(locks, measure_strains(locks, points, frames).plus(strain, -1.0), frames)
        strands = make_strands(shot, groom, locks.with_points(rest))
    strands.place(points)
    return strands


@pytest.mark.parametrize("points", [STANDING, LEANING])
def test_stabilising_stiffness_is_where_the_smallest_eigenvalue_changes_sign(points):
    needed = balanced_at(1, points).stabilising_stiffness(np.zeros(1), 1e4)[0]
    assert needed > 1.2
    for factor, stands in ((0.96, False), (1.02, True)):
        strands = balanced_at(factor * needed, points)
        assert (np.linalg.eigvalsh(stiffness_at(strands, points))[0] > 0) == stands
        assert (strands.stabilising_stiffness(np.zeros(1), 1e4)[0] == 1) == stands
    assert np.isinf(balanced_at(1, points).stabilising_stiffness(np.zeros(1), 0.9 * needed)[0])


@pytest.mark.parametrize("spring", [0.3, 0.7])
def test_gravity_leaves_a_lock_the_requested_fraction_of_its_stiffness(spring):
    """The squared lowest frequency stays above the fraction `spring` of that without gravity, by less than 0.1."""
    shot, groom = scene(STANDING, more=MODE + f"spring = {spring}\n[strands]\ncorrect_resolution = false\n")
    made = equilibrium(shot, groom)
    assert made.stiffened[0] > 1.1
    plain, balanced = make_strands(shot, groom), make_strands(shot, groom, made.rest, made.stiffened)
    balanced.place(STANDING)
    without, under_weight = (np.linalg.eigvalsh(stiffness_at(strands, STANDING))[0] for strands in (plain, balanced))
    assert 0.95 * spring < under_weight / without < spring + 0.1


def test_equilibrium_balances_a_lock_that_loft_cannot():
    """Loft iterates on the hanging shape and fails where that is unstable."""
    standing = helix(80, radius=4e-3, pitch=6e-3) @ rotation((0, 0, 1), np.radians(110)).T
    lofted, balanced = loft(*scene(standing)), equilibrium(*scene(standing, more=MODE))
    assert balanced.off[0] < 1e-6 < lofted.off[0]


FLOOR = Mesh(
    "/floor", 0.1 * np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1.0]]), np.array([[0, 2, 1], [0, 3, 2]])
)
REACH = 1e-3  # [m] activation distance of a lock and a body


def lying():
    """A wavy strand of 8 cm whose root is above the floor and whose length lies on it."""
    t = np.linspace(0, 1, 60)
    return np.c_[0.08 * t - 0.04, 0.9 * REACH + 6e-3 * np.exp(-((t / 0.08) ** 2)), 4e-3 * np.sin(12 * t)]


def over(height=0.0):
    """The floor as an obstacle, at a height."""
    mesh = Mesh(FLOOR.name, FLOOR.points + [0, height, 0], FLOOR.triangles.astype(np.int32))
    return Obstacle(mesh, Clip(np.array([1.0]), mesh.points[None], 24.0))


def test_the_rest_shape_of_a_lock_on_a_body_is_its_groomed_shape():
    """In equilibrium with gravity alone its rest shape would rise from the floor."""
    shot, groom = scene(lying(), more=MODE + "[strands]\nbend_scale = 4\n[contact]\nradius = 5e-4\n")
    hovering, resting = equilibrium(shot, groom), equilibrium(shot, groom, obstacles=[over()])
    assert sag(resting.rest.points, lying()) < 0.01 * sag(hovering.rest.points, lying())
    assert sag(hovering.rest.points, lying()) > 0.01
    strands = make_strands(shot, groom, resting.rest, resting.stiffened)
    strands.place(lying())
    floor = over()
    touching = Scene(strands, [floor.body(1.0)], shot.touching)
    for _ in range(48):
        touching.step(lying(), 1 / 24, gravity=GRAVITY)
    assert sag(strands.positions, lying()) < shot.strands.radius


def pressed_and_lifted(shot, groom, made):
    """Fraction of its weight with which a strand presses on the floor, and its rise without gravity [m]."""
    strands, floor = make_strands(shot, groom, made.rest, made.stiffened), over()
    strands.place(groom.locks.points)
    touching, pressed = Scene(strands, [floor.body(1.0)], shot.touching), []
    for _ in range(24):
        touching.step(groom.locks.points, 1 / 24, gravity=GRAVITY)
        _, values = touching.contacts
        pressed.append((values[:, 8] * values[:, 5]).sum() / (9.81 * strands.masses.sum()))
    for _ in range(12):
        touching.step(groom.locks.points, 1 / 24)
    return np.median(pressed), (strands.positions - groom.locks.points)[:, 1].max()


def test_a_lock_on_a_body_presses_with_its_weight_and_does_not_rise():
    """Lofted against gravity alone it hardly presses, and rises without gravity."""
    shot, groom = scene(lying(), more=MODE + "[strands]\nbend_scale = 4\n[contact]\nradius = 5e-4\n")
    pressed, lifted = pressed_and_lifted(shot, groom, loft(shot, groom))
    assert pressed < 0.1 and lifted > 0.01
    pressed, lifted = pressed_and_lifted(shot, groom, equilibrium(shot, groom, obstacles=[over()]))
    assert pressed > 0.8 and lifted < shot.strands.radius


@pytest.mark.parametrize(
    ("points", "body", "contact"),
    [
        (lying() * [1, -1, 1], over(), "radius = 5e-4"),  # below the floor, which could only pull
        (lying(), over(-0.3 * REACH), "radius = 5e-4"),  # beyond the activation distance
        (lying(), over(), "on = false"),
    ],
)
def test_bodies_that_cannot_push_support_no_lock(points, body, contact):
    shot, groom = scene(points, more=MODE + f"[strands]\nbend_scale = 4\n[contact]\n{contact}\n")
    free, beside = equilibrium(shot, groom), equilibrium(shot, groom, obstacles=[body])
    assert (free.rest.points == beside.rest.points).all()


def pinned_near_tip(groom, firm):
    pin = np.zeros(len(groom.locks.points), np.float32)
    pin[-3] = firm
    locks = Curves(groom.locks.points, groom.locks.offsets, groom.locks.ids, {}, {"pin": pin})
    return Groom(locks, locks, groom.scalp)


def test_a_soft_pin_supports_its_share_of_the_weight():
    shot, groom = scene(STRAIGHT, more=MODE)
    groom = pinned_near_tip(groom, 0.5)
    made = equilibrium(shot, groom)
    strands = make_strands(shot, groom, made.rest, made.stiffened)
    strands.place(STRAIGHT)
    for _ in range(48):
        forces = spring_forces(groom.locks, strands, STRAIGHT, 1 / 24, GRAVITY)
        strands.step(STRAIGHT, 1 / 24, gravity=GRAVITY, forces=forces)
    assert sag(strands.positions, STRAIGHT) < 1e-6


def test_a_pinned_lock_hangs_from_its_pin():
    """With a pin near its tip the rest shape stays close to the groomed shape, and the lock does not move."""
    shot, groom = scene(STRAIGHT, more=MODE)
    free, groom = equilibrium(shot, groom), pinned_near_tip(groom, 1.0)
    pinned = equilibrium(shot, groom)
    assert sag(pinned.rest.points, STRAIGHT) < 0.1 * sag(free.rest.points, STRAIGHT)
    strands = make_strands(shot, groom, pinned.rest, pinned.stiffened)
    strands.place(STRAIGHT)
    for _ in range(48):
        strands.step(STRAIGHT, 1 / 24, gravity=GRAVITY)
    assert sag(strands.positions, STRAIGHT) < 1e-6


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (MODE + "[solver]\ncontinuation = 'history'\n", "solver.continuation"),
        (MODE + "gain = 0.5\n", "rest.gain"),
        ("held = 2\n" + MODE, "held is 2"),
    ],
)
def test_unsupported_settings_are_refused(more, words):
    with pytest.raises(UserError, match=words):
        equilibrium(*scene(curl(), more=more))


def test_bdf2_keeps_equilibrium():
    shot, groom = scene(curl(), more=MODE)
    made = equilibrium(shot, groom)
    strands = make_strands(shot, groom, made.rest, made.stiffened)
    strands.place(groom.locks.points)
    for _ in range(48):
        strands.step(groom.locks.points, 1 / 24, gravity=GRAVITY, solver=Solver(integrator="bdf2"))
    assert sag(strands.positions, groom.locks.points) < 1e-6
