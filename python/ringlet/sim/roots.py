"""Roots that follow the animated scalp, and carry the held vertices of their locks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.groom import Groom


@dataclass
class Roots:
    """Carries every lock rigidly with the frame of its root on the scalp."""

    groom: Groom

    def __post_init__(self) -> None:
        self._rest = self._frames(self.groom.scalp.points, "rest pose")

    def carry(self, scalp_points: NDArray[np.float64], frame: float) -> NDArray[np.float64]:
        """The groomed locks on the scalp at ``frame``, each moved rigidly; positions [m], shape (n, 3)."""
        rest_place, rest_axes = self._rest
        place, axes = self._frames(scalp_points, f"frame {frame:g}")
        locks, turns = self.groom.locks, axes @ rest_axes.transpose(0, 2, 1)
        points = np.asarray(locks.points, np.float64)
        return _core.carry_curves(points, locks.offsets, turns, rest_place, place)

    def move(
        self, points: NDArray[np.float64], start: NDArray[np.float64], end: NDArray[np.float64], frame: float
    ) -> NDArray[np.float64]:
        """Points of the locks at ``frame``, shape (n, 3), each moved along with its root as the scalp goes from points
        ``start`` to ``end`` [m]."""
        (place, axes), (to, to_axes) = (self._frames(scalp, f"frame {frame:g}") for scalp in (start, end))
        return _core.carry_curves(
            np.asarray(points, np.float64), self.groom.locks.offsets, to_axes @ axes.transpose(0, 2, 1), place, to
        )

    def axes(self, scalp_points: NDArray[np.float64], frame: float) -> NDArray[np.float64]:
        """The axes of the roots' frames on the scalp at ``frame``, as columns, shape (count, 3, 3)."""
        return self._frames(scalp_points, f"frame {frame:g}")[1]

    def _frames(self, scalp_points: NDArray[np.float64], when: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        self.groom.check_roots(scalp_points, when, "sim")
        bound, points = self.groom.locks.curve, np.ascontiguousarray(scalp_points, np.float64)
        return _core.root_frames(points, self.groom.scalp.triangles, bound["root_triangle"], bound["root_barycentric"])
