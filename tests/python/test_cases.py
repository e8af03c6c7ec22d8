"""Small inputs that once came out wrong, run as a user would run them."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from commands import refused, run
from pxr import Usd, UsdGeom, Vt

import ringlet

CASES = Path(__file__).parents[1] / "cases"


@pytest.fixture
def case(request, tmp_path):
    """A copy of the folder of a case."""
    return Path(shutil.copytree(CASES / request.param, tmp_path / request.param))


def of(name):
    return pytest.mark.parametrize("case", [name], indirect=True, ids=[name])


def played(case, shot):
    """Points of the locks of a shot in its frames, shape (frames, locks, points, 3)."""
    result = run("sim", case / f"{shot}.shot.toml", "-o", case / f"{shot}.out.usdc")
    assert result.exit_code == 0, result.output
    cache = ringlet.read_cache(case / f"{shot}.out.usdc")
    locks = ringlet.read_groom(case / f"{shot}.out.usdc").locks
    return np.asarray(cache.points, np.float64).reshape(len(cache.points), len(locks), -1, 3)


@of("skel_rate")
def test_roots_of_a_skinned_head_travel_as_far_at_any_rate(case):
    roots = played(case, "s")[:, :, 0]
    np.testing.assert_allclose(np.linalg.norm(roots[-1] - roots[0], axis=1), 1.0, atol=1e-4)


@of("galilean")
def test_hair_of_a_head_in_steady_flight_does_not_move_on_it(case):
    points = played(case, "gal")[:20]  # later the head stops
    assert np.abs(np.diff(points[:, 0, 0], axis=0)).max() > 0.08  # [m] a frame
    local = points - points[:, :, :1]
    assert np.abs(local - local[0]).max() < 1e-5


@of("far_away")
def test_hair_far_from_the_origin_moves_as_it_does_there(case):
    near, *far = (played(case, shot) for shot in ("base", "m100", "km1"))
    near = near - near[:, :, :1]
    for points in far:
        assert np.abs(points - points[:, :, :1] - near).max() < 1e-6


@of("stubble")
@pytest.mark.parametrize("shot", ["s0.2", "s1"])
def test_stubble_shorter_than_its_contacts_is_not_stretched(case, shot):
    lengths = np.linalg.norm(np.diff(played(case, shot), axis=2), axis=3).sum(axis=2)
    assert lengths.max() < 1.01 * (2e-4 if shot == "s0.2" else 1e-3)


@of("reversed_sheet")
def test_hair_that_grows_into_a_reversed_sheet_keeps_its_length_and_is_reported(case):
    result = run("groom", case / "touch.recipe.toml", "-o", case / "g.usdc")
    assert result.exit_code == 0 and "reverse the orientation of touch.usdc /head/wall" in result.stderr
    assert ringlet.read_groom(case / "g.usdc").locks.lengths().min() > 0.029
    played(case, "touch")


@of("obj_group_names")
@pytest.mark.parametrize(("recipe", "name"), [("hyphen", "head-top"), ("digit", None), ("colon", None)])
def test_groups_of_an_obj_may_have_any_name(case, recipe, name):
    result = run("groom", case / f"{recipe}.recipe.toml", "-o", case / "g.usdc")
    assert result.exit_code == 0, result.output
    region = ringlet.read_groom(case / "g.usdc").region
    assert region and (name is None or region == name)


@of("ramp_products")
@pytest.mark.parametrize(
    ("recipe", "setting"), [("curl_ramp_1e30", "curl.width.ramp"), ("hairs_width_ramp", "hairs.width.ramp")]
)
def test_a_ramp_that_takes_a_value_beyond_all_bounds_is_refused(case, recipe, setting):
    refused(run("groom", case / f"{recipe}.recipe.toml", "-o", case / "g.usdc"), setting, "must be at most")
    assert not (case / "g.usdc").exists()


@of("coincident_points")
def test_points_of_a_lock_that_coincide_are_named(case):
    refused(run("sim", case / "s.shot.toml", "-o", case / "c.usdc"), "points 10 and 11 of curve 1 coincide")


@of("head_changed")
@pytest.mark.parametrize(
    ("change", "word"),
    [
        (lambda p: p + [0.1, 0.0, 0.0], "100 mm"),
        (lambda p: p @ np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0.0]]), "off the scalp"),
        (lambda p: 2.0 * p, "off the scalp"),
    ],
    ids=["moved", "turned", "doubled"],
)
def test_a_head_that_changed_since_the_groom_is_refused_until_it_is_bound_anew(case, change, word):
    assert run("groom", case / "r.recipe.toml", "-o", case / "g.usdc").exit_code == 0
    stage = Usd.Stage.Open(str(case / "head.usdc"))
    attribute = UsdGeom.Mesh(stage.GetPrimAtPath("/head/skin")).GetPointsAttr()
    attribute.Set(Vt.Vec3fArray.FromNumpy(change(np.array(attribute.Get())).astype(np.float32)))
    stage.Save()
    refused(run("sim", case / "s.shot.toml", "-o", case / "c.usdc"), word, "--rebind")
    assert run("sim", case / "s.shot.toml", "-o", case / "c.usdc", "--rebind").exit_code == 0
