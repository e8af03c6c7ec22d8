"""Single locks that stand off from the rest."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Ramped
from ringlet.groom.operators.operator import Context, along_edges, between_edges, turned, unit
from ringlet.groom.operators.shape import Shape


class Flyaways(Shape):
    """Turns some locks, chosen by chance, away from where they were going: by an angle that grows along the ramp, about
    an axis across the lock that is a lock's own."""

    op: Literal["flyaways"] = "flyaways"
    share: Annotated[float, Quantity("", 0.0, 1.0)] = Field(default=0.05, description="part of the locks that fly away")
    angle: Annotated[Ramped, Quantity("deg", 0.0, 180.0)] = Field(
        default=Ramped(value=30.0, vary=0.5, ramp=[(0, 0), (0.3, 0.5), (1, 1)]), description="how far they are turned"
    )

    turns: ClassVar[bool] = True

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """The same shapes, some of them elsewhere; lengths stay."""
        edges = np.diff(points, axis=1)
        flies = context.random("share").uniform(curves.ids) < self.share
        along = unit(points[:, -1] - points[:, 0])
        anywhere = unit(context.random("axis").normals(curves.ids, 3))
        axis = unit(np.cross(along, anywhere))
        angle = np.radians(context.values("angle", self.angle, curves)) * flies
        ramp = self.angle.along(between_edges(edges))
        away = along_edges(points[:, 0], turned(edges, axis[:, None, :], angle[:, None] * ramp))
        return np.where(flies[:, None, None], away, points)
