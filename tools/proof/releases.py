"""Strands released from shapes far from rest; `stability.py` prints the tables."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from coils import helix, jittered, rotation
from ringlet.data.curves import Curves
from ringlet.shot import Material, Solver
from ringlet.sim import Strands

VERTICES, PRESCRIBED = 100, 4
CLOSE = 1e-5  # [m] a strand nearer to its rest shape has returned


def zigzag():
    """A 4B curl: a planar zigzag."""
    k = np.arange(VERTICES)
    return np.c_[2e-3 * (k % 2), -1.5e-3 * k, 0 * k]


def straight():
    """Type 1 hair."""
    k = np.arange(VERTICES)
    return np.c_[0 * k, -2e-3 * k, 0 * k]


def coil_with_straight_middle():
    """A coil with ten collinear edges in its middle, whose hinge triangles are degenerate."""
    edges = np.diff(helix(VERTICES), axis=0)
    edges[45:55] = edges[44]
    return np.concatenate([helix(1), helix(1) + np.cumsum(edges, axis=0)])


def straightened(rest):
    """The rest shape pulled straight downwards."""
    lengths = np.linalg.norm(np.diff(rest[PRESCRIBED - 1 :], axis=0), axis=1)
    shape = rest.copy()
    shape[PRESCRIBED:] = rest[PRESCRIBED - 1] - np.c_[0 * lengths, np.cumsum(lengths), 0 * lengths]
    return shape


def flattened(rest):
    """The rest shape projected to a plane."""
    shape = rest.copy()
    shape[PRESCRIBED:, 2] = rest[PRESCRIBED - 1, 2]
    return shape


def compressed(rest):
    """The rest shape compressed to 30 % of its height."""
    shape = rest.copy()
    shape[PRESCRIBED:, 1] = rest[PRESCRIBED - 1, 1] + 0.3 * (rest[PRESCRIBED:, 1] - rest[PRESCRIBED - 1, 1])
    return shape


def tip_twisted(rest):
    """The last vertex rotated by 45° about the second last edge."""
    shape = rest.copy()
    shape[-1] = rest[-2] + rotation(rest[-2] - rest[-3], np.pi / 4) @ (rest[-1] - rest[-2])
    return shape


def scenes():
    """Name, rest shape and initial shape of every scene."""
    for per_turn, hand in itertools.product((5, 12), (1, -1)):
        rest = helix(VERTICES, per_turn=per_turn, hand=hand)
        coil = f"{'right' if hand > 0 else 'left'}-handed coil, {per_turn} vertices a turn"
        for amount in (0.05, 0.2, 0.5, 1.0):
            yield f"{coil}, jitter {amount:g} cm", rest, jittered(rest, 0.01 * amount)
        for shape in (straightened, flattened, compressed, tip_twisted):
            yield f"{coil}, {shape.__name__.replace('_', ' ')}", rest, shape(rest)
    for make in (straight, zigzag, coil_with_straight_middle):
        for amount in (0.05, 0.2, 0.5):
            yield f"{make.__name__.replace('_', ' ')}, jitter {amount:g} cm", make(), jittered(make(), 0.01 * amount)


@dataclass
class Release:
    """Result of each scene, arrays of shape (scenes,).

    away:      final distance from rest [m]
    excursion: largest distance from rest [m]
    gain:      largest increase of the energy in a step, relative to the initial energy
    back:      number of steps until it stays close to rest, or -1
    """

    away: np.ndarray
    excursion: np.ndarray
    gain: np.ndarray
    back: np.ndarray


def release(continuation="material_frame", newton=5, fps=24.0, steps=600, integrator="backward_euler"):
    """Releases all scenes together, with the default material."""
    _, rests, starts = zip(*scenes(), strict=True)
    rest, start = Curves.from_list(rests), np.concatenate(starts)
    strands = Strands(rest, Material(), PRESCRIBED)
    strands.place(start)
    single = [Strands(Curves.from_list([r]), Material(), PRESCRIBED) for r in rests]
    first = np.array([s.energy(x, continuation=continuation)[0] for s, x in zip(single, starts, strict=True)])
    solver = Solver(newton=newton, continuation=continuation, integrator=integrator)

    def distance():
        return np.linalg.norm(strands.positions - rest.points, axis=1).reshape(len(rests), -1).max(axis=1)

    before, excursion = first, distance()
    gain, back = np.zeros(len(rests)), np.full(len(rests), -1)
    for step in range(1, steps + 1):
        report = strands.step(rest.points, 1 / fps, solver=solver)
        energy = sum(report[name] for name in ("stretch", "bend", "twist", "kinetic"))
        gain = np.maximum(gain, np.where(report["nan"] > 0, np.inf, (energy - before) / first))
        before = energy
        away = distance()
        excursion = np.maximum(excursion, away)
        back = np.where(away < CLOSE, np.where(back < 0, step, back), -1)
    return Release(away, excursion, gain, back)
