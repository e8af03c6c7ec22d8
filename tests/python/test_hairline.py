"""Hairlines thin, shorten and flatten locks towards the border of the scalp."""

import numpy as np
import pytest
from shapes import ball
from styles import groom

from ringlet import UserError
from ringlet.groom import make_groom, parse_recipe


def hairline(settings, locks="count = 3000\npoints = 8"):
    guides = "[guides]\ncount = 30\nlength = 6\nlift = 1\ngravity_bend = 0\n"
    recipe = f"ringlet = 2\n[scalp]\nregion = 'scalp'\n{guides}[locks]\n{locks}\n{settings}\n[collide]\nmargin = 0\n"
    return make_groom(parse_recipe(recipe), ball()).locks


def test_a_hairline_thins_and_shortens_locks_towards_the_border_and_nothing_else():
    hard = hairline("")
    soft = hairline("[locks.hairline]\nwidth = 2\ndensity = 0.2\nlength = 0.5\nlaid = 0")
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
        locks = hairline(f"[locks.hairline]\nwidth = 2\ndensity = 1\nlength = 1\nlaid = {flat}")
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
