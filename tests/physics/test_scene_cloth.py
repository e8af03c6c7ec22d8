"""Cloth in a scene with strands and bodies: what contact conserves, what it stops, and that all ways to solve agree."""

import numpy as np
import pytest
from coils import rotation
from crossings import Judge
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.shot.cloth import ClothMaterial
from ringlet.shot.contact import Contact
from ringlet.shot.material import Material
from ringlet.shot.solver import Solver
from ringlet.sim.cloth import Cloth
from ringlet.sim.obstacle import Body
from ringlet.sim.scene import Scene
from ringlet.sim.strands import Strands
from sheets import sheet

FRAME = 1 / 24
DOWN = (0.0, -9.81, 0.0)


def level(width, squares, height):
    """A square sheet in the plane of x and z, its middle over the origin."""
    mesh = sheet(width, width, squares, squares)
    mesh.points = mesh.points[:, [0, 2, 1]] + [-width / 2, height, -width / 2]
    return mesh


def ball(radius, rings=10):
    """A sphere about the origin."""
    theta = np.linspace(0, np.pi, rings + 1)[1:-1, None]
    phi = np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False)[None, :]
    around = np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.cos(theta), np.sin(theta) * np.sin(phi)), -1)
    count = 2 * rings
    at = 1 + np.arange((rings - 1) * count).reshape(rings - 1, count)
    here, following = at, np.roll(at, -1, axis=1)
    last = 1 + at.size
    triangles = [np.stack(np.broadcast_arrays(0, following[0], here[0]), -1)]
    triangles.append(np.stack([here[:-1], following[:-1], following[1:]], -1).reshape(-1, 3))
    triangles.append(np.stack([here[:-1], following[1:], here[1:]], -1).reshape(-1, 3))
    triangles.append(np.stack(np.broadcast_arrays(last, here[-1], following[-1]), -1))
    points = np.concatenate([[(0, 1, 0)], around.reshape(-1, 3), [(0, -1, 0)]])
    return radius * points, np.concatenate(triangles).astype(np.int32)


def line(start, end, count):
    return np.linspace(start, end, count)


def free_strand(points):
    """A strand whose root holds nothing: what joins it to the rest has almost no stiffness. With its masses [kg]."""
    material = Material(drag=0.0, damping=0.0, mass_damping=0.0, radius=2e-4)
    slack = np.ones(len(points))
    slack[:3] = 1e-12
    strand = Strands(Curves.from_list([points]), material, 1, {name: slack for name in ("stretch", "bend", "twist")})
    length = np.linalg.norm(np.diff(points, axis=0), axis=1)
    mass = material.density * np.pi * material.radius**2 * 0.5 * (np.append(length, 0) + np.append(0, length))
    return strand, np.where(strand.held, 0.0, mass)


def crossings_of(scene, judge):
    return sum(judge.crossings(*move) for move in zip(scene.path[:-1], scene.path[1:], strict=True))


def test_a_sheet_comes_to_rest_on_a_sphere():
    points, triangles = ball(0.1)
    cloth = Cloth(level(0.3, 14, 0.12), ClothMaterial(thickness=4e-3))
    scene = Scene(bodies=[Body(points, triangles, thickness=2e-3)], cloths=[cloth])
    judge, crossings = Judge(scene), 0
    scene.record()
    for _ in range(24):
        report, _ = scene.step(None, FRAME, gravity=DOWN)
        crossings += crossings_of(scene, judge)
        assert report["fraction"] == 1.0
    assert crossings == 0
    assert np.abs(cloth.velocities).max() < 0.05
    assert cloth.positions[:, 1].min() < -0.02 and 0.1 < cloth.positions[:, 1].max() < 0.107
    assert scene.cloth_reports[0]["max_stretch"] < 0.05


