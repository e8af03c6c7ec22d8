"""Render hairs: interpolated around every lock, and deformed with it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from hashlib import blake2b
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import HAIR_SHARE, STRAND_RADIUS, Groom
from ringlet.data.precision import origin_of
from ringlet.data.quantities import Varied
from ringlet.groom import felt, hair_curl
from ringlet.groom.color import hair_colors
from ringlet.groom.hair_layout import lock_joins, place_hairs, root_frames
from ringlet.groom.hair_settings import HairSettings, fiber_settings, hair_settings, hair_values
from ringlet.groom.scalp import axes
from ringlet.groom.shares import LAID, REACH

MARGIN = 1e-4  # [m] distance of hairs from surfaces, twice the radius of a hair


@dataclass
class Hairs:
    """Render hairs of a groom at rest, with the data that deforms them with the locks.

    curves: points at rest [m], as of ``deformed``. Curve attributes: ``lock`` (row of the lock, int32), ``guide_id``
            (id of the lock, int64), ``root_triangle``, ``root_barycentric``. On a scalp with texture coordinates also
            ``st`` of the root, float32. Point attribute: ``width``, the diameter [m], float32.
    """

    curves: Curves
    _groom: Groom
    _axis: NDArray[np.float64]  # reference direction of each lock, in the frame of the scalp at its root
    _layout: dict[str, Any]
    _root: NDArray[np.float32] | None = None  # offsets of hair roots from lock roots on the scalp at rest

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
        fractions = np.full((len(self.curves), len(self._layout["hold"])), 255, np.uint8)
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
        points, offsets = np.ascontiguousarray(lock_points - origin, np.float32), self._groom.locks.offsets
        _core.warp_hairs(points, offsets, out, **deformation)
        if surfaces:
            layout = {name: self._layout[name] for name in ("first", "tip", "join", "flat", "hold", "pace")}
            corners, triangles = _merged(surfaces)
            _core.keep_beside(points, offsets, out, corners - origin, triangles, MARGIN, **layout, shares=fractions)
        return origin

    def deformation(self, scalp_points: NDArray) -> dict[str, Any]:
        """Inputs of the deformation (src/ringlet/groom/hairs.h) besides the locks, for a deformed scalp.

        ``axis`` (locks, 3) and ``root`` (hairs, 3) [m] follow the scalp; the other arrays are constant.
        """
        at = np.ascontiguousarray(scalp_points, np.float64)
        lock_roots, axis = self._frames(at)
        root = self._root if scalp_points is self._groom.scalp.points else None
        if root is None:
            root = self._root_offsets(at, lock_roots)
        return {"axis": axis, "root": root, **self._layout}

    def axes(self, scalp_points: NDArray) -> NDArray[np.float64]:
        """The ``axis`` of ``deformation`` alone, which costs less."""
        return self._frames(np.ascontiguousarray(scalp_points, np.float64))[1]

    def _frames(self, at: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Roots [m] and reference directions of the locks, each of shape (locks, 3)."""
        roots, frames = root_frames(self._groom, at, "this frame")
        return roots, np.einsum("lxk,lk->lx", frames, self._axis)

    def _root_offsets(self, scalp_points: NDArray, lock_roots: NDArray) -> NDArray[np.float32]:
        """Offset of each hair's root from its lock's root [m], shape (hairs, 3)."""
        bound = self.curves.curve
        corners = scalp_points[self._groom.scalp.triangles[bound["root_triangle"]]]
        root = np.einsum("hc,hcx->hx", bound["root_barycentric"], corners) - lock_roots[bound["lock"]]
        root[self._layout["first"][:-1]] = 0.0  # the first hair of a lock is the lock
        return root.astype(np.float32)


