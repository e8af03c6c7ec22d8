"""Overlays on the hair: one byte for each point of the locks."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.mesh import Mesh
from ringlet.sim.motion import Motion

Bytes = NDArray[np.uint8]

STRETCH_SHOWN = 0.02  # strain at the ends of the colour scale
DEPTH_SHOWN = 2e-3  # [m] depth in the head at the end of the colour scale
TURNING_SHOWN = 0.2  # [rad] turning within a window below which a lock counts as straight
WINDOW = 6  # points to either side in which the turning of a curl is summed: about one curl
POINTS_ROOTED = 2  # points at the root of a lock that may lie in the head
TOLERANCE = 1e-5  # [m] depths up to this value count as on the surface
CHUNK = 8192  # points that are measured between two checks for newer work


def as_bytes(values: NDArray) -> Bytes:
    """Numbers in [0, 1] as bytes."""
    return np.rint(255.0 * np.clip(values, 0.0, 1.0)).astype(np.uint8)


def stretch(locks: Curves, points: NDArray) -> Bytes:
    """Strain of each point's edge against the groom, shape (n,): 0.5 is unstrained, above it is longer."""
    now, rest = (_lengths(np.diff(np.asarray(p, np.float64), axis=0)) for p in (points, locks.points))
    change = np.zeros(len(locks.points))
    change[:-1] = now / np.maximum(rest, 1e-12) - 1.0
    tips = locks.offsets[1:] - 1
    change[tips] = change[tips - 1]
    return as_bytes(0.5 + 0.5 * change / STRETCH_SHOWN)


def _lengths(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.sqrt(np.einsum("nx,nx->n", vectors, vectors))  # three times as fast as np.linalg.norm


def turning(locks: Curves, points: NDArray) -> NDArray[np.float64]:
    """Turning angle of locks within a window around each point [rad], shape (n,)."""
    edges = np.diff(np.asarray(points, np.float64), axis=0)
    edges /= np.maximum(_lengths(edges), 1e-12)[:, None]
    angle = np.zeros(len(points))
    angle[1:-1] = np.arccos(np.clip(np.einsum("nx,nx->n", edges[:-1], edges[1:]), -1.0, 1.0))
    first = np.repeat(locks.offsets[:-1], locks.counts)
    last = np.repeat(locks.offsets[1:], locks.counts) - 1
    angle[locks.offsets[:-1]] = angle[locks.offsets[1:] - 1] = 0.0
    cumulative = np.concatenate([[0.0], np.cumsum(angle)])
    row = np.arange(len(points))
    return cumulative[np.minimum(row + WINDOW, last) + 1] - cumulative[np.maximum(row - WINDOW, first)]


def curl_loss(locks: Curves, groomed: NDArray[np.float64], points: NDArray) -> Bytes:
    """Fraction of the turning that a lock has lost around each point, shape (n,).

    groomed: ``turning`` of the groom [rad], shape (n,)
    """
    remaining = turning(locks, points) / np.maximum(groomed, TURNING_SHOWN)
    return as_bytes(np.where(groomed > TURNING_SHOWN, 1.0 - remaining, 0.0))


def contact(motion: Motion) -> Bytes:
    """Contact force at each point relative to the weight of a lock, shape (n,): 0.5 is a force of that weight."""
    count = len(motion.strands.positions)
    if motion.scene is None:
        return np.empty(0, np.uint8)
    vertices, values = motion.scene.contacts
    weight = 9.81 * float(np.sum(motion.strands.masses)) / max(1, len(motion.locks))
    vertex_force = np.abs(values[:, :4]) * values[:, 8:9]
    of_locks = vertices < count
    force = np.bincount(vertices[of_locks], weights=vertex_force[of_locks], minlength=count)
    return as_bytes(motion.cores.spread(force / (force + weight)))


def depths(scalp: Mesh, corners: NDArray, locks: Curves, points: NDArray) -> Iterator[NDArray[np.float64]]:
    """Depths of lock points in the head [m], in chunks that together have shape (n,).

    corners: current points of the head's mesh [m], shape (m, 3)
    """
    triangles = np.ascontiguousarray(scalp.triangles, np.int32)
    solid = _core.Solid(np.ascontiguousarray(corners, np.float64), triangles)
    number = np.arange(len(points)) - np.repeat(locks.offsets[:-1], locks.counts)
    low, high = corners.min(axis=0), corners.max(axis=0)
    for start in range(0, len(points), CHUNK):
        chunk = np.asarray(points[start : start + CHUNK], np.float64)
        depth = np.zeros(len(chunk))
        free = number[start : start + CHUNK] >= POINTS_ROOTED
        in_box = np.flatnonzero(free & ((chunk > low) & (chunk < high)).all(axis=1))
        if in_box.size:
            depth[in_box] = np.maximum(-solid.above(chunk[in_box])[0] - TOLERANCE, 0.0)
        yield depth
