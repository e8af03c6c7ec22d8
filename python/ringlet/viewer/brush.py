"""What a brush does to guides: a ball that is moved through them. Roots stay."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.groom.sculpt import lengthened

Array = NDArray[np.floating]

LONGER = 0.25  # part by which a guide grows while the brush goes its own radius over it
SMOOTHER = 0.5  # part of the way to the middle of its neighbours that a point goes meanwhile
SHORTEST = 0.05  # part of a guide that a cut leaves at least
FINE = 8  # places on an edge of a guide at which a cut looks


@dataclass(frozen=True)
class Ball:
    """Where a brush is, how far it came [m], and how far it reaches [m]."""

    at: Array
    by: Array
    radius: float

    def mirrored(self, middle: float) -> Ball:
        """The same on the other side of the plane x = middle."""
        turned = np.array([-1.0, 1.0, 1.0])
        return Ball(self.at * turned + np.array([2.0 * middle, 0.0, 0.0]), self.by * turned, self.radius)

    def reaches(self, points: NDArray) -> Array:
        """How much it acts at points (n, 3): 1 in its middle, 0 from its radius on, smooth between; shape (n,)."""
        t = np.clip(1.0 - np.linalg.norm(points - self.at, axis=1) / self.radius, 0.0, 1.0)
        return t * t * (3.0 - 2.0 * t)

    @property
    def way(self) -> float:
        """How far it came, in its radii; at most 1."""
        return min(1.0, float(np.linalg.norm(self.by)) / self.radius)


def held(guides: Curves, ball: Ball) -> Array:
    """How much of a ball's way the points of guides go along when they are grabbed where it is, shape (n,)."""
    weights = ball.reaches(guides.points)
    weights[guides.offsets[:-1]] = 0.0
    return weights


def grab(guides: Curves, ball: Ball, weights: Array) -> Curves:
    """Takes along what was held when the ball was put down."""
    return guides.with_points(guides.points + weights[:, None] * ball.by)


def comb(guides: Curves, ball: Ball) -> Curves:
    """Draws guides along with the ball; they keep their lengths, edge by edge."""

    def combed(points: Array, weights: Array) -> Array:
        edges = np.linalg.norm(np.diff(points, axis=0), axis=1)
        return _with_edges(points + weights[:, None] * ball.by, edges)

    return _each(guides, ball, combed)


def smooth(guides: Curves, ball: Ball) -> Curves:
    """Takes bends out of guides; they keep their lengths."""

    def smoothed(points: Array, weights: Array) -> Array:
        between = 0.5 * (points[:-2] + points[2:]) - points[1:-1]
        moved = points.copy()
        moved[1:-1] += SMOOTHER * ball.way * weights[1:-1, None] * between
        length = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
        now = np.linalg.norm(np.diff(moved, axis=0), axis=1)
        return _with_edges(moved, now * length / now.sum())

    return _each(guides, ball, smoothed)


def lengthen(guides: Curves, ball: Ball) -> Curves:
    """Lets guides grow at their tips, the more the farther the ball goes."""
    return _each(guides, ball, lambda points, weights: lengthened(points, 1.0 + LONGER * ball.way * weights.max()))


def cut(guides: Curves, ball: Ball) -> Curves:
    """Cuts guides where they come into the ball."""

    def shortened(points: Array, _: Array) -> Array:
        fine = np.linspace(0.0, len(points) - 1.0, FINE * (len(points) - 1) + 1)
        places = np.stack([np.interp(fine, np.arange(len(points)), column) for column in points.T], axis=1)
        within = np.linalg.norm(places - ball.at, axis=1) < ball.radius
        if not within.any():
            return points
        run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
        return lengthened(points, max(SHORTEST, run[int(within.argmax())] / run[-1]))

    return _each(guides, ball, shortened)


def given_back(guides: Curves, ball: Ball, before: Curves) -> Curves:
    """Lets guides in the ball be what they were before they were sculpted."""
    inside = np.repeat(_touched(guides, ball), guides.counts)
    return guides.with_points(np.where(inside[:, None], before.points, guides.points))


TOOLS: dict[str, Callable[[Curves, Ball], Curves]] = {
    "comb": comb,
    "smooth": smooth,
    "lengthen": lengthen,
    "cut": cut,
}


def _each(guides: Curves, ball: Ball, change: Callable[[Array, Array], Array]) -> Curves:
    """Guides of which those in the ball are changed, one by one; roots stay."""
    points = np.array(guides.points, np.float64)
    weights = held(guides, ball)
    for row in np.flatnonzero(_touched(guides, ball)).tolist():
        here = slice(guides.offsets[row], guides.offsets[row + 1])
        root = points[here][0].copy()
        points[here] = change(points[here], weights[here])
        points[guides.offsets[row]] = root
    return guides.with_points(points)


def _touched(guides: Curves, ball: Ball) -> NDArray[np.bool_]:
    """Which guides come into the ball, shape (count,): measured at their edges, which may be longer than the ball."""
    points = np.asarray(guides.points, np.float64)
    edge = np.diff(points, axis=0)
    t = np.einsum("nx,nx->n", ball.at - points[:-1], edge) / np.maximum(np.einsum("nx,nx->n", edge, edge), 1e-18)
    near = np.linalg.norm(points[:-1] + np.clip(t, 0.0, 1.0)[:, None] * edge - ball.at, axis=1) < ball.radius
    near[guides.offsets[1:-1] - 1] = False  # from one guide to the next there is no edge
    return np.logical_or.reduceat(np.append(near, False), guides.offsets[:-1])


def _with_edges(points: Array, lengths: Array) -> Array:
    """A guide whose edges point as they do and have given lengths."""
    edges = np.diff(points, axis=0)
    edges *= (lengths / np.maximum(np.linalg.norm(edges, axis=1), 1e-12))[:, None]
    return np.concatenate([points[:1], points[0] + np.cumsum(edges, axis=0)])
