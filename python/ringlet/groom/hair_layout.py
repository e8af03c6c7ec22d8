"""Where hairs are in their locks: roots, widths, and the inputs of the kernel that carries them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from ringlet import _core
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.groom import SECTION, Groom
from ringlet.data.pigment import FLATNESS, TWIST
from ringlet.data.quantities import Quantity
from ringlet.data.random import Random, soft_threshold
from ringlet.deform import root_frames
from ringlet.groom import felt, hair_curl
from ringlet.groom.adopted import place_adopted
from ringlet.groom.density import groom_areas, hair_region, lock_counts
from ringlet.groom.fiber import seen_widths
from ringlet.groom.hair_curl import Placed
from ringlet.groom.hair_settings import IDS_PER_LOCK, HairSettings, fiber_settings, hair_values, lock_radii
from ringlet.groom.operators.woven import JOIN
from ringlet.groom.part_line import TO_PART
from ringlet.groom.shares import LAID, REACH, cells_at_part, fed, gathered, scattered
from ringlet.groom.thinning import thinned
from ringlet.groom.values import Values

FRIZZ_KNOTS = 8
PLASTIC = np.array([0.7548776662466927, 0.5698402909980532])  # steps of a low-discrepancy sequence in the plane
MIRRORED = 1e-4  # distance from the region from which a root is mirrored at its border [m]
LATEST_JOIN = 0.9  # part of a lock
LEAST_RISE = 0.04  # sine of the angle at which a hair that goes straight to its strand leaves the skin
LATER, TRIES = 0.25, 40  # how much later it joins until it does, in `JOIN` of its lock, and how often at most
PACE_EASE = 0.3  # half the part of `root_falloff` over which a flat hair turns into its lock


def place_hairs(groom: Groom, settings: HairSettings, fraction: float, wider: bool) -> tuple[Curves, dict[str, Any]]:
    """Hairs with all attributes and unset points, and the inputs of the kernel that do not depend on the shape of the
    locks (src/ringlet/groom/hairs.h).

    Raises UserError when the groom's region is not in its mesh.
    """
    if groom.offsets is not None:
        return place_adopted(groom, groom.offsets, settings, fraction, wider)
    locks, scalp, values = groom.locks, groom.scalp, hair_values(groom, settings)
    own = values[""]
    roots, frames = root_frames(groom, scalp.points, "rest pose")
    areas = groom_areas(groom)
    full_count = lock_counts(groom, areas)
    counts, made = thinned(full_count, fraction)
    first = offsets_from_counts(counts)
    lock = np.repeat(np.arange(len(locks), dtype=np.int32), counts)
    number = made - (np.cumsum(full_count) - full_count)[lock]
    ids = locks.ids[lock] * IDS_PER_LOCK + number
    disk = _disk(settings, ids, number, full_count[lock])
    hairs = Placed(ids, lock, _cross_section(own, lock, disk), lock_radii(locks, own("lock_radius"))[lock], number > 0)

    spread = np.maximum(own("root_radius"), np.sqrt(areas / np.pi))
    around = spread[lock, None] * np.einsum("hxk,hk->hx", frames[lock][:, :, :2], disk)
    if TO_PART in locks.curve:
        at_part, offsets = cells_at_part(roots, frames, locks.curve[TO_PART].astype(np.float64), spread, lock, disk)
        around[at_part] = offsets
    places = roots[lock] + around
    joins = lock_joins(locks)[lock]
    _root_in_rows(groom, settings, first, number, places, joins)
    shared = (_is_shared(locks) & ~_is_row(locks))[lock]
    if shared.any():
        of = lock[shared]
        places[shared] = scattered(locks.curve[REACH][of], roots[of], frames[of, :, 2], disk[shared])
        joins[shared] = np.minimum(joins[shared] * gathered(np.linalg.norm(disk[shared], axis=1)), LATEST_JOIN)
    root_triangle, root_barycentric = _rooted(groom, places)
    if (flat := _is_shared(locks)[lock]).any():
        joins[flat] = _clear(groom, root_triangle[flat], root_barycentric[flat], lock[flat], joins[flat])
    root_triangle[~hairs.free] = locks.curve["root_triangle"]
    root_barycentric[~hairs.free] = locks.curve["root_barycentric"]

    u = np.linspace(0.0, 1.0, points_of_hairs(groom, settings))
    attributes: dict[str, NDArray] = {
        "lock": lock,
        "guide_id": locks.ids[lock],
        "root_triangle": root_triangle,
        "root_barycentric": root_barycentric,
    }
    if scalp.uv is not None:
        attributes["st"] = np.einsum("hc,hcx->hx", root_barycentric, scalp.uv[root_triangle]).astype(np.float32)
    width = own.per_hair("width", lock, ids)
    if wider:
        width = Quantity.of(settings, "width").clipped(width * (full_count / counts)[lock], settings.width.peak)
    curves = Curves(
        np.empty((len(lock) * len(u), 3), np.float32),
        offsets_from_counts(np.full(len(lock), len(u))),
        ids,
        attributes,
        {"width": (width.astype(np.float32)[:, None] * settings.width.along(u).astype(np.float32)).reshape(-1)},
    )
    _flatten(groom, curves)
    layout = {"first": first, **_layout(settings, own, hairs, u)}
    layout["join"] = np.where(hairs.free, joins, 0.0).astype(np.float32)
    if felt.is_felted(locks):
        layout["frizz"] = _felted(settings, own, hairs, layout["frizz"])
    layout |= _curl(values, layout, hairs, u)
    return curves, layout | _neighbours(settings, own, curves, hairs, roots, u)


def points_of_hairs(groom: Groom, settings: HairSettings) -> int:
    """Points of each hair."""
    if settings.points is not None:
        return settings.points
    most = int(groom.locks.counts.max())
    coil = hair_values(groom, settings).get("coil")
    return most if coil is None else max(most, hair_curl.points_needed(coil, groom.locks.lengths()))


def _rooted(groom: Groom, places: NDArray) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
    """Triangles (n,) and barycentrics (n, 3) of the roots nearest to places (n, 3) [m].

    Places beyond the border of the region are mirrored at it, so that hair does not crowd there.
    """
    points, region = np.ascontiguousarray(groom.scalp.points, np.float64), hair_region(groom)
    triangle, barycentric, off = _core.bind_roots(points, groom.scalp.triangles, places, region)
    beyond = np.flatnonzero(off > MIRRORED)
    corners = points[groom.scalp.triangles[triangle[beyond]]]
    inside = 2.0 * np.einsum("nc,ncx->nx", barycentric[beyond], corners) - places[beyond]
    triangle[beyond], barycentric[beyond], _ = _core.bind_roots(points, groom.scalp.triangles, inside, region)
    return triangle, barycentric


def _root_in_rows(
    groom: Groom, settings: HairSettings, first: NDArray, number: NDArray, places: NDArray, joins: NDArray
) -> None:
    """Sets the places where hairs of cornrows grow [m], shape (hairs, 3), and where they join their lock, (hairs,)."""
    rows = np.flatnonzero(_is_row(groom.locks))
    if not len(rows):
        return
    solid = _core.Solid(np.ascontiguousarray(groom.scalp.points, np.float64), groom.scalp.triangles)
    for k in rows.tolist():
        of = slice(first[k], first[k + 1])
        places[of], joins[of] = _fed(settings, groom.locks, solid, k, number[of])


def _flatten(groom: Groom, hairs: Curves) -> None:
    """Gives fibers with an elliptical section the angle ``twist`` of that section, and the widths that are seen."""
    fiber, lock = fiber_settings(groom), hairs.curve["lock"]
    if not fiber.is_flat or not len(hairs):
        return
    values = fiber.values(groom.locks, groom.scalp)
    flatness, pitch = (fiber.of_hairs(name, values(name), lock, hairs.ids) for name in (FLATNESS, "twist_pitch"))
    lengths = groom.locks.lengths()[lock]
    twist = fiber.twist(hairs.ids, lengths, pitch, int(hairs.counts[0]))
    seen = seen_widths(flatness, twist, lengths, pitch).astype(np.float32)
    hairs.point |= {TWIST: twist.ravel(), "width": hairs.point["width"] * seen.ravel()}


def _is_shared(locks: Curves) -> NDArray[np.bool_]:
    """Whether the hairs of a lock come from its share of a section, shape (locks,)."""
    if REACH not in locks.curve:
        return np.zeros(len(locks), np.bool_)
    return np.asarray(locks.curve[REACH].max(axis=1) > 0.0)


def _is_laid(locks: Curves) -> NDArray[np.bool_]:
    """Whether a lock lies on the scalp, shape (locks,)."""
    return np.asarray(locks.curve.get(LAID, np.zeros(len(locks))) > 0.0)


def _is_row(locks: Curves) -> NDArray[np.bool_]:
    """Whether a lock lies on the scalp along the row of a section, shape (locks,)."""
    return _is_shared(locks) & _is_laid(locks)


def _fed(
    settings: HairSettings, locks: Curves, solid: _core.Solid, lock: int, number: NDArray
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places where the hairs of a cornrow's strand grow [m], shape (n, 3), and parts of it where they join, (n,)."""
    own, counts = locks.curve, locks.counts
    length = max(float(locks.take(np.array([lock])).lengths()[0]), 1e-9)
    strands = (own[SECTION] == own[SECTION][lock]) & (counts == counts[lock]) & (own[LAID] > 0.0)
    middle = locks.take(strands).points.reshape(-1, counts[lock], 3).mean(axis=0)
    chance = Random(settings.seed, "hairs/row").uniforms(locks.ids[lock : lock + 1], 2)
    at = (chance + number[:, None] * PLASTIC) % 1.0  # a low-discrepancy sequence (Roberts 2018)
    found = fed(locks[lock], middle, solid, own[REACH][lock], own[LAID][lock] / length, own[JOIN][lock] / length, at)
    return found.places, found.joins


