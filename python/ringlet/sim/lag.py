"""Lag: bodies, pins and roots that are not at their targets after a frame, since hair or cloth blocks them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.sim.scene import Scene

ROOTS = "roots"  # of locks


def lagging(scene: Scene, targets: Sequence[tuple[str, NDArray[np.floating]]]) -> list[dict[str, Any]]:
    """What is not where the last step was to lead it, the farthest first.

    targets: name and positions [m] of all parts of the scene in its order: strands, then each cloth and each body. NaN
        where a vertex is free.
    Each entry has the name (``what``), the largest ``distance`` [m] and the ids of the ``locks`` that touch it there.
    """
    found, first, at = [], 0, scene.positions
    vertices, _ = scene.contacts
    strands = scene.strands.curves
    lock_of = np.repeat(strands.ids, strands.counts)
    for what, places in targets:
        part = slice(first, first + len(places))
        first += len(places)
        distance = np.nan_to_num(np.linalg.norm(at[part] - places, axis=1))
        behind = np.flatnonzero(distance > 0.0) + part.start
        if not len(behind):
            continue
        near = vertices[np.isin(vertices, behind).any(axis=1)] if what != ROOTS else behind
        locks = np.unique(lock_of[near[near < len(lock_of)]])
        found.append({"what": what, "distance": float(distance.max()), "locks": [int(lock) for lock in locks]})
    return sorted(found, key=lambda entry: -entry["distance"])
