"""Cornrows: braids on the scalp along rows, which take in the hair of their section."""

from itertools import pairwise

import numpy as np
import pytest
from ringlet.data.groom import SECTION, STRAND_RADIUS
from ringlet.groom.scalp import Scalp
from ringlet.groom.sections import EDGE, STRAND
from ringlet.groom.shares import LAID
from shapes import ball

from ringlet import Curves, UserError, read_groom, write_groom
from ringlet.groom import make_groom, make_hairs, parse_recipe, weave

POINTS, HEIGHT = 260, 0.005
BALL = ball(rings=40)
SURFACE = Scalp(BALL, "scalp")
RECIPE = """
ringlet = 2
seed = {seed}
[scalp]
region = 'scalp'
{curves}
[guides]
count = 30
[locks]
points = 260
[locks.sections]
pattern = 'rows'
size = 3
gap = 0.4
strands = 3
{sections}
[[shape]]
op = 'cornrow'
width = 0.9
pitch = 2.4
height = 0.5
length = 5
{cornrow}
[hairs]
per_lock = 200
root_falloff = 0.06
frizz = 0
stray = 0
shorter = 0
"""


def no_helper(name, setting):
    raise AssertionError(f"{setting} asks for {name}")


def groom(cornrow="", sections="", curves="", seed=1, helpers=None):
    text = RECIPE.format(cornrow=cornrow, sections=sections, curves=curves, seed=seed)
    return make_groom(parse_recipe(text), BALL, helpers=helpers)


def on_scalp(locks, before=0.012, after=0.012):
    """Points of strands on the scalp without both ends of the row, a mask of shape (locks, POINTS)."""
    along = np.linspace(0.0, 1.0, POINTS) * locks.lengths()[:, None]
    return (along > before) & (along < locks.curve[LAID][:, None] - after)


def heights(points):
    flat = np.ascontiguousarray(points.reshape(-1, 3), np.float64)
    return SURFACE.solid.above(flat)[0].reshape(points.shape[:-1])


@pytest.fixture(scope="module")
def made():
    return groom()


def test_every_row_has_its_strands_on_the_scalp_within_their_height(made):
    locks = made.locks
    rows, count = np.unique(locks.curve[SECTION], return_counts=True)
    assert len(rows) >= 6 and (count == 3).all() and not made.conflicts
    above = heights(locks.points.reshape(-1, POINTS, 3))[on_scalp(locks)]
    radius = locks.curve[STRAND_RADIUS][0]
    assert above.min() > 0.9 * radius and above.max() < HEIGHT - 0.85 * radius  # the mesh has flat faces
    assert np.abs(heights(locks.roots)).max() < 1e-6 and locks.roots[:, 2].min() > 0.0  # in front


def test_a_cornrow_is_braided_and_its_strands_touch_without_overlap(made):
    locks = made.locks
    grid, radius = locks.points.reshape(-1, POINTS, 3), locks.curve[STRAND_RADIUS][0]
    for row in np.unique(locks.curve[SECTION]):
        own = locks.curve[SECTION] == row
        strands, on = grid[own], on_scalp(locks)[own].all(axis=0)
        middle = strands.mean(axis=0)
        tangent = np.gradient(middle, axis=0)
        front = middle / np.linalg.norm(middle, axis=1, keepdims=True)
        across = np.cross(front, tangent)
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        offset = strands - middle
        places = np.stack([np.einsum("spx,px->sp", offset, axis)[:, on] for axis in (across, front)], axis=-1)
        word = weave.braid_word(places)
        assert len(word) >= 6 and set(word) == {(0, 1), (1, -1)}  # underhand: σ₁⁻¹ σ₂ …
        assert all(a != b for a, b in pairwise(word))
        gap = min(
            np.linalg.norm(strands[a][on, None] - strands[b][None, on], axis=2).min()
            for a, b in ((0, 1), (0, 2), (1, 2))
        )
        assert 1.8 * radius < gap < 2.3 * radius