@pytest.mark.parametrize("newton", [1, 5])
def test_a_strand_that_is_thrown_at_a_held_sheet_stays_on_its_side(newton):
    """At 20 m/s: half a metre a step, through a sheet that is one triangle thick."""
    mesh = level(0.2, 10, 0.0)
    rim = np.abs(mesh.points[:, [0, 2]]).max(axis=1) > 0.0999
    cloth = Cloth(mesh, ClothMaterial(thickness=1e-3), rim)
    strand, _ = free_strand(line([-0.05, 0.02, 0.013], [0.05, 0.03, -0.011], 21))
    strand.velocities[~strand.held] = [0, -20, 0]
    scene = Scene(strand, cloths=[cloth], contact=Contact(radius=5e-4))
    judge, crossings = Judge(scene), 0
    scene.record()
    for _ in range(6):
        scene.step(None, FRAME, solver=Solver(newton=newton))
        crossings += crossings_of(scene, judge)
    assert crossings == 0
    inside = (np.abs(strand.positions[:, [0, 2]]) < 0.09).all(axis=1)
    nearest = np.argmin(np.linalg.norm(strand.positions[:, None] - cloth.positions[None], axis=2), axis=1)
    assert (strand.positions[inside, 1] > cloth.positions[nearest[inside], 1] - 0.02).all()


def test_a_sheet_falls_beside_a_strand_that_has_more_to_do():
    """What is left of the system is measured over all that hangs together; of the sheet nothing was solved then."""
    strand = Strands(
        Curves.from_list([line([-0.05, 0.0007, 0.013], [0.15, 0.0007, -0.011], 21)]), Material(radius=2e-4), 1
    )
    strand.positions[12:, 0] += 0.005  # one edge is 50 % longer than it wants to be
    cloth = Cloth(level(0.1, 8, 0.0), ClothMaterial(thickness=1e-3, drag=0.0))
    before = cloth.positions.copy()
    scene = Scene(strand, cloths=[cloth], contact=Contact(radius=5e-4))
    report, _ = scene.step(strand.positions, FRAME, gravity=DOWN, solver=Solver(newton=1, extra=0))
    assert report["contacts"] > 0
    assert (before - cloth.positions)[:, 1].mean() > 0.7 * 9.81 * FRAME**2


def thrown_at_a_strand(friction):
    """A sheet flies into a strand. Of each step: the positions, impulses [N s] and the strand's share."""
    dt = 1 / 240
    cloth = Cloth(level(0.1, 8, 0.0), ClothMaterial(thickness=4e-3, drag=0.0, damping=0.0, friction=friction))
    cloth.velocities[:] = [0.0, 1.0, 0.1]
    strand, mass = free_strand(line([-0.06, 0.006, 0.013], [0.05, 0.009, -0.011], 19))
    scene = Scene(strand, cloths=[cloth], contact=Contact(radius=1e-3, friction=friction))
    masses = np.concatenate([mass, cloth.masses])[:, None]
    # The material frame converges too slowly for a sum to be seen to vanish.
    solver = Solver(newton=150, tolerance=1e-12, linear_tolerance=1e-8, continuation="history")
    for _ in range(4):
        before = np.concatenate([strand.velocities, cloth.velocities])
        report, _ = scene.step(None, dt, solver=solver)
        impulse = masses * (np.concatenate([strand.velocities, cloth.velocities]) - before)
        given = np.linalg.norm(impulse[: len(mass)], axis=1).sum()
        assert given > 0.01 * mass.sum()  # m/s: they do meet
        yield report, np.concatenate([strand.positions, cloth.positions]), impulse, given


def test_cloth_and_a_strand_that_meet_keep_their_momentum():
    """Without friction what leaves one arrives at the other, and nothing is turned: Σ Δ(m v) = Σ x × Δ(m v) = 0."""
    for report, positions, impulse, given in thrown_at_a_strand(friction=0.0):
        assert not report["unconverged"]
        assert np.linalg.norm(impulse.sum(axis=0)) < 1e-6 * given
        assert np.linalg.norm(np.cross(positions, impulse).sum(axis=0)) < 1e-6 * given * 0.1  # m: the size of the sheet


def test_friction_between_cloth_and_a_strand_keeps_momentum():
    """Its normal force is that of the last iteration, so that Newton's method need not converge to the last digit."""
    for _, _, impulse, given in thrown_at_a_strand(friction=0.5):
        assert np.linalg.norm(impulse.sum(axis=0)) < 1e-3 * given


