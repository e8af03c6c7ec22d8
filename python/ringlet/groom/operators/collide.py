"""Collision of locks with the head and with what is worn, at rest."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet import _core
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.quantities import Quantity
from ringlet.groom.operators.operator import Context, Operator, packed
from ringlet.groom.shares import LAID


class Collide(Operator):
    """Moves points below the skin, or closer to it than ``margin``, out along the surface normal, and likewise out of
    all other visible surfaces in the head's file, such as a shirt. The margin grows from 0 at the root. A lock that
    heads straight into a surface is laid along it. Locks keep their lengths. Cornrows lie on the skin as they are;
    their tails are moved."""

    margin: Annotated[float, Quantity("m", 0.0, 0.1)] = Field(
        default=0.002, description="smallest distance of locks from skin and clothes"
    )

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the curves outside the mesh."""
        if LAID not in curves.curve:
            return curves.with_points(_core.push_out(*packed(curves), context.scalp.bodies, self.margin))
        off = _off_scalp(curves)
        counts = np.add.reduceat(off, curves.offsets[:-1], dtype=np.int64)
        points = np.array(curves.points, np.float64)
        points[off] = _core.push_out(
            np.ascontiguousarray(points[off]), offsets_from_counts(counts), context.scalp.bodies, self.margin
        )
        return curves.with_points(points)


def _off_scalp(curves: Curves) -> NDArray[np.bool_]:
    """The points of curves beyond what lies on the scalp, and at least the last two of each; shape (n,)."""
    run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curves.points, axis=0), axis=1))])
    along = run - np.repeat(run[curves.offsets[:-1]], curves.counts)
    to_tip = np.repeat(curves.offsets[1:], curves.counts) - np.arange(len(along))
    beyond: NDArray[np.bool_] = along >= np.repeat(curves.curve[LAID], curves.counts)
    return beyond | (to_tip <= 2)
