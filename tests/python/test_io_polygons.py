"""Triangulation of polygons: every triangle faces as its polygon, and together they cover it once."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from ringlet.io import read_mesh
from ringlet.io.polygons import polygon_places, triangulate

from ringlet.groom import make_groom, parse_recipe

CASES = Path(__file__).parent.parent / "cases"

KITE = [(0, 0), (1, 1), (0, 0.3), (-1, 1)]
STAR = [(r * np.sin(t), r * np.cos(t)) for k in range(10) for r, t in [((1.0, 0.3)[k % 2], -np.pi * k / 5)]]
COMB = [(0, 0), (7, 0), *((7 - k, (3, 1)[k % 2]) for k in range(8))]
ON_EDGES = [(0, 0), (1, 0), (2, 0), (3, 0), (3, 3), (2, 3), (0, 3), (0, 1)]  # corners in the middle of straight sides
BRIDGED = [(0, 0), (3, 0), (3, 3), (0, 3), (0, 0), (1, 1), (1, 2), (2, 2), (2, 1), (1, 1)]  # a square hole, by a bridge
SHAPES = {"kite": KITE, "star": STAR, "comb": COMB, "on edges": ON_EDGES, "bridged": BRIDGED}


def area_vectors(places):
    return 0.5 * np.cross(places[..., 1, :] - places[..., 0, :], places[..., 2, :] - places[..., 0, :])


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("name", SHAPES)
def test_triangles_cover_a_polygon_once_whatever_its_first_corner(name, clockwise):
    flat = np.array(SHAPES[name], float)
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    places = np.column_stack([flat, np.zeros(len(flat))]) @ turn.T
    whole = 0.5 * np.cross(places, np.roll(places, -1, axis=0)).sum(axis=0)
    size = np.linalg.norm(whole)
    for first in range(len(places)):
        ring = np.roll(places[:: -1 if clockwise else 1], first, axis=0)
        corners, faces = triangulate(ring, np.array([len(ring)]), np.arange(len(ring)), clockwise=clockwise)
        parts = area_vectors(ring[corners]) @ whole / size
        assert corners.shape == (len(ring) - 2, 3) and not faces.any()
        assert parts.min() > 1e-3
        assert parts.sum() == pytest.approx(size)


def test_corners_of_quads_have_their_place_in_the_quad():
    square = np.array([[0, 0], [0, 1], [1, 1], [1, 0]])
    for first in range(4):
        ring = np.roll(np.column_stack([KITE, np.zeros(4)]), first, axis=0)
        corners, _ = triangulate(ring, np.array([4]), np.arange(4))
        np.testing.assert_array_equal(polygon_places(np.array([4]))[corners], square[corners])


def test_polygons_out_of_plane_have_triangles_that_face_as_they_do():
    bent = np.column_stack([KITE, [0.2, -0.1, 0.3, 0.1]])
    whole = 0.5 * np.cross(bent, np.roll(bent, -1, axis=0)).sum(axis=0)
    for first in range(4):
        ring = np.roll(bent, first, axis=0)
        corners, _ = triangulate(ring, np.array([4]), np.arange(4))
        assert (area_vectors(ring[corners]) @ whole).min() > 0.0


def test_convex_polygons_are_fans_of_their_first_corners():
    angles = 2.0 * np.pi * np.arange(9) / 9
    ring = np.column_stack([np.cos(angles), np.sin(angles), 0.05 * np.cos(2 * angles)])
    corners, faces = triangulate(ring, np.array([4, 5]), np.array([0, 2, 4, 6, 0, 1, 3, 5, 7]))
    np.testing.assert_array_equal(corners, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7], [4, 7, 8]])
    np.testing.assert_array_equal(faces, [0, 0, 1, 1, 1])


@pytest.mark.parametrize(
    "ring",
    [
        np.zeros((5, 3)),
        np.eye(3)[[0, 0, 0, 1]],
        np.array([[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]]),
        1e200 * np.eye(3)[[0, 1, 2, 1]],
    ],
)
def test_polygons_without_area_keep_their_number_of_triangles(ring):
    corners, _ = triangulate(ring, np.array([len(ring)]), np.arange(len(ring)))
    assert corners.shape == (len(ring) - 2, 3) and len(np.unique(corners)) == len(ring)


@pytest.mark.parametrize("name", ["concave_quad", "concave_quad_rot"])
def test_hair_on_a_concave_face_stands_on_it(name):
    recipe = parse_recipe(
        'ringlet = 2\nunit = "m"\n[scalp]\nfile = "x.obj"\n[guides]\ncount = 20\nlength = "5 cm"\n'
        '[locks]\ncount = 40\npoints = 60\n[curl]\nwidth = "1 cm"\npitch = "1.5 cm"\n'
    )
    mesh = read_mesh(CASES / "concave_face" / f"{name}.obj")
    assert (area_vectors(mesh.points[mesh.triangles])[:, 1] > 0.0).all()
    locks = make_groom(recipe, mesh).locks
    assert locks.points[:, 1].min() > -1e-4
    assert locks.lengths().max() < 0.13
