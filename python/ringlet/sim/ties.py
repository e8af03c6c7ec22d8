"""Ties: bands that hold the locks of a section together, as at the end of a braid."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.groom import SECTION, TIED
from ringlet.sim.strands import Strands


@dataclass(frozen=True)
class Ties:
    """Springs between vertices of strands, which pull and push.

    vertices:  the two of each, shape (k, 2)
    lengths:   their distances at rest [m], shape (k,)
    stiffness: spring constants [N/m], shape (k,)
    """

    vertices: NDArray[np.int32]
    lengths: NDArray[np.float64]
    stiffness: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.vertices)


def section_ties(locks: Curves, strands: Strands) -> Ties | None:
    """Ties every two locks of a section along the band that ties it; None where nothing is tied.

    Across the band and diagonally, so that the locks neither part nor slide along one another. Each is as stiff as the
    softer of both locks against stretch, at the length it has in the groom.
    """
    if TIED not in locks.point or SECTION not in locks.curve:
        return None
    pairs: list[tuple[int, int]] = []
    bands = [locks.offsets[row] + np.flatnonzero(_of(locks, row) > 0.5) for row in range(len(locks))]
    tied = np.array([len(band) > 0 for band in bands])
    for section in np.unique(locks.curve[SECTION][tied]):
        for a, b in combinations(np.flatnonzero(tied & (locks.curve[SECTION] == section)), 2):
            one, other = bands[a], bands[b]
            pairs += [*zip(one, other, strict=False), *zip(one, other[1:], strict=False)]
            pairs += zip(one[1:], other, strict=False)
    if not pairs:
        return None
    vertices = np.array(pairs, np.int32)
    points = np.asarray(locks.points, np.float64)
    stretch, _, _ = strands.stiffness
    before = np.maximum(vertices - 1, 0)  # the edge that ends at a vertex
    return Ties(
        vertices,
        np.linalg.norm(points[vertices[:, 0]] - points[vertices[:, 1]], axis=1),
        np.asarray(stretch[before].min(axis=1), np.float64),
    )


def _of(locks: Curves, row: int) -> NDArray:
    return np.asarray(locks.point[TIED][locks.offsets[row] : locks.offsets[row + 1]])
