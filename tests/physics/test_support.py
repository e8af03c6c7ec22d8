"""Supports that keep locks as groomed: pins, bodies with friction and other locks."""

import numpy as np
import pytest
from coils import helix, rotation
from hairstyles import FPS, HEAD, make_style
from locks import GRAVITY, sag, scene
from ringlet.data.curves import Curves
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip, Mesh
from ringlet.rest.compliance import ARM, Compliance
from ringlet.rest.equilibrium import support_forces
from ringlet.rest.nonnegative_qp import solve_nonnegative_qp
from ringlet.rest.rod_strains import edges
from ringlet.shot.solver import Solver
from ringlet.sim import Obstacle
from ringlet.sim.obstacle import Body
from ringlet.sim.resting_contacts import initial_contact_forces
from ringlet.sim.scene import Scene
from ringlet.sim.shot_strands import make_strands
from scipy.optimize import nnls
from scipy.sparse import block_diag

from ringlet.rest import dependencies, equilibrium, to_curves, update_rest_shape

MODE = "[rest]\nmode = 'equilibrium'\n"
SOFT = MODE + "[strands]\nbend_scale = 4\n[contact]\nradius = 5e-4\n"
REACH = 1e-3  # [m] activation distance of two locks, and of a lock and a body


@pytest.mark.parametrize("seed", range(3))
def test_compressive_forces_solve_nonnegative_least_squares(seed):
    """Several problems in one call; half of the forces of the last may also pull."""
    random = np.random.default_rng(seed)
    parts = [(random.normal(size=(12, 8)), random.normal(size=12)) for _ in range(4)]
    free = np.zeros(32, bool)
    free[24:28] = True
    found = solve_nonnegative_qp(
        block_diag([a.T @ a for a, _ in parts], "csr"), np.concatenate([-a.T @ b for a, b in parts]), free
    )
    pulls = np.concatenate([parts[3][0], -parts[3][0][:, :4]], axis=1)
    (*first, last), both = (nnls(a, b)[0] for a, b in parts), nnls(pulls, parts[3][1])[0]
    both[:4] -= both[8:]
    assert found == pytest.approx(np.concatenate([*first, both[:8]]), abs=1e-9)
    assert (last == 0).any() and (found == 0).any()


def test_energy_of_two_forces_is_summed_over_joints_that_both_strain():
    """Against strains per joint: bend and twist follow from the moment, stretch from the force."""
    random = np.random.default_rng(5)
    shot, groom = scene(*crossed(), more=SOFT)
    locks, strands = groom.locks, make_strands(shot, groom)
    rows, tangents = slice(30, 60), edges(locks, locks.points)[1][30:]
    points, vertex, force, couple = (
        locks.points[rows],
        random.integers(3, 30, 8),
        random.normal(size=(8, 3)),
        random.normal(size=8),
    )
    soft = [np.divide(1, of[rows], where=of[rows] > 0, out=np.zeros(30)) for of in strands.stiffness]
    first = [shot.held - 1, shot.held - 1, shot.held - 2]
    stretch, bend, twist = (np.where(np.arange(30) >= k, of, 0) for k, of in zip(first, soft, strict=True))

    def strains(k):
        moment = np.cross(points[vertex[k]] - points, force[k]) + ARM * couple[k] * tangents[vertex[k]]
        about, along = (moment * tangents).sum(1)[:, None], (force[k] * tangents).sum(1)[:, None]
        parts = bend[:, None], moment - about * tangents, twist[:, None], about, stretch[:, None], along
        there = np.concatenate([soft**0.5 * of for soft, of in zip(parts[::2], parts[1::2], strict=True)], axis=1)
        return (there * (np.arange(30) < vertex[k])[:, None]).ravel()

    each = np.stack([strains(k) for k in range(8)])
    give = Compliance(shot.held, locks, strands)
    found = give.of_pairs(rows, vertex, give.wrenches(30 + vertex, force, couple))
    assert found == pytest.approx(each @ each.T, rel=1e-9, abs=1e-9 * np.abs(found).max())


def crossed():
    """A beam, and a longer one across it."""
    t = np.linspace(0, 1, 30)[:, None]
    below = [0, 0, 0] + t * [0.04, 0, 0]
    above = [0.02, 0.95 * REACH, -0.03] + t * [0, 0, 0.06]
    return below, above


def fallen(steps, query=lambda scene: None):
    """Two beams after a fall onto each other and onto a floor; ``query`` is called before each step."""
    below, above = crossed()
    shot, groom = scene(below, above + [0, 0.2 * REACH, 0], more=SOFT)
    at, size = np.array([0, -1.8 * REACH, 0]), 0.2
    floor = np.array([[-size, 0, -size], [size, 0, -size], [0, 0, size]]) + at
    strands = make_strands(shot, groom)
    touching = Scene(strands, [Body(floor, np.array([[0, 2, 1]], np.int32))], shot.touching)
    for _ in range(steps):
        query(touching)
        touching.step(groom.locks.points, 1 / 48, gravity=GRAVITY)
    return touching