def _merged(surfaces: Sequence[tuple[NDArray, NDArray]]) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Merges points and triangles of several meshes into one."""
    before = np.cumsum([0] + [len(points) for points, _ in surfaces])
    return (
        np.concatenate([points for points, _ in surfaces], dtype=np.float64),
        np.concatenate([triangles + n for (_, triangles), n in zip(surfaces, before, strict=False)], dtype=np.int32),
    )


@dataclass
class HairMemory:
    """Cache of the last hairs, valid while the locks keep their roots.

    grooms, joined: caches of each of several grooms by name, and their curves with those that are joined of them
    """

    key: bytes = b""
    hairs: Hairs | None = None
    grooms: dict[str, HairMemory] = field(default_factory=dict)
    joined: tuple[list[Curves], Curves] | None = None


def make_hairs(groom: Groom, *, fraction: float = 1.0, wider: bool = False, memory: HairMemory | None = None) -> Hairs:
    """Makes the hairs of every lock, with positions keyed by (seed, lock, number).

    fraction: fraction of each lock's hairs to make, in (0, 1]; a smaller fraction gives a subset of the same hairs
    wider:    scales widths by the inverse fraction, so that a lock covers the same area
    memory:   cache of all data independent of the locks' shape; the next call overwrites the points of this result

    Raises UserError for a fraction out of range.
    """
    hairs = lay_hairs(groom, fraction=fraction, wider=wider, memory=memory)
    hairs.curves.points = hairs.deformed(groom.locks.points, groom.scalp.points, out=hairs.curves.points)
    hairs.curves = hair_colors(groom, hairs.curves)
    return hairs


def lay_hairs(groom: Groom, *, fraction: float = 1.0, wider: bool = False, memory: HairMemory | None = None) -> Hairs:
    """Makes the hairs as ``make_hairs``, without points and colours, for callers that compute them by themselves."""
    settings = hair_settings(groom)
    if not 0.0 < fraction <= 1.0:
        raise UserError(f"hairs: fraction is {fraction}; must be more than 0 and at most 1")
    memory = memory or HairMemory()
    frames = root_frames(groom, groom.scalp.points, "rest pose")[1]
    key = _key(groom, settings, fraction, wider)
    if memory.hairs is None or memory.key != key:
        memory.key, memory.hairs = key, _placed(groom, settings, fraction, wider)
    cached = memory.hairs
    axis = np.einsum("lxk,lx->lk", frames, axes(groom.locks, frames))
    layout = _with_lengths(cached, groom.locks)
    # Whoever keeps a layout compares curves: with a curl of hairs it changes with the locks.
    curves = cached.curves if layout is cached._layout else replace(cached.curves)
    return Hairs(curves, groom, axis, layout, cached._root)


def _placed(groom: Groom, settings: HairSettings, fraction: float, wider: bool) -> Hairs:
    """Hairs with unset points and axes."""
    curves, layout = place_hairs(groom, settings, fraction, wider)
    hairs = Hairs(curves, groom, np.empty(0), layout)
    hairs._root = hairs._root_offsets(groom.scalp.points, root_frames(groom, groom.scalp.points, "rest pose")[0])
    return hairs


def _with_lengths(hairs: Hairs, locks: Curves) -> dict[str, Any]:
    """The layout with what depends on the shape of the locks: turns of coils, and of hairs' own."""
    layout = hairs._layout
    if not layout["curl"]:
        return layout
    curl = hair_curl.with_turns(
        layout["curl"], locks.lengths()[hairs.curves.curve["lock"]] * (layout["tip"] - layout["join"])
    )
    hair_curl.check_points(curl["coil"], len(layout["profile"]))
    return {**layout, "curl": curl, "window": hair_curl.turn_points(locks)}


def _key(groom: Groom, settings: HairSettings, fraction: float, wider: bool) -> bytes:
    """Digest of the inputs that determine the positions of hairs in their locks."""
    locks, scalp, fiber = groom.locks, groom.scalp, fiber_settings(groom)
    section = fiber.values(locks, scalp)
    shape = settings.model_dump_json(), fiber.model_dump_json(include={"flatness", "twist_pitch", "vary_hairs", "seed"})
    digest = blake2b(f"{shape} {groom.region} {fraction} {wider}".encode(), digest_size=16)
    for array in (
        locks.ids,
        locks.offsets,
        locks.curve["root_triangle"],
        locks.curve["root_barycentric"],
        locks.curve.get(REACH, np.empty(0)),
        lock_joins(locks),
        *((locks.points, locks.curve[LAID]) if LAID in locks.curve else ()),
        *(locks.curve[name] for name in (felt.PROFILE, felt.MATTING, felt.FUZZ) if name in locks.curve),
        *(values(name) for values in hair_values(groom, settings).values() for name in _varied(values.settings)),
        locks.curve.get(STRAND_RADIUS, np.empty(0)),
        scalp.points,
        scalp.triangles,
        *((locks.curve[HAIR_SHARE],) if HAIR_SHARE in locks.curve else ()),
        *((locks.points,) if settings.blend != HairSettings().blend else ()),
        *((locks.lengths(), *map(section, ("flatness", "twist_pitch"))) if fiber.is_flat else ()),
        *((groom.offsets.lock, groom.offsets.tip, groom.offsets.across, groom.offsets.width) if groom.offsets else ()),
    ):
        digest.update(np.ascontiguousarray(array).data)
    return digest.digest()


def _varied(settings: BaseModel) -> list[str]:
    """Names of the settings that vary from lock to lock."""
    return [name for name in type(settings).model_fields if isinstance(getattr(settings, name), Varied)]
