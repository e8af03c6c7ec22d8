"""Signed distances to smooth shapes: negative inside, positive outside, in the unit of the points.

Every shape takes points of shape (n, 3) and returns distances of shape (n,). For blended shapes they are bounds, not
exact distances; ``project`` therefore iterates along the gradient to the surface.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline

Array = NDArray[np.float64]
Shape = Callable[[Array], Array]


def length(vectors: Array) -> Array:
    """Lengths along the last axis; for vectors of three, NumPy's norm takes four times as long."""
    return np.sqrt(np.einsum("...k,...k->...", vectors, vectors))


def sphere(p: Array, centre: ArrayLike, radius: float) -> Array:
    return length(p - np.asarray(centre)) - radius


def ellipsoid(p: Array, centre: ArrayLike, radii: ArrayLike) -> Array:
    """Distance to an ellipsoid, first order near its surface."""
    scaled = (p - np.asarray(centre)) / np.asarray(radii)
    k = length(scaled)
    return k * (k - 1.0) / np.maximum(length(scaled / np.asarray(radii)), 1e-9)


def capsule(p: Array, start: ArrayLike, end: ArrayLike, radius: float, end_radius: float | None = None) -> Array:
    """Distance to a capsule whose radius may vary linearly from end to end."""
    a, b = np.asarray(start, float), np.asarray(end, float)
    t = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
    taper = 0.0 if end_radius is None else end_radius - radius
    return length(p - a - t[:, None] * (b - a)) - radius - taper * t


def stroke(p: Array, points: Sequence[ArrayLike] | Array, radii: Sequence[float] | Array) -> Array:
    """Distance to a chain of capsules, like a stroke of a round brush of varying size."""
    links = zip(points[:-1], points[1:], radii[:-1], radii[1:], strict=True)
    return np.min([capsule(p, a, b, ra, rb) for a, b, ra, rb in links], axis=0)


def smooth(points: Sequence[ArrayLike], radii: Sequence[float], pieces: int = 3) -> tuple[Array, Array]:
    """Points and radii of a smooth stroke, each link divided into pieces along a spline."""
    knots = np.arange(len(points))
    fine = np.linspace(0, len(points) - 1, pieces * (len(points) - 1) + 1)
    return CubicSpline(knots, np.asarray(points, float))(fine), np.interp(fine, knots, radii)


def union(a: Array, b: Array, blend: float) -> Array:
    """Union of two shapes with a fillet of about the width ``blend``."""
    near = np.maximum(blend - np.abs(a - b), 0.0) / blend
    return np.minimum(a, b) - 0.25 * blend * near * near


def subtract(a: Array, b: Array, blend: float) -> Array:
    """Difference of two shapes with a rounded edge."""
    return -union(-a, b, blend)


def intersect(a: Array, b: Array, blend: float) -> Array:
    """Intersection of two shapes with a rounded edge."""
    return -union(-a, -b, blend)


def engrave(shape: Array, tool: Array, depth: float | Array, blend: float) -> Array:
    """Engraves the tool into the surface of a shape to a depth below it."""
    return subtract(shape, np.maximum(tool, -(shape + depth)), blend)


def gradient(shape: Shape, p: Array, step: float = 2e-3) -> Array:
    """Gradient of a shape by central differences, shape (n, 3)."""
    return np.stack([shape(p + h) - shape(p - h) for h in step * np.eye(3)], axis=-1) / (2.0 * step)


def project(shape: Shape, p: Array, steps: int = 3, stride: float = 0.3) -> Array:
    """Projects points to the surface by Newton steps along the gradient of at most ``stride``."""
    for _ in range(steps):
        slope = gradient(shape, p)
        move = -(shape(p) / np.maximum((slope**2).sum(-1), 1e-2))[:, None] * slope
        p = p + move * np.minimum(1.0, stride / np.maximum(length(move)[:, None], 1e-12))
    return p
