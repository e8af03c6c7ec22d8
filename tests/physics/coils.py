"""Shapes that the physics tests release, pull and shake."""

import numpy as np


def helix(vertices=100, *, radius=5e-3, pitch=5e-3, per_turn=12, hand=1):
    """A coil that hangs down from the origin, shape (vertices, 3) [m]; hand +1 or −1."""
    turn = 2 * np.pi * np.arange(vertices) / per_turn
    return np.c_[radius * np.cos(turn), -pitch * turn / (2 * np.pi), hand * radius * np.sin(turn)]


def jittered(points, amount, seed=0, held=4):
    """The free vertices moved at random, by ``amount`` [m] each on average (root mean square)."""
    noise = np.random.default_rng(seed).normal(size=points.shape) * amount / np.sqrt(3)
    noise[:held] = 0
    return points + noise


def rotation(axis, angle):
    """Rodrigues' rotation matrix."""
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
