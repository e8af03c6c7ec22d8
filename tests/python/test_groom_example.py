"""The example recipe on the example head."""

from pathlib import Path

import numpy as np
import pytest

import ringlet
from ringlet import _core

RECIPE = Path(__file__).parents[2] / "examples" / "child" / "curls.recipe.toml"


@pytest.fixture(scope="module")
def groom():
    return ringlet.build_groom(RECIPE)


def test_no_lock_intersects_the_head(groom):
    scalp, points = groom.scalp, groom.locks.points
    triangle, barycentric, distance = _core.bind_roots(scalp.points, scalp.triangles, points)
    nearest, frames = _core.root_frames(scalp.points, scalp.triangles, triangle, barycentric)
    inside = np.einsum("kx,kx->k", points - nearest, frames[:, :, 2]) < 0.0
    assert (distance[inside] < 1e-9).all()  # only roots, which are on the skin


def test_locks_resolve_their_curls(groom):
    edges = np.diff(groom.locks.points.reshape(len(groom.locks), -1, 3), axis=1)
    edges /= np.linalg.norm(edges, axis=2, keepdims=True)
    turn = np.degrees(np.arccos(np.clip(np.sum(edges[:, 1:] * edges[:, :-1], axis=2), -1.0, 1.0)))
    assert np.median(turn) < 360.0 / 12
    assert turn.max() < 90.0


def test_the_example_has_about_a_thousand_locks_of_varied_length(groom):
    assert 900 <= len(groom.locks) <= 1500
    lengths = groom.locks.lengths()
    assert lengths.min() > 0.05 and lengths.std() > 0.1 * lengths.mean()


def test_hairs_of_the_example_start_on_the_scalp_region(groom):
    hairs = ringlet.build_hairs(groom, fraction=0.25).curves
    assert np.isin(hairs.curve["root_triangle"], groom.scalp.regions["scalp"]).all()
    assert np.isfinite(hairs.points).all()
    assert hairs.curve["st"].min() >= 0.0 and hairs.curve["st"].max() <= 1.0
