"""What the motion of hair does not depend on: rate and unit of files, handedness, size, and what does not touch it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from commands import edit
from pxr import Usd, UsdGeom
from ringlet.shot import parse_shot
from small_example import write_example, write_head
from usd_scenes import CUBE, add_cube, new_stage

import ringlet
from ringlet import Body, Cloth, Contact, Curves, Material, Mesh, Scene, Solver, Strands, _core
from ringlet.groom import parse_recipe

# Files


RATES = (24, 25, 30, 48, 60, 120)
STEPS = 1200  # a second: the least that all rates divide


def swung_at(rate: int, folder, more: str) -> np.ndarray:
    """Points of locks that swing for a second on a head that slides [m], shape (n, 3)."""
    stage = new_stage(folder / f"head{rate}.usda", unit=1.0)
    stage.SetTimeCodesPerSecond(rate)
    add_cube(stage, points=CUBE * 0.1)
    slide = UsdGeom.Xformable(stage.GetPrimAtPath("/head")).AddTranslateOp()
    for second, x in ((0, 0.0), (1, 0.2)):
        slide.Set((x, 0, 0), second * rate)
    stage.Save()
    recipe = parse_recipe(
        f"ringlet = 2\n[scalp]\nfile = 'head{rate}.usda'\nregion = 'scalp'\n[guides]\ncount = 3\nlength = 5\n"
        "[locks]\npoints = 10\n[collide]\nmargin = 0\n",
        folder / "r.recipe.toml",
    )
    shot = parse_shot(
        f"ringlet = 2\ngroom = 'r.recipe.toml'\nframes = [0, {rate}]\npreroll = 0\n[forces]\ngravity = [3, -9, 0]\n"
        f"[solver]\nnewton = 3\nsubsteps = {STEPS // rate}\n{more}",
        folder / "s.shot.toml",
    )
    cache = ringlet.simulate(shot, ringlet.build_groom(recipe))
    assert np.abs(cache.points[-1] - cache.points[0] - [0.2, 0.0, 0.0]).max() > 0.002
    return cache.points[-1]


@pytest.mark.parametrize("more", ["", "[contact]\nradius = 2e-3\n"], ids=["alone", "in contact"])
def test_hair_moves_the_same_at_any_rate(tmp_path, more):
    """Steps are the same at all rates, so that only the rounding of times differs: a few digits of single precision."""
    first, *others = (swung_at(rate, tmp_path, more) for rate in RATES)
    for points in others:
        np.testing.assert_allclose(points, first, atol=5e-8)


def played(folder, *, unit: float = 0.01, up: str = "Y", size: float = 1.0):
    """Groom and cache of the small example in contact and wind, in metres.

    size: of head and hair alike
    """
    write_example(folder)
    head, recipe, file = folder / "head.usda", folder / "small.recipe.toml", folder / "small.shot.toml"
    head.unlink()
    write_head(head, unit=unit, up=up)
    if size != 1.0:
        stage = Usd.Stage.Open(str(head))
        UsdGeom.SetStageMetersPerUnit(stage, size * unit)
        stage.Save()
    for name, value in (("length", 5), ("width", 1.0), ("pitch", 1.5)):
        edit(recipe, f"{name} = {value}", f"{name} = {size * value}")
    start = np.sqrt(1.01 * size**2 - 0.01)  # curls open over hypot(start, 1 mm)
    edit(recipe, "[curl]", f"[curl]\nstart = {start}\nphase_wavelength = {3 * size}")
    recipe.write_text(recipe.read_text() + f"[collide]\nmargin = {0.05 * size}\n")
    file.write_text(
        file.read_text()
        + "[solver]\nuntil_converged = true\n[contact]\nradius = 2e-3\n[forces]\nwind = [0.3, 0, 0.2]\n"
    )
    groom = ringlet.load_groom(recipe)
    return groom, ringlet.simulate(ringlet.read_shot(file), groom)


@pytest.fixture(scope="module")
def in_centimetres(tmp_path_factory):
    return played(tmp_path_factory.mktemp("cm"))


@pytest.mark.parametrize(
    ("unit", "up"), [(1.0, "Y"), (0.001, "Y"), (0.0254, "Y"), (0.005, "Y"), (0.01, "Z"), (1.0, "Z"), (0.0254, "Z")]
)
def test_the_same_head_in_any_unit_and_axis_has_the_same_groom_and_motion(tmp_path, in_centimetres, unit, up):
    """To the rounding of a head's points in single precision: 4 nm at a radius of 9 cm, as in its file."""
    (groom, cache), (same, moved) = played(tmp_path, unit=unit, up=up), in_centimetres
    assert groom.space.meters_per_unit == pytest.approx(unit)
    np.testing.assert_allclose(groom.locks.points, same.locks.points, atol=2e-8)
    assert np.abs(cache.points[-1] - cache.points[0]).max() > 0.01
    np.testing.assert_allclose(cache.points, moved.points, atol=2e-7)


