"""Catmull–Clark subdivision surfaces: refined faces, and the sparse matrices that give their points from a cage.

The rules are those of Catmull and Clark 1978, with creases of DeRose, Kass and Truong 1998 (sect. 3 and app. B). The
refined points lie on the limit surface (Halstead, Kass and DeRose 1993).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Matrix = Any  # a scipy.sparse.csr_matrix, which has no types

SAG = 1e-4  # largest distance of most edges of the refined faces from the limit surface [m]
MAX_LEVELS = 3
MAX_FACES = 200_000  # of a refinement; each level has four times as many
MOST = 0.95  # of the edges


@dataclass
class Cage:
    """Polygons of a subdivision surface.

    counts:      corners per polygon, shape (f,)
    indices:     point of each corner, polygon by polygon
    points:      number of points
    creases:     points of sharp edges, shape (k, 2)
    sharpness:   of these edges, shape (k,); infinite, or the number of levels at which they stay sharp
    corners:     sharpness of each point, shape (points,)
    round_ends:  whether the corners of a boundary are smooth (USD's ``edgeOnly``)
    """

    counts: Indices
    indices: Indices
    points: int
    creases: Indices = field(default_factory=lambda: np.empty((0, 2), np.int64))
    sharpness: Array = field(default_factory=lambda: np.empty(0))
    corners: Array | None = None
    round_ends: bool = False

    @property
    def boundary(self) -> Indices:
        """Points on a boundary."""
        level = _Level(self)
        return np.unique(level.edges[level.uses != 2])


@dataclass
class Refinement:
    """Faces of a refined cage.

    counts, indices: polygons, as in ``Cage``; quads from the first level on
    faces:           polygon of the cage of each face, shape (f,)
    points:          matrix from the points of the cage to those of the faces on the limit surface
    corners:         matrix from values at the corners of the cage to those at the corners of the faces, linear
    """

    counts: Indices
    indices: Indices
    faces: Indices
    points: Matrix
    corners: Matrix


def refine(cage: Cage, levels: int) -> Refinement:
    """Refines a cage; with 0 levels the faces stay, and their points move onto the limit surface."""
    step = _Level(cage)
    points, corners = sparse.identity(cage.points, format="csr"), sparse.identity(len(cage.indices), format="csr")
    faces = np.arange(len(cage.counts))
    for _ in range(levels):
        points, corners, faces = step.points @ points, step.corners @ corners, np.repeat(faces, step.cage.counts)
        step = _Level(step.child)
    return Refinement(step.cage.counts, step.cage.indices, faces, (_limit(step) @ points).tocsr(), corners)


def _limit(level: _Level) -> Matrix:
    """Matrix from the points of a level to their limits, which are known for quads; those of a child are quads."""
    if (level.cage.counts == 4).all():
        return level.limit
    return (_Level(level.child).limit @ level.points)[: level.cage.points]


def levels_for(cage: Cage, points: Array) -> int:
    """Levels at which most edges are nearer to the limit surface than ``SAG``; each level quarters their distance.

    There are fewer where the refinement would have more than ``MAX_FACES``.

    points: of the cage [m], shape (n, 3)
    """
    most = 1 + int(np.floor(np.log(MAX_FACES / len(cage.indices)) / np.log(4.0)))
    if most <= 0:
        return 0
    edges = _Level(cage).edges
    on_limit = refine(cage, 1).points @ points
    middle = on_limit[cage.points : cage.points + len(edges)]
    sag = np.linalg.norm(middle - on_limit[edges].mean(axis=1), axis=1)
    typical = max(float(np.quantile(sag, MOST)), 1e-300)
    rounding = np.concatenate([[0.0], cage.sharpness[np.isfinite(cage.sharpness)]]).max()  # levels until creases end
    needed = max(np.ceil(np.log(typical / SAG) / np.log(4.0)), np.ceil(rounding))
    return int(np.clip(needed, 0, min(most, MAX_LEVELS)))


class _Level:
    """One step of subdivision. Points of the child are those of vertices, then of edges, then of faces."""

    def __init__(self, cage: Cage) -> None:
        self.cage = cage
        counts, indices, n = cage.counts, cage.indices, cage.points
        starts = np.cumsum(counts) - counts
        self._face = np.repeat(np.arange(len(counts)), counts)
        local = np.arange(len(indices)) - starts[self._face]
        self._next = starts[self._face] + (local + 1) % counts[self._face]
        self._previous = starts[self._face] + (local - 1) % counts[self._face]
        ends = np.sort(np.stack([indices, indices[self._next]], axis=1), axis=1)
        keys, self._edge, self.uses = np.unique(ends[:, 0] * n + ends[:, 1], return_inverse=True, return_counts=True)
        self.edges = np.stack([keys // n, keys % n], axis=1)
        self._sharp = np.where(self.uses == 2, 0.0, np.inf)  # a boundary is a crease
        creases = np.sort(cage.creases, axis=1)
        place = np.searchsorted(keys, creases[:, 0] * n + creases[:, 1]).clip(0, len(keys) - 1)
        there = keys[place] == creases[:, 0] * n + creases[:, 1]
        np.maximum.at(self._sharp, place[there], cage.sharpness[there])

        one_face = np.bincount(indices, minlength=n) < 2  # a corner of the boundary, or a point without faces
        authored = np.zeros(n) if cage.corners is None else cage.corners
        self._corner = np.where(one_face & (not cage.round_ends), np.inf, authored)
        self._make_matrices()

    def _make_matrices(self) -> None:
        cage, (f, e, n) = self.cage, (len(self.cage.counts), len(self.edges), self.cage.points)
        corners = np.arange(len(cage.indices))
        of_face = _matrix(self._face, corners, 1.0 / cage.counts[self._face], (f, len(corners)))
        self._centre = of_face @ _matrix(corners, cage.indices, 1.0, (len(corners), n))
        self._middle = _matrix(np.repeat(np.arange(e), 2), self.edges.ravel(), 0.5, (e, n))
        self._at_edge = _matrix(self._edge, self._face, 1.0, (e, f))  # faces at each edge
        self._at_vertex = _matrix(self.edges.ravel(), np.repeat(np.arange(e), 2), 1.0, (n, e))  # edges at each vertex
        self._around = _matrix(cage.indices, self._face, 1.0, (n, f))  # faces at each vertex
        self._of_face = of_face

    @property
    def points(self) -> Matrix:
        """Matrix from the points of the cage to those of the child."""
        sharp = np.minimum(self._sharp, 1.0)
        smooth = 0.5 * self._middle + 0.25 * (self._at_edge @ self._centre)
        edge = _rows(sharp) @ self._middle + _rows(1.0 - sharp) @ smooth
        return sparse.vstack([self._vertex_points(), edge, self._centre], format="csr")

    def _vertex_points(self) -> Matrix:
        """Vertex points; where sharpness ends within this level, a mean of the rules before and after."""
        before = self._vertex_rule(self._sharp, self._corner)
        decayed = self._sharp - 1.0, self._corner - 1.0
        fading = (self._sharp > 0.0) & (self._sharp < 1.0)
        ends = (self._corner > 0.0) & (self._corner < 1.0)
        number = self._at_vertex @ fading.astype(float) + ends
        if not number.any():
            return before
        total = self._at_vertex @ np.where(fading, self._sharp, 0.0) + np.where(ends, self._corner, 0.0)
        weight = np.where(number > 0, total / np.maximum(number, 1.0), 1.0)
        return _rows(weight) @ before + _rows(1.0 - weight) @ self._vertex_rule(*decayed)

    def _vertex_rule(self, sharp: Array, corner: Array) -> Matrix:
        valence = np.maximum(np.diff(self._at_vertex.indptr), 1)
        faces = np.maximum(np.diff(self._around.indptr), 1)
        smooth = (
            _rows(1.0 / (faces * valence)) @ self._around @ self._centre
            + _rows(2.0 / valence**2) @ self._at_vertex @ self._middle
            + _rows((valence - 3.0) / valence)
        )
        return self._blend(sharp, corner, smooth, 0.5, 0.5)

    @property
    def limit(self) -> Matrix:
        """Matrix from the points of a cage of quads to their limits."""
        valence = np.maximum(np.diff(self._at_vertex.indptr), 1)
        smooth = _rows(1.0 / (valence * (valence + 5.0))) @ (
            4.0 * (self._at_vertex @ self._middle + self._around @ self._centre) + _rows(valence**2 - 3.0 * valence)
        )
        return self._blend(self._sharp, self._corner, smooth, 1.0 / 3.0, 2.0 / 3.0)

    def _blend(self, sharp: Array, corner: Array, smooth: Matrix, own: float, mean: float) -> Matrix:
        """Chooses the rule of each vertex by its number of sharp edges: smooth, a crease of two, or a corner.

        own, mean: weights of a vertex on a crease, and of the mean of its two sharp edges' middles
        """
        number = self._at_vertex @ (sharp > 0.0).astype(float)
        is_corner = (number > 2) | (corner > 0.0)
        is_crease = (number == 2) & ~is_corner
        crease = _rows(np.full(len(number), own)) + 0.5 * mean * (
            self._at_vertex @ _rows((sharp > 0.0).astype(float)) @ self._middle
        )
        return (_rows(~(is_corner | is_crease)) @ smooth + _rows(is_crease) @ crease + _rows(is_corner)).tocsr()

    @property
    def corners(self) -> Matrix:
        """Matrix from values at the corners of the cage to those of the child."""
        n, c = len(self.cage.indices), np.arange(len(self.cage.indices))
        own = sparse.identity(n, format="csr")
        after, before = (0.5 * (own + _matrix(c, other, 1.0, (n, n))) for other in (self._next, self._previous))
        middle = _matrix(c, self._face, 1.0, (n, len(self.cage.counts))) @ self._of_face
        order = np.arange(4 * n).reshape(4, n).T.ravel()  # the four corners of each child together
        stacked: Matrix = sparse.vstack([own, after, middle, before], format="csr")
        return stacked[order]

    @property
    def child(self) -> Cage:
        """Polygons of the next level: one quad for each corner of the cage, in its order."""
        cage, n, e = self.cage, self.cage.points, len(self.edges)
        quads = np.stack([cage.indices, n + self._edge, n + e + self._face, n + self._edge[self._previous]], axis=1)
        sharp = np.flatnonzero(self._sharp > 1.0)
        halves = np.concatenate([np.stack([self.edges[sharp, k], n + sharp], axis=1) for k in (0, 1)])
        corner = np.concatenate([np.maximum(self._corner - 1.0, 0.0), np.zeros(e + len(cage.counts))])
        return Cage(
            counts=np.full(len(quads), 4),
            indices=quads.ravel(),
            points=n + e + len(cage.counts),
            creases=halves,
            sharpness=np.tile(self._sharp[sharp] - 1.0, 2),
            corners=corner,
            round_ends=True,  # the corners of the boundary are among those of the cage
        )


def _matrix(rows: Indices, columns: Indices, values: Array | float, shape: tuple[int, int]) -> Matrix:
    data = np.broadcast_to(np.asarray(values, np.float64), rows.shape)
    return sparse.csr_matrix((data, (rows, columns)), shape=shape)


def _rows(weights: NDArray) -> Matrix:
    """Diagonal matrix that scales rows."""
    return sparse.diags(np.asarray(weights, np.float64), format="csr")
