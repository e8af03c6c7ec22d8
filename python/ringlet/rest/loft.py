"""The loft: a rest shape of a groom, and how the groom hangs with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.groom import Groom

Progress = Callable[[str, int, int], None]
Array = NDArray[np.float64]


@dataclass
class Loft:
    """A lofted rest shape and what it does; positions in the rest pose of the scalp [m].

    groom:  the groom that hangs so
    rest:   the rest shape of its locks
    sagged: how they hang with the groom as their rest shape, shape (n, 3); None: unknown, see ``with_sag``
    lofted: how they hang with ``rest``, shape (n, 3)
    off:    largest distance of a vertex of each lock from where it should hang, shape (count,)
    moving: how far each still moved in its last step, of 1 s, shape (count,)
    stiffened: times that each is stiffer against bend than the shot says, shape (count,); None: none is
    support: forces on the locks besides those at their roots [N], shape (n, 3); None: there are none
    """

    groom: Groom
    rest: Curves
    sagged: Array | None
    lofted: Array
    off: Array
    moving: Array
    stiffened: Array | None = None
    support: Array | None = None

    def __repr__(self) -> str:
        return f"Loft({len(self.rest):,} locks, up to {1e3 * self.off.max(initial=0.0):.2g} mm off)"

    def lost(self) -> dict[str, dict[str, float]]:
        """The deviation from the groom, with the loft and, if known, without [m]: ``with max`` … of each measure.

        away:   how far the vertices hang from where they were groomed
        drop:   how much deeper the tips of the locks hang
        height: how much less high the locks reach over their lowest point
        """
        locks = self.groom.locks
        begin, tips = locks.offsets[:-1], locks.offsets[1:] - 1

        def height(points: NDArray[np.floating]) -> Array:
            return np.maximum.reduceat(points[:, 1], begin) - np.minimum.reduceat(points[:, 1], begin)

        def measured(points: Array) -> dict[str, Array]:
            return {
                "away": np.linalg.norm(points - locks.points, axis=1),
                "drop": locks.points[tips, 1] - points[tips, 1],
                "height": height(locks.points) - height(points),
            }

        lost: dict[str, dict[str, float]] = {}
        for when, points in (("without", self.sagged), ("with", self.lofted)):
            if points is None:
                continue
            for name, values in measured(points).items():
                size = np.abs(values)
                summary = {"mean": size.mean(), "95": np.percentile(size, 95), "max": size.max()}
                lost.setdefault(name, {}).update({f"{when} {k}": float(v) for k, v in summary.items()})
        return lost


def largest_per_lock(locks: Curves, values: Array) -> Array:
    """The largest of the vertices' values for each lock, shape (count,)."""
    return np.maximum.reduceat(values, locks.offsets[:-1])
