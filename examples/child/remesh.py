"""Isotropic remeshing of an implicit surface with a target edge length that varies in space.

Marching cubes extracts the surface. Then edges are split, collapsed and flipped and vertices relaxed repeatedly, after
Botsch and Kobbelt, "A Remeshing Approach to Multiresolution Modeling" (SGP 2004). Relaxed vertices are projected to the
implicit surface. Independent edits are applied at once, on whole arrays.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from distances import Array, Shape, project
from numpy.typing import NDArray
from scipy.ndimage import zoom
from scipy.sparse import csr_matrix
from skimage.measure import marching_cubes

Triangles = NDArray[np.int32]
SizeField = Callable[[Array], Array]


def mesh_shape(shape: Shape, low: Array, high: Array, cell: float, size: SizeField) -> tuple[Array, Triangles]:
    """Meshes the surface inside a box: points and outward triangles with edges of about the length ``size(points)``."""
    points, triangles = polygonise(shape, low, high, cell)
    points = project(shape, points)
    for _ in range(6):
        points, triangles = split_long(points, triangles, size)
        points, triangles = collapse_short(points, triangles, size)
        triangles = flip(points, triangles)
        points = project(shape, relax(points, triangles, size), steps=2)
    for _ in range(4):
        triangles = flip(points, triangles)
        points = project(shape, relax(points, triangles, size))
    return points, triangles


def polygonise(shape: Shape, low: Array, high: Array, cell: float) -> tuple[Array, Triangles]:
    """Marching cubes on a grid that is evaluated coarsely first, and finely near the surface."""
    coarse, ratio = 4.0 * cell, 4
    counts = np.ceil((high - low) / coarse).astype(int) + 1
    corners = low + coarse * np.argwhere(np.ones(counts, bool))
    values = shape(corners).reshape(counts)
    values = zoom(values, (ratio * (counts - 1) + 1) / counts, order=1)
    near = np.abs(values) < 1.5 * coarse
    values[near] = shape(low + cell * np.argwhere(near))
    points, triangles, _, _ = marching_cubes(values, 0.0, spacing=(cell,) * 3, gradient_direction="descent")
    return low + points.astype(np.float64), triangles.astype(np.int32)


def edges_of(triangles: Triangles) -> tuple[NDArray, NDArray]:
    """Edges as sorted vertex pairs, shape (e, 2), and the two half-edges of each, shape (e, 2).

    Half-edge 3t + k runs from corner k to corner k + 1 of triangle t. The mesh is closed, so each edge has two.
    """
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    low, high = np.minimum(start, end), np.maximum(start, end)
    order = np.sort(np.argsort(low.astype(np.int64) * (triangles.max() + 1) + high).reshape(-1, 2), axis=1)
    return np.stack([low, high], axis=1)[order[:, 0]], order


def claimed(claims: list[NDArray], count: int) -> NDArray:
    """Rows that own all items that they claim, with priority of earlier rows; shape (rows,), bool."""
    rows = np.arange(len(claims[0]))
    owner = np.full(count, len(rows))
    for claim in claims:
        np.minimum.at(owner, claim, rows)
    return np.all([owner[claim] == rows for claim in claims], axis=0)


def relative_length(points: Array, edges: NDArray, size: SizeField) -> Array:
    """Length of each edge relative to the target length at its midpoint, shape (e,)."""
    a, b = points[edges[:, 0]], points[edges[:, 1]]
    return np.linalg.norm(b - a, axis=1) / size(0.5 * (a + b))


def split_long(points: Array, triangles: Triangles, size: SizeField) -> tuple[Array, Triangles]:
    """Splits edges longer than 4/3 of the target length, the longest first, until none is left."""
    while True:
        edges, halves = edges_of(triangles)
        length = relative_length(points, edges, size)
        long = np.flatnonzero(length > 4.0 / 3.0)
        long = long[np.argsort(-length[long], kind="stable")]
        if len(long) == 0:
            return points, triangles
        long = long[claimed([halves[long, 0] // 3, halves[long, 1] // 3], len(triangles))]
        middle = len(points) + np.arange(len(long), dtype=np.int32)
        points = np.concatenate([points, points[edges[long]].mean(axis=1)])
        added = []
        for half in halves[long].T:
            face, corner = half // 3, half % 3
            second = triangles[face].copy()
            second[np.arange(len(face)), corner] = middle
            triangles[face, (corner + 1) % 3] = middle
            added.append(second)
        triangles = np.concatenate([triangles, *added])


def collapse_short(points: Array, triangles: Triangles, size: SizeField) -> tuple[Array, Triangles]:
    """Collapses edges shorter than 4/5 of the target length, unless the mesh would degenerate, until none is left."""
    shuffle = np.random.default_rng(0).permutation  # a random order allows many collapses at once
    while True:
        edges, _ = edges_of(triangles)
        length = relative_length(points, edges, size)
        short = shuffle(np.flatnonzero(length < 0.8))
        link = adjacency(edges, len(points))
        shared = link[edges[short, 0]].multiply(link[edges[short, 1]]).sum(axis=1)
        short = short[np.asarray(shared).ravel() == 2]
        short = short[independent(link, edges[short])]
        middle = points[edges[short]].mean(axis=1)
        moved = points.copy()
        moved[edges[short, 0]] = moved[edges[short, 1]] = middle
        inverted = inverted_vertices(points, moved, triangles)
        short = short[~inverted[edges[short]].any(axis=1)]
        if len(short) == 0:
            return points, triangles
        keep, removed = edges[short].T
        points[keep] = points[edges[short]].mean(axis=1)
        target = np.arange(len(points), dtype=np.int32)
        target[removed] = keep
        triangles = target[triangles]
        triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
        used, inverse = np.unique(triangles, return_inverse=True)
        points, triangles = points[used], inverse.reshape(-1, 3).astype(np.int32)


def adjacency(edges: NDArray, count: int) -> csr_matrix:
    ones = np.ones(2 * len(edges), dtype=np.int32)
    return csr_matrix((ones, (edges.ravel(), edges[:, ::-1].ravel())), shape=(count, count))


def independent(link: csr_matrix, edges: NDArray) -> NDArray:
    """Edges whose neighbourhoods share no vertex with those of earlier chosen edges; shape (e,), bool."""
    rank = np.full(link.shape[0], len(edges))
    np.minimum.at(rank, edges, np.arange(len(edges))[:, None])
    for _ in range(2):
        neighbours = np.minimum.reduceat(rank[link.indices], link.indptr[:-1])
        rank = np.minimum(rank, neighbours)
    return (rank[edges] == np.arange(len(edges))[:, None]).all(axis=1)


def face_normals(points: Array, triangles: Triangles) -> Array:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def inverted_vertices(points: Array, moved: Array, triangles: Triangles) -> NDArray:
    """Vertices of triangles that a displacement would invert; shape (n,), bool."""
    before, after = face_normals(points, triangles), face_normals(moved, triangles)
    lengths = np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
    new_normals = ((before * after).sum(1) < 0.5 * lengths) & (np.linalg.norm(after, axis=1) > 1e-12)
    inverted = np.zeros(len(points), bool)
    inverted[triangles[new_normals]] = True
    return inverted


def flip(points: Array, triangles: Triangles) -> Triangles:
    """Flips edges whose opposite angles sum to more than π (Delaunay), unless this would fold the surface."""
    for _ in range(10):
        edges, halves = edges_of(triangles)
        (f0, k0), (f1, k1) = (divmod(halves[:, s], 3) for s in (0, 1))
        a, b = triangles[f0, k0], triangles[f0, (k0 + 1) % 3]
        c, d = triangles[f0, (k0 + 2) % 3], triangles[f1, (k1 + 2) % 3]
        opposite_angles = angle(points, a, c, b) + angle(points, a, d, b)
        new = np.stack([np.stack([c, a, d], 1), np.stack([d, b, c], 1)], axis=1)  # (edges, 2, 3)
        old = face_normals(points, triangles)
        normal_sum = old[f0] + old[f1]
        new_normals = np.stack([face_normals(points, new[:, s]) for s in (0, 1)], axis=1)
        alignment = np.einsum("esx,ex->es", new_normals, normal_sum)
        alignment /= np.linalg.norm(new_normals, axis=-1) * np.linalg.norm(normal_sum, axis=-1, keepdims=True) + 1e-300
        flat = (old[f0] * old[f1]).sum(1) > 0.5 * np.linalg.norm(old[f0], axis=1) * np.linalg.norm(old[f1], axis=1)
        link = adjacency(edges, len(points))
        is_new_edge = np.asarray(link[c, d]).ravel() == 0
        flipped = np.flatnonzero((opposite_angles > np.pi + 1e-3) & (alignment > 0.5).all(axis=1) & flat & is_new_edge)
        flipped = flipped[np.argsort(-opposite_angles[flipped], kind="stable")]
        flipped = flipped[claimed([a[flipped], b[flipped], c[flipped], d[flipped]], len(points))]
        if len(flipped) == 0:
            break
        triangles = triangles.copy()
        triangles[f0[flipped]], triangles[f1[flipped]] = new[flipped, 0], new[flipped, 1]
    return triangles


def angle(points: Array, a: NDArray, at: NDArray, b: NDArray) -> Array:
    u, v = points[a] - points[at], points[b] - points[at]
    return np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(1))


def relax(points: Array, triangles: Triangles, size: SizeField) -> Array:
    """Relaxes vertices tangentially to the mean of their triangles, weighted by the target size."""
    doubled = face_normals(points, triangles)
    centres = points[triangles].mean(axis=1)
    weight = np.linalg.norm(doubled, axis=1) / size(centres) ** 2
    total, middle, normal = np.zeros(len(points)), np.zeros_like(points), np.zeros_like(points)
    for k in range(3):
        np.add.at(total, triangles[:, k], weight)
        np.add.at(middle, triangles[:, k], weight[:, None] * centres)
        np.add.at(normal, triangles[:, k], doubled)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    move = middle / total[:, None] - points
    moved = points + 0.7 * (move - (move * normal).sum(1, keepdims=True) * normal)
    return np.where(inverted_vertices(points, moved, triangles)[:, None], points, moved)
