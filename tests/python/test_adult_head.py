"""The adult head: a closed mesh with the regions of hair, where the child's skull is."""

from pathlib import Path

import numpy as np
import pytest
from pxr import Usd, UsdValidation
from ringlet.groom.scalp import Scalp
from ringlet.io import problems, read_mesh

from ringlet import _core

EXAMPLES = Path(__file__).parents[2] / "examples"
HEAD = EXAMPLES / "adult" / "head.usdc"


@pytest.fixture(scope="module")
def skin():
    return read_mesh(HEAD, "/adult/skin")


def places(mesh, region):
    """Points of a region [m], shape (n, 3)."""
    return mesh.points[np.unique(mesh.triangles[mesh.region(region)])]


def test_the_skin_is_closed_and_faces_outward(skin):
    halves = np.stack([skin.triangles, np.roll(skin.triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    there, back = np.unique(halves, axis=0), np.unique(halves[:, ::-1], axis=0)
    assert len(there) == len(halves) and np.array_equal(there, back)
    a, b, c = (skin.points[skin.triangles[:, k]] for k in range(3))
    assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0.0


def test_no_skin_comes_through_the_shirt_beyond_its_neckline(skin):
    shirt = read_mesh(HEAD, "/adult/shirt")
    solid = _core.Solid(np.ascontiguousarray(shirt.points, np.float64), shirt.triangles)
    beyond = skin.points[(np.abs(skin.points[:, 0]) > 0.076) & (skin.points[:, 1] < 0.21)]
    assert len(beyond) > 200 and solid.above(np.ascontiguousarray(beyond, np.float64))[0].max() < -0.001


def test_brows_lids_and_beard_are_where_they_grow(skin):
    eyes, chin = 0.371, 0.26
    brows, lids, beard = (places(skin, name) for name in ("brows", "lids", "beard"))
    assert (brows[:, 1] > eyes + 0.005).all() and (np.abs(brows[:, 0]) < 0.07).all()
    assert (np.abs(lids[:, 1] - eyes) < 0.012).all() and (np.abs(np.abs(lids[:, 0]) - 0.0315) < 0.02).all()
    assert beard[:, 1].max() < eyes and beard[:, 1].min() < chin and np.ptp(beard[:, 0]) > 0.1
    for name in ("brows", "lids", "beard"):
        side = places(skin, name)[:, 0] > 0.0
        assert 0.4 < side.mean() < 0.6, name


def test_it_has_the_proportions_of_an_adult_and_the_skull_of_the_child(skin):
    top, chin = skin.points[:, 1].max(), places(skin, "face")[:, 1].min()
    assert 0.21 < top - chin < 0.24
    eyes = places(skin, "lids")[:, 1].mean()
    assert (top - eyes) / (top - chin) == pytest.approx(0.5, abs=0.03)  # those of the child are lower
    child = Scalp(read_mesh(EXAMPLES / "child" / "head.usdc", "/child/skin"), "scalp")
    assert Scalp(skin, "scalp").middle == pytest.approx(child.middle, abs=0.01)


def test_the_file_is_valid_and_small():
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    errors = UsdValidation.ValidationContext(validators).Validate(Usd.Stage.Open(str(HEAD)))
    assert [error.GetErrorAsString() for error in errors] == [] == problems(HEAD)
    assert HEAD.stat().st_size < 1e6
