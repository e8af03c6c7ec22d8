"""Laid edges: the short hair along the hairline, laid on the skin in swoops."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from scipy.spatial import KDTree

from ringlet.data.curves import Curves
from ringlet.data.groom import STRAND_RADIUS
from ringlet.data.quantities import Quantity, Ramped, Varied
from ringlet.groom.hairline import border
from ringlet.groom.operators.operator import UP, Context, arc_lengths, grid, turned, unit, with_lock_points
from ringlet.groom.operators.shape import Shape
from ringlet.groom.scalp import Scalp
from ringlet.groom.sections import STRAND
from ringlet.groom.shares import LAID, LEAVE

SMOOTH = 0.012  # distance over which the direction across the border is averaged [m]
RISE = 0.004  # length over which a lock comes from its root to its height [m]
ALTERNATION = 2.5  # how steeply swoops change sides: higher leaves fewer nearly straight


class Edges(Shape):
    """Lays locks near the border of the scalp on the skin, in swoops. A lock leaves its root at the angle
    ``direction`` from the way out of the scalp, away from the middle of the face, and turns on by
    ``swoop · ramp(u) + wave sin(2πs / wavelength)``. Locks of a swoop come together towards its tip.

    Locks lie between the skin and ``height``, are not curled or moved off the skin, and are pinned in a shot. Put it
    after the operators that move locks.
    """

    op: Literal["edges"] = "edges"
    within: Annotated[Varied, Quantity("m", 1e-4, 0.2)] = Field(
        default=Varied(value=0.008), description="distance from the border up to which locks are laid"
    )
    share: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=1.0), description="fraction of the locks at the border that are laid; fewer further away"
    )
    length: Annotated[Varied, Quantity("m", 1e-3, 0.5)] = Field(
        default=Varied(value=0.025, vary=0.2), description="length of laid locks before they come together"
    )
    direction: Annotated[Varied, Quantity("deg", -360.0, 360.0)] = Field(
        default=Varied(value=30.0),
        description="angle at the root: 0 straight out of the scalp, 90 along the border, more turns back into it",
    )
    swoop: Annotated[Ramped, Quantity("deg", -1080.0, 1080.0)] = Field(
        default=Ramped(value=130.0, ramp=[(0, 0), (0.3, 0.15), (1, 1)]),
        description="angle by which a lock turns to its tip; its ramp says where",
    )
    wave: Annotated[Ramped, Quantity("deg", 0.0, 180.0)] = Field(
        default=Ramped(value=0.0), description="amplitude of waves, as an angle to both sides"
    )
    wavelength: Annotated[Varied, Quantity("m", 2e-3, 1.0)] = Field(
        default=Varied(value=0.015), description="length of a wave"
    )
    size: Annotated[float, Quantity("m", 1e-3, 0.5)] = Field(
        default=0.018, description="distance between swoops along the border"
    )
    tightness: Annotated[Ramped, Quantity("", 0.0, 1.0, product=False)] = Field(
        default=Ramped(value=0.85, ramp=[(0, 0), (0.5, 0.6), (1, 1)]),
        description="how far locks of a swoop come together: 0 not, 1 in one line",
    )
    alternate: Annotated[float, Quantity("m", 0.0, 1.0)] = Field(
        default=0.0,
        description="distance along the border over which swoops change sides; 0: all turn away from the middle",
    )
    width: Annotated[Varied, Quantity("m", 1e-4, 0.01)] = Field(
        default=Varied(value=0.0008), description="thickness of a laid lock"
    )
    height: Annotated[Varied, Quantity("m", 1e-4, 0.02)] = Field(
        default=Varied(value=0.0015), description="largest height of locks above the skin; at least their width"
    )

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the curves with locks near the border laid, all with ``lock_points`` points or more."""
        edge = Edge.of(context.scalp)
        fine = with_lock_points(curves, context)
        weight = self.weights(fine, context)
        if edge is None or not weight.any():
            return curves
        rows = np.flatnonzero(np.any(weight > 0.0, axis=1) & self._laid(curves, edge, context))
        if not len(rows):
            return curves
        radius, lift = self._heights(fine, context)
        laid = self._paths(fine.take(rows), edge, context)
        shapes = grid(fine).copy()
        shapes[rows] = _raised(laid, lift[rows], context.scalp)
        result = self.blended(fine, shapes, np.where(np.isin(np.arange(len(fine)), rows)[:, None], weight, 0.0))
        whole = rows[weight[rows].min(axis=1) > 0.5]
        attributes = {}
        to_tip = result.lengths() + LEAVE  # so that the tip is held too
        for name, values in ((LAID, to_tip), (STRAND_RADIUS, radius)):
            attributes[name] = np.array(curves.curve.get(name, np.zeros(len(curves))), np.float32)
            attributes[name][whole] = values[whole]
        return Curves(result.points, result.offsets, result.ids, {**result.curve, **attributes}, result.point)

    def _laid(self, curves: Curves, edge: Edge, context: Context) -> NDArray[np.bool_]:
        """The loose locks that are laid, shape (count,)."""
        t = np.clip(edge.distance(curves.roots) / context.values(self, "within", curves), 0.0, 1.0)
        share = context.values(self, "share", curves) * (1.0 - t * t * (3.0 - 2.0 * t))
        loose = curves.curve.get(STRAND, np.full(len(curves), -1)) < 0
        chosen: NDArray[np.bool_] = loose & (context.random("share").uniform(curves.ids) < share)
        return chosen

    def _heights(self, curves: Curves, context: Context) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Radius of locks and height of their centre lines above the skin [m], shape (count,) each."""
        radius = 0.5 * context.values(self, "width", curves)
        room = np.maximum(context.values(self, "height", curves) - 2.0 * radius, 0.0)
        return radius, radius + room * context.random("layer").uniform(curves.ids)

    def _paths(self, curves: Curves, edge: Edge, context: Context) -> NDArray[np.floating]:
        """Paths on the skin of laid locks, shape (count, points, 3)."""
        points = int(curves.counts[0])
        middles = edge.spaced(self.size, context)
        hand = np.ones(len(middles))
        if self.alternate > 0.0:
            field = context.random("alternate").field(middles.roots, self.alternate)
            hand = np.clip(ALTERNATION * field, -1.0, 1.0)
        of = np.asarray(KDTree(middles.roots).query(curves.roots)[1])
        own = self._path(curves, hand[of], points, edge, context)
        led = self._path(middles, hand, points, edge, context)[of]
        tightness = context.values(self, "tightness", curves)[:, None] * self.tightness.along(
            np.linspace(0.0, 1.0, points)
        )
        return own + np.minimum(tightness, 1.0)[:, :, None] * (led - own)

    def _path(self, curves: Curves, hand: NDArray, points: int, edge: Edge, context: Context) -> NDArray[np.floating]:
        """Paths on the skin from roots, each turning by itself; shape (count, points, 3).

        hand: 1 away from the middle of the face, -1 towards it, shape (count,)
        """
        values = {k: context.values(self, k, curves) for k in ("length", "direction", "swoop", "wave", "wavelength")}
        u = np.linspace(0.0, 1.0, points)
        along = values["length"][:, None] * u
        angle = values["direction"][:, None] + values["swoop"][:, None] * self.swoop.along(u)
        angle = angle + values["wave"][:, None] * self.wave.along(u) * np.sin(
            2.0 * np.pi * along / values["wavelength"][:, None]
        )
        turn = np.radians(hand[:, None] * angle)
        step = values["length"] / (points - 1)
        at = curves.roots
        normal = context.scalp.frames(curves)[:, :, 2]
        out, side = edge.axes(at, normal, context.scalp)
        axis = normal * np.sign(np.sum(np.cross(normal, out) * side, axis=1, keepdims=True))
        heading, turned_by, path = out, np.zeros(len(at)), [at]
        for k in range(1, points):
            middle = 0.5 * (turn[:, k - 1] + turn[:, k])
            heading = turned(heading, axis, middle - turned_by)
            turned_by = middle
            _, at, after, _ = context.scalp.solid.above(np.ascontiguousarray(at + step[:, None] * heading))
            axis = after * np.sign(np.sum(axis * after, axis=1, keepdims=True))
            heading = unit(heading - np.sum(heading * after, axis=1, keepdims=True) * after)
            path.append(at)
        return np.stack(path, axis=1)


@dataclass(frozen=True)
class Edge:
    """The border of a scalp.

    points:  along it [m], shape (n, 3)
    outward: unit directions out of the scalp, shape (n, 3)
    """

    points: NDArray[np.float64]
    outward: NDArray[np.float64]
    tree: KDTree

    @classmethod
    def of(cls, scalp: Scalp) -> Edge | None:
        """The border of a scalp; None for a closed surface."""
        points, outward = border(scalp)
        return cls(points, outward, KDTree(points)) if len(points) else None

    def distance(self, places: NDArray) -> NDArray[np.float64]:
        """Distance of places (n, 3) from the border [m], shape (n,)."""
        return np.asarray(self.tree.query(places)[0], np.float64)

    def axes(self, places: NDArray, normals: NDArray, scalp: Scalp) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Unit tangents of the skin at places: out of the scalp, and along the border away from the middle of the
        face, shape (n, 3) each."""
        near = int(np.clip(2.0 * SMOOTH / np.median(np.linalg.norm(np.diff(self.points, axis=0), axis=1)), 1, 200))
        distance, index = self.tree.query(places, k=min(near, len(self.points)))
        distance, index = distance.reshape(len(places), -1), index.reshape(len(places), -1)
        weight = np.exp(-0.5 * ((distance - distance[:, :1]) / SMOOTH) ** 2)
        out = np.einsum("nk,nkx->nx", weight, self.outward[index])
        out = unit(out - np.sum(out * normals, axis=1, keepdims=True) * normals)
        side = np.cross(normals, out)
        x, _, z = (places - scalp.middle).T
        around = np.sign(x)[:, None] * unit(np.stack([z, np.zeros(len(x)), -x], axis=1))
        away = np.sum(side * (around - UP), axis=1, keepdims=True)
        return out, np.where(away < 0.0, -side, side)

    def spaced(self, size: float, context: Context) -> Curves:
        """Points of the border at about a distance from one another, bound to the scalp, as curves of one point."""
        order = np.argsort(context.random("swoop").uniform(np.arange(len(self.points))), kind="stable")
        free = np.ones(len(self.points), np.bool_)
        chosen = []
        for k in order:
            if free[k]:
                chosen.append(k)
                free[self.tree.query_ball_point(self.points[k], size)] = False
        rows = np.sort(np.array(chosen))
        one = Curves(self.points[rows], np.arange(len(rows) + 1, dtype=np.int32), rows.astype(np.int64))
        return context.scalp.bind(one, np.inf, context.purpose)


def _raised(path: NDArray, lift: NDArray, scalp: Scalp) -> NDArray[np.float64]:
    """Paths (count, points, 3) put on the skin and raised to heights (count,) [m], from 0 at the root."""
    foot, normal = (found.reshape(path.shape) for found in scalp.nearest(path.reshape(-1, 3)))
    t = np.clip(arc_lengths(path) / RISE, 0.0, 1.0)
    raised: NDArray[np.float64] = foot + (lift[:, None] * t * (2.0 - t))[:, :, None] * normal
    return raised
