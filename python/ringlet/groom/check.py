"""Finds the intersections of a groom with the scalp, with other bodies and between locks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.mesh import Mesh
from ringlet.data.thickness import own_radii
from ringlet.deform.orientation import outward
from ringlet.groom.operators.operator import packed
from ringlet.groom.pins import PIN

Array = NDArray[np.float64]

KINDS = ("scalp", "body", "hair")
MAX_WORST = 10  # deepest places that a summary lists


@dataclass(frozen=True)
class Allowed:
    """Tolerances of a check.

    root_depth:  largest depth of a lock below the skin near its root [m]
    root_length: arc length from the root to which ``root_depth`` applies [m]
    thickness:   smallest distance between two locks that do not intersect [m]
    own_radius:  part of the radius of their own, as of locs and strands of braids, at which locks touch; as in a shot

    Raises UserError for a length that is negative or at least 1 m, and for a part that is not from 0 to 1.
    """

    root_depth: float = 5e-4
    root_length: float = 5e-3
    thickness: float = 1e-4
    own_radius: float = 0.85

    def __post_init__(self) -> None:
        if not 0.0 <= self.own_radius <= 1.0:
            raise UserError(f"check: own_radius is {self.own_radius:g}; must be from 0 to 1")
        for name in ("root_depth", "root_length", "thickness"):
            if not 0.0 <= (value := getattr(self, name)) < 1.0:
                raise UserError(f"check: {name} is {value:g} m; must be at least 0 and under 1 m")


@dataclass
class Findings:
    """The intersections that a check found.

    kind:     0 scalp, 1 body, 2 hair (``KINDS``), shape (k,)
    point:    index of the lock's point at the place or just before it, shape (k,)
    place:    position [m], shape (k, 3)
    depth:    depth beyond the tolerance; for hair, the distance at which they touch less their own [m], shape (k,)
    other:    index of the other lock's point, -1 for scalp and body, shape (k,)
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

    def summary(self) -> dict[str, Any]:
        """Summary of each kind as plain values: counts, greatest depth and deepest places; lengths in metres."""
        return {name: self._summary(np.flatnonzero(self.kind == k)) for k, name in enumerate(KINDS)}

    def by_kind(self) -> dict[str, Array]:
        """The places of every kind [m], shape (k, 3) each."""
        return {name: self.place[self.kind == k] for k, name in enumerate(KINDS)}

    def _summary(self, rows: NDArray[np.int64]) -> dict[str, Any]:
        worst = rows[np.argsort(-self.depth[rows], kind="stable")[:MAX_WORST]]
        lock = lock_of(self.locks, np.concatenate([self.point[rows], self.other[rows][self.other[rows] >= 0]]))
        return {
            "places": len(rows),
            "locks": len(np.unique(lock)),
            "depth": float(self.depth[rows].max(initial=0.0)),
            "worst": [self._entry(row) for row in worst],
        }

    def _entry(self, row: int) -> dict[str, Any]:
        """One intersection as plain values: lock id, number of the point from the root, position [m] and depth [m]."""
        lock, other = lock_of(self.locks, self.point[[row]])[0], int(self.other[row])
        entry = {
            "lock": int(self.locks.ids[lock]),
            "point": int(self.point[row] - self.locks.offsets[lock]),
            "place": [round(float(x), 6) for x in self.place[row]],
            "depth": float(self.depth[row]),
        }
        return (
            entry if other < 0 else {**entry, "other": int(self.locks.ids[lock_of(self.locks, np.array([other]))[0]])}
        )


class Bodies:
    """The solids that locks must stay out of: the mesh of the scalp, and other meshes.

    Raises UserError when the groom's region is not in its mesh.
    """

    def __init__(self, groom: Groom, others: Sequence[Mesh]) -> None:
        try:
            region = np.concatenate([groom.scalp.region(name) for name in groom.regions])
        except KeyError as error:
            raise UserError(f"check: {error.args[0]}") from None
        self.on_scalp = np.zeros(len(groom.scalp.triangles), bool)
        self.on_scalp[region] = True
        self.solids = [
            _core.Solid(
                np.ascontiguousarray(mesh.points, np.float64), outward(mesh.points, mesh.triangles, groom.scalp.points)
            )
            for mesh in (groom.scalp, *others)
            if len(mesh.triangles)
        ]


def check_groom(groom: Groom, others: Sequence[Mesh] = (), allowed: Allowed | None = None) -> Findings:
    """Finds the intersections of locks with the scalp's mesh, with other meshes and with each other.

    others: further meshes, points in metres
    """
    return find(groom.locks.check("check: locks"), Bodies(groom, others), allowed or Allowed())


def find(locks: Curves, bodies: Bodies, allowed: Allowed) -> Findings:
    """Returns every intersection beyond the tolerances."""
    findings = Findings(locks)
    sunk = _core.sunk_places(*packed(locks), bodies.solids, allowed.root_depth, allowed.root_length)
    body, point, triangle, place, depth = sunk
    on_scalp = body == 0
    on_scalp[on_scalp] = bodies.on_scalp[triangle[on_scalp]]
    for kind, rows in (("scalp", on_scalp), ("body", ~on_scalp)):
        findings.add(kind, point[rows], place[rows], depth[rows])
    lines = np.full(len(locks.points), 0.5 * allowed.thickness)
    pair, place, distance = _core.crossings(*packed(locks), lines)
    findings.add("hair", pair[:, 0], place, allowed.thickness - distance, pair[:, 1])
    _add_thick(findings, allowed)
    return findings


def _add_thick(findings: Findings, allowed: Allowed) -> None:
    """Adds intersections between locks of which one at least is thicker than the thickness that is allowed for all.

    Two places that the skin holds do not count: they stay as they are.
    """
    locks = findings.locks
    radius = np.maximum(allowed.own_radius * own_radii(locks), 0.5 * allowed.thickness)
    if 2.0 * radius.max(initial=0.0) <= allowed.thickness:
        return
    held = locks.point.get(PIN, np.zeros(len(radius))) >= 1.0
    pair, place, distance = _core.crossings(*packed(locks), radius)
    new = (distance >= allowed.thickness) & ~held[pair].all(axis=1)  # nearer ones are there already
    pair, depth = pair[new], radius[pair[new]].sum(axis=1) - distance[new]
    findings.add("hair", pair[:, 0], place[new], depth, pair[:, 1])


def lock_of(locks: Curves, points: NDArray) -> NDArray[np.int64]:
    """Row of the lock that each point belongs to, shape of ``points``."""
    return np.searchsorted(locks.offsets, points, side="right") - 1
