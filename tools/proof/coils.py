"""Coils, and the operations that proofs and tests apply to them."""

import numpy as np
from scipy.interpolate import CubicSpline


def helix(vertices=100, *, radius=5e-3, pitch=5e-3, per_turn=12, hand=1):
    """A helix down from the origin, shape (vertices, 3) [m]; ``hand`` is +1 or −1."""
    turn = 2 * np.pi * np.arange(vertices) / per_turn
    return np.c_[radius * np.cos(turn), -pitch * turn / (2 * np.pi), hand * radius * np.sin(turn)]


def jittered(points, amount, seed=0, prescribed=4):
    """Points with Gaussian noise of root mean square ``amount`` [m] on the free vertices."""
    noise = np.random.default_rng(seed).normal(size=points.shape) * amount / np.sqrt(3)
    noise[:prescribed] = 0
    return points + noise


def rotation(axis, angle):
    """Rodrigues' rotation matrix."""
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def coiled(knots, radius, pitch, per_turn=10):
    """A helix around the cubic spline through ``knots`` [m], shape (n, 3)."""
    spline = CubicSpline(np.arange(len(knots)), knots)
    fine = np.linspace(0, len(knots) - 1, 4000)
    arc = np.r_[0, np.cumsum(np.linalg.norm(np.diff(spline(fine), axis=0), axis=1))]
    at = np.interp(np.arange(0, arc[-1], pitch / per_turn), arc, fine)
    along = spline(at, 1) / np.linalg.norm(spline(at, 1), axis=1)[:, None]
    out = np.cross(along, [0.0, 0.0, 1.0])
    out /= np.linalg.norm(out, axis=1)[:, None]
    turn = 2 * np.pi * np.arange(len(at))[:, None] / per_turn
    return spline(at) + radius * (np.cos(turn) * out + np.sin(turn) * np.cross(along, out))
