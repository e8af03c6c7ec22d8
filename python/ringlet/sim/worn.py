"""What locks wear in a shot: its mass as factors on their material."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.groom import WORN_MASS
from ringlet.shot.material import Material

HALVINGS = 60  # of an interval of factors


def worn_factors(locks: Curves, material: Material, radius: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Factors on the material at the vertices of locks with which these have the mass of what they wear as well, and
    at vertices the stiffness that they have without; shapes (n,). Empty where nothing is worn.

    radius: factors on the radius that locks have without, shape (n,)

    The core weighs an edge by its area ``π (r (fᵢ + fᵢ₊₁) / 2)²``. The factors are ``f² = 1 + s m / m₀``, for the mass
    m worn at a vertex and its own m₀. The scale s of each lock gives its whole the mass.
    """
    worn = np.asarray(locks.point.get(WORN_MASS, ()), np.float64)
    if not worn.any():
        return {}
    edges = np.linalg.norm(np.diff(locks.points.astype(np.float64), axis=0), axis=1)
    edges[locks.offsets[1:-1] - 1] = 0.0  # from one lock to the next
    line = material.density * np.pi * material.radius**2
    lock = np.repeat(np.arange(len(locks)), locks.counts)

    def mass(factor: NDArray[np.float64]) -> NDArray[np.float64]:
        """Mass of each edge [kg]."""
        return line * edges * (0.5 * (factor[1:] + factor[:-1])) ** 2

    of_edges = mass(radius)
    own = 0.5 * (np.append(of_edges, 0.0) + np.insert(of_edges, 0, 0.0))
    share = worn / own
    wanted = np.bincount(lock, own + worn)
    low, high = np.zeros(len(locks)), np.full(len(locks), 4.0)
    for _ in range(HALVINGS):
        scale = 0.5 * (low + high)
        total = np.bincount(lock[:-1], mass(radius * np.sqrt(1.0 + scale[lock] * share)), len(locks))
        low, high = np.where(total < wanted, scale, low), np.where(total < wanted, high, scale)
    factor = np.sqrt(1.0 + low[lock] * share)
    return {"radius": factor, "stretch": factor**-2, "bend": factor**-4}
