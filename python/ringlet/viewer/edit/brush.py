"""Brushes that sculpt guides: a ball that moves through them. Roots stay."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.smooth_step import smooth_step
from ringlet.groom.sculpt import lengthened

Array = NDArray[np.floating]

LENGTHEN_RATE = 0.25  # relative growth of a guide for a brush move of one radius
SMOOTH_RATE = 0.5  # relative move of a point to the mean of its neighbours for a brush move of one radius
MIN_LENGTH_FRACTION = 0.05  # smallest fraction of a guide's length that a cut leaves
CUT_SAMPLES = 8  # samples per edge of a guide at which a cut is tested


# Weight by the distance from the radius inwards, 0 at the radius and 1 at the centre.
PROFILES: dict[str, Callable[[Array], Array]] = {
    "smooth": smooth_step,
    "sharp": lambda t: t**4,
    "flat": lambda t: (t > 0.0).astype(np.float64),
}


@dataclass(frozen=True)
class Ball:
    """A brush: centre [m], displacement since the last message [m], and radius [m].

    strength: weight at the centre
    profile:  falloff from there to the radius: smooth, sharp or flat
    """

    at: Array
    by: Array
    radius: float
    strength: float = 1.0
    profile: str = "smooth"

    def mirrored(self, middle: float) -> Ball:
        """The mirror image in the plane x = middle."""
        flip = np.array([-1.0, 1.0, 1.0])
        return replace(self, at=self.at * flip + np.array([2.0 * middle, 0.0, 0.0]), by=self.by * flip)

    def falloff(self, points: NDArray) -> Array:
        """Weights at points (n, 3): ``strength`` at the centre, 0 from the radius on; shape (n,)."""
        t = np.clip(1.0 - np.linalg.norm(points - self.at, axis=1) / self.radius, 0.0, 1.0)
        return self.strength * PROFILES[self.profile](t)

    @property
    def relative_step(self) -> float:
        """Length of the displacement in radii, at most 1."""
        return min(1.0, float(np.linalg.norm(self.by)) / self.radius)


def grab_weights(guides: Curves, ball: Ball) -> Array:
    """Weights with which the points of guides follow a ball that grabs them, shape (n,); 0 at roots."""
    weights = ball.falloff(guides.points)
    weights[guides.offsets[:-1]] = 0.0
    return weights


def grab(guides: Curves, ball: Ball, weights: Array) -> Curves:
    """Moves guides with the ball by the weights of its first contact."""
    return guides.with_points(guides.points + weights[:, None] * ball.by)


def comb(guides: Curves, ball: Ball) -> Curves:
    """Combs guides with the ball; edge lengths stay."""

    def combed(points: Array, weights: Array) -> Array:
        edges = np.linalg.norm(np.diff(points, axis=0), axis=1)
        return _with_edges(points + weights[:, None] * ball.by, edges)

    return _each(guides, ball, combed)


def smooth(guides: Curves, ball: Ball) -> Curves:
    """Smooths guides; their lengths stay."""

    def smoothed(points: Array, weights: Array) -> Array:
        laplacian = 0.5 * (points[:-2] + points[2:]) - points[1:-1]
        moved = points.copy()
        moved[1:-1] += SMOOTH_RATE * ball.relative_step * weights[1:-1, None] * laplacian
        length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
        edges = np.linalg.norm(np.diff(moved, axis=0), axis=1)
        return _with_edges(moved, edges * length / edges.sum())

    return _each(guides, ball, smoothed)


def lengthen(guides: Curves, ball: Ball) -> Curves:
    """Lengthens guides at their tips in proportion to the ball's move."""
    return _each(
        guides,
        ball,
        lambda points, weights: lengthened(points, 1.0 + LENGTHEN_RATE * ball.relative_step * weights.max()),
    )


def cut(guides: Curves, ball: Ball) -> Curves:
    """Cuts guides at their first point inside the ball."""

    def shortened(points: Array, _: Array) -> Array:
        at = np.linspace(0.0, len(points) - 1.0, CUT_SAMPLES * (len(points) - 1) + 1)
        samples = np.stack([np.interp(at, np.arange(len(points)), column) for column in points.T], axis=1)
        inside = np.linalg.norm(samples - ball.at, axis=1) < ball.radius
        if not inside.any():
            return points
        arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(samples, axis=0), axis=1))])
        return lengthened(points, max(MIN_LENGTH_FRACTION, arc[int(inside.argmax())] / arc[-1]))

    return _each(guides, ball, shortened)


def restore(guides: Curves, ball: Ball, before: Curves) -> Curves:
    """Resets guides in the ball to their shape before sculpting."""
    inside = np.repeat(in_ball(guides, ball), guides.counts)
    return guides.with_points(np.where(inside[:, None], before.points, guides.points))


TOOLS: dict[str, Callable[[Curves, Ball], Curves]] = {
    "comb": comb,
    "smooth": smooth,
    "lengthen": lengthen,
    "cut": cut,
}


def _each(guides: Curves, ball: Ball, change: Callable[[Array, Array], Array]) -> Curves:
    """Applies a change to each guide in the ball; roots stay."""
    points = np.array(guides.points, np.float64)
    weights = grab_weights(guides, ball)
    for row in np.flatnonzero(in_ball(guides, ball)).tolist():
        own = slice(guides.offsets[row], guides.offsets[row + 1])
        root = points[own][0].copy()
        points[own] = change(points[own], weights[own])
        points[guides.offsets[row]] = root
    return guides.with_points(points)


def in_ball(guides: Curves, ball: Ball) -> NDArray[np.bool_]:
    """Guides that intersect the ball, shape (count,); tests edges, which may be longer than the ball."""
    points = np.asarray(guides.points, np.float64)
    edge = np.diff(points, axis=0)
    t = np.einsum("nx,nx->n", ball.at - points[:-1], edge) / np.maximum(np.einsum("nx,nx->n", edge, edge), 1e-18)
    near = np.linalg.norm(points[:-1] + np.clip(t, 0.0, 1.0)[:, None] * edge - ball.at, axis=1) < ball.radius
    near[guides.offsets[1:-1] - 1] = False  # no edge joins one guide to the next
    return np.logical_or.reduceat(np.append(near, False), guides.offsets[:-1])


def _with_edges(points: Array, lengths: Array) -> Array:
    """Rescales the edges of a guide to given lengths."""
    edges = np.diff(points, axis=0)
    edges *= (lengths / np.maximum(np.linalg.norm(edges, axis=1), 1e-12))[:, None]
    return np.concatenate([points[:1], points[0] + np.cumsum(edges, axis=0)])
