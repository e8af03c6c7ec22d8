"""Makes the hairs of a groom, or of several on one head."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from ringlet.data.curves import Curves
from ringlet.data.groom import GROOM, Groom
from ringlet.deform import AnyHairs, Hairs, JoinedHairs
from ringlet.groom import hairs as one_groom
from ringlet.groom.hair_settings import hair_settings
from ringlet.groom.hairs import HairMemory
from ringlet.groom.several import WITHOUT, grooms_of, id_offsets

LEAST_POINTS = 4  # of a hair that is thinned
IDS_PER_GROOM = 25 * 10**16  # hairs of one groom; of lock · 10 000 + number, at most 1.1·10¹⁷ either way


def make_hairs(
    groom: Groom,
    *,
    fraction: float = 1.0,
    wider: bool = False,
    points: int | None = None,
    point_share: float = 1.0,
    memory: HairMemory | None = None,
) -> AnyHairs:
    """Makes the hairs of a groom as ``hairs.make_hairs``, or those of each of several that are joined.

    points:      of each hair, in place of those that the groom sets
    point_share: part of these to make; hairs with a coil of their own keep all
    """
    if points is not None or point_share < 1.0:
        groom = _with_points(groom, points, point_share)
    if not groom.grooms:
        return one_groom.make_hairs(groom, fraction=fraction, wider=wider, memory=memory)
    made = {name: one_groom.make_hairs(one, fraction=fraction, wider=wider) for name, one in grooms_of(groom).items()}
    return _joined(groom, made, _joined_curves(groom, made))


def _with_points(groom: Groom, points: int | None, share: float) -> Groom:
    """The same groom with another number of points of each hair."""

    def thinned(hairs: dict[str, Any], locks: Curves) -> dict[str, Any]:
        if points is None and hairs.get("points") is None and hairs.get("coil"):
            return hairs
        own = points or hairs.get("points") or int(locks.counts.max())
        count = own if hairs.get("coil") else max(min(own, LEAST_POINTS), round(share * own))
        return {**hairs, "points": count}

    if not groom.grooms:
        return replace(groom, hairs=thinned(groom.hairs, groom.locks))
    rows = groom.locks.curve[GROOM]
    grooms = {
        name: {**one, "hairs": thinned(one["hairs"], groom.locks.take(rows == row))}
        for row, (name, one) in enumerate(groom.grooms.items())
    }
    return replace(groom, grooms=grooms)


def lay_hairs(groom: Groom, *, memory: HairMemory | None = None) -> AnyHairs:
    """Lays out the hairs of a groom as ``hairs.lay_hairs``, or of several, all with as many points for display."""
    if not groom.grooms:
        return one_groom.lay_hairs(groom, memory=memory)
    memory, alone = memory or HairMemory(), grooms_of(groom)
    points = max(hair_settings(one).points or int(one.locks.counts.max()) for one in alone.values())
    made = {
        name: one_groom.lay_hairs(
            replace(one, hairs={**one.hairs, "points": points}), memory=memory.grooms.setdefault(name, HairMemory())
        )
        for name, one in alone.items()
    }
    sets = [hairs.curves for hairs in made.values()]
    if memory.joined is None or any(a is not b for a, b in zip(memory.joined[0], sets, strict=True)):
        memory.joined = sets, _joined_curves(groom, made)
    return _joined(groom, made, memory.joined[1])


def _joined(groom: Groom, made: dict[str, Hairs], curves: Curves) -> JoinedHairs:
    borders = np.searchsorted(groom.locks.curve[GROOM], np.arange(len(made) + 1)).tolist()
    ends = groom.locks.offsets[borders].tolist()
    locks, points = ([slice(a, b) for a, b in pairwise(rows)] for rows in (borders, ends))
    return JoinedHairs(curves, made, locks, points)


def _joined_curves(groom: Groom, made: dict[str, Hairs]) -> Curves:
    sets, offsets = [], id_offsets(list(made))
    for number, (name, hairs) in enumerate(made.items()):
        own = hairs.curves.curve
        curve = {
            **own,
            "lock": own["lock"] + np.int32(np.searchsorted(groom.locks.curve[GROOM], number)),
            "guide_id": own["guide_id"] + offsets[name],
            GROOM: np.full(len(hairs.curves), number, np.int32),
        }
        sets.append(replace(hairs.curves, ids=hairs.curves.ids + number * IDS_PER_GROOM, curve=curve))
    return Curves.joined(sets, WITHOUT)
