"""Frizz: noise of short wavelength across each lock."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.quantities import Quantity, Ramped
from ringlet.groom.operators.operator import Context, arc_lengths, unit
from ringlet.groom.operators.shape import Displacement
from ringlet.groom.operators.wander import wander


class Frizz(Displacement):
    """Noise of short wavelength across the lock: ``p' = p + magnitude · ramp(u) · (noise - (noise · t) t)``, with t the
    tangent of the lock and independent noise per lock."""

    op: Literal["frizz"] = "frizz"
    magnitude: Annotated[Ramped, Quantity("m", 0.0, 0.1)] = Field(
        default=Ramped(value=0.001, ramp=[(0, 0), (0.2, 1), (1, 1)]),
        description="standard deviation of the displacement; larger is fuzzier",
    )
    wavelength: Annotated[float, Quantity("m", 5e-4, 1.0)] = Field(
        default=0.008, description="length of the waves along the lock; shorter is rougher"
    )

    def displaced(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the shapes with frizz; roots stay.

        Raises UserError when ``wavelength`` is shorter than the spacing of the points.
        """
        along, count = arc_lengths(points), points.shape[1]
        if (longest := float(along[:, -1].max())) / (count - 1) > self.wavelength:
            raise UserError(
                f"{context.purpose}.wavelength is {self.wavelength:.4g} m, less than the {longest / (count - 1):.4g} m "
                "between the points of a shape; set locks.shape_points to "
                f"{int(np.ceil(2.0 * longest / self.wavelength)) + 1}"
            )
        noise = wander(context.random("wander"), curves.ids, along, self.wavelength)
        tangent = unit(np.gradient(points, axis=1))
        across = noise - np.sum(noise * tangent, axis=2, keepdims=True) * tangent
        ramp = self.magnitude.along(np.linspace(0.0, 1.0, count))
        magnitude = context.values(self, "magnitude", curves)[:, None] * ramp
        return points + magnitude[:, :, None] * across
