"""The stiffness at which locks show a word."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

ROUNDS = 20
FOUND, MET = 0.004, 0.1  # excess at which a stiffness is found, and at which it counts as such at the end
SOFTER, STIFFER = np.log([0.5, 4.0])  # changes of the logarithm of the stiffness in a round
USUAL = 0.7  # growth of the excess with the logarithm of the stiffness: weight is a part of what a lock shows
LEAST, MOST = 0.3, 1.5  # bounds on it between two rounds, for the next
SLOWER, TRIES = 0.15, 2  # least growth with which a softer lock comes nearer, and rounds without it that end a search


def find_stiffness(excess: Callable[[Mask, Array], Array], begin: Array) -> tuple[Array, Mask]:
    """The logarithm of the stiffness of each lock at which its excess is 0, by the secant method within brackets.

    excess: of some locks, given as a mask, at their logarithms of the stiffness; see ``HangingLocks.excess``
    begin:  logarithms at which the search begins, shape (count,)

    Returns the logarithms of least excess, and a mask of the locks whose excess is small enough. A lock that is too
    stiff, and no less so when it is softened, has no such stiffness: its weight alone moves it so, or it hangs so far
    out that it is straight. Where what it shows jumps from one of two motions to another, it has the nearer one.
    """
    at, nearest, pending = begin.copy(), begin.copy(), np.ones(len(begin), bool)
    low, high, least = np.full_like(at, -np.inf), np.full_like(at, np.inf), np.full_like(at, np.inf)
    last_at, last, vain = np.full_like(at, np.nan), np.full_like(at, np.nan), np.zeros(len(at), int)
    for _ in range(ROUNDS):
        off = np.full_like(at, np.nan)
        off[pending] = excess(pending, at[pending])
        soft = ~(off > 0.0)  # where it does not stay in place, too
        with np.errstate(invalid="ignore", divide="ignore"):
            nearest = np.where(np.abs(off) < least, at, nearest)
            least = np.fmin(np.abs(off), least)
            slope = (off - last) / (at - last_at)
        vain = np.where(~soft & (at < last_at) & ~(slope > SLOWER), vain + 1, 0)
        pending &= (least > FOUND) & (vain < TRIES)
        if not pending.any():
            break
        low, high = np.where(pending & soft, at, low), np.where(pending & ~soft, at, high)
        slope = np.where(np.isfinite(slope), slope.clip(LEAST, MOST), USUAL)
        step = np.nan_to_num(-off / slope, nan=STIFFER).clip(SOFTER, STIFFER)
        last_at, last = np.where(pending, at, last_at), np.where(pending, off, last)
        at = np.where(pending, at + step, at)
        outside = pending & ~((at > low) & (at < high))
        at[outside] = 0.5 * (low[outside] + high[outside])
    return nearest, least <= MET
