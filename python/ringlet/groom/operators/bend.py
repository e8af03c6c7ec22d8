"""Even bending of locks, as over a roller."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Ramped
from ringlet.groom.operators.operator import Context, along_edges, between_edges, turned, unit
from ringlet.groom.operators.shape import Shape
from ringlet.groom.part_line import Direction


class Bend(Shape):
    """Bends a lock towards a direction: the rotation grows from edge to edge up to the whole angle at the tip. The ramp
    distributes the bend along the lock."""

    op: Literal["bend"] = "bend"
    angle: Annotated[Ramped, Quantity("deg", -1000.0, 1000.0, product=False)] = Field(
        default=Ramped(value=45.0), description="rotation of the tip"
    )
    toward: Direction = Field(default=(0.0, -1.0, 0.0), description="direction of the bend, Y up")
    of: Literal["world", "scalp"] = Field(
        default="world",
        description="axes of `toward`: those of the world, or the tangent, bitangent and normal of the root",
    )

    turns: ClassVar[bool] = True

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the bent shapes; edge lengths stay."""
        edges = np.diff(points, axis=1)
        toward = np.broadcast_to(unit(np.array(self.toward)), (len(points), 3))
        if self.of == "scalp":
            toward = np.einsum("kij,kj->ki", context.scalp.frames(curves), toward)
        axis = unit(np.cross(points[:, -1] - points[:, 0], toward))
        density = self.angle.along(between_edges(edges))
        cumulative = np.cumsum(density) / max(density.sum(), 1e-12)
        angle = np.radians(context.values(self, "angle", curves))[:, None] * cumulative
        return along_edges(points[:, 0], turned(edges, axis[:, None, :], angle))
