"""Render hairs: interpolated around every lock, and deformed with it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from hashlib import blake2b
from typing import Any

import numpy as np
from pydantic import BaseModel

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import HAIR_SHARE, STRAND_RADIUS, Groom
from ringlet.data.quantities import Varied
from ringlet.deform import Hairs, root_frames
from ringlet.groom import felt, hair_curl
from ringlet.groom.color import hair_colors
from ringlet.groom.hair_layout import lock_joins, place_hairs, points_of_hairs
from ringlet.groom.hair_settings import HairSettings, fiber_settings, hair_settings, hair_values
from ringlet.groom.part_line import TO_PART
from ringlet.groom.scalp import axes
from ringlet.groom.shares import LAID, REACH


@dataclass
class HairMemory:
    """Cache of the last hairs, valid while the locks keep their roots.

    curled: the last layout of the curl of hairs, and curves that stand for it
    grooms, joined: caches of each of several grooms by name, and their curves with those that are joined of them
    """

    key: bytes = b""
    hairs: Hairs | None = None
    curled: tuple[dict[str, Any], Curves] | None = None
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
    groom.check_bound("hairs")
    key = _key(groom, settings, fraction, wider)
    if memory.hairs is None or memory.key != key:
        memory.key, memory.hairs, memory.curled = key, _placed(groom, settings, fraction, wider), None
    cached = memory.hairs
    assert cached.frames is not None
    axis = np.einsum("lxk,lx->lk", cached.frames, axes(groom.locks, cached.frames))
    layout = _with_lengths(cached, groom.locks)
    curves = cached.curves
    if layout["curl"]:  # whoever keeps a layout compares curves, so that another curl needs others
        if memory.curled is None or not _alike(layout["curl"], memory.curled[0]):
            memory.curled = layout["curl"], replace(curves)
        curves = memory.curled[1]
    return Hairs(curves, groom, axis, layout, cached.root, cached.frames)


def _alike(one: dict[str, np.ndarray], other: dict[str, np.ndarray]) -> bool:
    """Whether two layouts of the curl of hairs hold the same numbers."""
    return one.keys() == other.keys() and all(np.array_equal(one[name], other[name]) for name in one)


def _placed(groom: Groom, settings: HairSettings, fraction: float, wider: bool) -> Hairs:
    """Hairs with unset points and axes."""
    curves, layout = place_hairs(groom, settings, fraction, wider)
    hairs = Hairs(curves, groom, np.empty(0), layout)
    roots, hairs.frames = root_frames(groom, groom.scalp.points, "rest pose")
    hairs.root = hairs.root_offsets(groom.scalp.points, roots)
    return hairs


def _with_lengths(hairs: Hairs, locks: Curves) -> dict[str, Any]:
    """The layout with what depends on the shape of the locks: turns of coils, and of hairs' own."""
    layout = hairs.layout
    if not layout["curl"]:
        return layout
    lock, window = hairs.curves.curve["lock"], hair_curl.turn_points(locks)
    turns = np.where(window > 0, locks.counts / np.maximum(window, 1), 0.0)
    lengths = locks.lengths()[lock] * (layout["tip"] - layout["join"])
    curl = hair_curl.with_turns(layout["curl"], lengths, turns[lock])
    hair_curl.check_points(curl["coil"], len(layout["profile"]))
    return {**layout, "curl": curl, "window": window}


def _key(groom: Groom, settings: HairSettings, fraction: float, wider: bool) -> bytes:
    """Digest of the inputs that determine the positions of hairs in their locks."""
    locks, scalp, fiber = groom.locks, groom.scalp, fiber_settings(groom)
    section = fiber.values(locks, scalp)
    shape = settings.model_dump_json(), fiber.model_dump_json(include={"flatness", "twist_pitch", "vary_hairs", "seed"})
    points = points_of_hairs(groom, settings)
    digest = blake2b(f"{shape} {groom.region} {fraction} {wider} {points}".encode(), digest_size=16)
    for array in (
        locks.ids,
        locks.offsets,
        locks.curve["root_triangle"],
        locks.curve["root_barycentric"],
        *(locks.curve[name] for name in (REACH, TO_PART) if name in locks.curve),
        lock_joins(locks),
        *((locks.points, locks.curve[LAID]) if LAID in locks.curve else ()),
        *(locks.curve[name] for name in (felt.PROFILE, felt.MATTING, felt.FUZZ) if name in locks.curve),
        *(values(name) for values in hair_values(groom, settings).values() for name in _placed_values(values.settings)),
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


def _placed_values(settings: BaseModel) -> list[str]:
    """Names of the settings whose values depend on where locks are, and not on the settings and on ids alone."""
    found = ((name, getattr(settings, name)) for name in type(settings).model_fields)
    return [
        name for name, value in found if isinstance(value, Varied) and (value.map or value.region or value.noise > 0.0)
    ]
