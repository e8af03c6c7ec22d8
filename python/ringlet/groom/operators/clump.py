"""Clumping of neighbouring locks."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Ramped
from ringlet.groom.groups import Apart, leaders
from ringlet.groom.operators.operator import Context
from ringlet.groom.operators.shape import Shape


class Clump(Shape):
    """Pulls neighbouring locks towards a clump centre: ``p' = p + tightness · ramp(u) · (centre(u) - p)``. The centres
    are the locks nearest to samples of the scalp at spacing ``size``; a lock goes to the nearest that leans less than
    ``apart`` from it. Further levels make smaller clumps within the larger ones: the spacing shrinks by ``finer`` a
    level, and the tightness is the same. A tightness that is a plain number varies from root to tip, not from lock to
    lock."""

    op: Literal["clump"] = "clump"
    size: Annotated[float, Quantity("m", 1e-3, 1.0)] = Field(
        default=0.02, description="distance between clump centres; larger gives fewer, thicker clumps"
    )
    tightness: Annotated[Ramped, Quantity("", 0.0, 1.0, product=False)] = Field(
        default=Ramped(value=0.4, vary=0.5, ramp=[(0, 0), (1, 1)]),
        description="how far locks move to the centre of their clump: 0 not, 1 onto it",
    )

    levels: int = Field(default=1, ge=1, le=8, description="number of levels of clumps within clumps")
    finer: Annotated[float, Quantity("", 0.1, 0.9)] = Field(
        default=0.5, description="distance between the clumps of a level, relative to the level before"
    )
    apart: Apart = 60.0

    @classmethod
    def defaults(cls, data: dict[str, Any]) -> dict[str, Any]:
        """Defaults of the class; a plain number for ``tightness`` applies to all locks, without variation."""
        defaults = super().defaults(data)
        if isinstance(data.get("tightness"), int | float):
            defaults["tightness"] = {name: value for name, value in defaults["tightness"].items() if name != "vary"}
        return defaults

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the clumped shapes, large clumps first; roots stay."""
        tightness = context.values(self, "tightness", curves)[:, None]
        ramp = self.tightness.along(np.linspace(0.0, 1.0, points.shape[1]))
        tightness = np.minimum(tightness * ramp, 1.0)[:, :, None]
        for level in range(self.levels):
            size = self.size * self.finer**level
            centre = leaders(points, size, self.apart, context.scalp, context.seed + 1, "clump.size")
            points = points + tightness * (points[centre] - points)
        return points
