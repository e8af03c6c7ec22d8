"""Eyes, noses, mouths and ears of heads, and necklines, as signed distances by the measures of each head [cm]."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from distances import Array, capsule, ellipsoid, engrave, smooth, sphere, stroke, subtract, union
from numpy.typing import ArrayLike

Point = tuple[float, float, float]
Ellipsoid = tuple[Point, Point]  # centre and half axes
Capsule = tuple[Point, Point, float, float]  # ends and their radii
Stroke = tuple[list[Point], list[float]]  # points and their radii
Feature = tuple[Callable[[Array, Array], Array], ArrayLike, float]  # what adds it; the ball that bounds its effect


@dataclass(frozen=True)
class Eye:
    """The left eye: an eyeball and the opening between its lids.

    centre, radius:       of the eyeball [cm]
    width, upper, lower:  half angles of the opening at the eyeball's centre [rad]
    slant:                raises the outer corner
    lid:                  thickness of the lids [cm]
    """

    centre: Array
    radius: float
    width: float
    upper: float
    lower: float
    slant: float
    lid: float

    def added(self, d: Array, p: Array) -> Array:
        """Adds lids as shells around the eyeball, and the opening between them."""
        d = union(d, sphere(p, self.centre, self.radius + self.lid), 2.0 * self.lid)
        upper, lower = self.lid_edges(p)
        inside = self.radius - 1.5 * self.lid - np.linalg.norm(p - self.centre, axis=-1)
        pocket = np.maximum(np.maximum(upper, lower), inside)
        return subtract(d, np.maximum(pocket, self.centre[2] - p[:, 2]), 0.6 * self.lid)

    def lid_edges(self, p: Array) -> tuple[Array, Array]:
        """Distances along the eyeball beyond the edges of the upper and the lower lid; both negative in the opening."""
        direction = p - self.centre
        across = np.arctan2(direction[:, 0], np.maximum(direction[:, 2], 1e-3)) / self.width
        along = np.arctan2(direction[:, 1], np.hypot(direction[:, 0], direction[:, 2])) - self.slant * across
        return self.radius * (along - self.upper * lid_arch(across)), self.radius * (
            -along - self.lower * lid_arch(across)
        )

    def lid_direction(self, across: Array) -> Array:
        """Directions from the eyeball's centre to the edge of the upper lid, shape (n, 3)."""
        along = self.upper * lid_arch(across) + self.slant * across
        turn = self.width * across
        return np.column_stack([np.cos(along) * np.sin(turn), np.sin(along), np.cos(along) * np.cos(turn)])


def lid_arch(across: Array) -> Array:
    """Relative opening of the lids, at most 1, by the position from the inner corner (-1) to the outer one (1)."""
    return 1.0 - np.minimum(np.abs(across + 0.08), 1.6) ** 2.2


@dataclass(frozen=True)
class Nose:
    """A nose; its left wing and nostril.

    blend: radius of the blend of the wings [cm]
    """

    bridge: Capsule
    tip: Ellipsoid
    wing: Ellipsoid
    blend: float
    nostril: Ellipsoid

    def added(self, d: Array, p: Array) -> Array:
        d = union(d, capsule(p, *self.bridge), 1.3)
        d = union(d, ellipsoid(p, *self.tip), 0.6)
        d = union(d, ellipsoid(p, *self.wing), self.blend)
        return subtract(d, ellipsoid(p, *self.nostril), 0.15)


