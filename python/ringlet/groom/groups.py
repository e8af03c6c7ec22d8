"""Groups of neighbouring locks: each lock follows the leader of its group."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from scipy.spatial import KDTree

from ringlet.data.quantities import Quantity
from ringlet.groom.operators.operator import unit
from ringlet.groom.scalp import Scalp

CHOICE = 6  # nearest leaders that a lock may follow

Apart = Annotated[
    float,
    Quantity("deg", 1.0, 180.0),
    Field(description="locks that lean further apart than this, as across a part line, are not in one group"),
]


def leaders(
    shapes: NDArray, size: float, apart: float, scalp: Scalp, seed: int, what: str = "size"
) -> NDArray[np.integer]:
    """Row of each lock's leader, its own where none of the nearest leans alike, shape (count,).

    Leaders are the locks nearest to samples of the scalp. Samples that are twice as dense as the locks make every lock
    a leader, so they are not made.

    shapes: points of locks [m], shape (count, points, 3)
    size:   distance of leaders [m]
    apart:  angle by which a lock may lean away from its leader [degrees]
    what:   setting that gives the distance, for messages
    """
    roots, lean = shapes[:, 0], unit(shapes[:, shapes.shape[1] // 3] - shapes[:, 0])
    own, tree = np.arange(len(roots)), KDTree(roots)
    if len(roots) == 1 or 2.0 * size < np.median(tree.query(roots, k=2)[0][:, 1]):
        return own
    _, triangle, barycentric = scalp.sample(scalp.count_for_spacing(size, what), seed)
    leading = np.unique(tree.query(scalp.positions(triangle, barycentric))[1])
    _, choice = KDTree(roots[leading]).query(roots, k=min(CHOICE, len(leading)))
    near = leading[choice].reshape(len(roots), -1)
    alike = np.einsum("lkx,lx->lk", lean[near], lean) >= np.cos(np.radians(apart))
    return np.where(alike.any(axis=1), near[own, alike.argmax(axis=1)], own)
