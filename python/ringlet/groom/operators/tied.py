"""Locks that are tied: what is before the tie, over the head, and what is after it, where curls begin."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.groom.operators.operator import arc_lengths, at_lengths, grid, packed

TO_TIE = "to_tie"  # curve attribute of locks: length from the root to the tie [m], 0 for others
HEAD_EDGES = 40  # of a lock before its tie


def _is_cut(curves: Curves) -> NDArray[np.bool_]:
    """Whether a lock has both a head before its tie and hair after it, shape (count,)."""
    tied, length = curves.curve.get(TO_TIE, np.zeros(len(curves))), curves.lengths()
    return (tied > 1e-4) & (tied < 0.99 * length)


def after_ties(curves: Curves) -> Curves:
    """The locks from their ties on; those without a tie, or that end in it, whole. Point counts stay."""
    if not (cut := _is_cut(curves)).any():
        return curves
    points = grid(curves).copy()
    along = arc_lengths(points[cut])
    tied = curves.curve[TO_TIE][cut][:, None]
    u = np.linspace(0.0, 1.0, points.shape[1])
    points[cut] = at_lengths(points[cut], tied + (along[:, -1:] - tied) * u)
    return curves.with_points(np.ascontiguousarray(points.reshape(-1, 3)))


def with_heads(curled: NDArray, curves: Curves, after: Curves) -> NDArray[np.float64]:
    """Points of curls (n, 3), with as many points a lock, joined to the heads of the locks before their ties.

    after: the locks from their ties on, which the curls are about
    """
    if not (cut := _is_cut(curves)).any():
        return curled
    count = len(curled) // len(curves)
    tied = curves.curve[TO_TIE][cut][:, None]
    head = at_lengths(grid(curves)[cut], tied * np.linspace(0.0, 1.0, HEAD_EDGES + 1))[:, :-1]
    joined = np.concatenate([head, curled.reshape(len(curves), count, 3)[cut]], axis=1)
    whole = Curves.from_list(list(joined))
    result = curled.reshape(len(curves), count, 3).copy()
    result[cut] = _core.resample_curves(*packed(whole), count).reshape(-1, count, 3)
    return result.reshape(-1, 3)
