"""Density of hairs and their cover of the scalp."""

import numpy as np
import pytest
import ringlet.groom.hairs as hair_module
from scipy.spatial import KDTree
from shapes import ball, sheet

from ringlet import Curves, UserError, measure_hairs, write_groom, write_hairs
from ringlet.groom import cover, hair_count, hair_cover, hairs_per_cm2, make_groom, make_hairs, parse_recipe

DENSE = """
ringlet = 2
[scalp]
region = "scalp"
[guides]
count = 40
length = 4
[locks]
count = 300
points = 12
[hairs]
"""


def dense(hairs):
    """A groom of a ball with settings of its hairs."""
    return make_groom(parse_recipe(DENSE + hairs), ball())


def test_a_density_gives_the_number_of_hairs_and_fills_the_share_of_each_lock():
    made = dense("density = '100 /cm2'\n")
    hairs = make_hairs(made).curves
    area = 1e4 * 2.0 * np.pi * 0.09**2
    assert np.isclose(len(hairs) / area, 100.0, rtol=0.06) and np.isclose(
        hairs_per_cm2(made), len(hairs) / area, rtol=0.01
    )
    roots = hairs.roots[hairs.roots[:, 1] > 0.02]
    places = roots[np.random.default_rng(1).integers(len(roots), size=200)]
    near = [len(found) for found in KDTree(roots).query_ball_point(places, 0.008)]
    assert np.std(near) / np.mean(near) < 0.35  # even, although locks are 12 mm apart
    assert hair_count(made) == len(hairs)


def test_a_density_is_painted_and_masked():
    half = dense("density = 100\nmask = { where = 'x > 0' }\n")
    count = np.bincount(make_hairs(half).curves.curve["lock"])
    assert (count[half.locks.roots[:, 0] < 0] == 1).all() and np.median(count[half.locks.roots[:, 0] > 0]) > 50
    lock = half.locks.ids[3]
    own = dense(f"density = {{ value = 100, lock = {{ {lock} = 10 }} }}\n")
    assert np.bincount(make_hairs(own).curves.curve["lock"])[3] < 20
    with pytest.raises(
        UserError, match=r"hairs.density is 'thick'; must be a number or a density such as \"120 /cm2\""
    ):
        dense("density = 'thick'\n")


def test_cover_raises_the_density_until_so_much_of_the_scalp_is_hidden():
    lying = "root_radius = '8 mm'\nlock_radius = '8 mm'\n"
    thin, thick = dense(lying + "cover = 0.6\n"), dense(lying + "cover = 0.9\n")
    assert np.isclose(hair_cover(thin).seen(), 0.4, atol=0.03) and np.isclose(hair_cover(thick).seen(), 0.1, atol=0.03)
    assert hairs_per_cm2(thin) < 0.7 * hairs_per_cm2(thick)
    unchanged = dense(lying + f"density = {hairs_per_cm2(thick):.0f}\ncover = 0.1\n")
    assert np.isclose(hairs_per_cm2(unchanged), hairs_per_cm2(thick), rtol=0.02)
    assert any(
        "hairs.cover is 0.999, but at 400" in each for each in dense("cover = 0.999\nlock_radius = 0\n").conflicts
    )


def test_hairs_are_made_once_to_be_written_and_measured(tmp_path, monkeypatch):
    write_groom(dense("density = '20 /cm2'\n"), tmp_path / "groom.usdc")
    made, place = [], hair_module.place_hairs
    monkeypatch.setattr(hair_module, "place_hairs", lambda *given: made.append(1) or place(*given))
    measures: dict[str, float] = {}
    write_hairs(tmp_path / "groom.usdc", tmp_path / "hair.usdc", measures=measures)
    assert len(made) == 1
    assert measures == measure_hairs(tmp_path / "groom.usdc")


def test_hairs_that_hang_before_the_scalp_hide_the_part_that_their_optical_depth_says():
    plate = sheet()
    x = np.linspace(-0.1, 0.1, 2001)[:, None]
    across = np.stack(
        [
            np.broadcast_to(x, (2001, 400)),
            np.full((2001, 400), 0.01),
            np.broadcast_to(np.linspace(-0.1, 0.1, 400), (2001, 400)),
        ],
        axis=-1,
    )
    hairs = Curves(
        across.reshape(-1, 3).astype(np.float32),
        np.arange(2002, dtype=np.int32) * 400,
        np.arange(2001),
        point={"width": np.full(2001 * 400, 1e-4)},
    )
    from_above = [np.array([0.0, 1.0, 0.0])]
    depth = cover.measure(plate, np.arange(len(plate.triangles), dtype=np.int32), hairs, toward=from_above)
    assert np.isclose(depth.seen(), np.exp(-2001 * 1e-4 / 0.2), atol=0.02)
    assert np.isclose(depth.seen(2.0), np.exp(-2 * 2001 * 1e-4 / 0.2), atol=0.02)


@pytest.mark.parametrize("pattern", ["brick", "rows"])
def test_a_density_counts_the_share_of_a_section_for_every_strand(pattern):
    shape = "[[shape]]\nop = 'cornrow'\n" if pattern == "rows" else "[[shape]]\nop = 'braid'\nwidth = 0.8\n"
    recipe = (
        "ringlet = 2\n[scalp]\nregion = 'scalp'\n[guides]\ncount = 30\nlength = 12\n[locks]\npoints = 200\n"
        f"[locks.sections]\npattern = '{pattern}'\nsize = 3\ngap = 0.3\nstrands = 3\n{shape}[hairs]\ndensity = 40\n"
    )
    made = make_groom(parse_recipe(recipe), ball())
    assert np.isclose(hairs_per_cm2(made), 40.0, rtol=0.02)  # hair of part lines is combed into the strands


def test_hair_does_not_crowd_at_the_border_of_the_scalp():
    height = make_hairs(dense("density = 60\nroot_radius = '12 mm'\n")).curves.roots[:, 1]  # the border is at 0
    band = 0.002
    in_band = (height < band).mean() / (height < 5 * band).mean()
    assert in_band < 0.35  # 0.2 where hair is even
