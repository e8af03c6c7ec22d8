"""Smoothing of locks."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.quantities import Quantity, Varied
from ringlet.groom.operators.operator import Context, arc_lengths
from ringlet.groom.operators.shape import Shape


class Smooth(Shape):
    """Removes waves shorter than ``wavelength`` from a lock: minimises ``|p' - p|² + λ |Δ²p'|²`` with a fixed root,
    where λ halves waves of that length. Straight locks stay unchanged."""

    op: Literal["smooth"] = "smooth"
    wavelength: Annotated[Varied, Quantity("m", 0.0, 10.0)] = Field(
        default=Varied(value=0.02), description="length of waves that are halved; shorter ones are removed"
    )

    def shape(self, points: NDArray, curves: Curves, context: Context) -> NDArray[np.floating]:
        """Returns the smoothed shapes; roots stay."""
        count = points.shape[1]
        spacing = np.maximum(arc_lengths(points)[:, -1], 1e-9) / (count - 1)
        weight = (np.maximum(context.values(self, "wavelength", curves), 0.0) / (2.0 * np.pi * spacing)) ** 4
        second = np.diff(np.eye(count), n=2, axis=0)[:, 1:]  # Δ² of all points but the root, which is the origin
        stiffness, modes = np.linalg.eigh(second.T @ second)
        filtered = 1.0 / (1.0 + weight[:, None] * np.maximum(stiffness, 0.0))
        from_root = points[:, 1:] - points[:, :1]
        smoothed = np.einsum("ij,kj,lj,klx->kix", modes, filtered, modes, from_root, optimize=True)
        return np.concatenate([points[:, :1], points[:, :1] + smoothed], axis=1)