@pytest.mark.parametrize("size", [2.0, 0.5])
def test_a_head_of_another_size_has_the_groom_of_that_size(tmp_path, in_centimetres, size):
    """Nothing of a groom has a length of its own, but the millimetre over which a curl opens at the least."""
    groom, _ = played(tmp_path, size=size)
    np.testing.assert_allclose(groom.locks.points / size, in_centimetres[0].locks.points, atol=2e-8)


# Scenes


FRAME = 1 / 24
COUNT = 40  # vertices of a lock


def coil(x: float, z: float, phase: float = 0.0) -> np.ndarray:
    """A hanging coil of 8 cm."""
    s = np.linspace(0.0, 0.08, COUNT)
    wide, turn = 4e-3 * np.clip(s / 0.01, 0.0, 1.0), 2 * np.pi * s / 0.012 + phase
    return np.c_[x + wide * np.cos(turn), -s, z + wide * np.sin(turn)]


def ball(radius: float, at) -> Body:
    """An octahedron, its faces divided in four."""
    axes = np.eye(3)
    faces = [
        [a * axes[0], (b if a * b * c > 0 else c) * axes[1 if a * b * c > 0 else 2],
         (c if a * b * c > 0 else b) * axes[2 if a * b * c > 0 else 1]]
        for a in (1, -1) for b in (1, -1) for c in (1, -1)
    ]  # fmt: skip
    corners = []
    for a, b, c in faces:
        ab, bc, ca = ((p + q) / np.sqrt(2.0) for p, q in ((a, b), (b, c), (c, a)))
        corners += [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    points, triangles = np.unique(np.round(np.reshape(corners, (-1, 3)), 12), axis=0, return_inverse=True)
    return Body(radius * points + at, triangles.reshape(-1, 3).astype(np.int32))


def swinging(*, size: float = 1.0, mirrored: bool = False, converged: bool = False, integrator: str = "backward_euler"):
    """Positions of coils that swing at a ball and at one another, in units of ``size``, shape (frames, n, 3).

    size: of everything that has a length, also in the units of constants and of speeds
    """
    mirror = np.array([-1.0 if mirrored else 1.0, 1.0, 1.0])
    curves = Curves.from_list([coil(*place) * mirror * size for place in ((0, 0), (7e-3, 0, np.pi), (0.02, 0))])
    of = Material()
    material = of.model_copy(
        update={
            "youngs_modulus": of.youngs_modulus * size**2,
            "radius": of.radius * size,
            "drag": of.drag * size**2,
        }
    )
    body = ball(0.02, [0.012, -0.06, 1e-3])
    body = Body(body.points * mirror * size, body.triangles, body.thickness * size)
    contact = Contact(radius=4e-4 * size, creep_speed=1e-3 * size, separation_speed=2e-3 * size)
    scene = Scene(Strands(curves, material, 3), [body], contact)
    solver = Solver(until_converged=converged, tolerance=1e-8 * size, integrator=integrator)
    frames = []
    for frame in range(1, 9):
        shift = np.array([0.01 * np.sin(0.5 * frame), 0.0, 4e-3 * frame]) * mirror * size
        report, _ = scene.step(
            curves.points + shift,
            FRAME,
            bodies=[body.points + 0.3 * shift],
            gravity=tuple(mirror * size * [1.0, -9.8, 0.5]),
            wind=tuple(mirror * size * [0.5, 0.0, 0.0]),
            solver=solver,
        )
        assert report["contacts"] > 0
        frames.append(scene.strands.positions * mirror / size)
    return np.array(frames)


@pytest.mark.parametrize("integrator", ["backward_euler", "bdf2"])
def test_a_mirrored_scene_moves_as_the_mirror_image_to_the_bit(integrator):
    plain, mirrored = (swinging(mirrored=mirrored, integrator=integrator) for mirrored in (False, True))
    assert np.array_equal(plain, mirrored)


@pytest.mark.parametrize("size", [4.0, 0.25])
def test_a_scene_of_another_size_moves_as_its_image(size):
    """The same in another unit of length, constants included: a solver has none of its own. To a hundred tolerances."""
    plain, scaled = (swinging(size=size, converged=True) for size in (1.0, size))
    assert np.abs(plain[-1] - plain[0]).max() > 5e-3
    np.testing.assert_allclose(scaled, plain, atol=1e-6)


# What does not touch a lock


PLACES = [(0.2 * k, 0.1 * (k % 3)) for k in range(9)]  # of locks that touch nothing
TANGLED = [(10.0, 0.0), (10.007, 0.0, np.pi), (10.014, 0.0)]  # of coils that hook into one another
SHEET = np.stack(np.meshgrid(np.linspace(0, 0.1, 5), np.linspace(0, 0.1, 5)), axis=-1).reshape(-1, 2)
CELLS = [(k + 5 * row, k + 5 * row + 1, k + 5 * row + 5) for row in range(4) for k in range(4)]
CELLS += [(b, b + 5, c) for _, b, c in CELLS]


def sheet_at(x: float) -> Cloth:
    """A sheet that falls."""
    points = np.c_[x + SHEET[:, 0], np.zeros(len(SHEET)), SHEET[:, 1]]
    return Cloth(Mesh("sheet", points, np.array(CELLS, np.int32)))


def shaken(locks, watched, *, bodies=(), led=None, cloths=(), touching: bool = False, solver: Solver, frames: int = 6):
    """Positions of the watched locks while all roots are shaken, shape (frames, watched, COUNT, 3).

    led:      positions of the bodies at a frame
    touching: whether anything touches
    """
    curves = Curves.from_list([coil(*place) for place in locks])
    scene = Scene(Strands(curves, Material(bend_scale=6.0), 3), list(bodies), Contact(radius=4e-4), cloths=list(cloths))
    found, contacts = [], 0.0
    for frame in range(1, frames + 1):
        targets = curves.points + [0.01 * np.sin(0.5 * frame), 0.0, 0.0]
        at = led(frame) if led else [body.points for body in bodies]
        report, _ = scene.step(targets, FRAME, bodies=at, gravity=(1.0, -9.81, 0.0), solver=solver)
        contacts += report["contacts"]
        found.append([scene.strands.positions[COUNT * k : COUNT * (k + 1)].copy() for k in watched])
    assert (contacts > 0) == touching
    return np.array(found)


FEW, BDF2, CONVERGED = Solver(newton=3), Solver(integrator="bdf2"), Solver(until_converged=True)


@pytest.fixture(scope="module", params=[FEW, BDF2, CONVERGED], ids=["few iterations", "bdf2", "converged"])
def alone(request):
    """The solver, and how a lock moves with nothing else in its scene."""
    return request.param, shaken(PLACES[:1], [0], solver=request.param)


@pytest.mark.parametrize("count", [2, 4, 5, 9])
def test_other_locks_before_and_after_it_change_no_bit(alone, count):
    """Whatever lane of the processor a lock is in, and however many are used."""
    solver, lone = alone
    assert np.array_equal(shaken(PLACES[:count], [0], solver=solver), lone)
    assert np.array_equal(shaken(PLACES[count - 1 :: -1], [count - 1], solver=solver), lone)


def test_contact_elsewhere_changes_no_bit(alone):
    """Coils that are tangled, locks that coincide, a body that hits a lock, and one kilometre between them."""
    solver, lone = alone
    others = [*TANGLED, (0.9, 0.0), (0.9, 0.0), (1.5, 0.0), (1000.0, 0.0)]
    hit = ball(0.03, [1.55, -0.05, 0.0])

    def led(frame):
        return [hit.points - [8e-3 * frame, 0.0, 0.0]]

    found = shaken([PLACES[0], *others], [0], bodies=[hit], led=led, touching=True, solver=solver)
    assert np.array_equal(found, lone)


def test_a_pinch_elsewhere_changes_no_bit(alone):
    solver, lone = alone
    jaws = [ball(0.03, [0.6, -0.04, side * 0.05]) for side in (1.0, -1.0)]

    def closing(frame):
        return [jaw.points - [0.0, 0.0, side * 8e-3 * frame] for jaw, side in zip(jaws, (1.0, -1.0), strict=True)]

    found = shaken([PLACES[0], (0.6, 0.0), (0.61, 0.0)], [0], bodies=jaws, led=closing, touching=True, solver=solver)
    assert np.array_equal(found, lone)


def test_bodies_and_cloth_elsewhere_change_no_bit(alone):
    """Still or moving, large or small; cloth that falls, and cloth that falls on a body."""
    solver, lone = alone
    bodies = [ball(0.05, [0.5, -0.2, 0.0]), ball(5.0, [20.0, 0.0, 0.0]), ball(0.01, [-0.3, 0.0, 0.0])]

    def led(frame):
        return [bodies[0].points, bodies[1].points + [0.1 * frame, 0.0, 0.0], bodies[2].points]

    cloths = [sheet_at(0.45), sheet_at(3.0)]
    assert np.array_equal(
        shaken(PLACES[:1], [0], bodies=bodies, led=led, cloths=cloths, touching=True, solver=solver), lone
    )


def test_a_body_beside_a_lock_that_it_never_touches_changes_no_bit(alone):
    """A centimetre from where the lock swings."""
    solver, lone = alone
    beside = ball(0.02, [lone[..., 0].min() - 0.03, -0.05, 0.0])
    assert np.array_equal(shaken(PLACES[:1], [0], bodies=[beside], solver=solver), lone)


def test_any_number_of_threads_gives_the_same_bits():
    before = _core.thread_count()
    places = [*PLACES, *TANGLED]
    try:
        found = []
        for threads in (1, 2, 3):
            _core.set_thread_count(threads)
            found.append(
                shaken(places, range(len(places)), cloths=[sheet_at(3.0)], touching=True, solver=FEW, frames=2)
            )
    finally:
        _core.set_thread_count(before)
    assert all(np.array_equal(one, other) for one, other in pairwise(found))
