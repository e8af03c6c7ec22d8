"""Shares of the scalp: the places from which hairs come to the strands of a section."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.groom.scalp import Scalp, tangents
from ringlet.groom.sections import EDGE, SECTION, Division

DIRECTIONS = 48
HALVINGS = 9  # of a reach
FARTHEST = 1.5  # reach, in sizes of a section
BEYOND = 3e-4, 0.1  # how far a place is from the nearest of the scalp, across the normal: [m], and per reach

# Curve attribute of locks: how far their share reaches from the root in directions around the normal [m], shape (count,
# DIRECTIONS), float32; 0 for locks of no section.
REACH = "reach"


def reaches(
    division: Division, scalp: Scalp, triangle: NDArray[np.int32], barycentric: NDArray, section: NDArray
) -> NDArray[np.float32]:
    """``REACH`` of the strands of sections, for their roots, shape (n,), and sections, shape (n,), in order.

    The share of a strand is the part of its section, without the parting, that is nearest to its root. It should be
    star-shaped about the root.
    """
    if not len(triangle):
        return np.zeros((0, DIRECTIONS), np.float32)
    roots, frames = _core.root_frames(scalp.points, scalp.triangles, triangle, barycentric)
    around = _directions(frames[:, :, 2], 2.0 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS)
    strands = roots.reshape(len(np.unique(section)), -1, 3)
    low, high = np.zeros((len(roots), DIRECTIONS)), np.full((len(roots), DIRECTIONS), FARTHEST * division.sections.size)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        has = _has(division, scalp, roots, around, middle, section, strands)
        low, high = np.where(has, middle, low), np.where(has, high, middle)
    return low.astype(np.float32)


def _has(
    division: Division,
    scalp: Scalp,
    roots: NDArray,
    around: NDArray,
    reach: NDArray,
    section: NDArray,
    strands: NDArray,
) -> NDArray[np.bool_]:
    """Whether the places at a reach are in the shares of roots, shape (n, DIRECTIONS)."""
    wanted = (roots[:, None] + reach[:, :, None] * around).reshape(-1, 3)
    triangle, barycentric, _ = _core.bind_roots(scalp.points, scalp.triangles, wanted, scalp.region)
    places = scalp.positions(triangle, barycentric)
    off = np.linalg.norm(np.cross(np.repeat(_normals(around), DIRECTIONS, axis=0), places - wanted), axis=1)
    at = division.at(places)
    own = np.repeat(section, DIRECTIONS)
    count = strands.shape[1]
    of_section = np.repeat(np.arange(len(strands)), count * DIRECTIONS)
    nearest = np.linalg.norm(strands[of_section] - places[:, None], axis=2).argmin(axis=1)
    inside = (at[SECTION] == own) & (at[EDGE] >= 0.5 * division.sections.gap)
    inside &= nearest == np.tile(np.repeat(np.arange(count), DIRECTIONS), len(strands))
    return inside.reshape(reach.shape) & (off.reshape(reach.shape) <= BEYOND[0] + BEYOND[1] * reach)


def scattered(reach: NDArray[np.float32], roots: NDArray, normals: NDArray, disk: NDArray) -> NDArray[np.float64]:
    """Places of the unit disk, shape (n, 2), carried to shares so that areas keep their proportions [m], shape (n, 3).

    reach, roots, normals: of the lock of each place, shape (n, DIRECTIONS), (n, 3) and (n, 3)
    """
    square = reach.astype(np.float64) ** 2
    share = np.cumsum(0.5 * (square + np.roll(square, -1, axis=1)), axis=1)
    share /= np.maximum(share[:, -1:], 1e-18)
    wanted = (np.arctan2(disk[:, 1], disk[:, 0]) / (2.0 * np.pi)) % 1.0
    rows = np.arange(len(disk))
    k = np.minimum((share <= wanted[:, None]).sum(axis=1), DIRECTIONS - 1)
    before = np.where(k > 0, share[rows, k - 1], 0.0)
    t = np.clip((wanted - before) / np.maximum(share[rows, k] - before, 1e-18), 0.0, 1.0)
    far = (1.0 - t) * reach[rows, k] + t * reach[rows, (k + 1) % DIRECTIONS]
    angle = 2.0 * np.pi * (k + t) / DIRECTIONS
    x, y = tangents(normals), np.cross(normals, tangents(normals))
    direction = np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * y
    return roots + (np.linalg.norm(disk, axis=1) * far)[:, None] * direction


def _directions(normals: NDArray, angle: NDArray) -> NDArray[np.float64]:
    """Unit vectors around normals (n, 3) at angles (k,), shape (n, k, 3)."""
    x = tangents(normals)
    y = np.cross(normals, x)
    return np.cos(angle)[:, None] * x[:, None] + np.sin(angle)[:, None] * y[:, None]


def _normals(around: NDArray) -> NDArray[np.float64]:
    """Normals that unit vectors (n, DIRECTIONS, 3) are around, shape (n, 3)."""
    normals: NDArray[np.float64] = np.cross(around[:, 0], around[:, DIRECTIONS // 4])
    return normals