def test_a_contact_query_returns_the_contacts_of_the_last_step():
    """Locks and a body, initially without contact."""
    touching = fallen(8)
    vertices, values = touching.contacts
    found, where = touching.touching()
    assert (vertices == found).all() and (values[:, :8] == where).all()
    of_locks = (vertices < len(touching.strands.positions)).all(axis=1)
    assert of_locks.any() and not of_locks.all()


def test_a_contact_query_before_a_step_agrees_with_a_tiny_step():
    shot, groom = scene(*crossed(), more=SOFT)
    away = 1e-9  # [m] separation by a step
    contact = shot.touching.model_copy(update={"separation_speed": away / 1e-6})
    touching = Scene(make_strands(shot, groom), contact=contact)
    found, where = touching.touching()
    touching.step(groom.locks.points, 1e-6, solver=Solver(newton=1))
    vertices, values = touching.contacts
    assert len(found) > 0 and (vertices == found).all()
    assert where[:, :7] == pytest.approx(values[:, :7], abs=1e3 * away)
    assert where[:, 7] == pytest.approx(REACH)


def test_contact_queries_do_not_change_the_motion():
    plain, queried = fallen(8), fallen(8, query=Scene.touching)
    assert (plain.positions == queried.positions).all()
    for name, values in plain.memory.items():
        assert np.array_equal(values, queried.memory[name])


def drift(shot, groom, made, obstacles=(), steps=48, known=True):
    """Largest drift of locks from the groomed shape [m]; ``known``: support forces initialise the contacts."""
    strands = make_strands(shot, groom, made.rest, made.stiffened)
    strands.place(groom.locks.points)
    touching = Scene(strands, [one.body(1.0) for one in obstacles], shot.touching)
    if known:
        touching.set_initial_forces(
            *initial_contact_forces(shot.touching, groom.locks, make_strands(shot, groom), obstacles, made.support)
        )
    for _ in range(steps):
        touching.step(groom.locks.points, 1 / 24, gravity=GRAVITY)
    return sag(strands.positions, groom.locks.points)


def test_a_lock_on_another_is_supported_by_it():
    """Support forces are equal and opposite, reduce the correction of the upper lock, and both locks stay."""
    shot, groom = scene(*crossed(), more=SOFT)
    support, upper = support_forces(shot, groom, []), slice(30, 60)
    assert np.abs(support.sum(axis=0)).max() < 1e-12
    strands = make_strands(shot, groom)
    assert 0.1 < support[upper, 1].sum() / (9.81 * strands.masses[upper].sum()) < 1
    together = equilibrium(shot, groom)
    alone = equilibrium(*scene(*crossed(), more=SOFT.replace("radius = 5e-4", "on = false")))
    assert sag(together.rest.points[upper], crossed()[1]) < 0.5 * sag(alone.rest.points[upper], crossed()[1])
    assert (together.stiffened == 1).all()
    assert drift(shot, groom, together) < 0.2 * shot.strands.radius


@pytest.mark.parametrize("friction", [0.0, 1.0])
def test_contact_forces_support_a_lock_on_a_body_from_the_first_step(friction):
    """Contact forces sum to the support forces, so that no lock sinks in or slides before it is supported."""
    lying, slope = on_slope(friction)
    shot, groom = scene(lying, lying + [0, 0, 0.2], more=SOFT)
    made, groomed = equilibrium(shot, groom, obstacles=[slope]), make_strands(shot, groom)
    _, forces = initial_contact_forces(shot.touching, groom.locks, groomed, [slope], made.support)
    assert len(forces) > 0 and (forces[:, 0] > 0).all()
    total = np.linalg.norm(forces, axis=1).sum()
    assert total == pytest.approx(np.linalg.norm(made.support[~groomed.held], axis=1).sum(), rel=1e-9)
    at_once, later = (drift(shot, groom, made, [slope], 1, known) for known in (True, False))
    assert at_once < 1e-9 and at_once < 1e-3 * later


def test_contact_forces_support_crossed_locks_from_the_first_step():
    shot, groom = scene(*crossed(), more=SOFT)
    made = equilibrium(shot, groom)
    at_once, later = (drift(shot, groom, made, steps=1, known=known) for known in (True, False))
    assert at_once < 1e-9 and at_once < 1e-3 * later


def test_support_forces_are_refused_after_the_first_step():
    with pytest.raises(ValueError, match="before the first step"):
        fallen(1).set_initial_forces(np.zeros((0, 4)), np.zeros((0, 3)))


@pytest.mark.parametrize(("name", "locks", "seconds"), [("down", 60, 2.0), ("long 3B", 100, 1.0)])
def test_locks_in_contact_stay_as_groomed(name, locks, seconds):
    """Long hair: no vertex drifts by more than the radius of a hair."""
    style = make_style(name, locks, HEAD, "scalp")
    shot, head = style.shot("equilibrium"), style.head(np.zeros(1), FPS)
    made = equilibrium(shot, style.groom, obstacles=[head])
    assert np.linalg.norm(made.support, axis=1).max() > 1e-6  # some locks are supported
    *_, last = style.at_rest(shot, to_curves(made, shot), seconds)
    assert sag(last, style.groom.locks.points) < shot.strands.radius


