"""Cloth: balance of forces, known shapes, conservation and invariance of its motion."""

import numpy as np
import pytest
from coils import rotation
from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.shot.cloth import ClothMaterial
from ringlet.shot.solver import ClothSolver
from ringlet.sim.cloth import Cloth
from sheets import lattice, sheet

from ringlet import _core

FRAME = 1 / 24
EXACT = ClothSolver(newton=100, tolerance=1e-12, linear_tolerance=1e-10, linear_iterations=20000)


def cloth(mesh, held=None, **material):
    return Cloth(mesh, ClothMaterial(**{"damping": 0.0, "drag": 0.0, **material}), held)


def jittered(mesh, amount, seed=1):
    return mesh.points + amount * np.random.default_rng(seed).normal(size=mesh.points.shape)


def top_of(mesh):
    return np.flatnonzero(np.isclose(mesh.points[:, 1], mesh.points[:, 1].max()))


def total_energy(report):
    return sum(report[name] for name in ("stretch", "bend", "gravity", "kinetic"))


def test_gradient_agrees_with_finite_differences():
    mesh = sheet(0.1, 0.1, 3, 3)
    piece = cloth(mesh, [0, 3], shear=400.0, stretch_weft=700.0, bend=1e-3)
    x = jittered(mesh, 3e-3)
    _, gradient, _ = piece.energy(x)
    expected = np.zeros_like(x)
    for i, k in np.ndindex(x.shape):
        if not piece.held[i]:
            step = np.zeros_like(x)
            step[i, k] = 1e-7
            expected[i, k] = (piece.energy(x + step)[0] - piece.energy(x - step)[0]) / 2e-7
    assert np.abs(gradient - expected).max() < 1e-6 * np.abs(expected).max()


@pytest.mark.parametrize("amount", [0.0, 1e-3, 1e-1])
def test_hessian_is_symmetric_and_positive_semidefinite(amount):
    mesh = sheet(0.1, 0.1, 4, 4)
    _, _, hessian = cloth(mesh).energy(jittered(mesh, amount), hessian=True)
    values = np.linalg.eigvalsh(hessian)
    assert np.abs(hessian - hessian.T).max() < 1e-12 * values[-1]
    assert values[0] > -1e-12 * values[-1]


def test_a_folded_rest_shape_stays_at_rest():
    mesh = sheet(0.2, 0.2, 6, 6)
    mesh.points[:, 2] = 0.03 * np.abs(np.sin(40 * mesh.points[:, 0]))
    piece = cloth(mesh, [0])
    energy, gradient, _ = piece.energy(mesh.points)
    assert energy < 1e-20 and np.abs(gradient).max() < 1e-10
    for _ in range(10):
        piece.step(mesh.points, FRAME)
    assert np.abs(piece.positions - mesh.points).max() < 1e-10


def test_a_hanging_sheet_carries_in_every_row_the_weight_below():
    """The strain at height y is ρ g y / k, the extension of the sheet ρ g H² / 2k."""
    height, gravity, density, weft = 0.4, 9.81, 0.2, 50.0
    mesh = sheet(0.2, height, 6, 12)
    piece = cloth(mesh, top_of(mesh), density=density, stretch_weft=weft, stretch_warp=weft, shear=20.0)
    assert piece.settle(gravity=(0.0, -gravity, 0.0))
    fallen = mesh.points[:, 1] - piece.positions[:, 1]
    y = mesh.points[:, 1]
    expected = density * gravity / weft * (height**2 - y**2) / 2
    assert np.abs(fallen - expected).max() < 2e-3 * expected.max()
    pull = piece.energy(piece.positions)[1] - piece.masses[:, None] * (0.0, -gravity, 0.0)
    assert np.abs(pull[~piece.held]).max() < 1e-6 * piece.masses.sum() * gravity


def test_a_sheet_between_two_edges_hangs_as_a_catenary():
    """Without bending stiffness and nearly inextensible: y = a cosh(x / a), with a from length and span."""
    length, span, columns = 0.5, 0.4, 40
    mesh = sheet(length, 0.05, columns, 2)
    along = mesh.points[:, 0].copy()
    mesh.points = mesh.points[:, [0, 2, 1]].copy()
    ends = np.flatnonzero((along == 0) | (along == along.max()))
    piece = cloth(mesh, ends, bend=0.0, stretch_warp=1e5, stretch_weft=1e5, shear=1e3)
    low, high = 1e-2, 10.0
    for _ in range(200):
        a = 0.5 * (low + high)
        low, high = (a, high) if 2 * a * np.sinh(span / (2 * a)) > length else (low, a)
    s = along - length / 2
    x = a * np.arcsinh(s / a)
    expected = np.c_[x - x.min(), np.sqrt(a**2 + s**2) - np.sqrt(a**2 + length**2 / 4), mesh.points[:, 2]]
    guess = expected * (1.0, 0.9, 1.0)  # away from the solution
    piece.positions[:] = guess
    piece.positions[ends] = expected[ends]
    for _ in range(5):
        assert piece.settle(gravity=(0.0, -9.81, 0.0), tolerance=1e-7)
    sag = -expected[:, 1].min()
    assert np.abs(piece.positions - expected).max() < 5e-3 * sag


