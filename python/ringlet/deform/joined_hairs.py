"""Render hairs of several grooms on one head, deformed together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.deform.hairs import Hairs
from ringlet.deform.joined_layout import joined_layout, joined_windows


@dataclass
class JoinedHairs:
    """Render hairs of several grooms as one set, in the order of the grooms.

    curves:  as in ``Hairs``, with the attribute ``groom``: the row of a hair's groom; ``lock`` is a row of all locks
    members: hairs of each groom alone, by its name
    locks:   rows of each groom's locks among all
    lock_points: and of their points
    """

    curves: Curves
    members: dict[str, Hairs]
    locks: list[slice]
    lock_points: list[slice]

    @property
    def parts(self) -> list[Hairs]:
        """Hairs of each groom alone."""
        return list(self.members.values())

    @property
    def windows(self) -> NDArray[np.integer]:
        """Points of a turn of each lock's coil, as ``Hairs.windows``."""
        return joined_windows([(hairs.layout, len(hairs.groom.locks)) for hairs in self.parts])

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
        return {**joined_layout(each, [rows.start for rows in self.locks]), "members": each}

    def offset_fractions(
        self,
        lock_points: NDArray,
        deformation: dict[str, Any],
        surfaces: Sequence[tuple[NDArray, NDArray]],
        *,
        buffer: NDArray[np.float32] | None = None,
    ) -> NDArray[np.uint8]:
        """Fractions of the offsets from the locks that remain outside of surfaces, as ``Hairs.offset_fractions``."""
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
        yield from zip(self.members.values(), self.lock_points, strict=True)


AnyHairs = Hairs | JoinedHairs
