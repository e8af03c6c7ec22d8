"""Render hairs of several grooms on one head, deformed together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.groom import GROOM, Groom
from ringlet.groom import hairs as one_groom
from ringlet.groom.hairs import HairMemory, Hairs
from ringlet.groom.several import WITHOUT, grooms_of

IDS_PER_GROOM = 25 * 10**16  # hairs of one groom; of lock · 10 000 + number, at most 1.1·10¹⁷ either way


@dataclass
class JoinedHairs:
    """Render hairs of several grooms as one set, in the order of the grooms.

    curves:  as in ``Hairs``, with the attribute ``groom``: the row of a hair's groom; ``lock`` is a row of all locks
    members: hairs of each groom alone, by its name
    """

    curves: Curves
    members: dict[str, Hairs]
    _locks: list[slice]  # of each groom, in the points of all locks

    def deformed(
        self,
        lock_points: NDArray,
        scalp_points: NDArray,
        *,
        surfaces: Sequence[tuple[NDArray, NDArray]] = (),
        out: NDArray[np.float32] | None = None,
    ) -> NDArray[np.floating]:
        """Positions of all hairs on deformed locks and scalp, as ``Hairs.deformed``."""
        points = [
            hairs.deformed(np.ascontiguousarray(lock_points[rows]), scalp_points, surfaces=surfaces)
            for hairs, rows in zip(self.members.values(), self._locks, strict=True)
        ]
        return np.concatenate(points, out=out) if out is not None else np.concatenate(points)


AnyHairs = Hairs | JoinedHairs


def make_hairs(
    groom: Groom, *, fraction: float = 1.0, wider: bool = False, memory: HairMemory | None = None
) -> AnyHairs:
    """Makes the hairs of a groom as ``hairs.make_hairs``, or those of each of several that are joined."""
    if not groom.grooms:
        return one_groom.make_hairs(groom, fraction=fraction, wider=wider, memory=memory)
    made = {name: one_groom.make_hairs(one, fraction=fraction, wider=wider) for name, one in grooms_of(groom).items()}
    return _joined(groom, made)


def _joined(groom: Groom, made: dict[str, Hairs]) -> JoinedHairs:
    sets, slices, row = [], [], groom.locks.curve[GROOM]
    for number, hairs in enumerate(made.values()):
        first, last = np.searchsorted(row, [number, number + 1])
        slices.append(slice(int(groom.locks.offsets[first]), int(groom.locks.offsets[last])))
        curve = {
            **hairs.curves.curve,
            "lock": hairs.curves.curve["lock"] + np.int32(first),
            GROOM: np.full(len(hairs.curves), number, np.int32),
        }
        ids = hairs.curves.ids + number * IDS_PER_GROOM
        sets.append(Curves(hairs.curves.points, hairs.curves.offsets, ids, curve, hairs.curves.point))
    return JoinedHairs(Curves.joined(sets, WITHOUT), made, slices)
