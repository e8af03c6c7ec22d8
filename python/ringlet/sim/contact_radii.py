"""How thick locks are in contact."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.groom import STRAND_PROFILE, STRAND_RADIUS
from ringlet.shot.contact import ShotContact


def contact_radii(contact: ShotContact, locks: Curves) -> NDArray[np.float64] | None:
    """Half the distance at which two locks touch, at their vertices [m], shape (n,); None: the shot's for all."""
    if STRAND_RADIUS not in locks.curve:
        return None
    own = contact.own_radius * np.repeat(np.asarray(locks.curve[STRAND_RADIUS], np.float64), locks.counts)
    if STRAND_PROFILE in locks.curve:
        own *= _at_vertices(np.asarray(locks.curve[STRAND_PROFILE], np.float64), locks)
    return np.maximum(own, contact.radius) if (own > contact.radius).any() else None


def _at_vertices(profile: NDArray[np.float64], locks: Curves) -> NDArray[np.float64]:
    """Values at even steps from root to tip, shape (count, k), at the vertices, by their number; shape (n,)."""
    steps = np.linspace(0.0, 1.0, profile.shape[1])
    rows = zip(profile, locks.counts, strict=True)
    return np.concatenate([np.interp(np.linspace(0.0, 1.0, count), steps, row) for row, count in rows])
