"""Locks stood up, or laid down, at their roots."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Ramped
from ringlet.groom.operators.operator import Context, along_edges, between_edges, turned, unit
from ringlet.groom.operators.shape import Shape


class Lift(Shape):
    """Turns a lock about its root towards the normal of the scalp by an angle, and keeps its shape: with a ramp that
    falls to 0, only its base is lifted. It never goes beyond the normal; a negative angle lays it down."""

    op: Literal["lift"] = "lift"
    angle: Annotated[Ramped, Quantity("deg", -180.0, 180.0)] = Field(
        default=Ramped(value=20.0), description="how far it is turned"
    )

    turns: ClassVar[bool] = True

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """The same shapes, turned up; lengths stay."""
        edges = np.diff(points, axis=1)
        normal = context.scalp.frames(curves)[:, :, 2]
        lean = unit(points[:, points.shape[1] // 3] - points[:, 0])
        below = np.arccos(np.clip(np.sum(lean * normal, axis=1), -1.0, 1.0))
        angle = np.minimum(np.radians(context.values("angle", self.angle, curves)), below)
        axis = unit(np.cross(lean, normal))
        ramp = self.angle.along(between_edges(edges))
        return along_edges(points[:, 0], turned(edges, axis[:, None, :], angle[:, None] * ramp))
