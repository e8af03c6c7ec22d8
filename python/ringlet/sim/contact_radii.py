"""How thick locks are in contact."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.groom import STRAND_RADIUS
from ringlet.shot.contact import ShotContact


def contact_radii(contact: ShotContact, locks: Curves) -> NDArray[np.float64] | None:
    """Half the distance at which two locks touch, at their vertices [m], shape (n,); None: the shot's for all."""
    own = contact.own_radius * np.asarray(locks.curve.get(STRAND_RADIUS, np.zeros(len(locks))), np.float64)
    if not (own > contact.radius).any():
        return None
    return np.repeat(np.maximum(own, contact.radius), locks.counts)
