"""Guides grown on the scalp."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, FiniteFloat, model_validator

from ringlet.curves import Curves, offsets_from_counts
from ringlet.groom.operators.operator import UP, Context, Operator, unit
from ringlet.groom.settings import Quantity, Section, Varied, refuse

Vector = tuple[FiniteFloat, FiniteFloat, FiniteFloat]


class Zone(Section):
    """A part of the head where hair is longer, shorter or stands differently; it fades out towards its edge."""

    toward: Vector = Field(description="direction from the middle of the scalp, Y up: [0, 0.5, 1] is the forehead")
    spread: Annotated[float, Quantity("deg", 1.0, 180.0)] = Field(
        default=40.0, description="half the opening angle of the zone"
    )
    length: Annotated[float, Quantity("", 0.0, 10.0)] = Field(default=1.0, description="factor on the length")
    lift: Annotated[float, Quantity("", 0.0, 10.0)] = Field(default=1.0, description="factor on the lift")
    droop: Annotated[float, Quantity("", 0.0, 10.0)] = Field(default=1.0, description="factor on the droop")

    def weight(self, outward: NDArray) -> NDArray[np.float64]:
        """1 in the middle of the zone, 0 outside, for unit directions (n, 3)."""
        angle = np.degrees(np.arccos(np.clip(outward @ unit(np.array(self.toward)), -1.0, 1.0)))
        t = np.clip(1.0 - angle / self.spread, 0.0, 1.0)
        return t * t * (3.0 - 2.0 * t)


class Part(Section):
    """A parting: hair on each side of a plane flows away from it."""

    across: Vector = Field(default=(1.0, 0.0, 0.0), description="direction from one side of the parting to the other")
    offset: Annotated[float, Quantity("m", -1.0, 1.0)] = Field(
        default=0.0, description="how far the parting is from the middle of the scalp, along 'across'"
    )
    reach: Annotated[float, Quantity("m", 1e-3, 1.0)] = Field(
        default=0.04, description="distance at which hair has half forgotten the parting"
    )

    def turn(self, flow: NDArray, from_middle: NDArray) -> NDArray[np.float64]:
        """The flow (n, 3), turned away from the parting; ``from_middle``: places from the middle of the scalp [m]."""
        across = unit(np.array(self.across))
        side = from_middle @ across - self.offset
        weight = 0.5 ** (np.abs(side) / self.reach)
        return (1.0 - weight)[:, None] * flow + (weight * np.sign(side))[:, None] * across


class Grown(Operator):
    """Grows guides on the scalp.

    A guide leaves its root along ``lift · normal + (1 - lift) · flow`` and bends down on its way:
    ``direction(u) = that + droop · u · down``, with u from 0 (root) to 1 (tip). The flow runs along the surface, away
    from the whorl.
    """

    count: int | None = Field(default=None, ge=1, le=1_000_000, description="number of guides (this or spacing)")
    spacing: Annotated[float | None, Quantity("m", 1e-4, 1.0)] = Field(default=None, description="distance of guides")
    points: int = Field(default=10, ge=3, le=1000, description="points of a guide")
    length: Annotated[Varied, Quantity("m", 1e-4, 10.0)] = Field(
        default=Varied(value=0.08), description="length of a guide"
    )
    lift: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.8), description="1 stands up, 0 lies flat"
    )
    droop: Annotated[Varied, Quantity("", 0.0, 10.0)] = Field(
        default=Varied(value=0.4), description="how much the tip hangs down"
    )
    whorl: Vector | None = Field(
        default=(0.0, 1.0, -0.6),
        description="direction of the crown from the middle of the scalp; the flow runs away from it",
    )
    whorl_turn: Annotated[float, Quantity("deg", -180.0, 180.0)] = Field(
        default=25.0, description="how much the flow spirals about the whorl"
    )
    flow: Vector = Field(default=(0.0, -1.0, 0.0), description="direction of the flow where there is no whorl")
    part: Part | None = Field(default=None, description="a parting; none when absent")
    zone: list[Zone] = Field(default=[], description="parts of the head with their own length and stand")

    @model_validator(mode="after")
    def _one_density(self) -> Grown:
        if self.count is not None and self.spacing is not None:
            raise refuse("has both 'count' and 'spacing'; give one of them")
        return self

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Guides with ids that belong to their places; what comes in is not used."""
        scalp = context.scalp
        count = self.count or scalp.count_for_spacing(self.spacing or 0.025)
        ids, triangle, barycentric = scalp.sample(count, context.seed)
        bound = {"root_triangle": triangle, "root_barycentric": barycentric}
        roots = scalp.positions(triangle, barycentric)
        seeds = Curves(roots, offsets_from_counts(np.ones(len(ids))), ids, bound)

        normal = scalp.frames(seeds)[:, :, 2]
        outward = unit(roots - scalp.middle)
        length, lift, droop = (context.values(k, getattr(self, k), seeds) for k in ("length", "lift", "droop"))
        for zone in self.zone:
            weight = zone.weight(outward)
            length *= 1.0 + weight * (zone.length - 1.0)
            lift *= 1.0 + weight * (zone.lift - 1.0)
            droop *= 1.0 + weight * (zone.droop - 1.0)
        lift = np.clip(lift, 0.0, 1.0)[:, None]

        start = unit(lift * normal + (1.0 - lift) * self._flow(normal, roots - scalp.middle))
        u = (np.arange(self.points - 1) + 0.5) / (self.points - 1)
        direction = unit(start[:, None, :] - (droop[:, None] * u)[:, :, None] * UP)
        steps = direction * (length / (self.points - 1))[:, None, None]
        points = np.concatenate([roots[:, None], roots[:, None] + np.cumsum(steps, axis=1)], axis=1)
        offsets = offsets_from_counts(np.full(len(ids), self.points))
        return Curves(np.ascontiguousarray(points.reshape(-1, 3)), offsets, ids, bound)

    def _flow(self, normal: NDArray, from_middle: NDArray) -> NDArray[np.float64]:
        """Unit directions along the surface, shape (n, 3)."""
        if self.whorl is None:
            wanted = np.broadcast_to(np.array(self.flow), normal.shape)
        else:
            away = unit(unit(from_middle) - unit(np.array(self.whorl)))
            turn = np.radians(self.whorl_turn)
            wanted = np.cos(turn) * away + np.sin(turn) * np.cross(normal, away)
        if self.part is not None:
            wanted = self.part.turn(wanted, from_middle)
        return unit(wanted - np.sum(wanted * normal, axis=1, keepdims=True) * normal)
