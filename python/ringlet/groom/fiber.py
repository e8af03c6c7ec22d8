"""The fibre of hair: its roughness, the tilt of its cuticle, and its cross-section."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.mesh import Mesh
from ringlet.data.pigment import AZIMUTHAL_ROUGHNESS, FLATNESS, ROUGHNESS, TILT
from ringlet.data.quantities import Quantity, Section, Varied
from ringlet.data.random import Random
from ringlet.groom.values import Values

FEWEST_POINTS = 4.0  # points for each half turn of a section, below which its turns are not resolved


class FiberSettings(Section):
    """The fibre of hair, for each lock and each hair."""

    roughness: Annotated[Varied | None, Quantity("", 0.05, 1.0)] = Field(
        default=None,
        description="width of the highlight along the hair: larger is duller; that of the colour when absent",
    )
    azimuthal_roughness: Annotated[Varied | None, Quantity("", 0.05, 1.0)] = Field(
        default=None,
        description="roughness around the hair: larger spreads light further around it; that of the colour when absent",
    )
    tilt: Annotated[Varied, Quantity("deg", 0.0, 10.0)] = Field(
        default=Varied(value=2.0),
        description="tilt of the scales of the cuticle, which moves the highlight along the hair",
    )
    flatness: Annotated[Varied, Quantity("", 0.0, 0.9)] = Field(
        default=Varied(value=0.0),
        description="cross-section of the hair: 0 round, 0.5 an ellipse half as thick as wide",
    )
    twist_pitch: Annotated[Varied, Quantity("m", 1e-4, 1.0)] = Field(
        default=Varied(value=0.02), description="length over which an elliptical cross-section turns once"
    )
    vary_hairs: Annotated[float, Quantity("", 0.0, 1.0)] = Field(
        default=0.0, description="random change of all of these from hair to hair: 0.2 is ±20 %"
    )
    seed: int = Field(default=1, ge=0, le=2**31, description="another seed varies other locks and hairs")

    def optics(self, locks: Curves, scalp: Mesh, usual: dict[str, float]) -> dict[str, NDArray[np.float32]]:
        """Attributes of locks that renderers need, shape (locks,). ``usual``: roughnesses where none are given.

        Raises UserError for maps and regions that are not there.
        """
        found = {}
        for name in (ROUGHNESS, AZIMUTHAL_ROUGHNESS, TILT, FLATNESS):
            setting = getattr(self, name)
            if setting is None:
                found[name] = np.broadcast_to(np.float32(usual[name]), len(locks))
            elif name != FLATNESS or self.is_flat:
                found[name] = self.values(locks, scalp)(name).astype(np.float32)
        return found

    @property
    def is_flat(self) -> bool:
        """Whether a fiber may have an elliptical section."""
        return any((self.flatness.value, *self.flatness.region.values(), *self.flatness.lock.values()))

    def values(self, locks: Curves, scalp: Mesh) -> Values:
        """The settings evaluated per lock."""
        return Values(self, locks, scalp, self.seed, "fiber")

    def of_hairs(self, name: str, per_lock: NDArray, lock: NDArray, ids: NDArray) -> NDArray[np.float32]:
        """Values of a setting for hairs, from those of their locks, shape (hairs,)."""
        values = per_lock[lock]
        if self.vary_hairs:
            random = Random(self.seed, f"fiber/hairs/{name}")
            values = values * Varied(value=1.0, vary=self.vary_hairs).factors(random, ids, ids)
        return Quantity.of(self, name).clipped(values).astype(np.float32)

    def twist(
        self, ids: NDArray[np.int64], lengths: NDArray[np.floating], pitch: NDArray[np.floating], points: int
    ) -> NDArray[np.float32]:
        """Angle of the section's wide axis from its place at the root's frame [degrees], shape (hairs, points).

        lengths: of the hairs [m], shape (hairs,)
        pitch:   length of a turn [m], shape (hairs,)
        """
        start = 360.0 * Random(1, "fiber/twist").uniform(ids)
        turns = lengths / pitch
        return (start[:, None] + 360.0 * turns[:, None] * np.linspace(0.0, 1.0, points)).astype(np.float32)


def seen_widths(
    flatness: NDArray[np.floating], twist: NDArray[np.floating], lengths: NDArray, pitch: NDArray
) -> NDArray[np.float64]:
    """Widths at which twisted ellipses are seen from one direction, relative to their wide axis, as ``twist``.

    Renderers of round fibers show an ellipse by these. Turns too close for the points become their mean.

    flatness, lengths, pitch: of the hairs, shape (hairs,)
    """
    narrow, angle = 1.0 - flatness[:, None], np.radians(twist)
    seen = np.hypot(np.cos(angle), narrow * np.sin(angle))
    spacing = lengths / max(twist.shape[1] - 1, 1)
    points = 0.5 * pitch / np.maximum(spacing, 1e-9)
    resolved = np.clip(2.0 * points / FEWEST_POINTS - 1.0, 0.0, 1.0)[:, None]
    full = np.linspace(0.0, np.pi, 64, endpoint=False)
    mean = np.sqrt(np.cos(full) ** 2 + narrow**2 * np.sin(full) ** 2).mean(axis=1, keepdims=True)
    return resolved * seen + (1.0 - resolved) * mean