def _clear(groom: Groom, triangle: NDArray, barycentric: NDArray, lock: NDArray, joins: NDArray) -> NDArray[np.float64]:
    """Where hairs with roots in triangles (n,) at barycentrics (n, 3) join their locks (n,): no sooner than ``joins``.

    A hair goes straight to its lock. It joins later where skin that bulges on the way would hide it, if that helps.
    """
    points, locks = np.ascontiguousarray(groom.scalp.points, np.float64), groom.locks
    roots, frames = _core.root_frames(points, groom.scalp.triangles, triangle, barycentric)
    first, last = locks.offsets[lock], locks.counts[lock] - 1
    step, later, found = LATER * lock_joins(locks)[lock], joins.copy(), np.zeros(len(lock), np.bool_)
    for _ in range(TRIES):
        way = locks.points[first + np.rint(later * last).astype(np.int64)] - roots
        found |= np.sum(way * frames[:, :, 2], axis=1) >= LEAST_RISE * np.linalg.norm(way, axis=1)
        if found.all():
            break
        later = np.where(found, later, np.minimum(later + step, LATEST_JOIN))
    return np.where(found, later, joins)


def lock_joins(locks: Curves) -> NDArray[np.float64]:
    """Part of each lock after which hairs come to it, shape (locks,)."""
    if JOIN not in locks.curve:
        return np.zeros(len(locks))
    return np.minimum(locks.curve[JOIN] / np.maximum(locks.lengths(), 1e-9), LATEST_JOIN)


