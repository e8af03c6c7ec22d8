"""Sections of the scalp: their roots, partings and hairs."""

import numpy as np
import pytest
from ringlet.data.groom import SECTION
from ringlet.data.painted import painted
from ringlet.groom.scalp import Scalp
from ringlet.groom.sections import EDGE, STRAND
from ringlet.groom.shares import REACH
from scipy.spatial import KDTree
from shapes import ball, sheet
from styles import BRAID, PATTERNS, groom, no_helper, text

from ringlet import Curves, UserError, read_groom, write_groom
from ringlet.groom import make_groom, make_hairs, parse_recipe


@pytest.mark.parametrize("pattern", PATTERNS)
def test_every_section_has_its_strands_and_they_grow_in_it(pattern):
    locks = groom(f"pattern = '{pattern}'\nstrands = 3\njitter = 0.2").locks
    sections, count = np.unique(locks.curve[SECTION], return_counts=True)
    assert len(sections) > 3 and (count == 3).all() and (sections >= 0).all()
    assert len(np.unique(locks.ids)) == len(locks)


@pytest.mark.parametrize("pattern", PATTERNS)
def test_loose_hair_leaves_the_partings_free(pattern):
    free = groom(f"pattern = '{pattern}'\ngap = 0.6", locks="count = 1500\npoints = 8").locks
    everywhere = groom(f"pattern = '{pattern}'\ngap = 0", locks="count = 1500\npoints = 8").locks
    assert free.curve[EDGE].min() >= 0.003 and everywhere.curve[EDGE].min() < 0.0005
    assert 0.4 < len(free) / len(everywhere) < 0.95
    assert np.isin(free.ids, everywhere.ids).all()


def test_sections_that_a_mask_adds_change_no_other():
    some = groom("strands = 3\nmask = { where = 'x > 0' }", locks="points = 120\ncount = 60").locks
    every = groom(locks="points = 120\ncount = 60").locks
    strands = some.take(some.curve[STRAND] >= 0)
    assert 3 < len(strands) < len(every) and (some.curve[STRAND] < 0).any()
    same = every.take(np.isin(every.ids, strands.ids))
    assert np.array_equal(same.ids, strands.ids) and np.array_equal(same.points, strands.points)


def test_locks_outside_of_the_sections_grow_only_where_they_are_counted():
    masked = "strands = 3\nmask = { where = 'x > 0' }"
    assert (groom(masked).locks.curve[STRAND] >= 0).all()
    assert (groom(masked, locks="points = 60\ncount = 200").locks.curve[STRAND] < 0).sum() > 50


def painted_ball():
    """A ball whose painted ``hair`` is over 0 where z is, but for facets that cross the border."""
    made = ball(rings=20)
    made.maps["hair"] = np.maximum(made.points[made.triangles][:, :, 2], 0.0)
    return made


@pytest.mark.parametrize("pattern", PATTERNS)
def test_sections_and_their_strands_are_only_where_the_density_is_painted(pattern):
    scalp = painted_ball()
    made = groom(f"pattern = '{pattern}'\nsize = 6\nstrands = 3", "", "points = 9\ndensity = 'hair'", scalp=scalp)
    assert len(made.locks) >= 9 and (painted("hair", made.locks, scalp, "test") > 0.0).all()
    assert np.diff(np.unique(made.locks.curve[SECTION], return_counts=True)[1]).max(initial=0) == 0
    made.hairs = {"per_lock": 40, "frizz": 0.0, "stray": 0.0}
    roots = make_hairs(made).curves.roots
    grows = Scalp(scalp, None).grows(roots, "hair", "test")
    assert grows.mean() > 0.98  # shares are stars: a root may be just beyond the border, between two rays


def test_rows_end_where_the_density_does():
    locks = groom(
        "pattern = 'rows'\nstrands = 3\nsize = 3",
        "[[shape]]\nop = 'cornrow'\n",
        "points = 200\ndensity = 'hair'",
        scalp=painted_ball(),
    ).locks
    assert len(locks) >= 6 and (painted("hair", locks, painted_ball(), "test") > 0.0).mean() > 0.95


def test_a_density_without_a_number_of_locks_is_refused():
    with pytest.raises(UserError, match="locks has a density, but every guide becomes a lock; give it 'count'"):
        parse_recipe("ringlet = 2\n[locks]\ndensity = 'hair'\n")


