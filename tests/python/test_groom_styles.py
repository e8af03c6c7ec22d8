"""Sections, braids and twists: where strands grow, which path they follow, and when they are refused."""

from itertools import pairwise

import numpy as np
import pytest
from ringlet.data.groom import SECTION, STRAND_RADIUS
from ringlet.groom.felt import FUZZ, MATTING, PROFILE
from ringlet.groom.operators import Context
from ringlet.groom.scalp import Scalp
from ringlet.groom.sections import EDGE, STRAND
from ringlet.groom.shares import REACH
from scipy.spatial import KDTree
from shapes import ball, sheet

from ringlet import Curves, UserError, _core, read_groom, write_groom
from ringlet.groom import HairMemory, lock_thickness, make_groom, make_hairs, parse_recipe, weave

PATTERNS = ["grid", "brick", "rows", "triangles", "radial"]


def no_helper(name, setting):
    raise AssertionError(f"{setting} asks for {name}")


def groom(sections="strands = 3", shape="", locks="points = 120", curl="", top="", scalp=None, length=16):
    """A groom of straight hair that stands on the scalp."""
    return make_groom(
        parse_recipe(text(sections, shape, locks, curl, top, "" if scalp else "region = 'scalp'", length)),
        scalp or ball(),
    )


def text(sections="strands = 3", shape="", locks="points = 120", curl="", top="", region="", length=16):
    return f"""
ringlet = 1
{top}
[scalp]
{region}
[guides]
count = 30
length = {length}
lift = 1
droop = 0
[locks]
{locks}
[locks.sections]
{"" if "size" in sections else "size = 3"}
{sections}
{shape}
{curl}
[clean]
margin = 0
"""


def strands_of(locks):
    """Points of the strands of each section, shape (strands, points, 3)."""
    assert (locks.curve[STRAND] >= 0).all()
    grid = locks.points.reshape(len(locks), -1, 3)
    return [grid[locks.curve[SECTION] == section] for section in np.unique(locks.curve[SECTION])]


def words(locks):
    middle = Scalp(ball(), "scalp").middle
    return [weave.braid_word(weave.cross_sections(strands, middle)) for strands in strands_of(locks)]


BRAID = "[[shape]]\nop = 'braid'\nwidth = 1.2\npitch = 3\n"


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


def test_strands_of_a_braid_follow_the_closed_form():
    recipe = parse_recipe(
        text("pattern = 'radial'\nsize = 30\nstrands = 3", BRAID + "start = 2\ntail = 2", "points = 400", length=20)
    )
    surface, locks = Scalp(sheet(), None), Curves.from_list([])
    for operator in (recipe.guides, recipe.locks, recipe.shape[0]):
        locks = operator.apply(locks, Context(recipe.seed, surface, "braid", 400))
    (strands,) = strands_of(locks)
    radius = float(locks.curve[STRAND_RADIUS][0])
    across, front = 0.006 - radius, 0.67 * 0.006 - radius
    along, away = weave.frames(strands.mean(axis=0), surface.middle)
    offset = strands - strands.mean(axis=0)
    x, z = (np.einsum("spx,px->sp", offset, axis)[:, 60:340] for axis in (along, away))
    # z = b sin 2φ and x = a sin φ, a third of a turn apart
    s = (x / across) ** 2
    np.testing.assert_allclose((z / front) ** 2, 4.0 * s * (1.0 - s), atol=1e-6)
    np.testing.assert_allclose(np.sum(x * x, axis=0), 1.5 * across**2, rtol=1e-6)


@pytest.mark.parametrize(
    ("strands", "shape"),
    [
        (3, "pattern = 'over'"),
        (4, "pattern = 'over'"),
        (5, "pattern = 'under'"),
        (5, "pattern = 'fishtail'"),
        (3, "pattern = 'rope'"),
    ],
)
def test_strands_of_a_tight_braid_touch_and_do_not_overlap(strands, shape):
    # Along a straight line, where the distance of strands is that of their closed paths.
    locks = groom(
        f"strands = {strands}\npattern = 'radial'\nsize = 30", BRAID + shape, "points = 400", scalp=sheet(), length=20
    ).locks
    (points,) = strands_of(locks)
    middle = points[:, 100:300]
    least = min(
        np.linalg.norm(a[:, None] - b[None], axis=2).min() for k, a in enumerate(middle) for b in middle[k + 1 :]
    )
    assert least == pytest.approx(2.0 * locks.curve[STRAND_RADIUS][0], rel=0.03)


