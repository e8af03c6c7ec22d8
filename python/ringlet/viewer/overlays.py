"""What the page can lay over the hair: a byte for each point of the locks."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.mesh import Mesh
from ringlet.sim.motion import Motion

Bytes = NDArray[np.uint8]

STRETCH_SHOWN = 0.02  # from this part shorter to this part longer
DEPTH_SHOWN = 2e-3  # [m] in the head
TURNING_SHOWN = 0.2  # [rad] over a window; where a lock turns less than this there is no curl to be lost
WINDOW = 6  # points to either side over which a curl's turning is added up: about one curl
POINTS_ROOTED = 2  # points of a lock that may be in the head, since it is rooted there
TOLERANCE = 1e-5  # [m] less than this in the head is on it
AT_ONCE = 8192  # points that are measured before somebody else is let in


def as_bytes(values: NDArray) -> Bytes:
    """Numbers from 0 to 1 as bytes."""
    return np.rint(255.0 * np.clip(values, 0.0, 1.0)).astype(np.uint8)


def stretch(locks: Curves, points: NDArray) -> Bytes:
    """How far each point's edge is stretched against the groom: shorter below the middle, longer above it."""
    now, rest = (_lengths(np.diff(np.asarray(p, np.float64), axis=0)) for p in (points, locks.points))
    change = np.zeros(len(locks.points))
    change[:-1] = now / np.maximum(rest, 1e-12) - 1.0
    tips = locks.offsets[1:] - 1
    change[tips] = change[tips - 1]
    return as_bytes(0.5 + 0.5 * change / STRETCH_SHOWN)


def _lengths(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.sqrt(np.einsum("nx,nx->n", vectors, vectors))  # a third of the time of np.linalg.norm


def turning(locks: Curves, points: NDArray) -> NDArray[np.float64]:
    """The angle by which locks turn within a window around each point [rad], shape (n,)."""
    edges = np.diff(np.asarray(points, np.float64), axis=0)
    edges /= np.maximum(_lengths(edges), 1e-12)[:, None]
    angle = np.zeros(len(points))
    angle[1:-1] = np.arccos(np.clip(np.einsum("nx,nx->n", edges[:-1], edges[1:]), -1.0, 1.0))
    first = np.repeat(locks.offsets[:-1], locks.counts)
    last = np.repeat(locks.offsets[1:], locks.counts) - 1
    angle[locks.offsets[:-1]] = angle[locks.offsets[1:] - 1] = 0.0
    run = np.concatenate([[0.0], np.cumsum(angle)])
    here = np.arange(len(points))
    return run[np.minimum(here + WINDOW, last) + 1] - run[np.maximum(here - WINDOW, first)]


def curl_loss(locks: Curves, groomed: NDArray[np.float64], points: NDArray) -> Bytes:
    """The part of its turning that a lock has lost around each point. groomed: ``turning`` of the groom."""
    left = turning(locks, points) / np.maximum(groomed, TURNING_SHOWN)
    return as_bytes(np.where(groomed > TURNING_SHOWN, 1.0 - left, 0.0))


def contact(motion: Motion) -> Bytes:
    """How hard each point is pushed, against the weight of a lock: a force as large as that is the middle."""
    count = len(motion.strands.positions)
    if motion.scene is None:
        return np.empty(0, np.uint8)
    vertices, values = motion.scene.contacts
    weight = 9.81 * float(np.sum(motion.strands.masses)) / max(1, len(motion.locks))
    share = np.abs(values[:, :4]) * values[:, 8:9]
    of_locks = vertices < count
    force = np.bincount(vertices[of_locks], weights=share[of_locks], minlength=count)
    return as_bytes(force / (force + weight))


def depths(scalp: Mesh, corners: NDArray, locks: Curves, points: NDArray) -> Iterator[NDArray[np.float64]]:
    """How deep points of locks are in the head [m], some of them at a time; all together shape (n,).

    corners: where the points of the head are [m]
    """
    triangles = np.ascontiguousarray(scalp.triangles, np.int32)
    solid = _core.Solid(np.ascontiguousarray(corners, np.float64), triangles)
    number = np.arange(len(points)) - np.repeat(locks.offsets[:-1], locks.counts)
    low, high = corners.min(axis=0), corners.max(axis=0)
    for start in range(0, len(points), AT_ONCE):
        here = np.asarray(points[start : start + AT_ONCE], np.float64)
        depth = np.zeros(len(here))
        free = number[start : start + AT_ONCE] >= POINTS_ROOTED
        near = np.flatnonzero(free & ((here > low) & (here < high)).all(axis=1))
        if near.size:
            depth[near] = np.maximum(-solid.above(here[near])[0] - TOLERANCE, 0.0)
        yield depth
