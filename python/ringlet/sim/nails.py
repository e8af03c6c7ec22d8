"""Locks that are held to the skin beyond their roots: rigidly, or drawn back softly."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.sim.strands import Strands

RIGID = 0.999  # what is held more firmly than this moves rigidly
HALF_TIME = 0.02  # time in which a place held with 1/2 comes back, but for 1/e [s]


def held_vertices(locks: Curves, from_root: int) -> NDArray[np.bool_]:
    """The vertices that move rigidly with the skin, shape (n,): some from each root, and what is nailed."""
    number = np.arange(len(locks.points)) - np.repeat(locks.offsets[:-1], locks.counts)
    held = number < from_root
    return held | (locks.point["nail"] >= RIGID) if "nail" in locks.point else held


def rigid_elements(held: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_]]:
    """Which edges, corners and twists lie between held vertices alone, and never change; shapes (n,).

    An edge that is held at both ends holds its director too.
    """
    before, behind = np.append(False, held[:-1]), np.append(held[1:], False)
    edge = held & behind
    return edge, edge & before, edge & np.append(edge[1:], False)


def spring_forces(
    locks: Curves, strands: Strands, targets: NDArray[np.float64], dt: float, gravity: Sequence[float]
) -> NDArray[np.float64] | None:
    """The forces [N] that draw softly held vertices to their targets [m], shape (n, 3); None where there are none.

    They lead a vertex that nothing else holds a part ``1 - exp(-dt / τ)`` of the way from where it would be after the
    step, with ``τ = 0.02 s · (1 - w) / w`` for a hold w. However firm, that never goes beyond the target.
    """
    part = spring_fraction(locks, dt)
    soft = np.flatnonzero(part)
    if not soft.size:
        return None
    part = part[soft]
    ahead = strands.positions[soft] + dt * strands.velocities[soft] + dt * dt * np.asarray(gravity)
    forces = np.zeros_like(targets)
    forces[soft] = (part * strands.masses[soft])[:, None] / dt**2 * (targets[soft] - ahead)
    return forces


def spring_fraction(locks: Curves, dt: float) -> NDArray[np.float64]:
    """The part of the way to its target that a vertex is led in a step of ``dt`` [s], shape (n,); 0 of what is held."""
    hold = np.asarray(locks.point.get("nail", np.zeros(len(locks.points))), np.float64)
    hold = np.where(hold < RIGID, hold, 0.0)
    return 1.0 - np.exp(-dt * hold / (HALF_TIME * (1.0 - hold)))
