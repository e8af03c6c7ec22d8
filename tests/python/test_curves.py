"""Curves, frames along curves and roots on a moving mesh."""

import numpy as np
import pytest
from shapes import ball, rotation, sheet

from ringlet import Curves, UserError, _core


def helix(radius=0.01, pitch=0.02, turns=3.0, points=400):
    phase = 2.0 * np.pi * turns * np.linspace(0.0, 1.0, points)
    return np.stack([radius * np.cos(phase), pitch * phase / (2.0 * np.pi), radius * np.sin(phase)], axis=1)


@pytest.mark.parametrize(
    ("curve", "point", "message"),
    [
        ({}, {"width": [1e-4, np.nan, 0, 0]}, "here: width is nan on curve 7; must be at least 0 and finite"),
        ({"width": [1e-4, -1.0]}, {}, "here: width is -1 on curve 9; must be at least 0 and finite"),
        ({}, {"pin": [0, 0, 1, 1e30]}, "here: pin is 1e\\+30 on curve 9; must be from 0 to 1"),
        ({}, {"pin": [0, -5, 1, 0]}, "here: pin is -5 on curve 7; must be from 0 to 1"),
        ({}, {"pin": [0, 0, np.nan, 0]}, "here: pin is nan on curve 9; must be from 0 to 1"),
        ({"displayColor": [[0, 0, 0], [0, np.nan, 1]]}, {}, "here: displayColor is nan on curve 9; must be from 0"),
        ({}, {"displayColor": [[0, -1, 0]] * 4}, "here: displayColor is -1 on curve 7; must be from 0"),
        ({}, {"color": [[0, 0, 0]] * 3 + [[1e30, 0, 0]]}, "here: color is 1e\\+30 on curve 9; must be from 0"),
        ({"displayOpacity": [1.0, 2.0]}, {}, "here: displayOpacity is 2 on curve 9; must be from 0 to 1"),
        ({"melanin": [np.inf, 0.5]}, {}, "here: melanin is inf on curve 7; must be from"),
        ({"st": [[0, 0], [1e20, 0]]}, {}, "here: st is 1e\\+20 on curve 9; must be from"),
    ],
)
def test_widths_and_pins_out_of_range_are_refused(curve, point, message):
    curves = Curves.from_list([np.eye(3)[:2], np.eye(3)[1:]], ids=[7, 9])
    curves.curve |= {name: np.array(values) for name, values in curve.items()}
    curves.point |= {name: np.array(values) for name, values in point.items()}
    with pytest.raises(UserError, match=message):
        curves.check("here")


def frames_along(points, axis=(1.0, 0.0, 0.0)):
    offsets = np.array([0, len(points)], np.int32)
    return _core.curve_frames(np.ascontiguousarray(points), offsets, np.array([axis]))


def test_frames_are_rotations_whose_last_axis_follows_the_curve():
    points = helix()
    frames = frames_along(points)
    assert np.allclose(frames @ frames.transpose(0, 2, 1), np.eye(3), atol=1e-12)
    assert np.allclose(np.linalg.det(frames), 1.0)
    edges = np.diff(points, axis=0)
    along = np.einsum("nx,nx->n", edges / np.linalg.norm(edges, axis=1)[:, None], frames[:-1, :, 2])
    assert (along > 0.999).all()


def test_frames_do_not_turn_about_the_tangent():
    frames = frames_along(helix(points=4000))
    change = np.diff(frames[:, :, 0], axis=0)
    turning = np.abs(np.einsum("nx,nx->n", change, frames[:-1, :, 1]))
    assert turning.max() < 1e-5  # the Frenet frame rotates by 1.4e-3 an edge here


def test_in_a_plane_the_frame_keeps_its_normal():
    angle = np.linspace(0.0, 5.0, 50)
    circle = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    frames = frames_along(circle, axis=(0.0, 0.0, 1.0))
    assert np.allclose(frames[:, :, 0], [0.0, 0.0, 1.0])


def test_frames_turn_with_the_curve():
    turn = rotation((1.0, 2.0, 3.0), 70.0)
    points = helix(points=60)
    still, turned = (
        frames_along(points, (0.3, 0.1, 0.9)),
        frames_along(points @ turn.T, turn @ np.array([0.3, 0.1, 0.9])),
    )
    assert np.allclose(turned, turn @ still)


def test_frames_are_orthonormal_at_coincident_points_and_reversals():
    points = np.array([[0, 0, 0], [0, 1, 0], [0, 1, 0], [0, 0.5, 0], [0.5, 0.5, 0]], float)
    frames = frames_along(points)
    assert np.allclose(frames @ frames.transpose(0, 2, 1), np.eye(3), atol=1e-12)


def test_resampling_spaces_points_evenly_and_keeps_the_ends():
    rough = np.array([[0, 0, 0], [0.02, 0.01, 0], [0.05, 0.03, 0], [0.07, 0.09, 0.02]])
    fine = _core.resample_curves(rough, np.array([0, 4], np.int32), 40)
    edges = np.linalg.norm(np.diff(fine, axis=0), axis=1)
    assert np.ptp(edges) < 0.01 * edges.mean()
    assert np.array_equal(fine[[0, -1]], rough[[0, -1]])


