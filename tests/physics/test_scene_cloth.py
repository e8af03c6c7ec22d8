"""Cloth in a scene with strands and bodies: conservation, contact and agreement of the linear solvers."""

import numpy as np
import pytest
from coils import rotation
from crossings import Judge
from ringlet.data.curves import Curves
from ringlet.shot.cloth import ClothMaterial
from ringlet.shot.contact import Contact
from ringlet.shot.material import Material
from ringlet.shot.solver import Solver
from ringlet.sim.cloth import Cloth
from ringlet.sim.obstacle import Body
from ringlet.sim.scene import Scene
from ringlet.sim.strands import Strands
from sheets import sheet
from surfaces import sphere

FRAME = 1 / 24
DOWN = (0.0, -9.81, 0.0)


def level(width, squares, height):
    """A square sheet in a horizontal plane, centred on the vertical axis."""
    mesh = sheet(width, width, squares, squares)
    mesh.points = mesh.points[:, [0, 2, 1]] + [-width / 2, height, -width / 2]
    return mesh


def free_strand(points):
    """A strand that is decoupled from its root by edges of almost no stiffness, and its masses [kg]."""
    material = Material(drag=0.0, damping=0.0, mass_damping=0.0, radius=2e-4)
    slack = np.ones(len(points))
    slack[:3] = 1e-12
    strand = Strands(Curves.from_list([points]), material, 1, {name: slack for name in ("stretch", "bend", "twist")})
    length = np.linalg.norm(np.diff(points, axis=0), axis=1)
    mass = material.density * np.pi * material.radius**2 * 0.5 * (np.append(length, 0) + np.append(0, length))
    return strand, np.where(strand.held, 0.0, mass)


def test_a_sheet_comes_to_rest_on_a_sphere():
    points, triangles = sphere(0.1, 10, 20)
    cloth = Cloth(level(0.3, 14, 0.12), ClothMaterial(thickness=4e-3))
    scene = Scene(bodies=[Body(points, triangles, thickness=2e-3)], cloths=[cloth])
    judge, crossings = Judge(scene), 0
    scene.record()
    for _ in range(24):
        before = scene.positions.copy()
        report, _ = scene.step(None, FRAME, gravity=DOWN)
        crossings += judge.crossings_of_step(before, scene.path)
        assert report["lag"] == 0.0
    assert crossings == 0
    assert np.abs(cloth.velocities).max() < 0.05
    assert cloth.positions[:, 1].min() < -0.02 and 0.1 < cloth.positions[:, 1].max() < 0.107
    assert scene.cloth_reports[0]["max_stretch"] < 0.05


@pytest.mark.parametrize("newton", [1, 5])
def test_a_strand_thrown_at_a_pinned_sheet_stays_on_its_side(newton):
    """At 20 m/s a step of 1/24 s would move the strand 0.8 m beyond the sheet."""
    mesh = level(0.2, 10, 0.0)
    rim = np.abs(mesh.points[:, [0, 2]]).max(axis=1) > 0.0999
    cloth = Cloth(mesh, ClothMaterial(thickness=1e-3), rim)
    strand, _ = free_strand(np.linspace([-0.05, 0.02, 0.013], [0.05, 0.03, -0.011], 21))
    strand.velocities[~strand.held] = [0, -20, 0]
    scene = Scene(strand, cloths=[cloth], contact=Contact(radius=5e-4))
    judge, crossings = Judge(scene), 0
    scene.record()
    for _ in range(6):
        before = scene.positions.copy()
        scene.step(None, FRAME, solver=Solver(newton=newton))
        crossings += judge.crossings_of_step(before, scene.path)
    assert crossings == 0
    inside = (np.abs(strand.positions[:, [0, 2]]) < 0.09).all(axis=1)
    nearest = np.argmin(np.linalg.norm(strand.positions[:, None] - cloth.positions[None], axis=2), axis=1)
    assert (strand.positions[inside, 1] > cloth.positions[nearest[inside], 1] - 0.02).all()


def test_a_sheet_falls_beside_a_strand_with_a_larger_residual():
    """The residual covers the cluster, and the sheet is solved although the strand dominates it."""
    strand = Strands(
        Curves.from_list([np.linspace([-0.05, 0.0007, 0.013], [0.15, 0.0007, -0.011], 21)]), Material(radius=2e-4), 1
    )
    strand.positions[12:, 0] += 0.005  # stretches one edge by 50 %
    cloth = Cloth(level(0.1, 8, 0.0), ClothMaterial(thickness=1e-3, drag=0.0))
    before = cloth.positions.copy()
    scene = Scene(strand, cloths=[cloth], contact=Contact(radius=5e-4))
    report, _ = scene.step(strand.positions, FRAME, gravity=DOWN, solver=Solver(newton=1, extra=0))
    assert report["contacts"] > 0
    assert (before - cloth.positions)[:, 1].mean() > 0.7 * 9.81 * FRAME**2


def thrown_at_a_strand(friction):
    """A sheet hits a strand; yields report, positions, impulses [N s] and the strand's total impulse of a step."""
    dt = 1 / 240
    cloth = Cloth(level(0.1, 8, 0.0), ClothMaterial(thickness=4e-3, drag=0.0, damping=0.0, friction=friction))
    cloth.velocities[:] = [0.0, 1.0, 0.1]
    strand, mass = free_strand(np.linspace([-0.06, 0.006, 0.013], [0.05, 0.009, -0.011], 19))
    scene = Scene(strand, cloths=[cloth], contact=Contact(radius=1e-3, friction=friction))
    masses = np.concatenate([mass, cloth.masses])[:, None]
    # With the material frame the residual decreases too slowly to test conservation.
    solver = Solver(newton=150, tolerance=1e-12, linear_tolerance=1e-8, continuation="history")
    for _ in range(4):
        before = np.concatenate([strand.velocities, cloth.velocities])
        report, _ = scene.step(None, dt, solver=solver)
        impulse = masses * (np.concatenate([strand.velocities, cloth.velocities]) - before)
        exchanged = np.linalg.norm(impulse[: len(mass)], axis=1).sum()
        assert exchanged > 0.01 * mass.sum()  # [m/s] they collide
        yield report, np.concatenate([strand.positions, cloth.positions]), impulse, exchanged


