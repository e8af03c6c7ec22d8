"""Cuts at a plane, a mesh or a drawn line, as a bob or a fringe has."""

from __future__ import annotations

from typing import Literal

from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.groom.operators.operator import Context, arc_lengths
from ringlet.groom.operators.target import ToTarget


class Cut(ToTarget):
    """Cuts locks where they first cross a plane, a mesh or a drawn line; what is on this side of it stays as it is.
    Locks that end before it stay, and those that begin beyond it keep ``least``."""

    op: Literal["cut"] = "cut"

    def path(self, points: NDArray, curves: Curves, context: Context) -> tuple[NDArray, NDArray]:
        """The locks as they are."""
        return points, arc_lengths(points)
