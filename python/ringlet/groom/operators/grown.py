"""Guides grown on the scalp."""

from __future__ import annotations

from hashlib import blake2b
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, model_validator

from ringlet import _core
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.painted import painted_directions
from ringlet.data.quantities import Quantity, Section, Varied, refuse
from ringlet.groom.edge import EdgeScalp
from ringlet.groom.mask import Mask
from ringlet.groom.operators.guides import Guides
from ringlet.groom.operators.operator import UP, Context, packed, unit
from ringlet.groom.part_line import Direction, PartLine

DRAWN_IDS = 1 << 51  # of guides that are drawn, above those of guides that grow
DRAWN_TOLERANCE = 0.02  # of a drawn root from the scalp, onto which it is moved [m]


class Zone(Section):
    """A zone of the head with its own length, lift and gravity bend: a cone around a direction with a falloff, a mask,
    or the intersection of both."""

    toward: Direction | None = Field(
        default=None, description="direction from the middle of the scalp, Y up: [0, 0.5, 1] is the forehead"
    )
    angle: Annotated[float, Quantity("deg", 1.0, 180.0)] = Field(
        default=40.0, description="half the opening angle of the zone"
    )
    falloff: Annotated[float | None, Quantity("deg", 0.0, 180.0)] = Field(
        default=None,
        description="angle inside the border over which the zone fades; from its middle on when absent, 0 is sharp",
    )
    mask: Annotated[Mask | None, Quantity("", 0.0, 1.0)] = Field(default=None, description="where the zone is")
    length: Annotated[float, Quantity("", 0.0, 10.0)] = Field(default=1.0, description="factor on the length")
    lift: Annotated[float, Quantity("", 0.0, 10.0)] = Field(default=1.0, description="factor on the lift")
    gravity_bend: Annotated[float, Quantity("", 0.0, 10.0)] = Field(
        default=1.0, description="factor on the gravity bend"
    )

    @model_validator(mode="after")
    def _has_extent(self) -> Zone:
        if self.toward is None and self.mask is None:
            raise refuse("does not say where it is; give it 'toward' or a 'mask'")
        if self.falloff is not None and (self.toward is None or self.falloff > self.angle):
            raise refuse("has a falloff that its cone has no room for; give it 'toward', and an 'angle' as large")
        return self

    def weight(self, seeds: Curves, context: Context, what: str) -> NDArray[np.float64]:
        """Weights of the zone, 1 at its centre and 0 outside, shape (count,).

        seeds: curves of one point, the root
        """
        weight = np.ones(len(seeds))
        if self.toward is not None:
            outward = unit(seeds.points - context.scalp.middle)
            angle = np.degrees(np.arccos(np.clip(outward @ unit(np.array(self.toward)), -1.0, 1.0)))
            falloff = self.angle if self.falloff is None else self.falloff
            t = np.clip((self.angle - angle) / max(falloff, 1e-9), 0.0, 1.0)
            weight *= t * t * (3.0 - 2.0 * t)
        if self.mask is not None:
            weight *= self.mask.weights(seeds, context.scalp.mesh, context.random("zone"), f"{what}.mask")[:, 0]
        return weight


