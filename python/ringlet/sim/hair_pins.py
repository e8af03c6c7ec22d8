"""Pins: vertices beyond the roots that are held to the skin, rigidly or by springs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.sim.strands import Strands

RIGID = 0.999  # hold from which a vertex moves rigidly
HALF_TIME = 0.02  # time constant of a hold of 1/2 [s]


def held_vertices(locks: Curves, from_root: int) -> NDArray[np.bool_]:
    """The vertices that move rigidly with the skin, shape (n,): some from each root, and those of rigid pins."""
    number = np.arange(len(locks.points)) - np.repeat(locks.offsets[:-1], locks.counts)
    held = number < from_root
    return held | (locks.point["pin"] >= RIGID) if "pin" in locks.point else held


def rigid_elements(held: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_]]:
    """The edges, corners and twists between held vertices alone, which never change, as masks; shapes (n,).

    An edge that is held at both ends holds its director too.
    """
    before, behind = np.append(False, held[:-1]), np.append(held[1:], False)
    edge = held & behind
    return edge, edge & before, edge & np.append(edge[1:], False)


def spring_forces(
    locks: Curves, strands: Strands, targets: NDArray[np.float64], dt: float, gravity: Sequence[float]
) -> NDArray[np.float64] | None:
    """The forces [N] that draw vertices of soft pins to their targets [m], shape (n, 3); None where there are none.

    In a step they move a vertex that is free otherwise by the fraction ``1 - exp(-dt / τ)`` of its distance to the
    target, with ``τ = 0.02 s · (1 - w) / w`` for a hold w. However firm, it never overshoots.
    """
    fraction = spring_fraction(locks, dt)
    soft = np.flatnonzero(fraction)
    if not soft.size:
        return None
    fraction = fraction[soft]
    free = strands.positions[soft] + dt * strands.velocities[soft] + dt * dt * np.asarray(gravity)
    forces = np.zeros_like(targets)
    forces[soft] = (fraction * strands.masses[soft])[:, None] / dt**2 * (targets[soft] - free)
    return forces


def spring_fraction(locks: Curves, dt: float) -> NDArray[np.float64]:
    """The fraction of its distance to the target that a soft pin moves a vertex in ``dt`` [s], shape (n,)."""
    hold = np.asarray(locks.point.get("pin", np.zeros(len(locks.points))), np.float64)
    hold = np.where(hold < RIGID, hold, 0.0)
    return 1.0 - np.exp(-dt * hold / (HALF_TIME * (1.0 - hold)))