def cantilever(columns, width, gamma):
    """Tip deflection over length of a strip under Γ = ρ g L³ / D, clamped by its first two rows."""
    length, bend, density = 0.1, 1e-5, 0.15
    mesh = lattice(columns, width, length / (columns - 0.5))
    mesh.points = mesh.points[:, [0, 2, 1]] - [0.5 * length / (columns - 0.5), 0, 0]
    x = mesh.points[:, 0]
    stiff = {"stretch_warp": 1000.0, "stretch_weft": 1000.0, "shear": 1000.0}
    strip = cloth(mesh, np.flatnonzero(x < length / columns), bend=bend, density=density, **stiff)
    assert strip.settle(gravity=(0.0, -gamma * bend / (density * length**3), 0.0), tolerance=1e-8)
    return -strip.positions[np.isclose(x, x.max()), 1].mean() / length


ELASTICA = {1: 0.123471, 4: 0.425159, 20: 0.829881}  # tip deflection over length


@pytest.mark.parametrize("gamma", ELASTICA)
def test_a_wide_strip_sags_as_the_elastica(gamma):
    """A strip wider than long bends to a cylinder; the error decreases with the size of the triangles."""
    errors = [abs(cantilever(columns, 0.2, gamma) / ELASTICA[gamma] - 1) for columns in (5, 10)]
    assert errors[1] < 1e-2
    assert errors[1] < errors[0]


def test_a_narrow_strip_bends_as_a_plate_of_poisson_ratio_minus_a_third():
    """Anticlastic curvature of the free edges reduces the stiffness to 1 − ν² = 8/9."""
    assert abs(cantilever(20, 0.01, 8 / 9) / ELASTICA[1] - 1) < 5e-2


def test_energy_never_increases():
    mesh = sheet(0.3, 0.3, 8, 8)
    for newton in (1, 5):
        piece = cloth(mesh, top_of(mesh), bend=1e-4)
        piece.positions[~piece.held] = jittered(mesh, 5e-3)[~piece.held]
        before = piece.energy(piece.positions)[0] - float(
            (piece.masses[:, None] * piece.positions)[~piece.held, 1].sum() * -9.81
        )
        for _ in range(60):
            now = total_energy(
                piece.step(mesh.points, FRAME, gravity=(0.0, -9.81, 0.0), solver=ClothSolver(newton=newton))
            )
            assert now <= before + 1e-9
            before = now


def test_free_cloth_conserves_momentum_in_free_fall():
    mesh = sheet(0.2, 0.2, 6, 6)
    piece = cloth(mesh, bend=1e-3)
    piece.positions[:] = jittered(mesh, 2e-3)
    piece.velocities[:] = np.random.default_rng(2).normal(size=mesh.points.shape)
    mass = piece.masses[:, None]
    start = (mass * piece.velocities).sum(0)
    for k in range(1, 11):
        piece.step(mesh.points, FRAME, gravity=(0.0, -9.81, 0.0), solver=EXACT)
        fallen = start + mass.sum() * np.array([0, -9.81, 0]) * FRAME * k
        assert np.abs((mass * piece.velocities).sum(0) - fallen).max() < 1e-8 * np.abs(fallen).max()


def test_motion_is_invariant_under_rigid_transforms_and_uniform_motion():
    mesh = sheet(0.2, 0.2, 6, 6)
    turn, shift, speed = rotation([3, -1, 2], 1.1), np.array([0.3, -0.2, 0.5]), np.array([100.0, -50.0, 20.0])
    turned = Mesh("turned", mesh.points @ turn.T + shift, mesh.triangles)
    here, there = (
        cloth(mesh, top_of(mesh)),
        Cloth(turned, ClothMaterial(damping=0.0, drag=0.0), top_of(mesh), warp=tuple(turn @ (1.0, 0.0, 0.0))),
    )
    there.velocities[:] = speed
    gravity = np.array([1.0, -9.81, 2.0])
    for k in range(1, 6):
        here.step(mesh.points, FRAME, gravity=tuple(gravity), solver=EXACT)
        along = speed * FRAME * k
        there.step(turned.points + along, FRAME, gravity=tuple(turn @ gravity), solver=EXACT)
        assert np.abs(here.positions @ turn.T + shift + along - there.positions).max() < 1e-7


