"""Lift of locks at their roots."""

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
    """Rotates a lock about its root towards the normal of the scalp, and keeps its shape. A ramp that falls to 0 lifts
    the base alone. The rotation ends at the normal; a negative angle lays the lock down."""

    op: Literal["lift"] = "lift"
    angle: Annotated[Ramped, Quantity("deg", -180.0, 180.0)] = Field(
        default=Ramped(value=20.0), description="rotation about the root, towards the normal of the scalp"
    )

    turns: ClassVar[bool] = True

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the lifted shapes; edge lengths stay."""
        edges = np.diff(points, axis=1)
        normal = context.scalp.frames(curves)[:, :, 2]
        lean = unit(points[:, points.shape[1] // 3] - points[:, 0])
        angle_to_normal = np.arccos(np.clip(np.sum(lean * normal, axis=1), -1.0, 1.0))
        angle = np.minimum(np.radians(context.values(self, "angle", curves)), angle_to_normal)
        axis = unit(np.cross(lean, normal))
        ramp = self.angle.along(between_edges(edges))
        return along_edges(points[:, 0], turned(edges, axis[:, None, :], angle[:, None] * ramp))
