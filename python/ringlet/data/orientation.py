"""Orientation of surfaces: which triangles face the inside of what they enclose."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

SMALL = 0.25  # area of the openings of a surface, relative to its own, up to which it has an inside
THIN = 1e-6  # volume, relative to area^1.5, up to which a surface encloses nothing
PLACES = 16  # of a head, which say whether a surface is around it

Array = NDArray[np.float64]


def facing_inside(points: NDArray, triangles: NDArray, head: NDArray | None = None) -> NDArray[np.bool_]:
    """Mask of the triangles that face the inside of a closed surface, or of one with small openings, shape (m,).

    A connected surface has two consistent orientations, and outwards is the one in which it encloses a positive volume.
    Both are found as the connected parts of its double cover: each triangle, as it is wound and turned over, is joined
    to its neighbours as they agree with it. Openings are closed by fans. An open sheet and a Möbius strip have no
    inside.

    head: points of a head [m], shape (k, 3). A surface around it that faces it is a room, and stays as it is
    """
    count, places = len(triangles), np.asarray(points, np.float64)
    if not count:
        return np.zeros(0, np.bool_)
    places = places - places.mean(axis=0)
    corners = _names(places)[triangles]
    sides = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    owner = np.tile(np.arange(count), 3)
    low, high = np.sort(sides.astype(np.int64), axis=1).T
    _, edge, uses = np.unique(low * len(places) + high, return_inverse=True, return_counts=True)
    order = np.argsort(edge, kind="stable")
    first, second = order[uses[edge[order]] == 2].reshape(-1, 2).T
    a, b = owner[first], owner[second]
    agree = sides[first, 0] != sides[second, 0]  # a side runs one way in one triangle, and the other way in the other
    label = _connected(
        np.concatenate([a, a + count]),
        np.concatenate([np.where(agree, b, b + count), np.where(agree, b + count, b)]),
        2 * count,
    )

    volume, area = _enclosed(*places[triangles].transpose(1, 0, 2))
    open_side = uses[edge] == 1
    cap_volume, cap_area = _caps(places, ends[open_side], sides[open_side])
    of = owner[open_side]
    volumes = np.bincount(label, np.concatenate([volume, -volume])) + np.bincount(
        np.concatenate([label[of], label[of + count]]), np.concatenate([cap_volume, -cap_volume]), label.max() + 1
    )
    areas = np.bincount(label, np.tile(area, 2))
    open_areas = np.bincount(np.concatenate([label[of], label[of + count]]), np.tile(cap_area, 2), label.max() + 1)
    inward = (volumes < -THIN * areas**1.5) & (open_areas <= SMALL * areas)
    found = inward[label[:count]]
    if head is None or not found.any():
        return found
    inside = np.asarray(head, np.float64)[:: max(1, len(head) // PLACES)] - np.asarray(points, np.float64).mean(axis=0)
    for one in np.unique(label[:count][found]):
        own = label[:count] == one
        if np.median(winding_numbers(inside, places[triangles[own]])) < -0.5:
            found[own] = False
    return found


def outward(points: NDArray, triangles: NDArray, head: NDArray | None = None) -> NDArray[np.int32]:
    """Triangles with those that face the inside turned over, contiguous, shape (m, 3); see ``facing_inside``."""
    turned = facing_inside(points, triangles, head)[:, None]
    return np.ascontiguousarray(np.where(turned, triangles[:, ::-1], triangles), np.int32)


def winding_numbers(points: Array, corners: Array) -> Array:
    """Winding numbers of triangles (m, 3, 3) about points, shape (n,): Σ Ω / 4π (Jacobson et al. 2013, eq. 5)."""
    numbers = np.empty(len(points))
    for k, point in enumerate(points):
        a, b, c = (corners[:, i] - point for i in range(3))
        la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
        volume = np.einsum("ni,ni->n", a, np.cross(b, c))
        dots = (np.einsum("ni,ni->n", u, v) * w for u, v, w in ((a, b, lc), (b, c, la), (c, a, lb)))
        numbers[k] = 2.0 * np.arctan2(volume, la * lb * lc + sum(dots)).sum() / (4.0 * np.pi)
    return numbers


def _names(places: Array) -> NDArray[np.int64]:
    """A number for each point, the same for those at one place, as along seams; shape (n,)."""
    order = np.lexsort(places.T)
    new = (np.diff(places[order], axis=0) != 0.0).any(axis=1)
    names = np.empty(len(places), np.int64)
    names[order] = np.concatenate([[0], np.cumsum(new)])
    return names


def _caps(places: Array, ends: NDArray, sides: NDArray) -> tuple[Array, Array]:
    """Volumes and areas of fans over openings, a triangle for each open side of the surface, shape (k,) each.

    ends, sides: points of the open sides, and the same with those at one place as one, shape (k, 2) each
    """
    if not len(ends):
        return np.zeros(0), np.zeros(0)
    names, rim = np.unique(sides, return_inverse=True)
    rim = rim.reshape(-1, 2)
    loop = _connected(rim[:, 0], rim[:, 1], len(names))[rim[:, 0]]
    start, end = places[ends[:, 0]], places[ends[:, 1]]
    length = np.maximum(np.linalg.norm(end - start, axis=1), 1e-12)
    middle = np.stack([np.bincount(loop, length * x) for x in (0.5 * (start + end)).T], axis=1)
    middle /= np.maximum(np.bincount(loop, length), 1e-12)[:, None]
    return _enclosed(middle[loop], end, start)


def _enclosed(a: Array, b: Array, c: Array) -> tuple[Array, Array]:
    """Volumes of the tetrahedra of triangles and the origin, positive where these face away, and areas, shape (k,)."""
    across = np.cross(b - a, c - a)
    return np.einsum("ni,ni->n", a, across) / 6.0, 0.5 * np.linalg.norm(across, axis=1)


def _connected(rows: NDArray, columns: NDArray, count: int) -> NDArray[np.int32]:
    """Number of the connected part of each node of a graph, shape (count,)."""
    graph = coo_array((np.ones(len(rows), np.int8), (rows, columns)), (count, count))
    return connected_components(graph, directed=False)[1]
