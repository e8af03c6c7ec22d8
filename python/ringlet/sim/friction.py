"""Coulomb friction of every pair of materials."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.data.settings import did_you_mean
from ringlet.shot.contact import Contact, Pair
from ringlet.sim.cloth import Cloth
from ringlet.sim.obstacle import Body

LOCKS = "locks"  # their name in pairs of materials


def friction_matrix(contact: Contact, cloths: Sequence[Cloth], bodies: Sequence[Body]) -> NDArray[np.float64]:
    """Coulomb's μ of each pair of materials: of strands, then of each cloth, then of each body.

    The friction of a lock on a body or a cloth is theirs; of two of these, the geometric mean. Bodies do not touch.
    """
    on_it = [cloth.material.friction for cloth in cloths] + [body.friction for body in bodies]
    friction = np.zeros((1 + len(on_it),) * 2)
    friction[0, 0] = contact.friction
    friction[0, 1:] = friction[1:, 0] = on_it
    friction[1:, 1:] = np.sqrt(np.outer(on_it, on_it))
    friction[1 + len(cloths) :, 1 + len(cloths) :] = 0.0
    return friction


def override_pairs(friction: NDArray[np.float64], pairs: Sequence[Pair], names: Sequence[str]) -> NDArray[np.float64]:
    """The friction of materials on one another, shape (k, k), with that of some pairs by name.

    names: of the materials, k of them; several may have one name
    """
    friction = friction.copy()
    for index, pair in enumerate(pairs):
        for place, name in enumerate(pair.between):
            if name not in names:
                raise UserError(
                    f"shot: contact.pair[{index}].between[{place}] is '{name}', which is no name in the shot"
                    f"{did_you_mean(name, dict.fromkeys(names))}"
                )
        one, other = (np.flatnonzero(np.array(names) == name) for name in pair.between)
        friction[np.ix_(one, other)] = friction[np.ix_(other, one)] = pair.friction
    return friction