def test_looser_strands_are_thinner_on_the_same_path():
    tight, loose = (groom("strands = 3", BRAID + f"tightness = {t}").locks for t in (1, 0.5))
    assert np.array_equal(tight.points, loose.points)
    np.testing.assert_allclose(loose.curve[STRAND_RADIUS], 0.5 * tight.curve[STRAND_RADIUS], rtol=1e-6)


def test_the_word_of_three_strands_alternates_and_that_of_a_dutch_braid_is_its_mirror():
    over, under = (words(groom("strands = 3", BRAID + f"pattern = '{p}'").locks) for p in ("over", "under"))
    for a, b in zip(over, under, strict=True):
        assert len(a) > 12
        assert all(i != j for i, j in pairwise(at for at, _ in a))  # σ₁ σ₂⁻¹ σ₁ …
        assert set(a) == {(0, -1), (1, 1)} and set(b) == {(0, 1), (1, -1)}


def test_a_twist_has_one_hand_or_both():
    right = words(groom("strands = 2", "[[shape]]\nop = 'twist'").locks)
    both = words(groom("strands = 2", "[[shape]]\nop = 'twist'\nright_handed = 0.5").locks)
    assert {sign for word in right for _, sign in word} == {1} or {sign for word in right for _, sign in word} == {-1}
    assert all(len({sign for _, sign in word}) == 1 for word in both)
    assert {sign for word in both for _, sign in word} == {1, -1}


def test_the_width_ramp_narrows_the_braid():
    strands = strands_of(
        groom("strands = 3", "[[shape]]\nop = 'braid'\nwidth = { value = 1.2, ramp = [[0, 1], [1, 0.4]] }").locks
    )
    for one in strands:
        spread = np.linalg.norm(one - one.mean(axis=0), axis=2).max(axis=0)
        assert spread[80:105].max() < 0.75 * spread[20:45].max()


def test_a_curl_leaves_what_is_braided_as_it_is():
    plain = groom("strands = 3", BRAID).locks
    curled = groom("strands = 3", BRAID, curl="[curl]\nwidth = 1\npitch = 2").locks
    np.testing.assert_allclose(curled.points, plain.points, atol=2e-4)
    loose = groom("strands = 3", BRAID + "mask = { where = 'x > 0' }", curl="[curl]\nwidth = 1\npitch = 2").locks
    braided = loose.curve[STRAND_RADIUS] > 0.0
    assert 0 < braided.sum() < len(loose)
    assert loose.take(~braided).lengths().mean() > 1.2 * loose.take(braided).lengths().mean()


def test_hairs_of_a_strand_fill_it():
    made = groom("strands = 3", BRAID)
    made.hairs = {
        "per_lock": 40,
        "radius": {"value": 0.1, "ramp": [(0.0, 1.0)]},
        "frizz": 0.0,
        "stray": 0.0,
        "shorter": 0.0,
    }
    hairs = make_hairs(made).curves
    middle = hairs.points.reshape(len(hairs), -1, 3)[hairs.curve["lock"] == 0, 60]
    fine = _core.resample_curves(made.locks[0], np.array([0, 120], np.int32), 4000)
    away = KDTree(fine).query(middle)[0]
    radius = made.locks.curve[STRAND_RADIUS]
    assert away.max() == pytest.approx(float(radius[0]), rel=0.15)
    assert lock_thickness(made) == pytest.approx(2.0 * float(radius.max()))


def test_cached_hairs_of_a_strand_follow_its_width():
    memory = HairMemory()
    made = groom("strands = 3", BRAID)
    make_hairs(made, memory=memory)
    wide = groom("strands = 3", BRAID.replace("width = 1.2", "width = 1.6"))
    assert np.array_equal(make_hairs(wide, memory=memory).curves.points, make_hairs(wide).curves.points)
    unchanged = memory.hairs
    make_hairs(groom("strands = 3", BRAID.replace("width = 1.2", "width = 1.6")), memory=memory)
    assert memory.hairs is unchanged


@pytest.mark.parametrize(
    ("sections", "shape", "locks", "message"),
    [
        ("gap = 0.2", BRAID, "count = 100\npoints = 120", "no section has strands; give [locks.sections] strands"),
        ("strands = 1", BRAID, "points = 120", "weaves 1 strand; give locks.sections.strands at least 2"),
        (
            "strands = 3",
            BRAID + "pattern = 'fishtail'",
            "points = 120",
            "weaves 3 strands; a fishtail has 5, 7, 9 or 11",
        ),
        ("strands = 3", BRAID, "points = 60", "locks.points is 60: too few for the 5.3 turns of braid; set it to 107"),
        ("gap = 4", "", "count = 100\npoints = 8", "leaves no hair: its gap is as wide as its size"),
    ],
)
def test_what_cannot_be_woven_is_refused_with_a_remedy(sections, shape, locks, message):
    with pytest.raises(UserError) as refused:
        groom(sections, shape, locks)
    assert message in str(refused.value)


