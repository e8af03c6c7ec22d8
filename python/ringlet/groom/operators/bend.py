"""Locks bent evenly, as over a roller."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Ramped
from ringlet.groom.operators.operator import Context, along_edges, between_edges, turned, unit
from ringlet.groom.operators.shape import Shape
from ringlet.groom.parting import Vector


class Bend(Shape):
    """Turns each piece of a lock a little further than the one before: the tip by the whole angle, towards a direction.
    The ramp says where along the lock it bends."""

    op: Literal["bend"] = "bend"
    angle: Annotated[Ramped, Quantity("deg", -1000.0, 1000.0)] = Field(
        default=Ramped(value=45.0), description="how far the tip is turned"
    )
    toward: Vector = Field(default=(0.0, -1.0, 0.0), description="direction that it bends to, Y up")
    of: Literal["world", "scalp"] = Field(
        default="world", description="scalp: `toward` counts in tangent, bitangent and normal of the root"
    )

    turns: ClassVar[bool] = True

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """The same shapes, bent; lengths stay."""
        edges = np.diff(points, axis=1)
        toward = np.broadcast_to(unit(np.array(self.toward)), (len(points), 3))
        if self.of == "scalp":
            toward = np.einsum("kij,kj->ki", context.scalp.frames(curves), toward)
        axis = unit(np.cross(points[:, -1] - points[:, 0], toward))
        share = self.angle.along(between_edges(edges))
        turn = np.cumsum(share) / max(share.sum(), 1e-12)
        angle = np.radians(context.values("angle", self.angle, curves))[:, None] * turn
        return along_edges(points[:, 0], turned(edges, axis[:, None, :], angle))
