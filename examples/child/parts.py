"""Meshes of eyes, lashes and brows of any head, in its rest pose."""

from __future__ import annotations

import numpy as np
from anatomy import Head
from distances import Array, gradient, project
from features import Eye
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

Part = tuple[Array, NDArray[np.int32]]

PUPIL = 14.0 / 30.0  # half-angle of the pupil, as a part of that of the iris


def dome(eye: Eye, last: float, rings: int, lift: float, segments: int = 28) -> Part:
    """The front of an eyeball up to an angle from its axis (+Z), with a bulging cornea for highlights."""
    theta = last * np.arange(1, rings + 1) / rings
    around = 2.0 * np.pi * np.arange(segments) / segments
    bulge = np.maximum(1.0 - (np.append(0.0, theta) / np.radians(34.0)) ** 2, 0.0) ** 2
    radius = eye.radius + lift + 0.04 * eye.radius * bulge
    ring = np.stack([np.outer(np.sin(theta), np.cos(around)), np.outer(np.sin(theta), np.sin(around))], axis=-1)
    ring = np.concatenate([ring, np.broadcast_to(np.cos(theta)[:, None, None], (rings, segments, 1))], axis=-1)
    points = np.concatenate([[[0.0, 0.0, radius[0]]], (radius[1:, None, None] * ring).reshape(-1, 3)])
    return points, np.concatenate([fan(0, 1, segments), tube(1, rings, segments)])


def eyeball(head: Head) -> Part:
    return dome(head.eye, np.radians(120.0), 14, 0.0)


def iris(head: Head) -> Part:
    return dome(head.eye, head.iris, 7, 0.012)


def pupil(head: Head) -> Part:
    return dome(head.eye, PUPIL * head.iris, 3, 0.024)


def brow(head: Head, side: float) -> Part:
    """A strip on the skin above the eye; ``side`` is 1 for the left of the head and -1 for the right."""
    bow = CubicSpline([0.0, 0.5, 1.0], head.brow)
    t = np.linspace(0.0, 1.0, 12)
    points = project(head.skin, bow(t) * [side, 1.0, 1.0], steps=8)
    normals = gradient(head.skin, points)
    return strip(points, normals, np.interp(t, [0, 0.2, 0.55, 1], head.brow_width), head.brow_height)


def lash(head: Head, side: float) -> Part:
    """A dark line along the edge of the upper lid."""
    eye, scale = head.eye, head.eye.radius / 2.25
    across = np.linspace(-0.93, 1.02, 16)
    normals = eye.lid_direction(across) * [side, 1.0, 1.0]
    points = eye.centre * [side, 1.0, 1.0] + (eye.radius + 0.5 * eye.lid + 0.05 * scale) * normals
    widths = scale * np.interp(across, [-0.93, 0.0, 0.8, 1.02], [0.02, 0.07, 0.1, 0.03])
    return strip(points, normals, widths, eye.lid)


def strip(points: Array, normals: Array, widths: Array, thickness: float, segments: int = 8) -> Part:
    """A closed tube of elliptic cross-section along points, flattened along the normals."""
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    along = np.gradient(points, axis=0)
    across = np.cross(normals, along)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    turn = 2.0 * np.pi * np.arange(segments) / segments
    height = thickness * widths / widths.max()
    rings = points[:, None] + widths[:, None, None] * np.cos(turn)[:, None] * across[:, None]
    rings = rings + height[:, None, None] * np.sin(turn)[:, None] * normals[:, None]
    count = len(points)
    ends = [points[0] - 0.5 * (points[1] - points[0]), points[-1] + 0.5 * (points[-1] - points[-2])]
    all_points = np.concatenate([[ends[0]], rings.reshape(-1, 3), [ends[1]]])
    last = 1 + count * segments
    triangles = np.concatenate(
        [fan(0, 1, segments), tube(1, count, segments), fan(last, last - segments, segments)[:, ::-1]]
    )
    return all_points, outward(all_points, triangles)


def fan(tip: int, first: int, segments: int) -> NDArray[np.int32]:
    """Triangles between a tip and the ring that starts at the vertex ``first``."""
    k = np.arange(segments)
    return np.stack([np.full(segments, tip), first + k, first + (k + 1) % segments], axis=1).astype(np.int32)


def tube(first: int, rings: int, segments: int) -> NDArray[np.int32]:
    """Triangles between consecutive rings."""
    k = np.arange(segments)
    ring = first + segments * np.arange(rings - 1)[:, None]
    a, b = ring + k, ring + (k + 1) % segments
    lower = np.stack([a, a + segments, b], axis=-1)
    upper = np.stack([b, a + segments, b + segments], axis=-1)
    return np.concatenate([lower, upper], axis=1).reshape(-1, 3).astype(np.int32)


def outward(points: Array, triangles: NDArray) -> NDArray[np.int32]:
    """Triangles of a closed mesh, with reversed winding if its volume is negative."""
    a, b, c = (points[triangles[:, k]] - points.mean(axis=0) for k in range(3))
    volume = np.einsum("ij,ij->", a, np.cross(b, c))
    return np.ascontiguousarray(triangles if volume > 0 else triangles[:, ::-1], dtype=np.int32)
