"""Coherent noise: neighbouring locks move together."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Ramped
from ringlet.groom.operators.operator import Context
from ringlet.groom.operators.shape import Displacement


class Noise(Displacement):
    """Displaces points by a smooth noise field in space, the same for all locks at a place:
    ``p' = p + magnitude · ramp(u) · (field(p) - field(root))``."""

    op: Literal["noise"] = "noise"
    magnitude: Annotated[Ramped, Quantity("m", 0.0, 1.0)] = Field(
        default=Ramped(value=0.005, ramp=[(0, 0), (1, 1)]),
        description="amplitude of the field; larger moves locks further",
    )
    wavelength: Annotated[float, Quantity("m", 1e-3, 10.0)] = Field(
        default=0.05, description="distance in space over which the field changes; neighbours within it move together"
    )

    def displaced(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the displaced shapes; roots stay."""
        places = points.reshape(-1, 3)
        field = np.stack([context.random(axis).field(places, self.wavelength) for axis in "xyz"], axis=1)
        field = field.reshape(points.shape)
        ramp = self.magnitude.along(np.linspace(0.0, 1.0, points.shape[1]))
        magnitude = context.values(self, "magnitude", curves)[:, None] * ramp
        return points + magnitude[:, :, None] * (field - field[:, :1])
