"""Curves that keep the lengths of their edges on paths of other lengths."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

Array = NDArray[np.float64]

TOLERANCE = 1e-3  # relative error of the length of an edge, which is then scaled
ITERATIONS = 20
MOST_CHANGE = 0.5  # of the length of an edge in one iteration
LEAST_LENGTH = 1e-12  # of an edge that has a direction [m]


def along_paths(paths: Array, offsets: NDArray[np.integer], lengths: Array) -> Array:
    """Points (n, 3) of curves whose edges have these lengths, on paths through as many points [m].

    paths:   root first; roots stay. A curve that is longer than its path goes straight on at its end
    lengths: of the edge that begins at each point, shape (n,); 0 at the last of a curve

    Points go to their arc lengths on the path. Where it is not straight they are then nearer to each other than that:
    fast projection (Goldenthal et al. 2007) moves them the least until each edge has its length.
    """
    first = np.repeat(offsets[:-1], np.diff(offsets))
    is_root, is_edge = np.arange(len(paths)) == first, np.ones(len(paths), bool)
    is_edge[offsets[1:] - 1] = False
    x = _at_lengths(paths, offsets, first, _starts(lengths[:, None])[:, 0])
    for _ in range(ITERATIONS):
        along, now = _edges(x, is_edge)
        excess = np.where(is_edge, np.clip(now - lengths, -MOST_CHANGE * lengths, MOST_CHANGE * now), 0.0)
        if not (np.abs(excess) > TOLERANCE * lengths).any():
            break
        # The tensions λ of all edges solve J Jᵀ λ = C, with C = |d| − l and J = ∂C/∂x; points move by −Jᵀ λ.
        banded = np.zeros((2, len(x)))
        banded[0, 1:] = -np.einsum("ni,ni->n", along[:-1], along[1:])
        banded[1] = np.where(is_edge, 2.0 - is_root, 1.0)
        pull = solveh_banded(banded, excess, check_finite=False)[:, None] * along
        pull[1:] -= pull[:-1].copy()
        x += np.where(is_root[:, None], 0.0, pull)
    run = _starts(lengths[:, None] * _edges(x, is_edge)[0])
    return x[first] + run - run[first]


def _at_lengths(paths: Array, offsets: NDArray[np.integer], first: NDArray, run: Array) -> Array:
    """The points at arc lengths ``run`` [m] on paths, both counted on through all curves."""
    edges = np.diff(paths, axis=0, append=paths[-1:])
    edges[offsets[1:] - 1] = 0.0
    length = np.linalg.norm(edges, axis=1)
    at = _starts(length[:, None])[:, 0]
    target = at[first] + run - run[first]
    last = np.repeat(offsets[1:] - 2, np.diff(offsets))
    edge = np.clip(np.searchsorted(at, target, side="right") - 1, first, last)
    return paths[edge] + ((target - at[edge]) / np.maximum(length[edge], LEAST_LENGTH))[:, None] * edges[edge]


def _edges(points: Array, is_edge: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Directions and lengths of the edges that begin at points; 0 where none does."""
    edges = np.where(is_edge[:, None], np.diff(points, axis=0, append=points[-1:]), 0.0)
    length = np.linalg.norm(edges, axis=1)
    return edges / np.maximum(length, LEAST_LENGTH)[:, None], length


def _starts(steps: Array) -> Array:
    """Sums of the rows before each row."""
    return np.cumsum(steps, axis=0) - steps
