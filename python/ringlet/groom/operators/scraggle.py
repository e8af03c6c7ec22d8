"""Scraggle: noise of long wavelength, independent per lock."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Ramped
from ringlet.groom.operators.operator import Context, arc_lengths
from ringlet.groom.operators.shape import Displacement
from ringlet.groom.operators.wander import wander


class Scraggle(Displacement):
    """Noise of long wavelength that grows towards the tip: ``p' = p + magnitude · ramp(u) · noise(s / wavelength)``,
    with s the arc length from the root. The noise is a B-spline with normally distributed knots, one for each lock."""

    op: Literal["scraggle"] = "scraggle"
    magnitude: Annotated[Ramped, Quantity("m", 0.0, 1.0)] = Field(
        default=Ramped(value=0.005, ramp=[(0, 0), (1, 1)]),
        description="standard deviation of the displacement at the tip; larger is wilder",
    )
    wavelength: Annotated[float, Quantity("m", 1e-3, 10.0)] = Field(
        default=0.03, description="length along the lock over which the displacement changes"
    )

    def displaced(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the displaced shapes; roots stay."""
        ramp = self.magnitude.along(np.linspace(0.0, 1.0, points.shape[1]))
        magnitude = context.values(self, "magnitude", curves)[:, None] * ramp
        return points + magnitude[:, :, None] * wander(
            context.random("wander"), curves.ids, arc_lengths(points), self.wavelength
        )
