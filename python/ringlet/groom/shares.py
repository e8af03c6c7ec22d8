"""Shares of the scalp: the places from which hairs come to the strands of a section."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.groom import SECTION
from ringlet.groom.part_line import on_side
from ringlet.groom.scalp import Scalp, tangents
from ringlet.groom.sections import AREA, EDGE, Division

DIRECTIONS = 48
FIRST_JOIN, LAST_JOIN = 0.4, 1.5  # factor on where hair at the strand, and at the border of its share, joins it
LATEST = 0.97  # of joins, as a part of a row
HALVINGS = 9  # of a reach
FARTHEST = 1.5  # reach, in sizes of a section
NEAR_PART = 3.0  # distance of a lock from its part line up to which it fills its cell, in radii of its share
NEIGHBOURS, WIDEST = 24, 2.0  # of a cell: locks that may bound it; how far it reaches at most, in those radii
BEYOND = 3e-4, 0.1  # how far a place is from the nearest of the scalp, across the normal: [m], and per reach

# Curve attribute of locks: how far their share reaches from the root in directions around the normal [m], shape (count,
# DIRECTIONS), float32; 0 for locks of no section.
REACH = "reach"

# Curve attribute of locks: length from the root that lies on the scalp, along a row or as laid edges [m]; 0 for others.
# The ``REACH`` of rows is at even distances along them, first to the left (normal × tangent), then to the right.
LAID = "laid"
LEAVE = 0.008  # [m] before the end of what lies on the scalp over which its hold fades out in a shot


def reaches(
    division: Division, scalp: Scalp, triangle: NDArray[np.int32], barycentric: NDArray, section: NDArray
) -> NDArray[np.float32]:
    """``REACH`` of the strands of sections, for their roots, shape (n,), and sections, shape (n,), in order.

    All strands of a section take their hair from the whole of it, without the part line: it is gathered before
    it is divided. Were each to take what is nearest, skin would show between their hairs. The section should be
    star-shaped about the roots.
    """
    if not len(triangle):
        return np.zeros((0, DIRECTIONS), np.float32)
    roots, frames = _core.root_frames(scalp.points, scalp.triangles, triangle, barycentric)
    around = _directions(frames[:, :, 2], 2.0 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS)
    low, high = np.zeros((len(roots), DIRECTIONS)), np.full((len(roots), DIRECTIONS), FARTHEST * division.sections.size)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        has = _has(division, scalp, roots, around, middle, section)
        low, high = np.where(has, middle, low), np.where(has, high, middle)
    return low.astype(np.float32)


def _has(
    division: Division,
    scalp: Scalp,
    roots: NDArray,
    around: NDArray,
    reach: NDArray,
    section: NDArray,
) -> NDArray[np.bool_]:
    """Whether the places at a reach are in the shares of roots, shape (n, DIRECTIONS)."""
    wanted = (roots[:, None] + reach[:, :, None] * around).reshape(-1, 3)
    places, off = _on_scalp(scalp, wanted, np.repeat(_normals(around), DIRECTIONS, axis=0))
    at = division.at(places)
    own = np.repeat(section, DIRECTIONS)
    inside = (at[SECTION] == own) & (at[EDGE] >= 0.5 * division.sections.gap)
    return inside.reshape(reach.shape) & (off.reshape(reach.shape) <= BEYOND[0] + BEYOND[1] * reach)


def row_reaches(
    division: Division, scalp: Scalp, points: NDArray, normals: NDArray, section: int
) -> NDArray[np.float32]:
    """``REACH`` of the strands of a row with points (k, 3) [m], normals (k, 3) and a section, shape (DIRECTIONS,)."""
    half = DIRECTIONS // 2
    at = np.linspace(0, len(points) - 1, half).round().astype(np.int64)
    tangent = np.gradient(points, axis=0)[at]
    across = np.cross(normals[at], tangent)
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-12)
    around = np.concatenate([across, -across])
    roots, up = np.tile(points[at], (2, 1)), np.tile(normals[at], (2, 1))
    low, high = np.zeros(DIRECTIONS), np.full(DIRECTIONS, FARTHEST * division.sections.size)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        wanted = roots + middle[:, None] * around
        places, off = _on_scalp(scalp, wanted, up)
        at_places = division.at(places)
        has = (at_places[SECTION] == section) & (at_places[EDGE] >= 0.5 * division.sections.gap)
        has &= off <= BEYOND[0] + BEYOND[1] * middle
        low, high = np.where(has, middle, low), np.where(has, high, middle)
    return low.astype(np.float32)


def share_areas(locks: Curves) -> NDArray[np.float64]:
    """Areas whose hair the strands of sections carry [m²], shape (locks,); 0 for locks of no section.

    Part lines are bare since their hair is combed into the strands on both sides. Grooms of files without the
    attribute ``AREA`` have the areas of the shares alone.
    """
    if AREA in locks.curve:
        return np.asarray(locks.curve[AREA], np.float64)
    if REACH not in locks.curve:
        return np.zeros(len(locks))
    reach = locks.curve[REACH].astype(np.float64)
    areas = np.pi / DIRECTIONS * (reach**2).sum(axis=1)  # ∫ r²/2 dθ
    laid = locks.curve.get(LAID, np.zeros(len(locks)))
    for section in np.unique(locks.curve[SECTION][(reach.max(axis=1) > 0.0) & (laid > 0.0)]):
        strands = np.flatnonzero((locks.curve[SECTION] == section) & (laid > 0.0))
        row = locks.take(strands)
        middle = row.points.reshape(len(row), -1, 3).mean(axis=0)
        on_scalp = middle[: 1 + round(float((laid[strands] / row.lengths()).mean()) * (len(middle) - 1))]
        length = np.linalg.norm(np.diff(on_scalp, axis=0), axis=1).sum()
        areas[strands] = length * 2.0 * reach[strands].mean(axis=1) / len(strands)  # to both sides of the row
    return areas


@dataclass(frozen=True)
class Fed:
    """Where hairs of a row's strand grow, and where they join it.

    places: on the scalp but for its curvature [m], shape (n, 3)
    joins:  parts of the strand after which they join it, shape (n,)
    """

    places: NDArray[np.float64]
    joins: NDArray[np.float64]


def fed(
    lock: NDArray, middle: NDArray, scalp: _core.Solid, reach: NDArray, laid: float, feed: float, at: NDArray
) -> Fed:
    """Hairs that come to a strand (points, 3) of a row whose strands have the mean ``middle`` (points, 3) [m].

    scalp: the mesh of the scalp
    reach: ``REACH`` of the strand
    laid:  part of the strand that lies on the scalp
    feed:  part of the strand between where a hair grows and where it joins
    at:    numbers from 0 to 1 of each hair, shape (n, 2): along the row, and from it to the border of its section
    """
    along = laid * at[:, 0]
    joins = np.minimum(along + feed * gathered(at[:, 1]), LATEST * laid)
    foot, tangent = _on(middle, along)
    up = scalp.above(np.ascontiguousarray(foot))[2]
    across = np.cross(up, tangent)
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-12)
    side = np.sum((_on(lock, joins)[0] - _on(middle, joins)[0]) * across, axis=1)
    left = side >= 0.0
    k = along / max(laid, 1e-9) * (DIRECTIONS // 2 - 1)
    where = np.arange(DIRECTIONS // 2)
    far = np.where(left, np.interp(k, where, reach[: DIRECTIONS // 2]), np.interp(k, where, reach[DIRECTIONS // 2 :]))
    return Fed(foot + (np.where(left, 1.0, -1.0) * at[:, 1] * far)[:, None] * across, joins)


def gathered(far: NDArray) -> NDArray[np.float64]:
    """Factor on where hairs join a strand, for how far off it they grow, from 0 to 1 at the border, shape (n,).

    Hair near the strand joins it first, and hair from the part lines last, where the strands are together. Were all to
    join at one height, each share would stand as a tent, with skin between the tents of a section.
    """
    return FIRST_JOIN + (LAST_JOIN - FIRST_JOIN) * np.minimum(far, 1.0)


def _on(line: NDArray, t: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places on a line of evenly spaced points at parts of its length, and tangents there, shape (n, 3) each.

    Tangents are continuous along the line: that of an edge would jump at its ends, where rounding picks the edge.
    """
    at = np.clip(t, 0.0, 1.0) * (len(line) - 1)
    i = np.minimum(at.astype(np.int64), len(line) - 2)
    between = (at - i)[:, None]
    slopes = np.gradient(line.astype(np.float64), axis=0)
    places = line[i] + between * (line[i + 1] - line[i]).astype(np.float64)
    return places, (1.0 - between) * slopes[i] + between * slopes[i + 1]


