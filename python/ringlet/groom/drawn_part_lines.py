"""Sections between drawn part lines: the connected parts of a chart of the scalp."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

NEIGHBOURS = 8  # samples that a sample, or a place, is connected with
FEWEST = 4  # samples of a section
LONGER = 0.25  # of a part line at both ends, in sizes of a section: it need not reach the border to the millimetre


class DrawnPartLines:
    """The parts of a chart between polylines. Two samples are connected where they are near and no line separates them.

    A part is named by its first sample, so that another line renames only the parts that it divides.
    """

    def __init__(self, lines: list[NDArray], samples: NDArray, size: float) -> None:
        """From lines (k, 2) and samples (n, 2) in the chart [m], and the size of a section [m]."""
        longer = [_longer(line, LONGER * size) for line in lines]
        self._begin = np.concatenate([line[:-1] for line in longer])
        self._end = np.concatenate([line[1:] for line in longer])
        near = np.asarray(KDTree(samples).query(samples, k=min(NEIGHBOURS + 1, len(samples)))[1])[:, 1:]
        a, b = np.repeat(np.arange(len(samples)), near.shape[1]), near.ravel()
        joined = ~self._separated(samples[a], samples[b])
        graph = coo_array((np.ones(joined.sum(), np.int8), (a[joined], b[joined])), shape=(len(samples), len(samples)))
        _, label = connected_components(graph, directed=False)
        _, first, part, count = np.unique(label, return_index=True, return_inverse=True, return_counts=True)
        kept = count[part] >= FEWEST
        self._samples, self._names = samples[kept], first[part][kept]
        self._tree = KDTree(self._samples)
        self._box = {
            int(name): (own.min(axis=0), np.maximum(np.ptp(own, axis=0), 1e-9))
            for name in np.unique(self._names)
            for own in [self._samples[self._names == name]]
        }

    def at(self, flat: NDArray) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
        """Names of the parts at places (n, 2) [m], shape (n,); places in their boxes, 0 to 1, shape (n, 2); distances
        from the nearest line [m], shape (n,)."""
        k = min(NEIGHBOURS, len(self._samples))
        near = np.asarray(self._tree.query(flat, k=k)[1]).reshape(len(flat), k)
        joined = np.stack([~self._separated(flat, self._samples[near[:, j]]) for j in range(k)], axis=1)
        name = self._names[near[np.arange(len(flat)), joined.argmax(axis=1)]]
        low, extent = (np.array([self._box[int(n)][j] for n in name]).reshape(-1, 2) for j in (0, 1))
        return name.astype(np.int64), np.clip((flat - low) / extent, 0.0, 1.0), self._distance(flat)

    def _separated(self, p: NDArray, q: NDArray) -> NDArray[np.bool_]:
        """Whether a line runs between places p and q, shape (n, 2) each."""
        a, b = self._begin[None], self._end[None]
        p, q = p[:, None], q[:, None]
        apart = (_side(a, b, p) > 0.0) != (_side(a, b, q) > 0.0)
        across = (_side(p, q, a) > 0.0) != (_side(p, q, b) > 0.0)
        return np.asarray((apart & across).any(axis=1))

    def _distance(self, flat: NDArray) -> NDArray[np.float64]:
        edge = self._end - self._begin
        length2 = np.maximum(np.sum(edge * edge, axis=1), 1e-18)
        t = np.clip(np.einsum("nex,ex->ne", flat[:, None] - self._begin, edge) / length2, 0.0, 1.0)
        feet = self._begin + t[:, :, None] * edge
        return np.sqrt(np.min(np.sum((flat[:, None] - feet) ** 2, axis=2), axis=1))


def _side(a: NDArray, b: NDArray, p: NDArray) -> NDArray[np.float64]:
    """Twice the signed area of the triangles a, b, p."""
    return np.asarray(
        (b[..., 0] - a[..., 0]) * (p[..., 1] - a[..., 1]) - (b[..., 1] - a[..., 1]) * (p[..., 0] - a[..., 0])
    )


def _longer(line: NDArray, more: float) -> NDArray[np.float64]:
    """A polyline (k, 2) that is longer at both ends."""
    ends = [(line[0], line[0] - line[1]), (line[-1], line[-1] - line[-2])]
    first, last = (end + more * way / max(float(np.linalg.norm(way)), 1e-12) for end, way in ends)
    return np.concatenate([[first], line, [last]])
