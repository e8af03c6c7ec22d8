"""Locs: locks whose hairs are matted into a cylinder."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet.data.curves import Curves
from ringlet.data.groom import STRAND_RADIUS
from ringlet.data.quantities import Quantity, Ramped, Varied
from ringlet.groom.felt import FUZZ, KNOTS, MATTING, PROFILE
from ringlet.groom.operators.operator import Context
from ringlet.groom.operators.shape import Shape
from ringlet.groom.operators.woven import JOIN
from ringlet.groom.shares import REACH


class Loc(Shape):
    """Mats the hairs of each lock into a loc of the radius ``radius · ramp(u) (1 - taper u) (1 + bud B(u)) T(u)``. B is
    a bell of the width ``bud_length`` about ``bud_at``, and T rounds the tip over the length ``tip``. Matted hairs
    wander through the whole cross-section; ``fuzz`` is how far they stand off its surface. Centre lines stay."""

    op: Literal["loc"] = "loc"
    radius: Annotated[Ramped, Quantity("m", 1e-4, 0.05)] = Field(
        default=Ramped(value=0.003), description="radius of a loc; contact uses it without the ramp"
    )
    taper: Annotated[Varied, Quantity("", -1.0, 1.0)] = Field(
        default=Varied(value=0.15), description="how much thinner it is at the tip: 1 to nothing, -1 twice as thick"
    )
    matting: Annotated[Ramped, Quantity("", 0.0, 1.0)] = Field(
        default=Ramped(value=0.9, ramp=[(0, 0.2), (0.15, 1), (1, 1)]),
        description="0: hairs run side by side, 1: each wanders through the loc; a ramp leaves new growth loose",
    )
    fuzz: Annotated[Ramped, Quantity("m", 0.0, 0.05)] = Field(
        default=Ramped(value=0.0012), description="how far loose hairs stand off the surface"
    )
    bud: Annotated[Varied, Quantity("", 0.0, 2.0)] = Field(
        default=Varied(value=0.0), description="how much thicker a loc is at its bud: 0.5 is half as much again"
    )
    bud_at: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.93), description="where the bud is, from root (0) to tip (1)"
    )
    bud_length: Annotated[Varied, Quantity("m", 1e-4, 0.5)] = Field(
        default=Varied(value=0.015), description="length of the bud"
    )
    tip: Annotated[Varied, Quantity("m", 0.0, 0.5)] = Field(
        default=Varied(value=0.003),
        description="length over which the tip closes: as long as the radius a round tip, longer a pointed one",
    )

    start: Annotated[Varied, Quantity("m", 0.0, 0.5)] = Field(
        default=Varied(value=0.008), description="length at the root over which the hair of its section comes together"
    )

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the curves with the attributes ``strand_radius`` [m], ``strand_profile``, ``strand_matting`` and
        ``strand_fuzz`` [m], see ``ringlet.groom.felt``, and in sections ``join`` [m]."""
        points = len(curves.points) // len(curves)
        u, at_points = np.linspace(0.0, 1.0, KNOTS), np.linspace(0.0, 1.0, points)
        weight = np.array([np.interp(u, at_points, row) for row in self.weights(curves, context)])
        loc = (weight > 0.0).any(axis=1)
        if not loc.any():
            return curves
        radius = context.values(self, "radius", curves)
        matting = context.values(self, "matting", curves)[:, None] * self.matting.along(u)
        fuzz = context.values(self, "fuzz", curves)[:, None] * self.fuzz.along(u)
        new = {
            STRAND_RADIUS: radius,
            PROFILE: self._profile(u, curves, context),
            MATTING: np.minimum(matting, 1.0) * weight,
            FUZZ: fuzz * weight,
        }
        if REACH in curves.curve:
            new[JOIN] = context.values(self, "start", curves) * (curves.curve[REACH] > 0.0).any(axis=1)
        attributes = dict(curves.curve)
        for name, values in new.items():
            old = attributes.get(name, np.full(values.shape, 1.0 if name == PROFILE else 0.0))
            attributes[name] = np.where(loc.reshape(-1, *[1] * (values.ndim - 1)), values, old).astype(np.float32)
        return Curves(curves.points, curves.offsets, curves.ids, attributes, curves.point)

    def _profile(self, u: NDArray, curves: Curves, context: Context) -> NDArray[np.float64]:
        """Factor on the radius at places u from root to tip, shape (count, len(u))."""

        def values(name: str) -> NDArray[np.float64]:
            return context.values(self, name, curves)[:, None]

        length = np.maximum(curves.lengths(), 1e-9)[:, None]
        from_bud = (u - values("bud_at")) * length / (0.5 * values("bud_length"))
        to_tip = np.clip((1.0 - u) * length / np.maximum(values("tip"), 1e-9), 0.0, 1.0)
        closing = np.where(values("tip") > 0.0, np.sqrt(to_tip * (2.0 - to_tip)), 1.0)
        bud = 1.0 + values("bud") * np.exp(-from_bud * from_bud)
        return self.radius.along(u) * (1.0 - values("taper") * u) * bud * closing
