"""Cuts along a plane, as a bob or a fringe has."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Varied
from ringlet.groom.operators.operator import Context, arc_lengths, at_lengths, unit
from ringlet.groom.operators.shape import Shape
from ringlet.groom.parting import Direction


class Cut(Shape):
    """Cuts locks where they first cross a plane; what is on this side of it stays as it is. Locks that end before the
    plane stay, and those that grow beyond it keep ``least``."""

    op: Literal["cut"] = "cut"
    toward: Direction = Field(default=(0.0, -1.0, 0.0), description="direction in which everything goes, Y up")
    at: Annotated[Varied, Quantity("m", -1.0, 1.0)] = Field(
        default=Varied(value=0.08), description="how far the plane is from the middle of the scalp, in that direction"
    )
    soft: Annotated[float, Quantity("m", 0.0, 0.1)] = Field(
        default=0.003, description="how far tips scatter about the plane to both sides"
    )
    least: Annotated[float, Quantity("m", 1e-4, 1.0)] = Field(default=0.01, description="length that every lock keeps")

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the cut shapes, with as many points; roots stay."""
        plane = context.values(self, "at", curves)
        plane = plane + self.soft * (2.0 * context.random("soft").uniform(curves.ids) - 1.0)
        beyond = (points - context.scalp.middle) @ unit(np.array(self.toward)) - plane[:, None]
        along = arc_lengths(points)
        length = np.clip(_first_crossing(beyond, along), self.least, None)
        share = np.minimum(length / np.maximum(along[:, -1], 1e-12), 1.0)
        return np.where((share < 1.0)[:, None, None], at_lengths(points, share[:, None] * along), points)


def _first_crossing(beyond: NDArray, along: NDArray) -> NDArray[np.float64]:
    """Arc length at which a distance beyond a plane, shape (count, points), first becomes positive; inf: never.

    along: arc lengths of the points [m], same shape
    """
    crossed = beyond > 0.0
    i = np.maximum(crossed.argmax(axis=1), 1)
    rows = np.arange(len(beyond))
    before, after = beyond[rows, i - 1], beyond[rows, i]
    t = np.clip(before / np.where(before == after, 1.0, before - after), 0.0, 1.0)
    length = along[rows, i - 1] + t * (along[rows, i] - along[rows, i - 1])
    length = np.where(crossed[:, 0], 0.0, length)
    return np.where(crossed.any(axis=1), length, np.inf)