class Grown(Guides):
    """Grows guides on the scalp.

    A guide starts in the direction ``d₀ = lift · normal + (1 - lift) · flow`` and bends down towards its tip:
    ``d(u) = d₀ + gravity_bend · u · down``, with u from 0 (root) to 1 (tip). The flow is tangent to the surface and
    points away from the whorl.
    """

    count: int | None = Field(default=None, ge=1, le=1_000_000, description="number of guides; give this or `spacing`")
    spacing: Annotated[float | None, Quantity("m", 1e-4, 1.0)] = Field(
        default=None, description="distance between guides"
    )
    points: int = Field(default=10, ge=3, le=1000, description="points of a guide")
    length: Annotated[Varied, Quantity("m", 1e-4, 10.0)] = Field(
        default=Varied(value=0.08), description="length of a guide, curl excluded"
    )
    lift: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.8), description="direction at the root: 1 stands up, 0 lies flat along the flow"
    )
    gravity_bend: Annotated[Varied, Quantity("", 0.0, 30.0)] = Field(
        default=Varied(value=0.4), description="how strongly the tip bends down: 0 straight, larger hangs more steeply"
    )
    whorl: Annotated[Direction | None, BeforeValidator(lambda value: None if value is False else value)] = Field(
        default=(0.0, 1.0, -0.6),
        description="direction of the crown from the middle of the scalp; the flow runs away from it; false: no whorl",
    )
    whorl_turn: Annotated[float, Quantity("deg", -180.0, 180.0)] = Field(
        default=25.0, description="how far the flow spirals about the whorl"
    )
    flow: Direction = Field(default=(0.0, -1.0, 0.0), description="direction of the flow where there is no whorl")
    density: str | None = Field(
        default=None,
        description="painted values: where they are higher, guides stand closer; none grow where they are 0",
    )
    direction: str | None = Field(
        default=None,
        description="painted directions, a primvar of vectors or a picture of [maps] in colours, that replace the "
        "flow where they are not 0",
    )
    drawn: list[str] = Field(
        default=[],
        description="names of helper curves that are guides themselves, from root to tip, besides those that grow",
    )
    part_line: PartLine | None = Field(default=None, description="where hair parts; nowhere when absent")
    zone: list[Zone] = Field(default=[], description="zones of the head with their own length, lift and gravity bend")

    @model_validator(mode="after")
    def _one_density(self) -> Grown:
        if self.count is not None and self.spacing is not None:
            raise refuse("has both 'count' and 'spacing'; give one of them")
        return self

    def make(self, curves: Curves, context: Context) -> Curves:
        """Returns the grown guides, with ids fixed to their roots; ignores ``curves``."""
        scalp = context.scalp
        count = self.count or scalp.count_for_spacing(self.spacing or 0.025, "guides.spacing")
        ids, triangle, barycentric = scalp.sample(count, context.seed, self.density, "guides.density")
        bound = {"root_triangle": triangle, "root_barycentric": barycentric}
        roots = scalp.positions(triangle, barycentric)
        bound |= scalp.attributes(roots)
        seeds = Curves(roots, offsets_from_counts(np.ones(len(ids))), ids, bound)

        frames = scalp.frames(seeds)
        normal = frames[:, :, 2]
        length, lift, gravity_bend = (context.values(self, k, seeds) for k in ("length", "lift", "gravity_bend"))
        for k, zone in enumerate(self.zone):
            weight = zone.weight(seeds, context, f"guides.zone[{k}]")
            length *= 1.0 + weight * (zone.length - 1.0)
            lift *= 1.0 + weight * (zone.lift - 1.0)
            gravity_bend *= 1.0 + weight * (zone.gravity_bend - 1.0)
        length, lift, gravity_bend = (
            Quantity.of(self, name).clipped(values)
            for name, values in (("length", length), ("lift", lift), ("gravity_bend", gravity_bend))
        )
        lift = lift[:, None]

        flow = self._flow(seeds, frames, context)
        start = unit(lift * normal + (1.0 - lift) * flow)
        u = (np.arange(self.points - 1) + 0.5) / (self.points - 1)
        direction = _unit_or(flow[:, None, :], start[:, None, :] - (gravity_bend[:, None] * u)[:, :, None] * UP)
        steps = direction * (length / (self.points - 1))[:, None, None]
        points = np.concatenate([roots[:, None], roots[:, None] + np.cumsum(steps, axis=1)], axis=1)
        offsets = offsets_from_counts(np.full(len(ids), self.points))
        grown = Curves(np.ascontiguousarray(points.reshape(-1, 3)), offsets, ids, bound)
        return Curves.joined([grown, *(self._drawn(name, context) for name in self.drawn)])

    def _drawn(self, name: str, context: Context) -> Curves:
        """Guides from helper curves, whose roots are moved onto the scalp; their ids depend on the name alone.

        Raises UserError for an unknown name, and for roots off the scalp.
        """
        curves = context.helper(name, "drawn")
        first = DRAWN_IDS + (int.from_bytes(blake2b(name.encode(), digest_size=4).digest()) << 8)
        ids = first + np.arange(len(curves), dtype=np.int64)
        points = _core.resample_curves(*packed(curves), self.points)
        drawn = Curves(points, offsets_from_counts(np.full(len(ids), self.points)), ids)
        bound = context.scalp.bind(drawn, DRAWN_TOLERANCE, f"guides.drawn, '{name}'")
        roots = context.scalp.positions(bound.curve["root_triangle"], bound.curve["root_barycentric"])
        bound.points += np.repeat(roots - bound.roots, bound.counts, axis=0)
        return Curves(bound.points, bound.offsets, ids, {**bound.curve, **context.scalp.attributes(roots)})

    def _flow(self, seeds: Curves, frames: NDArray, context: Context) -> NDArray[np.float64]:
        """Unit tangents of the surface in the direction of growth, shape (n, 3); on an edge, those of its ``turn``.

        Where the flow is across the surface, as at the whorl, the tangent of the scalp's frame takes its place.
        """
        roots, normal, scalp = seeds.points, frames[:, :, 2], context.scalp
        from_middle = roots - scalp.middle
        if isinstance(scalp, EdgeScalp):
            flow = scalp.flow(np.asarray(roots, np.float64), normal, np.array(self.flow))
        elif self.whorl is None:
            flow = np.broadcast_to(np.array(self.flow), normal.shape)
        else:
            away = unit(unit(from_middle) - unit(np.array(self.whorl)))
            turn = np.radians(self.whorl_turn)
            flow = np.cos(turn) * away + np.sin(turn) * np.cross(normal, away)
        if self.direction is not None:
            painted = painted_directions(self.direction, seeds, scalp.mesh, "guides.direction")
            flow = np.where(painted.any(axis=1, keepdims=True), unit(painted), flow)
        if self.part_line is not None:
            away, falloff = self.part_line.away(roots, normal, scalp.middle, context.helper)
            flow = (1.0 - falloff)[:, None] * flow + falloff[:, None] * away
        return _unit_or(frames[:, :, 0], flow - np.sum(flow * normal, axis=1, keepdims=True) * normal)


def _unit_or(otherwise: NDArray, vectors: NDArray) -> NDArray[np.float64]:
    """Normalises vectors along the last axis; where they are almost zero, the ones of ``otherwise``."""
    return np.where(np.linalg.norm(vectors, axis=-1, keepdims=True) > 1e-9, unit(vectors), otherwise)
