"""Laid edges: hair along the hairline lies on the skin in swoops."""

import numpy as np
import pytest
from ringlet.data.groom import STRAND_RADIUS
from ringlet.groom.operators import Context
from ringlet.groom.operators.edges import Edge
from ringlet.groom.pins import PIN
from ringlet.groom.scalp import Scalp
from ringlet.groom.shares import LAID
from shapes import ball

from ringlet.groom import make_groom, make_hairs, parse_recipe

CURL = "[curl]\npreset = '3C'\n"


def groom(settings="", more=CURL, count=900, edges=True, sections=""):
    shape = f"[[shape]]\nop = 'edges'\n{settings}\n" if edges else ""
    text = f"""
ringlet = 2
[scalp]
region = 'scalp'
[guides]
count = 30
length = 5
lift = 1
gravity_bend = 0
[locks]
count = {count}
points = 120
{sections}
{shape}
{more}
[hairs]
per_lock = 12
"""
    return make_groom(parse_recipe(text), ball())


def is_laid(made):
    return made.locks.curve[LAID] > 0.0


def grid(made):
    return made.locks.points.reshape(len(made.locks), -1, 3)


def above(points):
    flat = np.ascontiguousarray(points.reshape(-1, 3), np.float64)
    return np.asarray(Scalp(ball(), "scalp").solid.above(flat)[0]).reshape(points.shape[:-1])


def test_laid_locks_lie_on_the_skin_under_their_height_and_never_through_it():
    made = groom("within = '12 mm'\nwidth = '0.8 mm'\nheight = '1.5 mm'\nlength = 3\ntightness = 0")
    laid = is_laid(made)
    root_height = made.locks.roots[:, 1]  # above the border, which is the equator
    assert laid.sum() > 20 and root_height[laid].max() < 0.012
    assert laid[root_height < 0.002].mean() > 0.9
    radius = made.locks.curve[STRAND_RADIUS][laid][:, None]
    np.testing.assert_allclose(radius, 0.0004, rtol=1e-6)
    height = above(grid(made)[laid])
    assert height.min() > -1e-9 and (height + radius).max() < 0.0015 + 3e-5
    assert (height - radius)[:, 20:].min() > -3e-5  # past the first millimetres
    np.testing.assert_allclose(made.locks.lengths()[laid], 0.03, rtol=0.25)
    hairs = make_hairs(made).curves
    of_laid = hairs.points.reshape(len(hairs), -1, 3)[laid[hairs.curve["lock"]]]
    assert above(of_laid)[:, 40:].min() > -2e-4 and above(of_laid).max() < 0.0022


def test_neither_curl_nor_clean_moves_them_and_a_shot_pins_them():
    plain, curled = groom(more=""), groom()
    laid = is_laid(plain)
    np.testing.assert_allclose(grid(plain)[laid], grid(curled)[laid], atol=1e-6)
    assert np.abs(grid(plain)[~laid] - grid(curled)[~laid]).max() > 1e-3
    pins = curled.locks.point[PIN].reshape(len(laid), -1)
    assert (pins[laid] == 1.0).all() and not pins[~laid].any()


def test_locks_of_a_swoop_come_together_and_turn_away_from_the_middle():
    made = groom("tightness = 1\nsize = 3\nlength = 2.5\ndirection = 30\nswoop = 60", count=3000)
    loose = groom("tightness = 0\nsize = 3\nlength = 2.5\ndirection = 30\nswoop = 60", count=3000)
    laid = is_laid(made)
    tips, spread = grid(made)[laid][:, -1], grid(loose)[laid][:, -1]
    nearest = [np.sort(np.linalg.norm(p[:, None] - p[None], axis=2), axis=1)[:, 1] for p in (tips, spread)]
    assert np.median(nearest[0]) < 1e-3 < 1.5e-3 < np.median(nearest[1])
    root, tip = grid(loose)[laid][:, 0], grid(loose)[laid][:, -1]
    azimuth = np.arctan2(tip[:, 0], tip[:, 2]) - np.arctan2(root[:, 0], root[:, 2])
    sides = np.abs(root[:, 0]) > 0.02
    assert (azimuth[sides] * root[sides, 0] > 0.0).all()
    assert (tip[:, 1] < root[:, 1])[root[:, 1] < 0.004].all()  # out of the scalp


def test_swoops_change_sides_softly():
    surface = Scalp(ball(), "scalp")
    edge = Edge.of(surface)
    made = groom("alternate = 9\nsize = 1.5\ntightness = 0\ndirection = 30\nswoop = 60\nlength = 2.5", count=3000)
    roots, tips = grid(made)[is_laid(made)][:, 0], grid(made)[is_laid(made)][:, -1]
    _, side = edge.axes(roots, surface.nearest(roots)[1], surface)
    moved = np.sum((tips - roots) * side, axis=1)
    assert moved.min() < -0.01 and moved.max() > 0.01
    middles = edge.spaced(0.015, Context(1, surface, "edges"))
    assert (
        np.linalg.norm(middles.roots[:, None] - middles.roots[None], axis=2)[~np.eye(len(middles), dtype=bool)].min()
        > 0.015
    )
    near = np.linalg.norm(roots[:, None] - roots[None], axis=2) < 0.006
    assert np.abs(moved[:, None] - moved[None])[near].max() < 0.75 * np.ptp(moved)


def test_one_lock_more_moves_no_other():
    a, b = groom(count=900), groom(count=901)
    both = np.intersect1d(a.locks.ids, b.locks.ids)
    assert len(both) > 850
    rows = [np.searchsorted(made.locks.ids, both) for made in (a, b)]
    order = [np.argsort(made.locks.ids) for made in (a, b)]
    first, second = (grid(made)[o[r]] for made, o, r in zip((a, b), order, rows, strict=True))
    np.testing.assert_allclose(first, second, atol=1e-12)


def test_strands_of_sections_and_other_locks_stay():
    sections = "[locks.sections]\nsize = 3\nstrands = 3\nmask = { where = 'y > 4' }"
    plain, laid = groom(more="", edges=False, sections=sections), groom(more="", sections=sections)
    strands = plain.locks.curve["strand"] >= 0
    assert strands.sum() > 10 and not is_laid(laid)[strands].any() and is_laid(laid).sum() > 10
    np.testing.assert_allclose(grid(plain)[~is_laid(laid)], grid(laid)[~is_laid(laid)], atol=1e-5)


@pytest.mark.parametrize("share", [0.0, 0.4])
def test_a_share_of_the_locks_is_laid(share):
    every, some = (groom(f"within = 3\nshare = {value}", more="", count=3000) for value in (1, share))
    count = is_laid(some).sum() if LAID in some.locks.curve else 0
    assert count == pytest.approx(share * is_laid(every).sum(), abs=0.1 * is_laid(every).sum())