@pytest.mark.parametrize("more", ["mask = 0", "blend = 0", "mask = { where = 'id < 0' }"])
def test_a_braid_that_acts_nowhere_changes_nothing(more):
    plain, masked = (groom("strands = 3", shape).locks for shape in ("", BRAID + more))
    assert np.array_equal(plain.points, masked.points)


def test_locks_outside_of_the_sections_grow_only_where_they_are_counted():
    masked = "strands = 3\nmask = { where = 'x > 0' }"
    assert (groom(masked).locks.curve[STRAND] >= 0).all()
    assert (groom(masked, locks="points = 60\ncount = 200").locks.curve[STRAND] < 0).sum() > 50


def hairline(settings, locks="count = 3000\npoints = 8"):
    guides = "[guides]\ncount = 30\nlength = 6\nlift = 1\ndroop = 0\n"
    recipe = f"ringlet = 1\n[scalp]\nregion = 'scalp'\n{guides}[locks]\n{locks}\n{settings}\n[clean]\nmargin = 0\n"
    return make_groom(parse_recipe(recipe), ball()).locks


def test_a_hairline_thins_and_shortens_locks_towards_the_border_and_nothing_else():
    hard = hairline("")
    soft = hairline("[locks.hairline]\nwidth = 2\ndensity = 0.2\nlength = 0.5\nflat = 0")
    same = hard.take(np.isin(hard.ids, soft.ids))
    assert np.array_equal(same.ids, soft.ids)  # locks that grow are those that grew before
    height = soft.roots[:, 1]  # above the border, which is the equator
    far, near, between = height > 0.0205, height < 0.002, (height > 0.008) & (height < 0.012)
    before, after = (locks.points.reshape(len(locks), -1)[far] for locks in (same, soft))
    np.testing.assert_allclose(before, after, atol=1e-12)
    assert near.sum() / np.sum(hard.roots[:, 1] < 0.002) == pytest.approx(0.2, abs=0.1)
    ratio = soft.lengths() / same.lengths()
    assert ratio[near].mean() == pytest.approx(0.5, abs=0.02) and ratio[between].mean() == pytest.approx(0.75, abs=0.05)
    assert (ratio <= 1.0 + 1e-6).all()


def test_a_flat_hairline_lies_along_the_skin():
    leans = []
    for flat in (0, 1):
        locks = hairline(f"[locks.hairline]\nwidth = 2\ndensity = 1\nlength = 1\nflat = {flat}")
        points = locks.points.reshape(len(locks), -1, 3)
        near = points[:, 0, 1] < 0.002
        edge = points[near, 1] - points[near, 0]
        normal = points[near, 0] / np.linalg.norm(points[near, 0], axis=1, keepdims=True)
        leans.append(np.einsum("nx,nx->n", edge, normal) / np.linalg.norm(edge, axis=1))
    assert leans[0].min() > 0.9 and np.median(leans[1]) < 0.3


def test_strands_of_sections_keep_their_length_at_a_hairline():
    plain = groom("strands = 3").locks
    soft = groom("strands = 3", locks="points = 120\nhairline = { width = 3 }").locks
    assert np.array_equal(plain.points, soft.points)


def test_a_hairline_without_locks_to_thin_is_refused():
    with pytest.raises(UserError, match="locks has a hairline, but every guide becomes a lock; give it 'count'"):
        hairline("[locks.hairline]", locks="points = 8")


def test_masks_and_values_go_by_places_in_sections():
    expected = {
        "section >= 0 and strand == 1": lambda at: (at[STRAND] == 1) & (at[SECTION] >= 0),
        "u > 0.5 or v > 0.5": lambda at: (at["u"] > 0.5) | (at["v"] > 0.5),
        "edge > 5": lambda at: at[EDGE] > 0.005,  # in the unit of the recipe
    }
    for where, held in expected.items():
        nail = f"[[nail]]\nmask = {{ where = '{where}' }}"
        locks = groom("size = 30\nstrands = 3", "", "points = 20\nspacing = 8", nail, "unit = 'mm'", length=160).locks
        nailed = locks.point["nail"].reshape(len(locks), -1)[:, 0] > 0.5
        assert nailed.any() and not nailed.all()
        assert np.array_equal(nailed, held(locks.curve)), where
    long = groom("strands = 3", "[[shape]]\nop = 'length'\nfactor = { value = 1.5, map = 'u' }").locks
    np.testing.assert_allclose(long.lengths(), 0.16 * np.maximum(1.5 * long.curve["u"], 0.01), rtol=0.02)