def test_damping_resists_strain_rates_and_not_rigid_motion():
    mesh = sheet(0.2, 0.2, 6, 6)
    swinging = {}
    for damping in (0.0, 1.0):
        piece = cloth(mesh, damping=damping)
        piece.velocities[:] = (0.5, 0.2, 0.0)
        piece.positions[:] = mesh.points * (1.05, 1.0, 1.0)
        for _ in range(5):
            report = piece.step(mesh.points, FRAME, solver=EXACT)
        swinging[damping] = report["stretch"]
        mean = (piece.masses[:, None] * piece.velocities).sum(0) / piece.masses.sum()
        assert np.abs(mean - (0.5, 0.2, 0.0)).max() < 1e-8
    assert swinging[1.0] > 2 * swinging[0.0], "damping slows the return"


def test_drag_accelerates_cloth_to_the_speed_of_the_wind():
    mesh = sheet(0.2, 0.2, 4, 4)
    piece = cloth(mesh, drag=5.0)
    wind = (0.5, 0.0, 0.2)
    for _ in range(100):
        piece.step(mesh.points, FRAME, wind=wind)
    assert np.abs(piece.velocities - wind).max() < 1e-6


def test_an_attachment_extends_by_weight_over_stiffness():
    """In equilibrium the extension of the spring is the weight over its stiffness."""
    mesh = sheet(0.1, 0.1, 2, 2)
    attachment = np.zeros(9)
    attachment[4] = 30.0
    piece = Cloth(mesh, ClothMaterial(damping=0.0, drag=0.0, bend=1e-2), attachment=attachment)
    assert piece.settle(gravity=(0.0, -9.81, 0.0))
    expected = piece.masses.sum() * 9.81 / 30.0
    assert abs(mesh.points[4, 1] - piece.positions[4, 1] - expected) < 1e-6 * expected


def test_prescribed_vertices_reach_their_targets():
    mesh = sheet(0.2, 0.2, 4, 4)
    piece = cloth(mesh, top_of(mesh))
    targets = mesh.points + [0.01, 0.02, -0.03]
    piece.step(targets, FRAME)
    assert (piece.positions[piece.held] == targets[piece.held]).all()


def test_motion_is_bit_identical_for_any_number_of_threads():
    mesh = sheet(0.3, 0.3, 12, 12)
    before, results = _core.thread_count(), []
    try:
        for threads in (1, 2, 5):
            _core.set_thread_count(threads)
            piece = Cloth(mesh, held=[0, 12])
            for _ in range(4):
                piece.step(mesh.points, FRAME, gravity=(3.0, -9.81, 1.0))
            results.append(piece.positions.copy())
    finally:
        _core.set_thread_count(before)
    assert (results[0] == results[1]).all() and (results[0] == results[2]).all()


def test_a_non_finite_start_is_reported():
    mesh = sheet(0.2, 0.2, 4, 4)
    piece = cloth(mesh)
    piece.positions[3] = np.nan
    assert piece.step(mesh.points, FRAME)["nan"] == 1


def test_a_scaled_rest_shape_is_at_rest_and_keeps_its_mass():
    mesh = sheet(0.1, 0.1, 4, 4)
    mesh.points[:, 2] = 0.3 * np.abs(mesh.points[:, 0] - 0.05)  # with a fold
    piece = cloth(mesh, stretch_warp=500.0, stretch_weft=500.0)
    mass, area = piece.masses.sum(), 0.01 * np.hypot(1, 0.3)
    for scale in (0.5, 2.0, 1.0):
        piece.scale_rest(scale)
        assert piece.energy(scale * mesh.points)[0] < 1e-20
        # ½ k (1/s − 1)² in each direction, over the area s² A
        expected = area * scale**2 * 500.0 * (1 / scale - 1) ** 2
        assert abs(piece.energy(mesh.points)[0] - expected) < 1e-9
        assert piece.masses.sum() == mass
    with pytest.raises(ValueError, match="above 0"):
        piece.scale_rest(0.0)


def test_the_warp_follows_the_texture_coordinates():
    """A stretch along u strains only the warp, for any orientation of the sheet."""
    mesh = sheet(0.1, 0.1, 2, 2)
    mesh.uv = mesh.points[mesh.triangles][:, :, [1, 0]]  # u along y
    piece = cloth(mesh, stretch_warp=1000.0, stretch_weft=1.0, shear=0.0, bend=0.0)
    along_u = piece.energy(mesh.points * (1.0, 1.1, 1.0))[0]
    assert abs(along_u / (0.5 * 1000.0 * 0.01 * 0.01) - 1) < 1e-9


@pytest.mark.parametrize(("what", "message"), [("flat", "triangle 1 has no area"), ("loose", "vertex 9 belongs to no")])
def test_an_invalid_cloth_mesh_is_refused(what, message):
    mesh = sheet(0.1, 0.1, 2, 2)
    if what == "flat":
        mesh.triangles[1] = (0, 1, 1)
    else:
        mesh.points = np.vstack([mesh.points, [(9.0, 9.0, 9.0)]])
    with pytest.raises(UserError, match=message):
        Cloth(mesh)
