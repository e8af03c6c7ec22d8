"""Checks a groom: what goes through the scalp, the body, and other locks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.curves import Curves
from ringlet.errors import UserError
from ringlet.groom.crossings import Neighbours
from ringlet.groom.groom import Groom
from ringlet.groom.inside import Surface
from ringlet.mesh import Mesh

Array = NDArray[np.float64]

KINDS = ("scalp", "body", "hair")
WORST = 10  # places that are told
SAMPLE, MOST_SAMPLES = 5e-4, 100  # places on an edge that are looked at are no farther apart [m], but no more than that
ROUNDING = 1e-9  # a depth below this is none [m]


@dataclass(frozen=True)
class Allowed:
    """What a groom may do.

    root_depth:  how deep a lock may be in the skin near its root [m]
    root_length: how far from the root that goes, along the lock [m]
    thickness:   of a lock: nearer than this, two of them are in one another [m]
    """

    root_depth: float = 5e-4
    root_length: float = 5e-3
    thickness: float = 1e-4

    def __post_init__(self) -> None:
        for name in ("root_depth", "root_length", "thickness"):
            if not 0.0 <= (value := getattr(self, name)) < 1.0:
                raise UserError(f"check: {name} is {value:g} m; must be at least 0 and under 1 m")

    def depth(self, locks: Curves) -> Array:
        """How deep each point of the locks may be, shape (n,)."""
        return np.where(along(locks) <= self.root_length, self.root_depth, 0.0)


@dataclass
class Findings:
    """What a check found, place by place.

    kind:     0 scalp, 1 body, 2 hair (``KINDS``), shape (k,)
    point:    the point of the lock that the place is at or just behind, index into the points of the locks, shape (k,)
    place:    where it is [m], shape (k, 3)
    depth:    how deep, beyond what is allowed; for hair, how much nearer than a thickness [m], shape (k,)
    other:    the point of the other lock, -1 where there is none, shape (k,)
    """

    locks: Curves
    kind: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))
    point: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))
    place: Array = field(default_factory=lambda: np.zeros((0, 3)))
    depth: Array = field(default_factory=lambda: np.zeros(0))
    other: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))

    def __len__(self) -> int:
        return len(self.kind)

    def add(self, kind: str, point: NDArray, place: Array, depth: Array, other: NDArray | None = None) -> None:
        """Adds places of one kind."""
        self.kind = np.concatenate([self.kind, np.full(len(point), KINDS.index(kind))])
        self.point = np.concatenate([self.point, point])
        self.place = np.concatenate([self.place, place])
        self.depth = np.concatenate([self.depth, depth])
        self.other = np.concatenate([self.other, np.full(len(point), -1) if other is None else other])

    def told(self) -> dict[str, Any]:
        """Counts, the greatest depth and the worst places of every kind, as plain values; lengths in metres."""
        return {name: self._told(np.flatnonzero(self.kind == k)) for k, name in enumerate(KINDS)}

    def by_kind(self) -> dict[str, Array]:
        """The places of every kind [m], shape (k, 3) each."""
        return {name: self.place[self.kind == k] for k, name in enumerate(KINDS)}

    def _told(self, rows: NDArray[np.int64]) -> dict[str, Any]:
        worst = rows[np.argsort(-self.depth[rows], kind="stable")[:WORST]]
        lock = lock_of(self.locks, np.concatenate([self.point[rows], self.other[rows][self.other[rows] >= 0]]))
        return {
            "places": len(rows),
            "locks": len(np.unique(lock)),
            "depth": float(self.depth[rows].max(initial=0.0)),
            "worst": [self._one(row) for row in worst],
        }

    def _one(self, row: int) -> dict[str, Any]:
        """A place as an artist finds it: the id of the lock, the number of the point from its root, where it is."""
        lock, other = lock_of(self.locks, self.point[[row]])[0], int(self.other[row])
        told = {
            "lock": int(self.locks.ids[lock]),
            "point": int(self.point[row] - self.locks.offsets[lock]),
            "place": [round(float(x), 6) for x in self.place[row]],
            "depth": float(self.depth[row]),
        }
        return told if other < 0 else {**told, "other": int(self.locks.ids[lock_of(self.locks, np.array([other]))[0]])}


@dataclass
class Near:
    """Places on the locks that are inside a body, or nearer to it than asked.

    point:    the point of the lock that each place is behind, shape (k,), and ``at``, how far on to the next, 0 to 1
    place:    where it is [m], shape (k, 3)
    height:   above the surface [m], negative inside, shape (k,)
    foot:     the nearest place on the surface [m], with ``normal`` outward there, shape (k, 3)
    on_scalp: whether that is in the region that carries hair, shape (k,)
    """

    point: NDArray[np.int64]
    at: Array
    place: Array
    height: Array
    foot: Array
    normal: Array
    on_scalp: NDArray[np.bool_]


class Bodies:
    """What locks may not go through: the mesh they grow on, and others beside it. It remembers how far places were from
    it: those that cannot have come near are not looked at again."""

    def __init__(self, groom: Groom, others: Sequence[Mesh]) -> None:
        try:
            region = groom.scalp.region(groom.region)
        except KeyError as error:
            raise UserError(f"check: {error.args[0]}") from None
        self._on_scalp = np.zeros(len(groom.scalp.triangles), bool)
        self._on_scalp[region] = True
        places = groom.scalp.points[groom.scalp.triangles[region]].reshape(-1, 3)
        self.middle = 0.5 * (places.min(axis=0) + places.max(axis=0))
        self.surfaces = [Surface(mesh.points, mesh.triangles) for mesh in (groom.scalp, *others)]
        self._edge, self._at = _samples(groom.locks)
        self._seen = [(np.full((len(self._edge), 3), np.inf), np.zeros(len(self._edge))) for _ in self.surfaces]

    def near(self, locks: Curves, margin: float) -> list[Near]:
        """For each body the places on the locks whose height is under ``margin`` [m]."""
        points = np.asarray(locks.points, np.float64)
        places = points[self._edge] + self._at[:, None] * (points[self._edge + 1] - points[self._edge])
        return [self._near(k, places, margin) for k in range(len(self.surfaces))]

    def _near(self, k: int, places: Array, margin: float) -> Near:
        surface, (seen, height) = self.surfaces[k], self._seen[k]
        moved = np.linalg.norm(places - seen, axis=1)  # infinite for what was never looked at
        ask = np.flatnonzero(~(height - moved > margin) & _in_box(places, surface.points, margin))
        found, foot, normal, triangle = surface.nearest(places[ask])
        seen[ask], height[ask] = places[ask], found
        low = np.flatnonzero(found < margin)
        rows = ask[low]
        on_scalp = self._on_scalp[triangle[low]] if k == 0 else np.zeros(len(low), bool)
        return Near(self._edge[rows], self._at[rows], places[rows], found[low], foot[low], normal[low], on_scalp)


def check_groom(groom: Groom, others: Sequence[Mesh] = (), allowed: Allowed | None = None) -> Findings:
    """Finds where locks are in the mesh they grow on, in others, and in one another.

    others: meshes beside the one of the scalp, in metres
    """
    allowed, locks = allowed or Allowed(), groom.locks.check("check: locks")
    return find(locks, Bodies(groom, others), Neighbours(locks, allowed.thickness), allowed)


def find(locks: Curves, bodies: Bodies, neighbours: Neighbours, allowed: Allowed) -> Findings:
    """Everything that is not allowed."""
    findings = Findings(locks)
    may = allowed.depth(locks)
    for near in bodies.near(locks, 0.0):
        depth = -near.height - may[near.point]
        for kind, rows in (
            ("scalp", np.flatnonzero((depth > ROUNDING) & near.on_scalp)),
            ("body", np.flatnonzero((depth > ROUNDING) & ~near.on_scalp)),
        ):
            rows = _deepest(near.point[rows], depth[rows], rows)
            findings.add(kind, near.point[rows], near.place[rows], depth[rows])
    close = neighbours.close(locks.points).within(allowed.thickness)
    first, way = close.edges[:, 0], locks.points[close.edges[:, 0] + 1] - locks.points[close.edges[:, 0]]
    place = locks.points[first] + close.at[:, :1] * way + 0.5 * close.apart
    findings.add("hair", first, place, allowed.thickness - close.distance, close.edges[:, 1])
    return findings


def _samples(locks: Curves) -> tuple[NDArray[np.int64], Array]:
    """Places on the locks, the points and more between them: the point that each is behind, and how far on to the next
    it is, 0 to 1. Roots are left out: they are on the skin."""
    points = np.asarray(locks.points, np.float64)
    first = np.setdiff1d(np.arange(len(points)), locks.offsets[1:] - 1)
    length = np.linalg.norm(points[first + 1] - points[first], axis=1)
    pieces = np.clip(np.ceil(length / SAMPLE), 1, MOST_SAMPLES).astype(int)
    edge = np.repeat(np.arange(len(first)), pieces)
    step = np.arange(len(edge)) - np.repeat(np.cumsum(pieces) - pieces, pieces) + 1
    return first[edge], step / pieces[edge]


def along(locks: Curves) -> Array:
    """Length from the root to every point [m], shape (n,)."""
    steps = np.linalg.norm(np.diff(locks.points, axis=0, prepend=locks.points[:1]), axis=1)
    steps[locks.offsets[:-1]] = 0.0
    run = np.cumsum(steps)
    return run - np.repeat(run[locks.offsets[:-1]], locks.counts)


def lock_of(locks: Curves, points: NDArray) -> NDArray[np.int64]:
    """The place in the list of the lock that each point belongs to."""
    return np.searchsorted(locks.offsets, points, side="right") - 1


def _deepest(points: NDArray, depth: Array, rows: NDArray) -> NDArray:
    """Of several places at one point, the deepest."""
    order = np.lexsort((-depth, points))
    _, first = np.unique(points[order], return_index=True)
    return rows[order[first]]


def _in_box(places: Array, points: Array, margin: float) -> NDArray[np.bool_]:
    return ((places >= points.min(axis=0) - margin) & (places <= points.max(axis=0) + margin)).all(axis=1)