def test_masks_and_values_go_by_places_in_sections():
    expected = {
        "section >= 0 and strand == 1": lambda at: (at[STRAND] == 1) & (at[SECTION] >= 0),
        "u > 0.5 or v > 0.5": lambda at: (at["u"] > 0.5) | (at["v"] > 0.5),
        "edge > 5": lambda at: at[EDGE] > 0.005,  # in the unit of the recipe
    }
    for where, held in expected.items():
        pin = f"[[pin]]\nmask = {{ where = '{where}' }}"
        locks = groom("size = 30\nstrands = 3", "", "points = 20\nspacing = 8", pin, "unit = 'mm'", length=160).locks
        pinned = locks.point["pin"].reshape(len(locks), -1)[:, 0] > 0.5
        assert pinned.any() and not pinned.all()
        assert np.array_equal(pinned, held(locks.curve)), where
    long = groom("strands = 3", "[[shape]]\nop = 'length'\nfactor = { value = 1.5, map = 'u' }").locks
    np.testing.assert_allclose(long.lengths(), 0.16 * np.maximum(1.5 * long.curve["u"], 0.01), rtol=0.02)


def test_a_mask_by_sections_is_refused_where_there_are_none():
    recipe = "ringlet = 2\n[guides]\ncount = 9\n[[pin]]\nmask = { where = 'strand == 1' }"
    with pytest.raises(
        UserError, match=r"pin\[0\].mask.where has 'strand', which only locks of sections and edges have; add"
    ):
        make_groom(parse_recipe(recipe), sheet())


def hairs_of(made, **settings):
    made.hairs = {"frizz": 0.0, "stray": 0.0, "shorter": 0.0, "root_falloff": 0.1, **settings}
    return make_hairs(made).curves


@pytest.mark.parametrize("pattern", ["grid", "brick", "triangles"])
def test_hairs_of_strands_cover_their_section_and_leave_the_parting_free(pattern):
    made = groom(f"pattern = '{pattern}'\nstrands = 3\nsize = 4\ngap = 0.4", BRAID)
    hairs = hairs_of(made, per_lock=150)
    recipe = parse_recipe(text(f"pattern = '{pattern}'\nstrands = 3\nsize = 4\ngap = 0.4", region="region = 'scalp'"))
    surface = Scalp(ball(), "scalp")
    division = recipe.locks.sections.divide(surface, recipe.seed, no_helper)
    at = division.at(hairs.roots)
    assert np.mean(at[SECTION] == made.locks.curve[SECTION][hairs.curve["lock"]]) > 0.97
    assert np.mean(at[EDGE] > 0.0019) > 0.94
    _, triangle, barycentric = surface.sample(3000, 5)
    places = surface.positions(triangle, barycentric)
    bare = KDTree(hairs.roots).query(places)[0][division.at(places)[EDGE] > 0.002]
    assert np.median(bare) < 0.0012 and np.mean(bare < 0.004) > 0.95


def test_hairs_lie_flat_from_their_root_to_where_their_strand_is_woven():
    made = groom("strands = 3\nsize = 4", BRAID)
    hairs = hairs_of(made, per_lock=60)
    points = hairs.points.reshape(-1, 120, 3)[hairs.ids % 10_000 > 0]  # the first hair of a lock is the strand itself
    height = Scalp(ball(), "scalp").solid.above(np.ascontiguousarray(points[:, :12].reshape(-1, 3), np.float64))[0]
    height = height.reshape(-1, 12)
    assert height.min() > -3e-4 and np.abs(height[:, 0]).max() < 1e-5
    assert height[:, 6].max() < 0.004 < height[:, -1].max()  # where the strand is woven it stands off


def test_hairs_of_a_wide_section_come_over_the_skin_that_bulges_between():
    made = groom("strands = 3\nsize = 6", BRAID + "start = 0.3\n")
    hairs = hairs_of(made, per_lock=150)
    points = hairs.points.reshape(len(hairs), -1, 3).astype(np.float64)[hairs.ids % 10_000 > 0]
    surface = Scalp(ball(), "scalp").solid
    height = surface.above(np.ascontiguousarray(points[:, :14].reshape(-1, 3)))[0].reshape(-1, 14)
    assert np.mean((height < -3e-4).any(axis=1)) < 0.02