@dataclass(frozen=True)
class Mouth:
    """A mouth; the left half of its lips, from the corner to the middle.

    mound:       the jaws under the lips
    groove:      width of the philtrum [cm]
    line:        height of the line between the lips in the middle, less the bow's height [cm]
    bow, smile:  its waves per length [rad/cm], and its curvature upwards [1/cm]
    """

    mound: Ellipsoid
    philtrum: Capsule
    groove: float
    upper: Stroke
    lower: Stroke
    line: float
    bow: float
    smile: float

    def added(self, d: Array, p: Array) -> Array:
        d = union(d, ellipsoid(p, *self.mound), 1.4)
        d = engrave(d, capsule(p, *self.philtrum), 0.1, self.groove)
        d = union(d, self.lips(p), 0.25)
        gap = np.hypot(p[:, 1] - self.height(p[:, 0]), np.maximum(p[:, 0] - 2.5, 0.0)) - 0.12
        return engrave(d, np.maximum(gap, 3.0 - p[:, 2]), 0.26 - 0.06 * p[:, 0], 0.18)

    def lips(self, p: Array) -> Array:
        return np.minimum(stroke(p, *smooth(*self.upper)), stroke(p, *smooth(*self.lower)))

    def height(self, x: Array) -> Array:
        """Height of the line between the lips: a bow with a slight smile."""
        return self.line + 0.07 * np.cos(self.bow * x) + self.smile * x**2


@dataclass(frozen=True)
class Ear:
    """The left ear.

    centre: of the leaf [cm]
    flare:  angle of the rim from the skull [rad]
    tilt:   of the top backwards [rad]
    """

    centre: Array
    flare: float
    tilt: float

    def added(self, d: Array, p: Array) -> Array:
        q = self.frame(p)
        d = union(d, leaf(q), 0.5)
        d = subtract(d, ellipsoid(q, (0.45, -0.4, 0.72), (0.72, 0.95, 0.8)), 0.25)  # the bowl
        return union(d, ellipsoid(q, (-0.5, -0.55, 0.35), (0.35, 0.5, 0.3)), 0.3)  # tragus

    def contains(self, p: Array) -> np.ndarray:
        """Points on the ear, shape (n,), bool."""
        return (leaf(self.frame(p)) < 0.2) & (p[:, 0] > self.centre[0] - 0.7)

    def frame(self, p: Array) -> Array:
        """Transforms points to the frame of the ear: backwards in its plane, up, and along its normal."""
        back = np.array([np.sin(self.flare), 0.0, -np.cos(self.flare)])
        up = np.array([0.0, np.cos(self.tilt), -np.sin(self.tilt)])
        up -= (up @ back) * back
        up /= np.linalg.norm(up)
        return (p - self.centre) @ np.column_stack([back, up, np.cross(back, up)])


def leaf(q: Array) -> Array:
    """The ear without its bowl, in its frame: a flat ellipsoid with a rolled rim, a lobe and an inner fold."""
    d = ellipsoid(q, (0.7, 0.1, 0.0), (1.75, 2.6, 0.5))
    rim = [(-0.2, 0.0, 0.15), (-0.5, 1.0, 0.2), (-0.15, 2.0, 0.3), (0.75, 2.6, 0.35), (1.7, 2.2, 0.4)]
    rim += [(2.25, 0.9, 0.4), (2.05, -0.7, 0.35), (1.4, -1.9, 0.2), (0.6, -2.5, 0.1)]
    d = union(d, stroke(q, *smooth(rim, [0.2, 0.3, 0.34, 0.36, 0.36, 0.34, 0.32, 0.3, 0.3])), 0.25)
    d = union(d, ellipsoid(q, (0.35, -2.4, 0.05), (0.75, 0.75, 0.42)), 0.5)  # lobe
    fold = [(1.2, 1.5, 0.3), (1.4, 0.3, 0.4), (1.15, -0.8, 0.4), (0.5, -1.45, 0.3)]
    return union(d, stroke(q, *smooth(fold, [0.2, 0.3, 0.3, 0.25])), 0.3)


def with_features(d: Array, p: Array, features: Sequence[Feature]) -> Array:
    """A head with features, in the order of modelling, each evaluated in the ball that bounds its effect."""
    for add, centre, reach in features:
        near = np.flatnonzero(sphere(p, centre, reach) < 0.0)
        d[near] = add(d[near], p[near])
    return d


def with_neckline(cloth: Array, opening: Array, rib: float) -> Array:
    """A shirt with an opening around the neck, and a rib of a radius along the opening."""
    rim = np.hypot(opening - 0.25, cloth + 0.05) - rib
    return union(subtract(cloth, opening, 0.15), rim, 0.12)
