"""The fibre of hair: its roughness, the tilt of its cuticle, and the section."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.pigment import AZIMUTHAL_ROUGHNESS, FLATNESS, ROUGHNESS, TILT
from ringlet.data.quantities import Quantity, Section
from ringlet.data.random import Random

FEWEST_POINTS = 4.0  # points for each half turn of a section, below which its turns are not resolved


class FiberSettings(Section):
    """The fibre, the same for all hairs."""

    roughness: Annotated[float | None, Quantity("", 0.05, 1.0)] = Field(
        default=None,
        description="roughness along the hair: the width of the highlight; as the colour has it when absent",
    )
    azimuthal_roughness: Annotated[float | None, Quantity("", 0.05, 1.0)] = Field(
        default=None, description="roughness around the hair: how soft light wraps about it; as `roughness` when absent"
    )
    tilt: Annotated[float, Quantity("deg", 0.0, 10.0)] = Field(
        default=2.0, description="tilt of the cuticle's scales, which moves the highlight towards the root"
    )
    flatness: Annotated[float, Quantity("", 0.0, 0.9)] = Field(
        default=0.0, description="section of the fibre: 0 round, 0.5 an ellipse half as thick as it is wide"
    )
    twist_pitch: Annotated[float, Quantity("m", 1e-4, 1.0)] = Field(
        default=0.02, description="length over which an elliptical section turns once about the hair"
    )

    def optics(self, default: float) -> dict[str, float]:
        """What renderers need of the fibre, by attribute. ``default``: the roughness where none is given."""
        along = default if self.roughness is None else self.roughness
        around = along if self.azimuthal_roughness is None else self.azimuthal_roughness
        shape = {FLATNESS: self.flatness} if self.flatness else {}
        return {ROUGHNESS: along, AZIMUTHAL_ROUGHNESS: around, TILT: self.tilt, **shape}

    def twist(self, ids: NDArray[np.int64], lengths: NDArray[np.floating], points: int) -> NDArray[np.float32]:
        """Angle of the section's wide axis from its place at the root's frame [degrees], shape (hairs, points).

        lengths: of the hairs [m], shape (hairs,)
        """
        start = 360.0 * Random(1, "fiber/twist").uniform(ids)
        turns = lengths / self.twist_pitch
        return (start[:, None] + 360.0 * turns[:, None] * np.linspace(0.0, 1.0, points)).astype(np.float32)

    def seen_widths(self, twist: NDArray[np.floating], lengths: NDArray[np.floating]) -> NDArray[np.float64]:
        """Widths at which a twisted ellipse is seen from one direction, relative to its wide axis, as ``twist``.

        Renderers of round fibres show an ellipse by these. Turns too close for the points become their mean.
        """
        narrow = 1.0 - self.flatness
        angle = np.radians(twist)
        seen = np.hypot(np.cos(angle), narrow * np.sin(angle))
        spacing = lengths / max(twist.shape[1] - 1, 1)
        points = 0.5 * self.twist_pitch / np.maximum(spacing, 1e-9)
        resolved = np.clip(2.0 * points / FEWEST_POINTS - 1.0, 0.0, 1.0)[:, None]
        mean = np.hypot(np.cos(full := np.linspace(0.0, np.pi, 64, endpoint=False)), narrow * np.sin(full)).mean()
        return resolved * seen + (1.0 - resolved) * mean