def test_a_mask_by_sections_is_refused_where_there_are_none():
    recipe = "ringlet = 1\n[guides]\ncount = 9\n[[nail]]\nmask = { where = 'strand == 1' }"
    with pytest.raises(UserError, match=r"nail\[0\].mask.where has 'strand', which only locks of sections have; add"):
        make_groom(parse_recipe(recipe), sheet())


def hairs_of(made, **settings):
    made.hairs = {"frizz": 0.0, "stray": 0.0, "shorter": 0.0, "gather": 0.1, **settings}
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
        text(f"pattern = 'drawn'\npartings = 'p'\n{sections}", locks=locks, region="region = 'scalp'")
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
    with pytest.raises(UserError, match="needs both pattern = 'drawn' and 'partings'"):
        parse_recipe(text("pattern = 'drawn'"))


LOC = "[[shape]]\nop = 'loc'\nradius = 0.4\ntaper = 0\ntip = 0\nfuzz = 0\nmatting = { value = 0, ramp = [[0, 1]] }\n"
FULL = {"per_lock": 60, "radius": {"value": 0.1, "ramp": [(0.0, 1.0)]}, "frizz": 0.0, "stray": 0.0, "shorter": 0.0}


ROOT = 2  # points of hairs at their roots


def hairs_of_locs(shape, **hairs):
    """Offsets of hairs across their loc beyond its root, shape (hairs, points, 3) [m], and the groom."""
    made = groom("strands = 1", shape, "points = 40")
    made.hairs = {**FULL, "gather": 0.02, **hairs}
    curves = make_hairs(made).curves
    points = curves.points.reshape(len(curves), -1, 3)
    lock = curves.curve["lock"]
    lines = made.locks.points.reshape(len(made.locks), -1, 3)
    tangent = np.gradient(lines, axis=1)
    tangent /= np.linalg.norm(tangent, axis=2, keepdims=True)
    offset = points - lines[lock]
    offset -= np.sum(offset * tangent[lock], axis=2, keepdims=True) * tangent[lock]
    # The first hair of a lock is the lock, and from the roots all over its section hairs come to it.
    return offset[np.r_[True, lock[1:] == lock[:-1]], ROOT:], made


def reach(offset):
    """Distance of the outermost hair along the loc [m]."""
    return np.linalg.norm(offset, axis=2).max(axis=0)


def test_hairs_fill_the_radius_of_a_loc_with_its_taper_bud_and_tip():
    even = reach(hairs_of_locs(LOC)[0])
    np.testing.assert_allclose(even, 0.004, rtol=0.02)
    tapered = reach(hairs_of_locs(LOC.replace("taper = 0", "taper = 0.5"))[0])
    np.testing.assert_allclose(tapered, even * (1.0 - 0.5 * np.linspace(0, 1, 40)[ROOT:]), rtol=0.02)
    offset, made = hairs_of_locs(LOC + "bud = 0.5\nbud_at = 0.5\nbud_length = 3\n")
    budded = reach(offset)
    assert budded[16:20].max() == pytest.approx(0.006, rel=0.03) and budded[[3, 33]].max() < 0.0041
    assert lock_thickness(made) == pytest.approx(0.012, rel=0.03)
    closed = reach(hairs_of_locs(LOC.replace("tip = 0", "tip = 4"))[0])
    assert closed[-1] < 1e-4 and (np.diff(closed[-9:]) < 0).all() and closed[18] > 0.0039


def test_matted_hairs_wander_through_the_loc_and_stay_in_it():
    for matting, alike in ((0, 1.0), (1, 0.0)):
        offset = hairs_of_locs(LOC.replace("value = 0", f"value = {matting}"))[0]
        assert reach(offset).max() < 0.00402
        a, b = offset[:, 10], offset[:, 23]  # 5 cm apart on straight locs
        assert np.sum(a * b) / np.sqrt(np.sum(a * a) * np.sum(b * b)) == pytest.approx(alike, abs=0.08)


def test_fuzz_stands_off_the_surface_of_a_loc_no_farther_than_its_length():
    offset = hairs_of_locs(LOC.replace("fuzz = 0", "fuzz = 0.2"))[0]
    away = np.linalg.norm(offset, axis=2)
    assert 0.0055 < away.max() < 0.00602
    assert 0.01 < np.mean(away > 0.0041) < 0.2


