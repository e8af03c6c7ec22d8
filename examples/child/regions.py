"""Segmentation of the skin into scalp, ears, face and neck, by triangle."""

from __future__ import annotations

import numpy as np
from distances import Array
from head_shape import EAR_CENTRE, ear_frame, ear_leaf, mirrored
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

NAMES = ("scalp", "face", "ear_left", "ear_right", "neck")
SKULL_CENTRE = np.array([0.0, 0.5, -1.2])

# Heights by the angle around the vertical axis: 0° is the front, 90° the ear, 180° the back.
_HAIRLINE = PchipInterpolator(  # forehead, corner, temple, sideburn, over the ear, behind it, nape
    np.radians([0, 15, 30, 42, 55, 66, 78, 85, 90, 97, 104, 110, 118, 130, 150, 165, 180]),
    [6.0, 6.05, 6.0, 5.3, 3.9, 2.6, 0.6, -0.3, 0.3, 1.2, 0.9, -0.8, -2.6, -4.0, -5.1, -5.4, -5.2],
)
_JAWLINE = PchipInterpolator(np.radians([0, 30, 60, 90, 110, 180]), [-8.7, -8.3, -7.2, -5.6, -4.4, -4.0])


def above_hairline(points: Array) -> Array:
    """Height above the hairline [cm], positive where hair grows, shape (n,); not valid on ears."""
    p = mirrored(points) - SKULL_CENTRE
    return points[:, 1] - _HAIRLINE(np.arctan2(p[:, 0], p[:, 2]))


def label(points: Array, triangles: NDArray) -> NDArray:
    """Index into ``NAMES`` of each triangle, shape (m,); every region is connected."""
    p = mirrored(points[triangles].mean(axis=1))
    around = np.arctan2(p[:, 0], p[:, 2] - SKULL_CENTRE[2])
    is_ear = (ear_leaf(ear_frame(p)) < 0.2) & (p[:, 0] > EAR_CENTRE[0] - 0.7)
    side = np.where(points[triangles, 0].mean(axis=1) > 0, NAMES.index("ear_left"), NAMES.index("ear_right"))
    labels = np.where(p[:, 1] > _JAWLINE(around), NAMES.index("face"), NAMES.index("neck"))
    labels = np.where(above_hairline(p) > 0, NAMES.index("scalp"), labels)
    return without_islands(np.where(is_ear, side, labels), triangles)


def without_islands(labels: NDArray, triangles: NDArray) -> NDArray:
    """Reassigns isolated triangles to the surrounding region, so that every region is its largest component."""
    neighbours = facing(triangles)
    labels = labels.copy()
    for _ in range(100):
        same = labels[neighbours[:, 0]] == labels[neighbours[:, 1]]
        inside = neighbours[same]
        graph = csr_matrix((np.ones(len(inside)), inside.T), shape=(len(triangles),) * 2)
        piece = connected_components(graph, directed=False)[1]
        size = np.bincount(piece)
        largest = {int(piece[labels == k][np.argmax(size[piece[labels == k]])]) for k in np.unique(labels)}
        stray = ~np.isin(piece, list(largest))
        votes = np.zeros((len(triangles), len(NAMES)), int)
        for a, b in (neighbours.T, neighbours.T[::-1]):
            np.add.at(votes, (a[~stray[b]], labels[b[~stray[b]]]), 1)
        # A triangle with two neighbours in another region makes the border jagged, and is reassigned too.
        own = votes[np.arange(len(labels)), labels]
        change = (stray & (votes.max(axis=1) > 0)) | (~stray & (own <= 1) & (votes.max(axis=1) >= 2))
        if not change.any():
            break
        labels[change] = votes[change].argmax(axis=1)
    return labels


def facing(triangles: NDArray) -> NDArray:
    """Pairs of triangles that share an edge, shape (e, 2)."""
    halves = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    return np.lexsort(halves.T).reshape(-1, 2) // 3