def test_hairs_gather_over_a_length_of_their_strand_and_bend_little_at_the_skin():
    made = groom("strands = 3\nsize = 4", BRAID)
    hairs = hairs_of(made, per_lock=150)
    points = hairs.points.reshape(len(hairs), -1, 3).astype(np.float64)
    lock = hairs.curve["lock"]
    strands = made.locks.points.reshape(len(made.locks), -1, 3)
    far = np.linalg.norm(points[:, 0] - strands[lock, 0], axis=1)
    joined = np.zeros(len(lock))
    for k, strand in enumerate(strands):
        joined[lock == k] = KDTree(strand).query(points[lock == k, 10])[1]  # a hair has come to it after a tenth
    near, out = np.quantile(far, [0.3, 0.7])
    assert joined[far > out].mean() > 1.2 * joined[far < near].mean()
    edges = np.diff(points[:, :3], axis=1)
    edges /= np.linalg.norm(edges, axis=2, keepdims=True)
    bends = np.degrees(np.arccos(np.clip(np.sum(edges[:, 0] * edges[:, 1], axis=1), -1.0, 1.0)))
    assert np.quantile(bends, 0.95) < 1.0


def test_hairs_of_strands_are_the_same_from_a_file(tmp_path):
    made = groom("strands = 3", BRAID, locks="points = 120\nspacing = 2")
    write_groom(made, tmp_path / "groom.usdc")
    again = read_groom(tmp_path / "groom.usdc")
    assert np.array_equal(again.locks.curve[REACH], made.locks.curve[REACH])
    assert (made.locks.curve[REACH].max(axis=1) > 0.002).tolist() == (made.locks.curve[STRAND] >= 0).tolist()
    np.testing.assert_allclose(make_hairs(again).curves.points, make_hairs(made).curves.points, atol=1e-6)


def arc(plane, angle):
    """A parting over the ball: where a plane through its middle, with that normal, cuts it near the top."""
    normal = np.asarray(plane, float) / np.linalg.norm(plane)
    up = np.array([0.0, 1.0, 0.0]) - normal[1] * normal
    up /= np.linalg.norm(up)
    t = np.linspace(-angle, angle, 30)[:, None]
    return 0.09 * (np.cos(t) * up + np.sin(t) * np.cross(normal, up))


def drawn(*lines, locks="points = 20", sections="strands = 1"):
    recipe = parse_recipe(
        text(f"pattern = 'drawn'\npart_lines = 'p'\n{sections}", locks=locks, region="region = 'scalp'")
    )
    return make_groom(recipe, ball(), helpers={"p": Curves.from_list(list(lines))}).locks


def test_drawn_partings_divide_the_scalp_and_another_one_renames_only_what_it_divides():
    across, ahead = arc((1, 0, 0), 1.55), arc((0, 0, 1), 1.55)
    two, four = drawn(across), drawn(across, ahead)
    assert (len(two), len(four)) == (2, 4)
    assert sorted(np.sign(two.roots[:, 0])) == [-1, 1]
    assert {(x, z) for x, z in np.sign(four.roots[:, [0, 2]])} == {(a, b) for a in (-1, 1) for b in (-1, 1)}
    aside = drawn(across, 0.09 * np.stack([np.sin(t := np.linspace(0.05, 1.6, 20)), np.cos(t), 0.3 * t], axis=1))
    same = np.isin(aside.ids, two.ids)
    assert len(aside) == 3 and same.sum() == 2  # one is divided, and keeps its name on a side
    left = two.take(two.roots[:, 0] < 0)
    assert np.array_equal(aside.take(np.isin(aside.ids, left.ids)).points, left.points)


def test_loose_hair_leaves_drawn_partings_free():
    locks = drawn(arc((1, 0, 0), 1.55), locks="points = 8\ncount = 2000", sections="gap = 0.6")
    assert 0.002 < np.abs(locks.roots[:, 0]).min() < 0.005  # as in the chart, which is wider at the border
    assert locks.curve[EDGE].min() >= 0.003
    assert len(np.unique(locks.curve[SECTION])) == 2


def test_drawn_sections_without_partings_are_refused():
    with pytest.raises(UserError, match="needs both pattern = 'drawn' and 'part_lines'"):
        parse_recipe(text("pattern = 'drawn'"))
