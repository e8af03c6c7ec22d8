"""Locks without a scalp for tests of rest shapes, and measures of their sag and frequency."""

import numpy as np
from coils import helix, rotation
from ringlet.data.curves import Curves
from ringlet.data.groom import Groom
from ringlet.data.mesh import Mesh
from ringlet.shot import parse_shot
from ringlet.shot.solver import Solver

SHOT = 'ringlet = 2\ngroom = "groom.usdc"\nframes = [1, 1]\n'
GRAVITY = (0.0, -9.81, 0.0)


def scene(*strands, more=""):
    """A shot and a groom of these strands."""
    mesh = Mesh("none", np.zeros((3, 3)), np.array([[0, 1, 2]], np.int32))
    locks = Curves.from_list(list(strands))
    return parse_shot(SHOT + more), Groom(locks, locks, mesh)


def curl():
    """A helix that leaves its root sideways."""
    return helix(80, radius=4e-3, pitch=6e-3) @ rotation((0, 0, 1), np.radians(70)).T


def arc():
    """A smooth strand of 8 cm that leaves sideways and bends upwards."""
    angle = np.linspace(0, 1.0, 40)
    return 0.08 * np.c_[np.sin(angle), 1 - np.cos(angle), 0 * angle]


def sag(points, groomed):
    """Largest distance from the groomed shape [m]."""
    return float(np.linalg.norm(points - groomed, axis=1).max())


STRAIGHT = np.c_[np.linspace(0, 0.06, 40), np.zeros((40, 2))]


def first_frequency(strands, hanging):
    """Lowest natural frequency about the hanging shape [1/s], from the spectrum of the tip after a small push."""
    dt = 1 / 1000
    strands.place(hanging)
    strands.settle(gravity=GRAVITY, tolerance=1e-9)
    rest = strands.positions.copy()
    strands.velocities[:] = 1e-3 * (rest - rest[0])[:, [1]] * [0, 0, 1] / 0.01
    tip = []
    for _ in range(1500):
        strands.step(rest, dt, gravity=GRAVITY, solver=Solver(newton=20, tolerance=1e-10))
        tip.append(strands.positions[-1, 2] - rest[-1, 2])
    spectrum = np.abs(np.fft.rfft(np.array(tip) * np.hanning(len(tip)), 16 * len(tip)))
    return np.fft.rfftfreq(16 * len(tip), dt)[spectrum.argmax()]
