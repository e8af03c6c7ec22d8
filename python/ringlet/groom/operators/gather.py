"""Gathering of hair at a tie: a pony tail, a bunch."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity
from ringlet.groom.operators.operator import Context, arc_lengths, at_lengths, unit
from ringlet.groom.operators.shape import Shape

HEAD_POINTS = 24  # points of the path over the head


class Gather(Shape):
    """Leads each lock along a path over the head to a tie and on along the tail; the lock keeps its length. The helper
    curve ``tie`` starts at the tie and is the centre line of the tail.

    Over the head the path is a spherical interpolation from root to tie about the centre of the scalp. Its distance
    from that centre is interpolated too, and raised by ``rise`` midway. In the tail each lock has its own offset.
    """

    op: Literal["gather"] = "gather"
    tie: str = Field(min_length=1, description="name of the helper curve that begins at the tie, from `[curves]`")
    radius: Annotated[float, Quantity("m", 0.0, 1.0)] = Field(default=0.01, description="of the hair in the tie")
    spread: Annotated[float, Quantity("", 0.0, 20.0)] = Field(
        default=2.0, description="radius at the end of the tail, as a multiple of that in the tie"
    )
    rise: Annotated[float, Quantity("m", -0.5, 0.5)] = Field(
        default=0.005, description="how much higher than the head the way is half-way to the tie"
    )

    turns: ClassVar[bool] = True

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the locks on their paths to the tie; lengths stay."""
        tail = np.asarray(context.helper(self.tie, "tie")[0], np.float64)
        disk = self._disk(curves, context)
        beside = unit(np.cross(tail[-1] - tail[0], unit(context.scalp.middle - tail[0]) + 1e-3))
        above = unit(np.cross(beside, tail[-1] - tail[0]))
        offset = disk @ np.stack([beside, above])
        width = np.linspace(1.0, self.spread, len(tail))
        in_tail = tail[None] + width[None, :, None] * offset[:, None, :]
        over_head = self._over_head(points[:, 0], in_tail[:, 0], context.scalp.middle)
        return at_lengths(np.concatenate([over_head, in_tail[:, 1:]], axis=1), arc_lengths(points))

    def _disk(self, curves: Curves, context: Context) -> NDArray[np.float64]:
        """Random position of each lock in the cross-section of the tie [m], shape (count, 2)."""
        random = context.random("place")
        angle = 2.0 * np.pi * random.uniform(curves.ids, 0)
        radius = self.radius * np.sqrt(random.uniform(curves.ids, 1))
        return radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)

    def _over_head(self, roots: NDArray, ties: NDArray, middle: NDArray) -> NDArray[np.float64]:
        """Paths around the centre from roots to ties (count, 3); shape (count, HEAD_POINTS, 3)."""
        t = np.linspace(0.0, 1.0, HEAD_POINTS)
        from_middle, to_middle = roots - middle, ties - middle
        a, b = unit(from_middle), unit(to_middle)
        angle = np.arccos(np.clip(np.sum(a * b, axis=1), -1.0, 1.0))[:, None, None]
        near = np.sin(angle) < 1e-6
        sine = np.where(near, 1.0, np.sin(angle))
        u = t[None, :, None]
        first = np.where(near, 1.0 - u, np.sin((1.0 - u) * angle) / sine)
        last = np.where(near, u, np.sin(u * angle) / sine)
        direction = unit(first * a[:, None] + last * b[:, None])
        start, end = (np.linalg.norm(v, axis=1)[:, None] for v in (from_middle, to_middle))
        distance = (1.0 - t) * start + t * end + self.rise * np.sin(np.pi * t)
        return middle + distance[:, :, None] * direction
