"""Braids that fold back on themselves in a groom."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ringlet.data.braids import Braids
from ringlet.data.curves import Curves
from ringlet.data.groom import STRAND_RADIUS

SHOWN = 10  # locks that a summary names


def folded_braids(locks: Curves) -> dict[str, Any]:
    """The number of ``braids`` with a fold, twists and locs among them, ``of`` how many.

    ``places`` are the points at which their strands fold, on how many ``locks``. ``worst`` has the first of these,
    each with the point of its first fold.
    """
    braids = Braids.of(locks)
    folded = braids.folded(locks.points)
    points = np.flatnonzero(folded)
    rows, first = np.unique(np.searchsorted(locks.offsets, points, side="right") - 1, return_index=True)
    worst = [
        {"lock": int(locks.ids[row]), "point": int(points[k] - locks.offsets[row])}
        for row, k in zip(rows[:SHOWN], first[:SHOWN], strict=True)
    ]
    return {
        "places": len(points),
        "locks": len(rows),
        "braids": len(braids.of_points(folded)),
        "of": len(braids),
        "worst": worst,
    }


def fold_warnings(locks: Curves) -> Iterator[str]:
    """A sentence about the braids of a groom that fold; none where none does."""
    if STRAND_RADIUS not in locks.curve:
        return
    found = folded_braids(locks)
    if found["places"]:
        first = found["worst"][0]
        yield (
            f"{found['braids']} of {found['of']} braids or twists fold back on themselves, first lock {first['lock']} "
            f"at its point {first['point']}: their path bends sharper than they are wide; bend locks before they are "
            "braided, lower the magnitude of what bends them after that, or leave their sections out with a mask"
        )
