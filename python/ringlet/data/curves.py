"""One data structure for guides, locks, groom guides and hairs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape

import numpy as np
from numpy.typing import NDArray

from ringlet.data import limits
from ringlet.data.attributes import check_attribute
from ringlet.data.errors import UserError
from ringlet.data.sketch import sketch

ID_HALVES = "id_high", "id_low"
LEAST_EDGE = 1e-8  # [m] an edge that is shorter has no direction in single precision


@dataclass
class Curves:
    """A set of polylines, root first, packed one after another.

    points:  positions [m], shape (n, 3), float64 (float32 for dense hairs)
    offsets: the first row of each curve in ``points``, and the end of the last; shape (count + 1,), int32
    ids:     stable names of the curves, shape (count,), int64; never reused, never an index
    curve:   attributes with one row per curve, e.g. ``root_triangle``
    point:   attributes with one row per point, e.g. ``width``
    """

    points: NDArray[np.floating]
    offsets: NDArray[np.int32]
    ids: NDArray[np.int64]
    curve: dict[str, NDArray] = field(default_factory=dict)
    point: dict[str, NDArray] = field(default_factory=dict)

    @classmethod
    def from_list(cls, curves: Sequence[NDArray], ids: Sequence[int] | None = None) -> Curves:
        """Packs a list of (k, 3) arrays; ids default to 0, 1, 2 …"""
        counts = [len(c) for c in curves]
        points = np.concatenate(curves) if curves else np.empty((0, 3))
        names = np.arange(len(counts)) if ids is None else np.asarray(ids)
        return cls(np.ascontiguousarray(points, np.float64), offsets_from_counts(counts), names.astype(np.int64))

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __repr__(self) -> str:
        kinds = {"curve": self.curve, "point": self.point}
        named = [f"{kind}: {', '.join(sorted(values))}" for kind, values in kinds.items() if values]
        return f"Curves({'; '.join([f'{len(self):,} curves, {len(self.points):,} points', *named])})"

    def _repr_html_(self) -> str:
        return f"<p>{escape(repr(self))}</p>{sketch(self.points, self.offsets)}"

    def __getitem__(self, index: int) -> NDArray[np.floating]:
        """The points of one curve, a view of shape (k, 3)."""
        return self.points[self.offsets[index] : self.offsets[index + 1]]

    @property
    def counts(self) -> NDArray[np.int32]:
        """Points per curve, shape (count,)."""
        return np.diff(self.offsets)

    @property
    def roots(self) -> NDArray[np.floating]:
        """First point of every curve [m], shape (count, 3)."""
        return self.points[self.offsets[:-1]]

    def lengths(self) -> NDArray[np.floating]:
        """Arc length of every curve [m], shape (count,)."""
        return np.add.reduceat(self.edge_lengths(), self.offsets[:-1]) if len(self) else np.empty(0)

    def edge_lengths(self) -> NDArray[np.floating]:
        """Length of the edge that begins at each point [m], shape (n,); 0 at the last of a curve."""
        edges = np.zeros(len(self.points))
        edges[:-1] = self._steps()
        edges[self.offsets[1:] - 1] = 0.0  # the jump from one curve to the next is no edge
        return edges

    def _steps(self) -> NDArray[np.floating]:
        """Distance of every point from the one before, also from one curve to the next [m], shape (n - 1,)."""
        steps = self.points[1:] - self.points[:-1]
        return np.sqrt(np.einsum("nk,nk->n", steps, steps))

    def take(self, indices: NDArray) -> Curves:
        """The chosen curves (indices or a mask), with their attributes."""
        chosen, rows = np.arange(len(self))[indices], self.point_rows(indices)
        return Curves(
            self.points[rows],
            offsets_from_counts(self.counts[chosen]),
            self.ids[chosen],
            {name: values[chosen] for name, values in self.curve.items()},
            {name: values[rows] for name, values in self.point.items()},
        )

    def point_rows(self, indices: NDArray) -> NDArray[np.int64]:
        """Rows of the points of the chosen curves (indices or a mask), shape (k,)."""
        chosen = np.arange(len(self))[indices]
        counts = self.counts[chosen]
        offsets = offsets_from_counts(counts)
        return np.repeat(self.offsets[chosen] - offsets[:-1], counts) + np.arange(offsets[-1])

    def row_of(self, id: int, what: str) -> int:
        """Row of the curve with an id; raises UserError, which begins with ``what``, when there is none."""
        found = np.flatnonzero(self.ids == id)
        if not found.size:
            nearest = self.ids[np.abs(self.ids - id).argmin()]
            raise UserError(f"{what}: there is no lock {id}; the nearest id is {nearest}")
        return int(found[0])

    @classmethod
    def joined(cls, sets: Sequence[Curves], absent: Mapping[str, float] | None = None) -> Curves:
        """Several sets of curves as one, in their order; ids must be different.

        An attribute that some sets lack is ``absent[name]`` there, by default 0. One that varies along the curves of
        some sets is an attribute of the points of all.
        """
        defaults = absent or {}
        along = {name for one in sets for name in one.point}
        kinds = {name: values for one in sets for name, values in {**one.curve, **one.point}.items()}

        def of(one: Curves, name: str) -> NDArray:
            count = len(one.points) if name in along else len(one)
            if name in one.point:
                return one.point[name]
            if name in one.curve:
                return np.repeat(one.curve[name], one.counts, axis=0) if name in along else one.curve[name]
            like = kinds[name]
            if like.dtype.kind in "SU":
                return np.zeros((count, *like.shape[1:]), like.dtype)
            return np.full((count, *like.shape[1:]), defaults.get(name, 0), like.dtype)

        joined = {name: np.concatenate([of(one, name) for one in sets]) for name in kinds}
        return cls(
            np.concatenate([one.points for one in sets]),
            offsets_from_counts(np.concatenate([one.counts for one in sets])),
            np.concatenate([one.ids for one in sets]),
            {name: values for name, values in joined.items() if name not in along},
            {name: values for name, values in joined.items() if name in along},
        )

    def with_points(self, points: NDArray[np.floating]) -> Curves:
        """The same curves with other points, of the same shape."""
        if points.shape != self.points.shape:
            raise ValueError(f"curves: points have shape {points.shape}; must be {self.points.shape}")
        return Curves(points, self.offsets, self.ids, self.curve, self.point)

    def distinct(self) -> Curves:
        """The same curves without points that coincide with the one before; each keeps at least two."""
        edges = np.linalg.norm(np.diff(self.points, axis=0, prepend=self.points[:1]), axis=1)
        kept = edges >= LEAST_EDGE
        kept[self.offsets[:-1]] = True
        counts = np.add.reduceat(kept, self.offsets[:-1]) if len(self) else np.zeros(0, np.int64)
        kept |= np.repeat(counts < 2, self.counts)
        if kept.all():
            return self
        counts = np.add.reduceat(kept, self.offsets[:-1])
        point = {name: values[kept] for name, values in self.point.items()}
        return Curves(self.points[kept], offsets_from_counts(counts), self.ids, self.curve, point)

    def check(self, what: str) -> Curves:
        """Refuses invalid curves; ``what`` names them in the message. Returns self."""
        if len(self) == 0:
            raise UserError(f"{what}: there are no curves; give at least one")
        if self.offsets[0] != 0 or self.offsets[-1] != len(self.points) or (self.counts < 0).any():
            raise UserError(
                f"{what}: point counts add up to {self.offsets[-1]}, but there are {len(self.points)} points; "
                "export it again"
            )
        if (short := np.flatnonzero(self.counts < 2)).size:
            raise UserError(
                f"{what}: curve {self.ids[short[0]]} has {self.counts[short[0]]} point(s); must have at least 2"
            )
        if not np.abs(self.points).max() <= limits.FARTHEST:
            row = int(np.flatnonzero(~(np.abs(self.points) <= limits.FARTHEST).all(axis=1))[0])
            curve = self._curve_of(row)
            raise UserError(
                f"{what}: curve {self.ids[curve]}, point {row - self.offsets[curve]} is {self.points[row]}; "
                f"must be finite, and at most {limits.FARTHEST:g} from 0"
            )
        if (flat := np.flatnonzero(self.lengths() <= 0)).size:
            raise UserError(f"{what}: curve {self.ids[flat[0]]} has length 0; remove it or draw it out")
        if len(np.unique(self.ids)) != len(self):
            values, uses = np.unique(self.ids, return_counts=True)
            raise UserError(f"{what}: id {values[uses > 1][0]} is used by {uses.max()} curves; ids must be unique")
        self._check_values(what)
        return self

    def _check_values(self, what: str) -> None:
        """Refuses attributes that are not finite or out of range."""
        for name, values in self.curve.items():
            check_attribute(name, values, what, "curve", lambda row: f"curve {self.ids[row]}")
        for name, values in self.point.items():
            check_attribute(name, values, what, "point", lambda row: f"curve {self.ids[self._curve_of(row)]}")

    def _curve_of(self, row: int) -> int:
        """The curve that a row of ``points`` belongs to."""
        return int(np.searchsorted(self.offsets, row, side="right") - 1)

    def check_strands(self, what: str) -> Curves:
        """Refuses curves that cannot move as strands; ``what`` names them in the message. Returns self.

        A strand has at least 3 points, and no edge shorter than ``LEAST_EDGE``.
        """
        if (short := np.flatnonzero(self.counts < 3)).size:
            raise UserError(
                f"{what}: curve {self.ids[short[0]]} has {self.counts[short[0]]} points; must have at least 3"
            )
        x, y, z = (self.points[1:] - self.points[:-1]).T  # columns are faster than rows of three numbers
        edges = np.sqrt(x * x + y * y + z * z)
        edges[self.offsets[1:-1] - 1] = np.inf  # the jump from one curve to the next is no edge
        if not edges.min(initial=np.inf) >= LEAST_EDGE:
            flat = np.flatnonzero(~(edges >= LEAST_EDGE))
            curve = self._curve_of(flat[0])
            point, place = flat[0] - self.offsets[curve], ", ".join(f"{x:.4g}" for x in self.points[flat[0]])
            raise UserError(
                f"{what}: points {point} and {point + 1} of curve {self.ids[curve]} coincide at ({place}) m; move them "
                "apart, or resample it"
            )
        return self


def id_halves(ids: NDArray[np.int64]) -> dict[str, NDArray[np.int32]]:
    """Ids as attributes of 32 bits, for programs and files without integers of 64."""
    halves = zip(ID_HALVES, (ids >> 32, ids & 0xFFFFFFFF), strict=True)
    return {name: half.astype(np.uint32).view(np.int32) for name, half in halves}


def pop_id_halves(curve: dict[str, NDArray]) -> NDArray[np.int64] | None:
    """Takes ids in halves out of the attributes of curves; None where there are none."""
    halves = [curve.pop(name, None) for name in ID_HALVES]
    found = [np.asarray(half, np.int64) for half in halves if half is not None and half.dtype == np.int32]
    return (found[0] << 32) | (found[1] & 0xFFFFFFFF) if len(found) == len(ID_HALVES) else None


def offsets_from_counts(counts: Sequence[int] | NDArray) -> NDArray[np.int32]:
    """Running offsets, shape (count + 1,), of curves with that many points each."""
    offsets = np.zeros(len(counts) + 1, np.int64)
    np.cumsum(counts, out=offsets[1:])
    if offsets[-1] > np.iinfo(np.int32).max:
        raise UserError(f"curves: {offsets[-1]} points; must be under {np.iinfo(np.int32).max}")
    return offsets.astype(np.int32)