def test_a_root_binds_to_the_closest_point_of_the_mesh():
    mesh = ball()
    rng = np.random.default_rng(1)
    points = rng.normal(size=(200, 3))
    points *= 0.11 / np.linalg.norm(points, axis=1)[:, None]
    triangle, barycentric, distance = _core.bind_roots(mesh.points, mesh.triangles, points)
    corners = mesh.points[mesh.triangles]
    bound = np.einsum("kc,kcx->kx", barycentric, corners[triangle])
    assert np.allclose(np.linalg.norm(bound - points, axis=1), distance)
    assert (barycentric >= 0.0).all() and np.allclose(barycentric.sum(axis=1), 1.0)
    inside = rng.dirichlet([1, 1, 1], size=30)  # samples of all triangles, none of which is closer
    others = np.einsum("sc,mcx->msx", inside, corners).reshape(-1, 3)
    for point, nearest in zip(points[:40], distance, strict=False):
        assert np.linalg.norm(others - point, axis=1).min() >= nearest - 1e-12


def test_a_root_binds_only_to_allowed_triangles():
    mesh = ball()
    below = np.array([[0.0, -0.1, 0.0]])
    triangle, _, distance = _core.bind_roots(mesh.points, mesh.triangles, below, mesh.regions["scalp"])
    assert triangle[0] in mesh.regions["scalp"]
    assert distance[0] > 0.1


def test_a_root_is_carried_rigidly_by_a_mesh_that_moves_rigidly():
    mesh = ball()
    triangle, barycentric, _ = _core.bind_roots(mesh.points, mesh.triangles, mesh.points[:50] * 1.05)
    turn, shift = rotation((0.2, 1.0, -0.4), 130.0), np.array([0.3, -0.1, 0.5])
    rest, rest_frames = _core.root_frames(mesh.points, mesh.triangles, triangle, barycentric)
    now, now_frames = _core.root_frames(mesh.points @ turn.T + shift, mesh.triangles, triangle, barycentric)
    assert np.allclose(now, rest @ turn.T + shift)
    assert np.allclose(now_frames @ rest_frames.transpose(0, 2, 1), turn)


def test_each_curve_is_carried_by_its_own_rotation():
    first, second = helix(points=40), helix(radius=0.02, points=25) + 0.1
    turns = np.stack([rotation((0.2, 1.0, -0.4), 130.0), rotation((1.0, 0.0, 0.3), -20.0)])
    from_points, to_points = np.array([[0.1, 0, 0], [0, 0.2, 0]], float), np.array([[1, 2, 3], [-1, 0, 5]], float)
    offsets = np.array([0, 40, 65], np.int32)
    carried = _core.carry_curves(np.concatenate([first, second]), offsets, turns, from_points, to_points)
    assert np.allclose(carried[:40], (first - from_points[0]) @ turns[0].T + to_points[0])
    assert np.allclose(carried[40:], (second - from_points[1]) @ turns[1].T + to_points[1])
    with pytest.raises(ValueError, match="one row a curve"):
        _core.carry_curves(first, offsets[:2], turns, from_points, to_points)


def test_flat_triangles_are_those_without_area_or_not_finite():
    points = np.array(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0], [1, 3e-9, 0], [1, 5e-10, 0], [np.nan, 0, 0], [np.inf, 1, 0]]
    )
    triangles = np.array([[0, 1, 2], [0, 1, 3], [0, 3, 4], [0, 3, 5], [0, 1, 6], [0, 1, 7], [1, 1, 2]], np.int32)
    assert _core.flat_triangles(points, triangles).tolist() == [False, True, False, True, True, True, True]


def test_the_normal_of_roots_is_smooth_across_edges():
    mesh = ball(rings=12)
    angle = np.linspace(0.2, 1.2, 400)
    path = 0.09 * np.stack([np.sin(angle), np.cos(angle), 0.1 * np.sin(angle)], axis=1)
    triangle, barycentric, _ = _core.bind_roots(mesh.points, mesh.triangles, path)
    normals = _core.root_frames(mesh.points, mesh.triangles, triangle, barycentric)[1][:, :, 2]
    assert len(np.unique(triangle)) > 4
    assert np.linalg.norm(np.diff(normals, axis=0), axis=1).max() < 0.02  # facets meet at 15°, a jump of 0.26


def test_binding_to_a_degenerate_triangle_finds_the_closest_point():
    points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0]], float)
    _, _, distance = _core.bind_roots(points, np.array([[0, 1, 2]], np.int32), np.array([[1.5, 1.0, 0.0]]))
    assert np.isclose(distance[0], 1.0)


def test_a_triangle_with_a_missing_point_is_refused():
    mesh = sheet()
    with pytest.raises(IndexError, match="point"):
        _core.bind_roots(mesh.points[:10], mesh.triangles, mesh.points[:1])


@pytest.mark.parametrize(
    ("curves", "words"),
    [
        ([np.zeros((1, 3))], "must have at least 2"),
        ([np.zeros((3, 3))], "length 0"),
        ([np.array([[0, 0, 0], [0, np.nan, 0]])], "must be finite"),
        ([], "no curves"),
    ],
)
def test_unusable_curves_are_refused(curves, words):
    with pytest.raises(UserError, match=words):
        Curves.from_list(curves).check("drawn guides")


def test_taking_curves_takes_their_attributes():
    curves = Curves.from_list([helix(points=5), helix(points=7), helix(points=3)], ids=[10, 20, 30])
    curves.curve["hand"] = np.array([1, -1, 1])
    curves.point["width"] = np.arange(15.0)
    taken = curves.take(np.array([2, 0]))
    assert taken.ids.tolist() == [30, 10]
    assert np.array_equal(taken[0], curves[2])
    assert taken.point["width"].tolist() == [12, 13, 14, 0, 1, 2, 3, 4]
