"""Segmentation of the skin into scalp, ears, face and neck, by triangle."""

from __future__ import annotations

import numpy as np
from anatomy import Head, mirrored
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

NAMES = ("scalp", "face", "ear_left", "ear_right", "neck")


def label(head: Head, points: NDArray, triangles: NDArray) -> NDArray:
    """Index into ``NAMES`` of each triangle, shape (m,); every region is connected."""
    p = mirrored(points[triangles].mean(axis=1))
    around = np.arctan2(p[:, 0], p[:, 2] - head.skull[2])
    side = np.where(points[triangles, 0].mean(axis=1) > 0, NAMES.index("ear_left"), NAMES.index("ear_right"))
    labels = np.where(p[:, 1] > head.jawline(around), NAMES.index("face"), NAMES.index("neck"))
    labels = np.where(head.above_hairline(p) > 0, NAMES.index("scalp"), labels)
    return without_islands(np.where(head.ear.contains(p), side, labels), triangles)


def patches(head: Head, points: NDArray, triangles: NDArray) -> dict[str, NDArray[np.int32]]:
    """Triangles of the further regions of a head, such as its brows, by name."""
    p = mirrored(points[triangles].mean(axis=1))
    return {name: np.flatnonzero(inside(p)).astype(np.int32) for name, inside in head.patches.items()}


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
