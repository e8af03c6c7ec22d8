"""What strands must hold inside to be still under loads.

The energy of a strand with a material frame depends on the edges' vectors and on how directors turn about them; where
it is still, its derivative by an edge is the load of all that is beyond, and its derivative by a director is zero. From
the tip to the root these are as many equations for each edge as there are forces: one that stretches it, two that bend
the corner at its beginning, one that twists the edge before (rest/balance.h).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.rest.rod_strains import RodStrains

Array = NDArray[np.float64]


def internal_forces(
    curves: Curves, points: Array, directors: Array, loads: Array, held: int, twisting: Array | None = None
) -> RodStrains:
    """Forces [N] along edges, moments [N m] at corners and about edges that balance loads.

    points, directors: where the strands are still [m] and their directors, shapes (n, 3)
    loads:             what pulls at each vertex [N], shape (n, 3)
    held:              vertices of each strand that are held from its root; at least three, which hold its frame
    twisting:          what turns the director of each edge besides, as a nail does [N m], shape (n,)
    Each is the derivative of the elastic energy by the quantity of the same name in ``RodStrains``. Exact, whatever the
    shape and the stiffness; what happens between held vertices is not asked for, and zero.
    """
    twisting = np.zeros(len(points)) if twisting is None else twisting
    points, directors, loads = (np.ascontiguousarray(of, np.float64) for of in (points, directors, loads))
    return RodStrains(*_core.balance(curves.offsets, held, points, directors, loads, twisting))