def test_hair_of_a_row_lies_flat_towards_its_braid_and_leaves_the_parting_free(made):
    hairs = make_hairs(made).curves
    free = hairs.ids % 10_000 > 0
    lock, points = hairs.curve["lock"][free], hairs.points.reshape(-1, POINTS, 3)[free]
    recipe = parse_recipe(RECIPE.format(cornrow="", sections="", curves="", seed=1))
    at = recipe.locks.sections.divide(SURFACE, recipe.seed, no_helper).at(points[:, 0])
    assert np.mean(at[SECTION] == made.locks.curve[SECTION][lock]) > 0.99
    assert np.mean(at[EDGE] > 0.0018) > 0.97
    assert np.abs(heights(points[:, 0])).max() < 1e-5
    above = heights(points[:, :14])
    assert np.mean((above < -1e-4).any(axis=1)) < 0.003 and above.min() > -7e-4 and above.max() < HEIGHT + 5e-4
    grid = made.locks.points.reshape(-1, POINTS, 3)
    ahead = np.linalg.norm(grid[lock] - points[:, -1:], axis=2)
    assert ahead[:, -1].max() < 0.004  # all end in the tail of their strand
    middle = np.array([grid[made.locks.curve[SECTION] == row].mean(axis=0) for row in made.locks.curve[SECTION]])[lock]
    away = [np.linalg.norm(middle - points[:, k, None], axis=2).min(axis=1) for k in (0, 4, 8, 14)]
    assert np.median(away[0]) > 0.005
    assert all(np.mean(b < a + 2e-3) > 0.98 for a, b in pairwise(away))  # nearer and nearer
    along = np.linalg.norm(middle - points[:, :1], axis=2).argmin(axis=1) * made.locks.lengths()[lock] / (POINTS - 1)
    tenths = np.histogram(along / made.locks.curve[LAID][lock], bins=10, range=(0.0, 1.0))[0] / len(lock)
    assert tenths.min() > 0.09 and tenths.max() < 0.11  # as dense at the front as elsewhere
    roots = np.sort(np.linalg.norm(points[lock == 12, 0] - made.locks.roots[12], axis=1))
    assert roots[-1] > 0.1 and np.diff(roots).max() < 0.02  # all along the row


def test_a_cornrow_is_pinned_along_its_row_and_its_tail_is_free(made):
    pin = made.locks.point["pin"].reshape(-1, POINTS)
    assert (pin[on_scalp(made.locks, before=-1.0)] == 1.0).all() and (pin[:, -25:] == 0.0).all()
    assert np.all(np.diff(pin, axis=1) <= 0.0)


def test_a_row_that_a_mask_takes_away_changes_no_other(made):
    some = groom(sections="mask = { where = 'x > 0.5' }").locks
    same = made.locks.take(np.isin(made.locks.ids, some.ids))
    assert 3 < len(some) < len(made.locks) and np.array_equal(same.points, some.points)


def test_a_cornrow_follows_a_drawn_path():
    t = np.linspace(-1.0, 1.0, 12)
    line = 0.09 * np.stack([0.12 + 0.06 * np.sin(2 * t), np.cos(t), -np.sin(t)], axis=1)
    drawn = groom("path = 'swing'", helpers={"swing": Curves.from_list([line])}).locks
    laid = drawn.curve[LAID] > 0.0
    assert laid.sum() == 3
    fine = line[:-1, None] + np.linspace(0, 1, 30)[None, :, None] * np.diff(line, axis=0)[:, None]
    points = drawn.points.reshape(len(drawn), POINTS, 3)[laid]
    away = np.linalg.norm(points[:, :, None] - fine.reshape(-1, 3), axis=3).min(axis=2)
    assert away[on_scalp(drawn)[laid]].max() < 0.009
    with pytest.raises(UserError, match=r"cornrow\.path: curve 1 runs in section"):
        groom("path = 'swing'", helpers={"swing": Curves.from_list([line, line + 0.001])})


def test_names_of_several_helper_curves_are_their_curves_together():
    t = np.linspace(-1.0, 1.0, 12)
    lines = [0.09 * np.stack([np.full(12, x), np.cos(t), -np.sin(t)], axis=1) for x in (0.12, -0.5)]
    helpers = {name: Curves.from_list([line]) for name, line in zip("ab", lines, strict=True)}
    together = groom("path = 'both'", helpers={"both": Curves.from_list(lines)}).locks
    assert (together.curve[LAID] > 0.0).sum() == 6
    assert np.array_equal(groom("path = ['a', 'b']", helpers=helpers).locks.points, together.points)
    assert np.array_equal(
        groom("path = ['a']", helpers=helpers).locks.points, groom("path = 'a'", helpers=helpers).locks.points
    )
    for wrong, message in (("['a', 'c']", "'c', which is no helper curve"), ("[]", "path"), ("['a', 3]", "path")):
        with pytest.raises(UserError, match=message):
            groom(f"path = {wrong}", helpers=helpers)
    with pytest.raises(UserError, match="as another one does; draw a part line between them"):
        groom("path = ['a', 'a']", helpers=helpers)


@pytest.mark.parametrize("more", ["mask = 0", "blend = 0"])
def test_a_cornrow_that_acts_nowhere_changes_nothing(more):
    masked = groom(more).locks
    assert LAID not in masked.curve and (masked.curve[STRAND] >= 0).all()


def test_cornrows_are_the_same_from_a_file(made, tmp_path):
    write_groom(made, tmp_path / "groom.usdc")
    again = read_groom(tmp_path / "groom.usdc")
    np.testing.assert_allclose(make_hairs(again).curves.points, make_hairs(made).curves.points, atol=2e-6)