def test_a_loc_acts_on_the_locks_of_its_mask_alone(tmp_path):
    made = groom("strands = 1", LOC + "mask = { where = 'x > 0' }", "points = 40")
    radius = made.locks.curve[STRAND_RADIUS]
    np.testing.assert_allclose(radius, np.where(made.locks.roots[:, 0] > 0.0, 0.004, 0.0), atol=1e-8)
    assert np.array_equal(made.locks.points, groom("strands = 1", "", "points = 40").locks.points)
    write_groom(made, tmp_path / "locs.usdc")
    read = read_groom(tmp_path / "locs.usdc").locks.curve
    for name in (STRAND_RADIUS, PROFILE, MATTING, FUZZ):
        assert np.array_equal(read[name], made.locks.curve[name])


KNOT = "[[shape]]\nop = 'knot'\nwidth = 3\nheight = 2.4\n"


def knots(strands, more="", points=300):
    """Centre lines of knots (sections, points, 3), their locks, and heights of the lines over the ball [m]."""
    locks = groom(f"strands = {strands}\nsize = 5", KNOT + more, f"points = {points}").locks
    lines = np.array([one.mean(axis=0) for one in strands_of(locks)])
    return lines, locks, np.linalg.norm(lines, axis=2) - 0.09


def axis_distance(line):
    """Distance of a knot's points from its axis, which goes through the middle of the ball [m]."""
    axis = line[0] / np.linalg.norm(line[0])
    return np.linalg.norm(line - np.outer(line @ axis, axis), axis=1)


@pytest.mark.parametrize("windings", [2, 3.5])
def test_windings_of_a_knot_touch_and_do_not_overlap(windings):
    lines, locks, _ = knots(1, f"windings = {windings}")
    thickness = 2.0 * locks.curve[STRAND_RADIUS]
    for line, thick in zip(lines, thickness, strict=True):
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
        distance = np.linalg.norm(line[:, None] - line[None], axis=2)
        others = np.abs(along[:, None] - along[None]) > 0.5 * np.pi * thick  # beyond half a circle of that thickness
        nearest = np.where(others, distance, np.inf).min(axis=1)
        assert 0.93 * thick < nearest.min() and np.median(nearest[150:]) < 1.1 * thick


def test_a_knot_sits_on_the_scalp_with_its_width_and_height_and_its_end_tucked_under():
    lines, locks, heights = knots(1)
    assert np.array_equal(lines[:, 0], groom("strands = 1\nsize = 5", "", "points = 300").locks.roots)
    for line, height, radius in zip(lines, heights, locks.curve[STRAND_RADIUS], strict=True):
        away = axis_distance(line)
        assert height.max() + radius == pytest.approx(0.024, rel=0.05)
        assert 2.0 * (away.max() + radius) == pytest.approx(0.03, rel=0.07)
        assert height[60:].min() == pytest.approx(radius, rel=0.3) and height[60:].argmin() > 200  # the last winding
        assert away[-1] < away.max() - 0.5 * radius and height[-1] < 1.3 * radius  # the tip is under those above
    loose = knots(1, "tuck = 0")[0]
    assert min(map(axis_distance, loose), key=lambda away: away[-1])[-1] > max(axis_distance(one)[-1] for one in lines)
    assert (locks.curve[PROFILE][:, -1] < 1e-6).all()  # the end closes


def test_two_strands_of_a_knot_are_twisted_and_touch():
    locks = knots(2, points=400)[1]
    radius = float(locks.curve[STRAND_RADIUS][0])
    for one in strands_of(locks):
        apart = np.linalg.norm(one[0, 60:-30, None] - one[1, None], axis=2).min(axis=1)  # thinner at the end
        np.testing.assert_allclose(apart, 2.0 * radius, rtol=0.08)
        across = (one[0] - one[1])[60:]
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        turned = np.arccos(np.clip(np.sum(across[1:] * across[:-1], axis=1), -1.0, 1.0)).sum() / (2.0 * np.pi)
        length = np.linalg.norm(np.diff(one.mean(axis=0), axis=0), axis=1)[60:].sum()
        assert turned > 0.3 * length / (4.0 * 2.0 * radius)  # a turn every two thicknesses, seen along a bent axis


def test_a_knot_of_few_points_is_refused():
    with pytest.raises(UserError, match=r"locks.points is 20: too few for the 3.0 turns of knot and its strands"):
        knots(1, points=20)


@pytest.mark.parametrize("more", ["mask = 0", "blend = 0"])
def test_a_knot_that_acts_nowhere_changes_nothing(more):
    plain = groom("strands = 1", "").locks
    assert np.array_equal(plain.points, groom("strands = 1", KNOT + more).locks.points)
