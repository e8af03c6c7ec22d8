"""Hairs in the frames of their locks, and their positions on locks and a scalp that move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.groom import Groom
from ringlet.data.precision import origin_of

MARGIN = 1e-4  # [m] distance of hairs from surfaces, twice the radius of a hair


@dataclass
class Hairs:
    """Render hairs of a groom at rest, with the data that deforms them with the locks.

    curves: points at rest [m], as of ``deformed``. Curve attributes: ``lock`` (row of the lock, int32), ``guide_id``
            (id of the lock, int64), ``root_triangle``, ``root_barycentric``. On a scalp with texture coordinates also
            ``st`` of the root, float32. Point attribute: ``width``, the diameter [m], float32.
    groom:  the groom whose locks carry them
    axis:   reference direction of each lock, in the frame of the scalp at its root, shape (locks, 3)
    layout: inputs of the kernel that follow neither lock nor scalp (src/ringlet/groom/hairs.h)
    root:   offsets of hair roots from lock roots on the scalp at rest [m], shape (hairs, 3); None where not computed
    frames: of the scalp at rest at the roots of locks, shape (locks, 3, 3); None where not computed
    """

    curves: Curves
    groom: Groom
    axis: NDArray[np.float64]
    layout: dict[str, Any]
    root: NDArray[np.float32] | None = None
    frames: NDArray[np.float64] | None = None

    @property
    def parts(self) -> list[Hairs]:
        """These, as those of the only groom."""
        return [self]

    @property
    def windows(self) -> NDArray[np.integer]:
        """Points of a turn of each lock's coil, shape (locks,); empty where hairs only follow their lock."""
        return self.layout["window"]

    def deformed(
        self,
        lock_points: NDArray,
        scalp_points: NDArray,
        *,
        surfaces: Sequence[tuple[NDArray, NDArray]] = (),
        out: NDArray[np.float32] | None = None,
    ) -> NDArray[np.floating]:
        """Positions of the hairs on deformed locks and scalp [m], shape (n, 3), float32; float64 far from the origin.

        lock_points:  current positions of ``groom.locks`` [m], shape (locks' points, 3)
        scalp_points: current positions of ``groom.scalp`` [m], shape (scalp points, 3)
        surfaces:     surfaces that a hair crosses only with its lock: points [m], shape (k, 3), triangles (m, 3)
        out:          output buffer, also returned near the origin; allocating a new one takes longer than the
                      deformation
        """
        if out is None:
            out = self.new_buffer()
        origin = self._deform(lock_points, self.deformation(scalp_points), surfaces, out)
        return out + origin if origin.any() else out

    def offset_fractions(
        self,
        lock_points: NDArray,
        deformation: dict[str, Any],
        surfaces: Sequence[tuple[NDArray, NDArray]],
        *,
        buffer: NDArray[np.float32] | None = None,
    ) -> NDArray[np.uint8]:
        """Fractions of the offsets from the locks that remain when hairs stay on their lock's side of surfaces.

        Shape (hairs, points of a hair), uint8; 255 is the whole offset.

        deformation: result of ``deformation`` for the current scalp
        buffer:      buffer for the points of all hairs, shape (n, 3); saves an allocation
        """
        fractions = np.full((len(self.curves), len(self.layout["hold"])), 255, np.uint8)
        if surfaces:
            self._deform(lock_points, deformation, surfaces, self.new_buffer() if buffer is None else buffer, fractions)
        return fractions

    def new_buffer(self) -> NDArray[np.float32]:
        """Allocates a buffer for the points of all hairs, shape (n, 3), float32."""
        return np.empty((int(self.curves.offsets[-1]), 3), np.float32)

    def _deform(
        self,
        lock_points: NDArray,
        deformation: dict[str, Any],
        surfaces: Sequence[tuple[NDArray, NDArray]],
        out: NDArray[np.float32],
        fractions: NDArray[np.uint8] | None = None,
    ) -> NDArray[np.float64]:
        """Fills ``out`` relative to the returned origin [m], for which single precision is exact enough."""
        origin = origin_of(lock_points)
        near, offsets = lock_points - origin if origin.any() else lock_points, self.groom.locks.offsets
        points = np.ascontiguousarray(near, np.float32)
        _core.warp_hairs(points, offsets, out, **deformation)
        if surfaces:
            layout = {name: self.layout[name] for name in ("first", "tip", "join", "flat", "hold", "pace")}
            corners, triangles = _merged(surfaces)
            _core.keep_beside(points, offsets, out, corners - origin, triangles, MARGIN, **layout, shares=fractions)
        return origin

    def deformation(self, scalp_points: NDArray) -> dict[str, Any]:
        """Inputs of the deformation (src/ringlet/groom/hairs.h) other than the locks, for a deformed scalp.

        ``axis`` (locks, 3) and ``root`` (hairs, 3) [m] follow the scalp; the other arrays are constant.
        """
        if self.frames is not None and scalp_points is self.groom.scalp.points:
            frames, root = self.frames, self.root
        else:
            at = np.ascontiguousarray(scalp_points, np.float64)
            lock_roots, frames = root_frames(self.groom, at, "this frame")
            root = self.root_offsets(at, lock_roots)
        return {"axis": self._axes_in(frames), "root": root, **self.layout}

    def axes(self, scalp_points: NDArray) -> NDArray[np.float64]:
        """The ``axis`` of ``deformation`` alone, which costs less."""
        return self._axes_in(root_frames(self.groom, np.ascontiguousarray(scalp_points, np.float64), "this frame")[1])

    def _axes_in(self, frames: NDArray[np.float64]) -> NDArray[np.float64]:
        """Reference directions of the locks in frames of the scalp, shape (locks, 3)."""
        return np.einsum("lxk,lk->lx", frames, self.axis)

    def root_offsets(self, scalp_points: NDArray, lock_roots: NDArray) -> NDArray[np.float32]:
        """Offset of each hair's root from its lock's root [m], shape (hairs, 3)."""
        bound = self.curves.curve
        corners = scalp_points[self.groom.scalp.triangles[bound["root_triangle"]]]
        root = np.einsum("hc,hcx->hx", bound["root_barycentric"], corners) - lock_roots[bound["lock"]]
        root[self.layout["first"][:-1]] = 0.0  # the first hair of a lock is the lock
        return root.astype(np.float32)


def _merged(surfaces: Sequence[tuple[NDArray, NDArray]]) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Merges points and triangles of several meshes into one."""
    before = np.cumsum([0] + [len(points) for points, _ in surfaces])
    return (
        np.concatenate([points for points, _ in surfaces], dtype=np.float64),
        np.concatenate([triangles + n for (_, triangles), n in zip(surfaces, before, strict=False)], dtype=np.int32),
    )


def root_frames(groom: Groom, at: NDArray[np.float64], when: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Roots of the locks [m], shape (locks, 3), and frames of the scalp there, shape (locks, 3, 3).

    at:   points of the scalp [m], shape (n, 3)
    when: which points these are, for messages
    """
    groom.check_roots(at, when, "hairs")
    bound = groom.locks.curve
    return _core.root_frames(
        np.ascontiguousarray(at, np.float64), groom.scalp.triangles, bound["root_triangle"], bound["root_barycentric"]
    )
