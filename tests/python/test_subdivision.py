"""Catmull–Clark surfaces against closed forms, and heads that are such surfaces."""

from __future__ import annotations

import numpy as np
import pytest
from ringlet.io.subdivision import Cage, levels_for, refine
from usd_scenes import CUBE, CUBE_FACES


def cube(**settings) -> Cage:
    return Cage(np.full(6, 4), np.array(CUBE_FACES).ravel(), 8, **settings)


def sheet(side: int) -> tuple[Cage, np.ndarray]:
    """A grid of quads with random points."""
    row, column = np.divmod(np.arange((side - 1) ** 2), side - 1)
    first = row * side + column
    faces = np.stack([first, first + 1, first + side + 1, first + side], axis=1)
    return Cage(np.full(len(faces), 4), faces.ravel(), side**2), np.random.default_rng(4).random((side**2, 3))


def b_spline(controls: np.ndarray, t: float) -> np.ndarray:
    """Uniform cubic B-spline of four controls, at t from 0 to 1 between the inner two."""
    basis = np.array([(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3]) / 6
    return np.tensordot(basis, controls, axes=1)


@pytest.mark.parametrize("levels", [0, 1, 2])
def test_the_limit_of_a_cube_is_half_as_large_at_its_corners(levels):
    """n = 3: (9 v + 4 Σ e + Σ f) / 24 is v / 2 about the centre."""
    points = refine(cube(), levels).points @ (2.0 * CUBE - 1.0)
    np.testing.assert_allclose(points[:8], 0.5 * (2.0 * CUBE - 1.0), atol=1e-12)


@pytest.mark.parametrize("levels", [1, 2, 3])
def test_a_regular_sheet_is_a_bicubic_b_spline(levels):
    cage, points = sheet(4)
    made = refine(cage, levels)
    limits = made.points @ points
    # The grid of the refined middle face, found through linear values at its corners.
    parameter = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    places = made.corners @ np.tile(parameter, (9, 1))
    middle = np.repeat(made.faces == 4, 4)
    grid = points.reshape(4, 4, 3)  # row, column
    for corner, (u, v) in zip(made.indices[middle], places[middle], strict=True):
        expected = b_spline(np.stack([b_spline(row, u) for row in grid]), v)
        np.testing.assert_allclose(limits[corner], expected, atol=1e-12)


def test_a_boundary_is_a_cubic_b_spline_that_reaches_its_corners():
    cage, points = sheet(4)
    limits = refine(cage, 0).points @ points
    np.testing.assert_allclose(limits[[0, 3, 12, 15]], points[[0, 3, 12, 15]])
    np.testing.assert_allclose(limits[1], (points[0] + 4 * points[1] + points[2]) / 6)
    cage.round_ends = True
    limits = refine(cage, 0).points @ points
    np.testing.assert_allclose(limits[0], (points[1] + 4 * points[0] + points[4]) / 6)


def test_infinite_creases_keep_a_cube_and_finite_ones_decay():
    edges = np.unique(np.sort([[f[k], f[(k + 1) % 4]] for f in CUBE_FACES for k in range(4)], axis=1), axis=0)
    sharp = refine(cube(creases=edges, sharpness=np.full(12, np.inf)), 2).points @ CUBE
    assert set(np.round(sharp.ravel() * 4) / 4) == {0.0, 0.25, 0.5, 0.75, 1.0} and np.ptp(sharp) == 1.0
    np.testing.assert_allclose(sharp[:8], CUBE)
    size = [
        np.ptp((refine(cube(creases=edges, sharpness=np.full(12, s)), 3).points @ CUBE)[:8])
        for s in (0.0, 0.5, 1.0, 2.0)
    ]
    assert size[0] == pytest.approx(0.5) and np.all(np.diff(size) > 0.05) and size[-1] < 1.0
    # Sharp for one level: the limit of the cube once it is split without rounding.
    split = refine(cube(creases=edges, sharpness=np.full(12, np.inf)), 1)
    once = Cage(split.counts, split.indices, split.points.shape[0])
    np.testing.assert_allclose(
        (refine(cube(creases=edges, sharpness=np.ones(12)), 2).points @ CUBE)[:8],
        (refine(once, 1).points @ (split.points @ CUBE))[:8],
        atol=1e-12,
    )


def test_polygons_of_any_number_of_corners_keep_planes_and_linear_values():
    """A prism of five sides: affine invariance, and faces that know their polygon."""
    angle = 2 * np.pi * np.arange(5) / 5
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    points = np.concatenate([ring, ring + [0, 0, 1]])
    faces = [[4, 3, 2, 1, 0], [5, 6, 7, 8, 9], *([k, (k + 1) % 5, 5 + (k + 1) % 5, 5 + k] for k in range(5))]
    cage = Cage(np.array([len(f) for f in faces]), np.concatenate(faces), 10)
    made = refine(cage, 2)
    np.testing.assert_allclose(np.asarray(made.points.sum(axis=1)).ravel(), 1.0)
    np.testing.assert_allclose(np.asarray(made.corners.sum(axis=1)).ravel(), 1.0)
    np.testing.assert_array_equal(np.bincount(made.faces), [20, 20, 16, 16, 16, 16, 16])
    assert made.corners.shape == (4 * len(made.faces), len(cage.indices))
    deeper = refine(cage, 4).points @ points  # points of a level stay where they are at the next
    np.testing.assert_allclose((made.points @ points)[:10], deeper[:10], atol=1e-12)


def test_levels_follow_the_distance_from_the_limit_surface():
    assert levels_for(cube(), CUBE * 1e-5) == 0
    assert levels_for(cube(), CUBE * 1e-3) < levels_for(cube(), CUBE * 1e-2) <= 3
    assert levels_for(cube(), CUBE * 100.0) == 3
