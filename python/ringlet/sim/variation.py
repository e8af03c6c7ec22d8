"""Values that vary, at the vertices of locks: from root to tip, over the head, and from lock to lock."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.painted import per_lock
from ringlet.data.random import Random
from ringlet.shot.variation import VARIATIONS, Mapped, Variation


def material_factors(variation: Variation, groom: Groom) -> dict[str, NDArray[np.float64]]:
    """The factors on the material that differ from 1, at the vertices of the locks, by name; shape (n,) each."""
    factors: dict[str, NDArray[np.float64]] = {}
    for name in VARIATIONS:
        if (varied := getattr(variation, name)) == Mapped():
            continue
        factor = at_vertices(varied, groom, f"variation.{name}", variation.seed)
        if name in ("radius", "stretch") and not factor.min() > 0.0:
            raise UserError(f"shot: variation.{name} is 0 somewhere; it must be above 0, raise its ramp or map")
        if (factor != 1.0).any():
            factors[name] = factor
    return factors


def at_vertices(varied: Mapped, groom: Groom, setting: str, seed: int = 1) -> NDArray[np.float64]:
    """A value at each vertex of the locks, shape (n,); ``setting`` is its name in the shot, for messages."""
    locks = groom.locks
    of_point = varied.map if varied.map in locks.point else None
    plain = varied.model_copy(update={"map": None}) if of_point else varied
    value = per_lock(plain, Random(seed, setting), locks, groom.scalp, f"shot: {setting}")
    values = np.repeat(value, locks.counts) * varied.along(_places(locks))
    return values if of_point is None else values * _at_points(of_point, locks, setting)


def _places(locks: Curves) -> NDArray[np.float64]:
    """Arc length of each vertex relative to its lock's, from 0 at the root to 1 at the tip, shape (n,)."""
    steps = np.linalg.norm(np.diff(locks.points, axis=0, prepend=locks.points[:1]), axis=1)
    steps[locks.offsets[:-1]] = 0.0
    run = np.cumsum(steps)
    return (run - np.repeat(run[locks.offsets[:-1]], locks.counts)) / np.repeat(locks.lengths(), locks.counts)


def _at_points(name: str, locks: Curves, setting: str) -> NDArray[np.float64]:
    """Values painted on the points of the locks, shape (n,)."""
    values = np.asarray(locks.point[name], np.float64)
    if values.ndim != 1:
        raise UserError(
            f"shot: {setting}.map '{name}' has {values.shape[1]} numbers a point; must be one, paint another"
        )
    if (bad := np.flatnonzero(~(np.isfinite(values) & (values >= 0.0)))).size:
        lock = locks.ids[np.searchsorted(locks.offsets, bad[0], side="right") - 1]
        raise UserError(
            f"shot: {setting}.map '{name}' is {values[bad[0]]:g} on lock {lock}; must be at least 0 and finite, "
            "paint it again"
        )
    return values