def _disk(settings: HairSettings, ids: NDArray, number: NDArray, full_count: NDArray) -> NDArray[np.float64]:
    """Samples of the unit disk, uniform within a lock (a jittered Vogel spiral), shape (hairs, 2); 0 for the first."""
    random = Random(settings.seed, "hairs/place")
    radius = np.sqrt(
        (number - random.uniform(ids, 0)) / np.maximum(full_count - 1, 1), where=number > 0, out=np.zeros(len(ids))
    )
    angle = number * np.pi * (3.0 - np.sqrt(5.0)) + 2.0 * np.pi * random.uniform(ids // IDS_PER_LOCK, 1)
    return radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _layout(settings: HairSettings, per_lock: Values, hairs: Placed, u: NDArray) -> dict[str, NDArray]:
    """Inputs of the kernel without the curl of hairs; offsets are zero for the first hair of each lock."""
    random, lock, ids, free = Random(settings.seed, "hairs"), hairs.lock, hairs.ids, hairs.free
    tip = 1.0 - per_lock("shorter")[lock] * free * random.uniform(ids, 0) ** 2
    strays = soft_threshold(per_lock("stray")[lock], random.uniform(ids, 1))
    frizz, stray = per_lock("frizz")[lock], per_lock("stray_distance")[lock]
    amplitude = (frizz + strays * (stray - frizz)) * free
    edges = (_is_laid(per_lock.locks) & ~_is_row(per_lock.locks))[lock]
    amplitude = np.where(
        edges, np.minimum(amplitude, hairs.radius), amplitude
    )  # laid edges have no hairs that stand off
    knots = (
        amplitude[:, None]
        * np.linspace(0.0, 1.0, FRIZZ_KNOTS).repeat(2)
        * (2.0 * Random(settings.seed, "hairs/frizz").uniforms(ids, 2 * FRIZZ_KNOTS) - 1.0)
    )
    t = np.clip(1.0 - u / settings.root_falloff, 0.0, 1.0)
    return {
        "offset": (hairs.radius[:, None] * hairs.disk).astype(np.float32),
        "tip": tip.astype(np.float32),
        "flat": (_is_shared(per_lock.locks)[lock] & free).astype(np.float32),
        "taper": per_lock("lock_taper")[lock].astype(np.float32),
        "frizz": knots.astype(np.float32),
        "profile": settings.lock_radius.along(u).astype(np.float32),
        "hold": (t * t * (3.0 - 2.0 * t)).astype(np.float32),
        "pace": _pace(u, settings.root_falloff).astype(np.float32),
    }


def _pace(u: NDArray, root_falloff: float) -> NDArray[np.float64]:
    """How far along its lock a flat hair is at its parameters u: it starts once it has come there, smoothly."""
    soft = PACE_EASE * root_falloff
    late = np.clip(u - root_falloff + soft, 0.0, None)
    pace = np.where(late < 2.0 * soft, late * late / (4.0 * soft), late - soft)
    return pace / max(1.0 - root_falloff, 1e-9) if root_falloff < 1.0 else 0.0 * u


def _felted(settings: HairSettings, per_lock: Values, hairs: Placed, frizz: NDArray) -> NDArray[np.float32]:
    """Knots of hairs with the thickness and the matting of their locks, shape (hairs, 2 · felt.KNOTS)."""
    u = np.linspace(0.0, 1.0, felt.KNOTS)
    narrows = settings.lock_radius.along(u) * (1.0 - per_lock("lock_taper")[:, None] * u)
    radius = hairs.radius[:, None] * narrows[hairs.lock]
    return felt.felted(per_lock.locks, hairs.lock, hairs.ids, hairs.disk, radius, frizz, settings.seed).astype(
        np.float32
    )


def _curl(values: dict[str, Values], layout: dict[str, NDArray], hairs: Placed, u: NDArray) -> dict[str, Any]:
    """Inputs of the kernel for the curl of hairs; empty where these only follow their lock."""
    window = np.empty(0, np.int32)
    if len(values) == 1:
        return {"window": window, "curl": {}}
    knots = layout["frizz"].shape[1] // 2
    curl, wander = hair_curl.curl_layout(
        values.get("families"), values.get("curl"), values.get("coil"), hairs, u, knots
    )
    return {"window": window, "curl": curl, "frizz": layout["frizz"] + wander.astype(np.float32)}


def _cross_section(per_lock: Values, lock: NDArray, disk: NDArray) -> NDArray[np.float64]:
    """Positions in the cross-section of the locks, relative to its radius, shape (hairs, 2).

    ``hollow`` moves the disk's samples to the rim; ``flatness`` flattens the disk along a random direction per lock.
    """
    radius = np.linalg.norm(disk, axis=1)
    disk = disk * (np.maximum(radius, 1e-9) ** -np.minimum(per_lock("hollow"), 1.0)[lock])[:, None]
    angle = np.pi * Random(per_lock.seed, "hairs/ribbon").uniform(per_lock.locks.ids)[lock]
    thin = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    pressed = np.minimum(per_lock("lock_flatness"), 1.0)[lock] * np.sum(disk * thin, axis=1)
    return disk - pressed[:, None] * thin


def _neighbours(
    settings: HairSettings, per_lock: Values, curves: Curves, hairs: Placed, roots: NDArray, u: NDArray
) -> dict[str, NDArray]:
    """Neighbouring lock that each hair blends with, and the blend weight: one half midway, 0 across a part line."""
    blend = settings.blend.along(u).astype(np.float32)
    locks, scalp, lock, amount = per_lock.locks, per_lock.scalp, hairs.lock, per_lock("blend")
    if not amount.any() or len(locks) < 2:
        return {"other": np.empty(0, np.int32), "share": np.empty(0, np.float32), "blend": blend}
    bound = curves.curve
    at = np.einsum("hc,hcx->hx", bound["root_barycentric"], scalp.points[scalp.triangles[bound["root_triangle"]]])
    nearest = np.asarray(KDTree(roots).query(at, k=2)[1])
    other = np.where(nearest[:, 0] == lock, nearest[:, 1], nearest[:, 0]).astype(np.int32)
    own_distance, other_distance = (np.linalg.norm(at - roots[index], axis=1) for index in (lock, other))
    middle = np.add.reduceat(locks.points, locks.offsets[:-1], axis=0) / locks.counts[:, None] - locks.roots
    lean = middle / np.maximum(np.linalg.norm(middle, axis=1, keepdims=True), 1e-12)
    angle = np.degrees(np.arccos(np.clip(np.sum(lean[lock] * lean[other], axis=1), -1.0, 1.0)))
    alignment = np.clip(4.0 * (1.0 - angle / settings.apart), 0.0, 1.0)
    share = amount[lock] * alignment * own_distance / np.maximum(own_distance + other_distance, 1e-12)
    return {
        "other": other,
        "share": np.where(hairs.free, np.minimum(share, 1.0), 0.0).astype(np.float32),
        "blend": blend,
    }
