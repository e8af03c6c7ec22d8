"""Roots that follow the scalp: how the held vertices of every lock move with the animated mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.errors import UserError
from ringlet.groom.groom import Groom


@dataclass
class Roots:
    """Carries every lock rigidly with the place where it is rooted, in position and orientation."""

    groom: Groom

    def __post_init__(self) -> None:
        locks = self.groom.locks
        if "root_triangle" not in locks.curve or "root_barycentric" not in locks.curve:
            raise UserError("sim: the locks are not bound to a scalp; make the groom again from its recipe")
        self._lock_of_point = np.repeat(np.arange(len(locks)), locks.counts)
        self._rest = self._frames(self.groom.scalp.points, "rest pose")

    def carry(self, scalp_points: NDArray[np.float64], frame: float) -> NDArray[np.float64]:
        """The groomed locks on the scalp as it stands at ``frame``, each moved rigidly; positions [m], shape (n, 3)."""
        rest_place, rest_axes = self._rest
        place, axes = self._frames(scalp_points, f"frame {frame:g}")
        turn = axes @ rest_axes.transpose(0, 2, 1)
        lock = self._lock_of_point
        away = self.groom.locks.points - rest_place[lock]
        return place[lock] + np.einsum("nij,nj->ni", turn[lock], away)

    def _frames(self, scalp_points: NDArray[np.float64], when: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        scalp, locks = self.groom.scalp, self.groom.locks
        if scalp_points.shape != scalp.points.shape:
            raise UserError(
                f"{scalp.name}: has {len(scalp_points)} points at {when}, but the groom was made on one with "
                f"{len(scalp.points)}; make the groom again on this mesh"
            )
        place, axes = _core.root_frames(
            np.ascontiguousarray(scalp_points, np.float64),
            scalp.triangles,
            locks.curve["root_triangle"],
            locks.curve["root_barycentric"],
        )
        a, b, c = (scalp_points[scalp.triangles[locks.curve["root_triangle"], k]] for k in range(3))
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        flat = area <= 1e-9 * np.maximum(((b - a) ** 2).sum(axis=1), ((c - a) ** 2).sum(axis=1))
        good = np.isfinite(place).all(axis=1) & np.isfinite(axes).all(axis=(1, 2)) & ~flat
        if not good.all():
            lock = int(np.flatnonzero(~good)[0])
            triangle = locks.curve["root_triangle"][lock]
            raise UserError(
                f"{scalp.name}: at {when} triangle {triangle}, where lock {locks.ids[lock]} is rooted, has no area or "
                "is not finite; mend the mesh or its animation"
            )
        return place, axes