def test_a_tip_supports_nothing():
    """A lock on a tip would slide off."""
    below, above = crossed()
    carried, ends_there = (
        np.abs(support_forces(*scene(below, upper, more=SOFT), [])).max()
        for upper in (above, above * [1, 1, 0] + np.linspace(-0.06, 0, 30)[:, None] * [0, 0, 1])
    )
    assert ends_there == 0 < carried


def test_a_contact_that_hardly_overlaps_supports_nothing():
    """It would have to sink in before it carries, and what it carries would fall until then."""
    below, above = crossed()
    hardly, enough = (
        np.abs(support_forces(*scene(below, above + [0, rise * REACH, 0], more=SOFT), [])).max()
        for rise in (0.03, 0.01)  # to overlaps of 0.02 and 0.04
    )
    assert hardly == 0 < enough


RIDGE = 0.02 * np.array([[0, 0, -1], [0, 0, 1], [1, -1, -1], [1, -1, 1], [-1, -1, -1], [-1, -1, 1.0]])


@pytest.mark.parametrize("aside", [0.1, 0.3])
def test_a_ridge_pushes_a_lock_from_its_closest_point(aside):
    """A straight lock across a ridge between two of its vertices: the support points straight up."""
    lock = np.c_[np.linspace(-0.02, 0.04, 31) - 2e-3 * aside, np.full(31, 0.9 * REACH), np.zeros(31)]
    mesh = Mesh("/ridge", RIDGE, np.array([[0, 1, 2], [1, 3, 2], [0, 4, 1], [1, 4, 5]], np.int32))
    obstacle = Obstacle(mesh, Clip(np.array([1.0]), RIDGE[None], 24.0))
    obstacle.settings = obstacle.settings.model_copy(update={"friction": 0.0})
    support = support_forces(*scene(lock, more=SOFT), [obstacle]).sum(axis=0)
    assert support[1] > 0 and np.abs(support[0]) < 1e-3 * support[1]


def on_slope(friction):
    """A strand that lies across a slope of 4°, and the slope."""
    t = np.linspace(0, 1, 60)
    turn = rotation((0, 0, 1), np.radians(4)).T
    lying = np.c_[6e-3 * np.exp(-((t / 0.08) ** 2))[:, None] * [0, 1, 0]] + np.c_[0 * t, 0.9 * REACH + 0 * t, 0.08 * t]
    mesh = Mesh(
        "/slope",
        0.1 * np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1.0]]) @ turn,
        np.array([[0, 2, 1], [0, 3, 2]], np.int32),
    )
    obstacle = Obstacle(mesh, Clip(np.array([1.0]), mesh.points[None], 24.0))
    obstacle.settings = obstacle.settings.model_copy(update={"friction": friction})
    return lying @ turn, obstacle


def test_friction_holds_a_lock_on_a_slope():
    """With friction the rest shape needs no uphill correction, and the strand stays without creep."""
    lying, rough = on_slope(1.0)
    shot, groom = scene(lying, more=SOFT)
    smooth, held = (equilibrium(shot, groom, obstacles=[on_slope(mu)[1]]) for mu in (0.0, 1.0))
    assert sag(held.rest.points, lying) < 0.1 * sag(smooth.rest.points, lying)
    soon, late = (drift(shot, groom, held, [rough], steps) for steps in (48, 240))
    assert late < shot.strands.radius
    assert late - soon < 0.05 * shot.strands.radius


def test_a_curl_with_rows_of_pins_hangs_between_them():
    """Rows of pins act as clamps, twist included; the curl between them is in equilibrium."""
    curl = helix(60, radius=4e-3, pitch=4e-3) @ rotation((0, 0, 1), np.radians(70)).T
    shot, groom = scene(curl, more=MODE)
    pin = np.zeros(60, np.float32)
    pin[25:31] = pin[44:48] = 1.0
    locks = Curves(groom.locks.points, groom.locks.offsets, groom.locks.ids, {}, {"pin": pin})
    groom = Groom(locks, locks, groom.scalp)
    made = equilibrium(shot, groom)
    assert made.off[0] < 1e-7 and made.stiffened[0] == 1
    assert sag(made.rest.points, curl) > 1e-4
    strands = make_strands(shot, groom, made.rest)
    strands.place(curl)
    for _ in range(48):
        strands.step(curl, 1 / 24, gravity=GRAVITY)
    assert sag(strands.positions, curl) < 1e-7


def test_a_lock_is_rebalanced_when_its_support_changes():
    """The lower beam moves away, so the unchanged upper beam needs a new equilibrium."""
    shot, groom = scene(*crossed(), more=SOFT)
    kept = to_curves(equilibrium(shot, groom), shot)
    groom.locks.points[3:30, 1] -= np.linspace(0, 2 * REACH, 27)
    before, again, anew = (
        kept.points.copy(),
        update_rest_shape(shot, groom, kept, dependencies(shot)),
        equilibrium(shot, groom),
    )
    upper = slice(30, 60)
    assert np.abs(again.rest.points - anew.rest.points).max() < 1e-6
    assert sag(again.rest.points[upper], before[upper]) > 1e-3