def _on_scalp(scalp: Scalp, wanted: NDArray, normals: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The places of the scalp nearest to those wanted (n, 3) [m], and how far off they are across the normals."""
    triangle, barycentric, _ = _core.bind_roots(
        scalp.points, scalp.triangles, np.ascontiguousarray(wanted), scalp.region
    )
    places = scalp.positions(triangle, barycentric)
    return places, np.linalg.norm(np.cross(normals, places - wanted), axis=1)


def scattered(reach: NDArray[np.float32], roots: NDArray, normals: NDArray, disk: NDArray) -> NDArray[np.float64]:
    """Places of the unit disk, shape (n, 2), carried to shares so that areas keep their proportions [m], shape (n, 3).

    reach, roots, normals: of the lock of each place, shape (n, DIRECTIONS), (n, 3) and (n, 3)
    """
    x = tangents(normals)
    return roots + _carried(reach, disk, x, np.cross(normals, x))


def cells_at_part(
    roots: NDArray, frames: NDArray, to_part: NDArray, spread: NDArray, lock: NDArray, disk: NDArray
) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """Hairs of the locks next to a part line (n,), and their offsets from the root of their lock [m], shape (n, 3).

    They fill the cell of the lock, which is what is nearest to its root on its side of the line: disks around the roots
    leave bays along the line, or cross it.

    roots, frames, to_part, spread: of all locks, with ``TO_PART`` and the radius of what they cover [m]
    lock, disk:                     of all hairs: their lock, and their place in the unit disk
    """
    near = np.linalg.norm(to_part, axis=1) < NEAR_PART * spread
    hairs, of = np.flatnonzero(near[lock]), (np.cumsum(near) - 1)[lock[near[lock]]]
    count = min(NEIGHBOURS, len(roots) - 1)
    neighbours = np.asarray(KDTree(roots).query(roots[near], k=count + 1)[1]).reshape(-1, count + 1)[:, 1:]
    apart, own_part = roots[neighbours] - roots[near, None], to_part[near, None]
    border = np.where(on_side(apart, own_part)[:, :, None], 0.5 * apart, own_part)  # feet of the cell's sides
    border = np.concatenate([border, own_part], axis=1)
    x, y = frames[near, :, 0], frames[near, :, 1]
    angle = 2.0 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    around = np.cos(angle)[:, None] * x[:, None] + np.sin(angle)[:, None] * y[:, None]
    toward = np.maximum(np.einsum("ndx,nkx->ndk", around, border), 1e-12)
    reach = np.minimum((np.sum(border * border, axis=2)[:, None] / toward).min(axis=2), WIDEST * spread[near, None])
    return hairs, _carried(reach[of], disk[hairs], x[of], y[of])


def _carried(reach: NDArray, disk: NDArray, x: NDArray, y: NDArray) -> NDArray[np.float64]:
    """Offsets [m], shape (n, 3), of places of the unit disk, shape (n, 2), that is stretched to reaches (n, DIRECTIONS)
    in the plane of x and y, shape (n, 3) each; areas keep their proportions."""
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
    direction = np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * y
    return np.asarray((np.linalg.norm(disk, axis=1) * far)[:, None] * direction)


def _directions(normals: NDArray, angle: NDArray) -> NDArray[np.float64]:
    """Unit vectors around normals (n, 3) at angles (k,), shape (n, k, 3)."""
    x = tangents(normals)
    y = np.cross(normals, x)
    return np.cos(angle)[:, None] * x[:, None] + np.sin(angle)[:, None] * y[:, None]


def _normals(around: NDArray) -> NDArray[np.float64]:
    """Normals that unit vectors (n, DIRECTIONS, 3) are around, shape (n, 3)."""
    normals: NDArray[np.float64] = np.cross(around[:, 0], around[:, DIRECTIONS // 4])
    return normals