def test_contact_of_cloth_and_strand_conserves_momentum():
    """Without friction linear and angular momentum are conserved: Σ Δ(m v) = Σ x × Δ(m v) = 0."""
    for report, positions, impulse, exchanged in thrown_at_a_strand(friction=0.0):
        assert not report["unconverged"]
        assert np.linalg.norm(impulse.sum(axis=0)) < 1e-6 * exchanged
        assert (
            np.linalg.norm(np.cross(positions, impulse).sum(axis=0)) < 1e-6 * exchanged * 0.1
        )  # [m] size of the sheet


def test_friction_of_cloth_and_strand_conserves_linear_momentum():
    """Friction uses the normal force of the last iteration, so conservation holds to the Newton tolerance."""
    for _, _, impulse, exchanged in thrown_at_a_strand(friction=0.5):
        assert np.linalg.norm(impulse.sum(axis=0)) < 1e-3 * exchanged


def coupled():
    """A sheet that falls on two curls above a body."""
    x = np.linspace(0, 0.08, 17)
    curls = [np.c_[x - 0.04, 0.002 * np.sin(250 * x), 0.002 * np.cos(250 * x) + 0.01 * k] for k in range(2)]
    strands = Strands(Curves.from_list(curls), Material(), 3)
    floor = np.array([[-1, -0.006, -1], [1, -0.006, -1], [1, -0.006, 1], [-1, -0.006, 1]])
    body = Body(floor, np.array([[0, 2, 1], [0, 3, 2]]), thickness=1e-3)
    cloth = Cloth(level(0.06, 6, 0.0045), ClothMaterial(thickness=2e-3))
    return Scene(strands, [body], Contact(radius=1e-3), cloths=[cloth])


def ends_of(make, system, tolerance):
    """The scene after three steps with a linear solver."""
    scene, solver = make(), Solver(newton=1, system=system, linear_tolerance=tolerance)
    for _ in range(3):
        report, _ = scene.step(None, FRAME / 4, gravity=DOWN, solver=solver)
        assert report["linear_residual"] <= tolerance
        assert (report["linear_iterations"] > 0) == (system == "conjugate_gradient" and make is coupled)
    return scene


@pytest.mark.parametrize("held", ["corner", "edge"])
def test_cloth_follows_a_rigid_motion_of_its_pins(held):
    """The advection of a step moves cloth rigidly with its pins, so that a rotation changes no gap."""
    mesh = level(0.1, 6, 0.0)
    row, column = np.divmod(np.arange(49), 7)
    cloth = Cloth(mesh, ClothMaterial(), row + column < 3 if held == "corner" else row == 0)
    scene = Scene(cloths=[cloth])
    scene.record()
    turned = mesh.points @ rotation([0.0, 1.0, 0.0], 0.6).T + [0.0, 0.03, 0.01]
    scene.step(None, FRAME, cloths=[turned])
    assert np.abs(scene.path[1] - turned).max() < 1e-8


def test_linear_solvers_agree_in_contact():
    scenes = {t: ends_of(coupled, "conjugate_gradient", t) for t in (1e-8, 1e-4)}
    direct = ends_of(coupled, "direct", 0.05)
    of_strands = direct.contacts[0] < len(direct.strands.positions)
    assert (of_strands.any(axis=1) & ~of_strands.all(axis=1)).any()  # cloth and curls are in contact
    moved = np.abs(direct.positions - coupled().positions).max()
    exact, rough = (np.abs(scenes[t].positions - direct.positions).max() for t in (1e-8, 1e-4))
    assert exact < 1e-6 * moved
    assert rough < 1e-2 * moved


def test_linear_solvers_agree_without_contact():
    """The factors of strands, which precondition conjugate gradients, solve them without an iteration."""

    def apart():
        return Scene(coupled().strands)

    ends = {how: ends_of(apart, how, 1e-8).positions for how in ("conjugate_gradient", "direct")}
    moved = np.abs(ends["direct"] - apart().positions).max()
    assert moved > 1e-4
    assert np.abs(ends["direct"] - ends["conjugate_gradient"]).max() < 1e-9 * moved


def test_cloth_on_a_sphere_is_invariant_under_uniform_motion():
    """The same positions at rest and at 100 m/s."""
    ends = []
    for speed in (0.0, 100.0):
        points, triangles = sphere(0.1, 6, 12)
        cloth = Cloth(level(0.2, 8, 0.112), ClothMaterial(thickness=4e-3, drag=0.0))
        cloth.velocities[:] = [speed, -1.0, 0]
        scene = Scene(bodies=[Body(points, triangles, thickness=2e-3)], cloths=[cloth])
        for k in range(1, 5):
            scene.step(None, FRAME, bodies=[points + [speed * k * FRAME, 0, 0]], gravity=DOWN)
        ends.append(cloth.positions - [speed * 4 * FRAME, 0, 0])
    assert np.abs(ends[1] - ends[0]).max() < 1e-7
