"""How thick locks are in contact."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.groom import SECTION, STRAND_RADIUS, WORN_RADIUS
from ringlet.data.thickness import own_radii
from ringlet.shot.contact import ShotContact


def contact_radii(contact: ShotContact, locks: Curves) -> NDArray[np.float64] | None:
    """Half the distance at which two locks touch, at their vertices [m], shape (n,); None: the shot's for all.

    A bead has its own radius on a lock that is alone in its section, such as a core. Several strands in one bead are
    nearer to one another than that and would be pushed apart: they keep theirs.
    """
    if STRAND_RADIUS not in locks.curve:
        return None
    own = contact.own_radius * own_radii(locks)
    if WORN_RADIUS in locks.point and SECTION in locks.curve:
        _, section, size = np.unique(locks.curve[SECTION], return_inverse=True, return_counts=True)
        own = np.maximum(own, locks.point[WORN_RADIUS] * np.repeat(size[section] == 1, locks.counts))
    return np.maximum(own, contact.radius) if (own > contact.radius).any() else None
