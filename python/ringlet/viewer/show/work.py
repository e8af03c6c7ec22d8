"""Estimates the size of a groom before it is made, from the one that is displayed."""

from __future__ import annotations

from ringlet.groom import Recipe
from ringlet.viewer.show.display_groom import DisplayGroom

MOST_RATIO = 4.0  # a groom so many times larger than the displayed one is made only on request
SMALL = 4_000_000  # points that any computer grooms in seconds; fewer are made in any case


def too_large(recipe: Recipe, shown: Recipe, display: DisplayGroom) -> float:
    """How many times larger a groom is than the displayed one, where it takes much longer; else 0.

    shown: recipe of the displayed groom
    """
    if recipe.grooms or shown.grooms:  # of several grooms the estimate knows too little
        return 0.0
    before, now = (_points(one, shown, display) for one in (shown, recipe))
    return now / before if now > MOST_RATIO * before and now > SMALL else 0.0


def _points(recipe: Recipe, shown: Recipe, display: DisplayGroom) -> float:
    """Estimated number of points of locks and hairs."""
    locks = len(display.groom.locks) * _lock_ratio(recipe, shown)
    hairs = display.count * _lock_ratio(recipe, shown) * _hairs(recipe) / _hairs(shown)
    if recipe.hairs.density is not None and shown.hairs.density is not None:  # their number is that of the scalp
        hairs = display.count * recipe.hairs.density.value / shown.hairs.density.value
    points = recipe.locks.points or int(display.groom.locks.counts.max())
    return locks * points + hairs * (recipe.hairs.points or points)


def _lock_ratio(recipe: Recipe, shown: Recipe) -> float:
    """Number of locks relative to that of the displayed recipe; 1 where it is given in another way."""
    now, before = recipe.locks, shown.locks
    if now.count and before.count:
        return now.count / before.count
    if now.spacing and before.spacing:
        return (before.spacing / now.spacing) ** 2
    return 1.0


def _hairs(recipe: Recipe) -> float:
    return max(recipe.hairs.per_lock.value, 1e-6)
