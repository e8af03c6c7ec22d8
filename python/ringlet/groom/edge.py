"""Hair that is rooted on an edge: on a line of the skin, as lashes are, or in a narrow band along it, as brows are."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from scipy.spatial import KDTree

from ringlet import _core
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.data.painted import painted, region
from ringlet.data.quantities import Quantity, Ramped, Section, refuse
from ringlet.data.random import Random
from ringlet.groom.helpers import Names
from ringlet.groom.mask import Mask
from ringlet.groom.operators.operator import arc_lengths, at_lengths, unit
from ringlet.groom.scalp import Samples, Scalp

STEP = 2e-4  # [m] between the places that represent a line
FARTHEST = 0.01  # [m] of a drawn line from the skin
IDS_PER_LINE = 10**8  # id of a curve that grows on an edge: line · 10⁸ + number on the line
CANDIDATES = 6  # for each root, at least: with 4, gaps between roots are up to a sixth larger
MOST_CANDIDATES = 10**7

Array = NDArray[np.float64]


class Edge(Section):
    """Lines that carry hair in place of an area: drawn ones, or the border of a region.

    Locks carry `u`, from 0 at the start of their line to 1 at its end, and `v`, from 0 to 1 across the band. Masks and
    values use them. A border is cut where its mask is under a half, and runs from the middle of the head outwards.
    """

    lines: list[str] = Field(default=[], description="names of curves of `[curves]` that are drawn on the skin")
    both_sides: bool = Field(default=False, description="also grow hair on the images of the lines at the plane x = 0")
    region: str | None = Field(default=None, description="named faces whose border carries hair, such as an eyelid")
    mask: Annotated[Mask, Quantity("", 0.0, 1.0)] = Field(
        default=Mask(), description='which part of the lines, such as `{ where = "y > 4" }` for an upper lid'
    )
    width: Annotated[Ramped, Quantity("m", 0.0, 0.1)] = Field(
        default=Ramped(value=0.0005), description="width of the band of roots; its ramp is along the line"
    )
    turn: Annotated[Ramped, Quantity("deg", -180.0, 180.0)] = Field(
        default=Ramped(value=90.0),
        description="direction of growth along the skin: 0 along the line, 90 across it, to the side that "
        "`guides.flow` points to; its ramp is along the line",
    )

    @model_validator(mode="after")
    def _one_source(self) -> Edge:
        if bool(self.lines) == (self.region is not None):
            raise refuse("needs either 'lines' or a 'region'; give one of them")
        if self.both_sides and self.region is not None:
            raise refuse("has 'both_sides', which is for 'lines'; name a region that has both, or take it out")
        for name in ("width", "turn"):
            value: Ramped = getattr(self, name)
            if varied := [what for what in ("vary", "noise", "map", "region", "lock") if getattr(value, what)]:
                raise refuse(f"has a {name} with '{varied[0]}', but it varies along the line alone; give it a ramp")
        return self

    def of(self, scalp: Scalp, helper: Callable[[Names, str], Curves], seed: int) -> EdgeScalp:
        """The scalp with hair on the lines alone.

        helper: curves of a name, for a setting

        Raises UserError for lines that are not there, or off the skin.
        """
        if self.region is not None:
            rough = border_lines(scalp, region(self.region, scalp.mesh, "scalp.edge.region"))
        else:
            curves = [helper(name, "edge.lines") for name in self.lines]
            rough = [np.asarray(one[k], np.float64) for one in curves for k in range(len(one))]
            rough += [line * (-1.0, 1.0, 1.0) for line in rough] if self.both_sides else []
        lines = [line for points in rough for line in self._chosen(_on_skin(points, scalp, self), scalp, seed)]
        if not lines:
            raise UserError(f"scalp.edge: nothing is left of its lines on {scalp.where}; change its mask")
        return EdgeScalp(scalp, self, lines)

    def _chosen(self, places: Array, scalp: Scalp, seed: int) -> list[Array]:
        """The stretches of a line where the mask is at least a half."""
        if self.mask.everywhere:
            return [places]
        seeds = _seeds(places, scalp, np.arange(len(places)))
        kept = self.mask.weights(seeds, scalp.mesh, Random(seed, "edge/mask"), "scalp.edge.mask")[:, 0] >= 0.5
        if not kept.any():
            return []
        closed = np.linalg.norm(places[0] - places[-1]) < 2.0 * STEP
        if closed and not kept.all():
            places, kept = places[:-1], kept[:-1]
            first = int(np.flatnonzero(~kept)[0]) if not kept.all() else 0
            places, kept = np.roll(places, -first, axis=0), np.roll(kept, -first)
        stretches = np.split(np.arange(len(kept)), np.flatnonzero(np.diff(kept.astype(int))) + 1)
        found = [places[rows] for rows in stretches if kept[rows[0]] and len(rows) > 2]
        return [line if self.lines else _outwards(line) for line in found]


@dataclass(frozen=True)
class Line:
    """Places along a line of the skin, shape (n, 3) each, and how far along it they are, from 0 to 1."""

    places: Array
    tangents: Array
    u: Array
    length: float

    @classmethod
    def through(cls, places: Array) -> Line:
        """The line through places [m], shape (n, 3)."""
        run = arc_lengths(places[None])[0]
        return cls(places, unit(np.gradient(places, axis=0)), run / run[-1], float(run[-1]))


class EdgeScalp(Scalp):
    """A scalp whose hair grows on lines."""

    def __init__(self, scalp: Scalp, edge: Edge, lines: list[Array]) -> None:
        self.__dict__.update(scalp.__dict__)
        self.edge, self.lines = edge, [Line.through(places) for places in lines]
        self.length = sum(line.length for line in self.lines)
        self._places = np.concatenate([line.places for line in self.lines])
        self._tangents = np.concatenate([line.tangents for line in self.lines])
        self._u = np.concatenate([line.u for line in self.lines])
        self._row = np.repeat(np.arange(len(self.lines)), [len(line.places) for line in self.lines])
        self._tree = KDTree(self._places)

    @property
    def middle(self) -> Array:
        """Centre of the box around the lines [m]."""
        return 0.5 * (self._places.min(axis=0) + self._places.max(axis=0))

    @property
    def area(self) -> float:
        """Area of the band [m²]."""
        return float(sum(line.length * self._width(line.u).mean() for line in self.lines))

    def _width(self, u: Array) -> Array:
        return self.edge.width.value * self.edge.width.along(u)

    def count_for_spacing(self, spacing: float, what: str) -> int:
        """Number of roots at a mean spacing [m]: along the lines, or over the band where that is wider."""
        return max(1, round(self.length / spacing), super().count_for_spacing(spacing, what))

    def sample(self, count: int, seed: int, density: str | None = None, what: str = "density") -> Samples:
        """Roots evenly along the lines, after a painted density if one is named; see ``Scalp.sample``.

        Candidates are fixed for each line, so that most roots stay when their number changes.
        """
        number = CANDIDATES * count
        while True:
            ids, places = self._on_band(number, seed)
            seeds = _seeds(places, self, ids)
            if density is not None:
                share = np.clip(painted(density, seeds, self.mesh, what), 0.0, 1.0)
                seeds = seeds.take(Random(seed, "edge/density").uniform(ids) < share)
            if len(seeds) >= min(count, 2 * CANDIDATES) and len(seeds) >= count:
                break
            number *= 2
            if number > max(MOST_CANDIDATES, 64 * count):
                raise UserError(f"{what} '{density}' is 0 nearly all along scalp.edge; paint where hair is to grow")
        area = max(self.area, 0.5 * np.sqrt(3.0) * self.length**2 / count)
        rows = _core.thin_out(np.ascontiguousarray(seeds.points, np.float64), area, count)
        kept = seeds.take(rows)
        return kept.ids, kept.curve["root_triangle"], kept.curve["root_barycentric"]

    def _on_band(self, number: int, seed: int) -> tuple[NDArray[np.int64], Array]:
        """Ids and places [m] of random candidates in the band, more where it is wider."""
        random, found = Random(seed, "edge"), []
        widest = float(self._width(self._u).max())
        for row, line in enumerate(self.lines):
            ids = row * IDS_PER_LINE + np.arange(max(1, round(number * line.length / self.length)), dtype=np.int64)
            u = random.uniform(ids, 0)
            width = self._width(u)
            if widest > 0.0:
                wide = random.uniform(ids, 1) * widest <= width
                ids, u, width = ids[wide], u[wide], width[wide]
            places = at_lengths(line.places[None], (u * line.length)[None])[0]
            k = np.clip(np.searchsorted(line.u, u), 0, len(line.u) - 1)
            aside = width * (random.uniform(ids, 2) - 0.5)
            found.append((ids, places + aside[:, None] * self._across(places, line.tangents[k])))
        return np.concatenate([ids for ids, _ in found]), np.concatenate([places for _, places in found])

    def _across(self, places: Array, tangents: Array) -> Array:
        return unit(np.cross(self.nearest(places)[1], tangents))

    def attributes(self, roots: Array) -> dict[str, NDArray[np.float32]]:
        """``u`` along the line and ``v`` across the band of roots (n, 3) [m], each from 0 to 1, shape (n,)."""
        nearest = self._tree.query(roots)[1]
        u, tangents = self._u[nearest], self._tangents[nearest]
        aside = np.sum((roots - self._places[nearest]) * self._across(roots, tangents), axis=1)
        v = np.clip(0.5 + aside / np.maximum(self._width(u), 1e-9), 0.0, 1.0)
        return {"u": u.astype(np.float32), "v": v.astype(np.float32)}

    def flow(self, roots: Array, normals: Array, toward: Array) -> Array:
        """Directions of growth along the skin, unit tangents of shape (n, 3).

        toward: direction that says to which side of a line hair grows across it, shape (3,)
        """
        nearest = self._tree.query(roots)[1]
        tangents = self._tangents[nearest]
        across = unit(np.cross(normals, tangents))
        side = np.bincount(self._row[nearest], across @ toward, minlength=len(self.lines))[self._row[nearest]]
        across = np.where(side[:, None] < 0.0, -across, across)
        angle = np.radians(self.edge.turn.value * self.edge.turn.along(self._u[nearest]))[:, None]
        return np.cos(angle) * tangents + np.sin(angle) * across


def border_lines(scalp: Scalp, triangles: NDArray[np.int32]) -> list[Array]:
    """The border of triangles as polylines [m], each of shape (n, 3), in the order of their lowest corner."""
    corners = scalp.triangles[triangles].astype(np.int64)
    edges = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    sides, uses = np.unique(edges, axis=0, return_counts=True)
    around: dict[int, list[int]] = {}
    for a, b in sides[uses == 1].tolist():
        around.setdefault(a, []).append(b)
        around.setdefault(b, []).append(a)
    lines = []
    while around:
        path = [min(around)]
        while after := around.get(path[-1]):
            here, there = path[-1], min(after)
            for a, b in ((here, there), (there, here)):
                around[a].remove(b)
                if not around[a]:
                    del around[a]
            path.append(there)
        lines.append(scalp.points[path])
    if not lines:
        raise UserError("scalp.edge.region has no border: it is all of a closed surface; name another, or give lines")
    return lines


def _on_skin(points: Array, scalp: Scalp, edge: Edge) -> Array:
    """Places at even steps along a line, moved to the nearest skin [m], shape (n, 3)."""
    run = arc_lengths(points[None])[0]
    count = max(3, int(np.ceil(run[-1] / STEP)) + 1)
    even = at_lengths(points[None], np.linspace(0.0, run[-1], count)[None])[0]
    if not edge.lines:
        return even
    smooth = _core.resample_curves(np.ascontiguousarray(points), np.array([0, len(points)], np.int32), count)
    triangle, barycentric, distance = _core.bind_roots(scalp.points, scalp.triangles, smooth, scalp.region)
    if distance.max() > FARTHEST:
        raise UserError(
            f"scalp.edge: a line of {', '.join(edge.lines)} is {distance.max():.3g} m from {scalp.where}; at most "
            f"{FARTHEST:g} m is allowed: draw it on the skin"
        )
    return scalp.positions(triangle, barycentric)


def _seeds(places: Array, scalp: Scalp, ids: NDArray) -> Curves:
    """Places on the skin as curves of one point that are bound to it."""
    flat = np.ascontiguousarray(places, np.float64)
    triangle, barycentric, _ = _core.bind_roots(scalp.points, scalp.triangles, flat, scalp.region)
    bound = {"root_triangle": triangle, "root_barycentric": barycentric}
    return Curves(scalp.positions(triangle, barycentric), offsets_from_counts(np.ones(len(ids))), ids, bound)


def _outwards(line: Array) -> Array:
    """A line that starts at its end nearest to the plane of symmetry x = 0."""
    return line if abs(line[0, 0]) <= abs(line[-1, 0]) else line[::-1]
