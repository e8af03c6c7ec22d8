"""Flyaways: single locks that stand off from the rest."""

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
    """Rotates randomly chosen locks away from their direction: by an angle that follows the ramp, about a random axis
    across each lock."""

    op: Literal["flyaways"] = "flyaways"
    share: Annotated[float, Quantity("", 0.0, 1.0)] = Field(
        default=0.05, description="fraction of the locks that fly away"
    )
    angle: Annotated[Ramped, Quantity("deg", 0.0, 180.0)] = Field(
        default=Ramped(value=30.0, vary=0.5, ramp=[(0, 0), (0.3, 0.5), (1, 1)]), description="rotation of the tip"
    )

    turns: ClassVar[bool] = True

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the shapes with the flyaways rotated; edge lengths stay."""
        edges = np.diff(points, axis=1)
        is_flyaway = context.random("share").uniform(curves.ids) < self.share
        along = unit(points[:, -1] - points[:, 0])
        random_direction = unit(context.random("axis").normals(curves.ids, 3))
        axis = unit(np.cross(along, random_direction))
        angle = np.radians(context.values(self, "angle", curves)) * is_flyaway
        ramp = self.angle.along(between_edges(edges))
        rotated = along_edges(points[:, 0], turned(edges, axis[:, None, :], angle[:, None] * ramp))
        return np.where(is_flyaway[:, None, None], rotated, points)
