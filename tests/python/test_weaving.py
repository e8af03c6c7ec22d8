"""Braids and twists: their closed form, thickness, words and hairs."""

from itertools import pairwise

import numpy as np
import pytest
from ringlet.data.groom import STRAND_RADIUS
from ringlet.groom.operators import Context
from ringlet.groom.scalp import Scalp
from scipy.spatial import KDTree
from shapes import sheet
from styles import BRAID, groom, strands_of, text, words

from ringlet import Curves, UserError, _core
from ringlet.groom import HairMemory, lock_thickness, make_hairs, parse_recipe, weave


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
        "lock_radius": {"value": 0.1, "ramp": [(0.0, 1.0)]},
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
    ("shape", "least"),
    [(BRAID, 107), ("[[shape]]\nop = 'knot'\nwindings = 6", 14 * 6), ("[[shape]]\nop = 'cornrow'\nwidth = 0.5", 150)],
)
def test_strands_get_the_points_that_their_weave_needs_where_none_are_given(shape, least):
    locks = groom("strands = 3\npattern = 'rows'" if "cornrow" in shape else "strands = 3", shape, "").locks
    assert least <= locks.counts.min() == locks.counts.max() < 10 * least


@pytest.mark.parametrize(
    ("sections", "shape", "locks", "message"),
    [
        ("gap = 0.2", BRAID, "count = 100\npoints = 120", "no section has strands; set locks.sections.strands"),
        ("strands = 1", BRAID, "points = 120", "weaves 1 strand; give locks.sections.strands at least 2"),
        (
            "strands = 3",
            BRAID + "pattern = 'fishtail'",
            "points = 120",
            "weaves 3 strands; a fishtail has 5, 7, 9 or 11",
        ),
        (
            "strands = 3",
            BRAID,
            "points = 60",
            "is 60: too few for the 5.3 turns of braid; leave it out, or set it to 107",
        ),
        ("gap = 4", "", "count = 100\npoints = 8", "leaves no hair: its gap is as wide as its size, or its mask"),
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
