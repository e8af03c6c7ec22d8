"""Render hairs of several grooms on one head, deformed together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.groom import GROOM, Groom
from ringlet.deform import Hairs
from ringlet.groom import hairs as one_groom
from ringlet.groom.hair_settings import hair_settings
from ringlet.groom.hairs import HairMemory
from ringlet.groom.joined_layout import joined_layout
from ringlet.groom.several import WITHOUT, grooms_of, id_offsets

IDS_PER_GROOM = 25 * 10**16  # hairs of one groom; of lock · 10 000 + number, at most 1.1·10¹⁷ either way


@dataclass
class JoinedHairs:
    """Render hairs of several grooms as one set, in the order of the grooms.

    curves:  as in ``Hairs``, with the attribute ``groom``: the row of a hair's groom; ``lock`` is a row of all locks
    members: hairs of each groom alone, by its name
    """

    curves: Curves
    members: dict[str, Hairs]
    _locks: list[slice]  # rows of each groom's locks among all
    _lock_points: list[slice]  # and of their points

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
            for hairs, rows in self._with_points()
        ]
        return np.concatenate(points, out=out) if out is not None else np.concatenate(points)

    def axes(self, scalp_points: NDArray) -> NDArray[np.float64]:
        """The ``axis`` of ``deformation`` alone."""
        return np.concatenate([hairs.axes(scalp_points) for hairs in self.members.values()])

    def deformation(self, scalp_points: NDArray) -> dict[str, Any]:
        """Inputs of the deformation of all hairs, as ``Hairs.deformation``, with two entries more.

        ``group`` is the row of each hair's groom, uint8; arrays along hairs have a row for each groom, one after
        another. ``members`` holds the inputs of each groom alone. Hairs of all grooms have as many points.
        """
        each = [hairs.deformation(scalp_points) for hairs in self.members.values()]
        return {**joined_layout(each, [rows.start for rows in self._locks]), "members": each}

    def offset_fractions(
        self,
        lock_points: NDArray,
        deformation: dict[str, Any],
        surfaces: Sequence[tuple[NDArray, NDArray]],
        *,
        buffer: NDArray[np.float32] | None = None,
    ) -> NDArray[np.uint8]:
        """Fractions of the offsets from the locks that remain beside surfaces, as ``Hairs.offset_fractions``."""
        end, found = 0, []
        for (hairs, rows), own in zip(self._with_points(), deformation["members"], strict=True):
            begin, end = end, end + int(hairs.curves.offsets[-1])
            room = None if buffer is None else buffer[begin:end]
            points = np.ascontiguousarray(lock_points[rows])
            found.append(hairs.offset_fractions(points, own, surfaces, buffer=room))
        return np.concatenate(found)

    def new_buffer(self) -> NDArray[np.float32]:
        """Allocates a buffer for the points of all hairs, shape (n, 3), float32."""
        return np.empty((int(self.curves.offsets[-1]), 3), np.float32)

    def _with_points(self) -> Iterator[tuple[Hairs, slice]]:
        yield from zip(self.members.values(), self._lock_points, strict=True)


AnyHairs = Hairs | JoinedHairs


def make_hairs(
    groom: Groom,
    *,
    fraction: float = 1.0,
    wider: bool = False,
    points: int | None = None,
    memory: HairMemory | None = None,
) -> AnyHairs:
    """Makes the hairs of a groom as ``hairs.make_hairs``, or those of each of several that are joined.

    points: of each hair, in place of those that the groom sets
    """
    if points is not None:
        groom = _with_points(groom, points)
    if not groom.grooms:
        return one_groom.make_hairs(groom, fraction=fraction, wider=wider, memory=memory)
    made = {name: one_groom.make_hairs(one, fraction=fraction, wider=wider) for name, one in grooms_of(groom).items()}
    return _joined(groom, made, _joined_curves(groom, made))


def _with_points(groom: Groom, points: int) -> Groom:
    """The same groom with another number of points of each hair."""
    grooms = {name: {**one, "hairs": {**one["hairs"], "points": points}} for name, one in groom.grooms.items()}
    return replace(groom, hairs={**groom.hairs, "points": points}, grooms=grooms)


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
