"""How thick locks are in contact."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.groom import STRAND_RADIUS
from ringlet.data.thickness import own_radii
from ringlet.shot.contact import ShotContact


def contact_radii(contact: ShotContact, locks: Curves) -> NDArray[np.float64] | None:
    """Half the distance at which two locks touch, at their vertices [m], shape (n,); None: the shot's for all."""
    if STRAND_RADIUS not in locks.curve:
        return None
    own = contact.own_radius * own_radii(locks)
    return np.maximum(own, contact.radius) if (own > contact.radius).any() else None