def coupled():
    """A sheet that falls on two curls, with a body under them."""
    x = np.linspace(0, 0.08, 17)
    curls = [np.c_[x - 0.04, 0.002 * np.sin(250 * x), 0.002 * np.cos(250 * x) + 0.01 * k] for k in range(2)]
    strands = Strands(Curves.from_list(curls), Material(), 3)
    floor = np.array([[-1, -0.006, -1], [1, -0.006, -1], [1, -0.006, 1], [-1, -0.006, 1]])
    body = Body(floor, np.array([[0, 2, 1], [0, 3, 2]]), thickness=1e-3)
    cloth = Cloth(level(0.06, 6, 0.0045), ClothMaterial(thickness=2e-3))
    return Scene(strands, [body], Contact(radius=1e-3), cloths=[cloth])


def ends_of(make, system, tolerance):
    """Where three steps end that are solved in this way."""
    scene, solver = make(), Solver(newton=1, system=system, linear_tolerance=tolerance)
    for _ in range(3):
        report, _ = scene.step(None, FRAME / 4, gravity=DOWN, solver=solver)
        assert report["linear_residual"] <= tolerance
        assert (report["linear_iterations"] > 0) == (system == "conjugate_gradient" and make is coupled)
    return scene


@pytest.mark.parametrize("held", ["corner", "edge"])
def test_cloth_goes_along_with_what_is_held_of_it_as_one(held):
    """In the first move, so that a turn as such brings nothing of it together; an edge leaves no turn about it open."""
    mesh = level(0.1, 6, 0.0)
    row, column = np.divmod(np.arange(49), 7)
    cloth = Cloth(mesh, ClothMaterial(), row + column < 3 if held == "corner" else row == 0)
    scene = Scene(cloths=[cloth])
    scene.record()
    turned = mesh.points @ rotation([0.0, 1.0, 0.0], 0.6).T + [0.0, 0.03, 0.01]
    scene.step(None, FRAME, cloths=[turned])
    assert np.abs(scene.path[1] - turned).max() < 1e-8


def test_all_ways_to_solve_the_system_agree_where_things_touch():
    scenes = {t: ends_of(coupled, "conjugate_gradient", t) for t in (1e-8, 1e-4)}
    direct = ends_of(coupled, "direct", 0.05)
    of_strands = direct.contacts[0] < len(direct.strands.positions)
    assert (of_strands.any(axis=1) & ~of_strands.all(axis=1)).any()  # the cloth and the curls do touch
    moved = np.abs(direct.positions - coupled().positions).max()
    exact, rough = (np.abs(scenes[t].positions - direct.positions).max() for t in (1e-8, 1e-4))
    assert exact < 1e-6 * moved
    assert rough < 1e-2 * moved


def test_all_ways_to_solve_the_system_agree_where_nothing_touches():
    """Strands alone are solved exactly by the factor of each: conjugate gradients, which begin with that, have nothing
    left to do, and a direct solver solves them all together."""

    def apart():
        return Scene(coupled().strands)

    ends = {how: ends_of(apart, how, 1e-8).positions for how in ("automatic", "banded", "conjugate_gradient", "direct")}
    moved = np.abs(ends["banded"] - apart().positions).max()
    assert moved > 1e-4
    assert (ends["automatic"] == ends["banded"]).all()
    assert (ends["conjugate_gradient"] == ends["banded"]).all()
    assert np.abs(ends["direct"] - ends["banded"]).max() < 1e-9 * moved


def test_strands_alone_do_not_solve_what_is_coupled():
    scene = coupled()
    before = scene.positions
    with pytest.raises(UserError, match="'banded'"):
        scene.step(None, FRAME, gravity=DOWN, solver=Solver(system="banded"))
    assert (scene.strands.positions == before[: len(scene.strands.positions)]).all()


def test_the_scene_does_not_know_how_fast_it_flies():
    """At 100 m/s it does what it does at rest."""
    ends = []
    for speed in (0.0, 100.0):
        points, triangles = ball(0.1, 6)
        cloth = Cloth(level(0.2, 8, 0.112), ClothMaterial(thickness=4e-3, drag=0.0))
        cloth.velocities[:] = [speed, -1.0, 0]
        scene = Scene(bodies=[Body(points, triangles, thickness=2e-3)], cloths=[cloth])
        for k in range(1, 5):
            scene.step(None, FRAME, bodies=[points + [speed * k * FRAME, 0, 0]], gravity=DOWN)
        ends.append(cloth.positions - [speed * 4 * FRAME, 0, 0])
    assert np.abs(ends[1] - ends[0]).max() < 1e-7
