"""Render hairs: many around every lock, carried by it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationError

from ringlet import _core
from ringlet.curves import Curves, offsets_from_counts
from ringlet.errors import UserError
from ringlet.groom.groom import Groom
from ringlet.groom.random import Random
from ringlet.groom.settings import Quantity, Ramped, Section, explain

IDS_PER_LOCK = 10_000  # the id of a hair: id of its lock · 10 000 + number in it
FRIZZ_KNOTS = 8


class HairSettings(Section):
    """The hairs of each lock."""

    per_lock: int = Field(
        default=20, ge=1, le=IDS_PER_LOCK, description="hairs of a lock; the first of them is the groom guide itself"
    )
    points: int | None = Field(
        default=None, ge=2, le=10_000, description="points of a hair; those of the lock when absent"
    )
    radius: Annotated[Ramped, Quantity("m", 0.0, 0.1)] = Field(
        default=Ramped(value=0.0012, ramp=[(0, 1), (0.5, 0.8), (1, 0.5)]),
        description="radius of a lock's cross-section",
    )
    spread: Annotated[float, Quantity("m", 0.0, 0.1)] = Field(
        default=0.003, description="radius on the scalp that a lock's roots cover"
    )
    gather: Annotated[float, Quantity("", 0.001, 1.0)] = Field(
        default=0.15, description="part of the lock over which they come together"
    )
    width: Annotated[Ramped, Quantity("m", 1e-6, 0.01)] = Field(
        default=Ramped(value=0.00009, vary=0.2, ramp=[(0, 1), (0.7, 0.9), (1, 0.3)]), description="diameter of a hair"
    )
    shorter: Annotated[float, Quantity("", 0.0, 0.9)] = Field(
        default=0.08, description="by how much the shortest hairs of a lock are shorter"
    )
    frizz: Annotated[float, Quantity("m", 0.0, 0.05)] = Field(
        default=0.0004, description="how far hairs wander from their place in the lock"
    )
    stray: Annotated[float, Quantity("", 0.0, 1.0)] = Field(
        default=0.04, description="part of the hairs that leave their lock"
    )
    stray_radius: Annotated[float, Quantity("m", 0.0, 0.1)] = Field(default=0.004, description="how far those wander")
    seed: int = Field(default=1, ge=0, le=2**31, description="another seed, other places in the locks")


@dataclass
class Hairs:
    """Hairs of a groom at rest, and how to carry them.

    curves: points at rest [m], float32. Curve attributes: ``lock`` (index of the lock, int32), ``guide_id`` (its id,
            int64), ``root_triangle``, ``root_barycentric``, and, where the scalp has them, ``st`` (texture coordinates
            of the root, float32). Point attribute: ``width``, the diameter [m], float32.
    """

    curves: Curves
    _groom: Groom
    _axis: NDArray[np.float64]  # where each lock's frame starts, in the frame of the scalp at its root
    _layout: dict[str, NDArray]

    def at(self, lock_points: NDArray, scalp_points: NDArray) -> NDArray[np.float32]:
        """Where the hairs are when locks and scalp have moved; shape (n, 3) [m], float32.

        lock_points:  positions of ``groom.locks`` now [m], shape (locks' points, 3)
        scalp_points: positions of ``groom.scalp`` now [m], shape (scalp points, 3)
        """
        locks, triangles = self._groom.locks, self._groom.scalp.triangles
        at = np.ascontiguousarray(scalp_points, np.float64)
        lock_roots, frames = _core.root_frames(
            at, triangles, locks.curve["root_triangle"], locks.curve["root_barycentric"]
        )
        hair_roots = np.einsum(
            "hc,hcx->hx", self.curves.curve["root_barycentric"], at[triangles[self.curves.curve["root_triangle"]]]
        )
        lock = self.curves.curve["lock"]
        root = (hair_roots - lock_roots[lock]).astype(np.float32)
        root[self._layout["first"][:-1]] = 0.0  # the first hair of a lock is the lock
        return _core.warp_hairs(
            np.ascontiguousarray(lock_points, np.float32),
            locks.offsets,
            axis=np.einsum("lxk,lk->lx", frames, self._axis),
            root=root,
            **self._layout,
        )


def make_hairs(groom: Groom, *, fraction: float = 1.0) -> Hairs:
    """Hairs around every lock of the groom, placed by (seed, lock, number).

    fraction: the part of each lock's hairs to make, in (0, 1]; always the first ones of the same hairs
    """
    settings = _settings(groom.hairs)
    if not 0.0 < fraction <= 1.0:
        raise UserError(f"hairs: fraction is {fraction}; must be more than 0 and at most 1")
    locks, scalp = groom.locks, groom.scalp
    lock_count = len(locks)
    each = max(1, round(settings.per_lock * fraction))
    count = lock_count * each
    lock = np.repeat(np.arange(lock_count, dtype=np.int32), each)
    number = np.tile(np.arange(each), lock_count)
    ids = locks.ids[lock] * IDS_PER_LOCK + number
    points = settings.points or int(locks.counts.max())

    roots, frames = _core.root_frames(
        scalp.points, scalp.triangles, locks.curve["root_triangle"], locks.curve["root_barycentric"]
    )
    axis = _start_axes(locks, frames)
    disk = _disk(settings, ids, number)
    around = roots[lock] + settings.spread * np.einsum("hxk,hk->hx", frames[lock][:, :, :2], disk)
    try:
        region = np.ascontiguousarray(scalp.region(groom.region), np.int32)
    except KeyError as error:
        raise UserError(f"hairs: {error.args[0]}") from None
    root_triangle, root_barycentric, _ = _core.bind_roots(scalp.points, scalp.triangles, around, region)
    is_lock = number == 0
    root_triangle[is_lock] = locks.curve["root_triangle"]
    root_barycentric[is_lock] = locks.curve["root_barycentric"]

    u = np.linspace(0.0, 1.0, points)
    attributes: dict[str, NDArray] = {
        "lock": lock,
        "guide_id": locks.ids[lock],
        "root_triangle": root_triangle,
        "root_barycentric": root_barycentric,
    }
    if scalp.uv is not None:
        attributes["st"] = np.einsum("hc,hcx->hx", root_barycentric, scalp.uv[root_triangle]).astype(np.float32)
    thickness = settings.width.per_curve(Random(settings.seed, "hairs/width"), ids, roots[lock]).astype(np.float32)
    widths = (thickness[:, None] * settings.width.along(u).astype(np.float32)).reshape(-1)

    curves = Curves(
        np.empty((0, 3), np.float32), offsets_from_counts(np.full(count, points)), ids, attributes, {"width": widths}
    )
    hairs = Hairs(curves, groom, axis, _layout(settings, ids, number, disk, roots[lock], u, each, lock_count))
    curves.points = hairs.at(locks.points, scalp.points)
    return hairs


def _settings(values: dict[str, Any]) -> HairSettings:
    try:
        return HairSettings.model_validate(values, context={"unit": 1.0})
    except ValidationError as error:
        raise explain(error, "groom: hairs") from error


def _start_axes(locks: Curves, frames: NDArray) -> NDArray[np.float64]:
    """For each lock, a direction across its first edge in the root's frame (count, 3): the tangent of the surface, or
    its bitangent where the lock runs along the tangent."""
    first = locks.points[locks.offsets[:-1] + 1] - locks.points[locks.offsets[:-1]]
    along = np.abs(np.einsum("lxk,lx->lk", frames[:, :, :2], first))
    return np.where((along[:, :1] <= along[:, 1:]), [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])


def _disk(settings: HairSettings, ids: NDArray, number: NDArray) -> NDArray[np.float64]:
    """Places in the unit disk (hairs, 2), evenly spread within a lock (a shaken Vogel spiral); 0 for the first hair."""
    random = Random(settings.seed, "hairs/place")
    radius = np.sqrt(
        (number - random.uniform(ids, 0)) / max(settings.per_lock - 1, 1), where=number > 0, out=np.zeros(len(ids))
    )
    angle = number * np.pi * (3.0 - np.sqrt(5.0)) + 2.0 * np.pi * random.uniform(ids // IDS_PER_LOCK, 1)
    return radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _layout(
    settings: HairSettings,
    ids: NDArray,
    number: NDArray,
    disk: NDArray,
    roots: NDArray,
    u: NDArray,
    each: int,
    lock_count: int,
) -> dict[str, NDArray]:
    """What the kernel needs (src/ringlet/groom/hairs.h); all zero for the first hair of each lock."""
    random = Random(settings.seed, "hairs")
    free = number > 0
    radius = settings.radius.per_curve(Random(settings.seed, "hairs/radius"), ids // IDS_PER_LOCK, roots)
    tip = 1.0 - settings.shorter * free * random.uniform(ids, 0) ** 2
    reach = np.where(random.uniform(ids, 1) < settings.stray, settings.stray_radius, settings.frizz) * free
    knots = (
        reach[:, None]
        * np.linspace(0.0, 1.0, FRIZZ_KNOTS).repeat(2)
        * (2.0 * Random(settings.seed, "hairs/frizz").uniforms(ids, 2 * FRIZZ_KNOTS) - 1.0)
    )
    near = np.clip(1.0 - u / settings.gather, 0.0, 1.0)
    return {
        "first": np.arange(0, lock_count * each + 1, each, dtype=np.int32),
        "offset": (radius[:, None] * disk).astype(np.float32),
        "tip": tip.astype(np.float32),
        "frizz": knots.astype(np.float32),
        "profile": settings.radius.along(u).astype(np.float32),
        "hold": (near * near * (3.0 - 2.0 * near)).astype(np.float32),
    }
