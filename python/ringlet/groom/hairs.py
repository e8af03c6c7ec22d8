"""Render hairs: interpolated around every lock, and deformed with it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from hashlib import blake2b
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationError
from scipy.spatial import KDTree

from ringlet import _core
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.data.groom import SECTION, STRAND_RADIUS, Groom
from ringlet.data.mesh import Mesh
from ringlet.data.painted import per_lock as for_each_lock
from ringlet.data.pigment import TWIST
from ringlet.data.precision import origin_of
from ringlet.data.quantities import Quantity, Ramped, Section, Varied, explain
from ringlet.data.random import Random, soft_threshold
from ringlet.groom import density, felt, hair_curl
from ringlet.groom.color import hair_colors
from ringlet.groom.cover import Cover, measure
from ringlet.groom.fiber import FiberSettings
from ringlet.groom.hair_curl import Families, HairCoil, HairCurl, Placed, Values
from ringlet.groom.mask import Mask
from ringlet.groom.operators.woven import JOIN
from ringlet.groom.scalp import axes
from ringlet.groom.shares import LAID, REACH, fed, scattered

IDS_PER_LOCK = 10_000  # id of a hair: id of its lock · 10 000 + number in the lock
FRIZZ_KNOTS = 8
PLASTIC = np.array([0.7548776662466927, 0.5698402909980532])
LATEST_JOIN = 0.9  # part of a lock
PACE_EASE = 0.3  # half the part of `gather` over which a flat hair turns into its lock
FIRST_PER_CM2, MOST_PER_CM2 = 60.0, 400.0  # densities that a cover begins with and ends at
HAIR_SHARE = "hair_share"  # curve attribute of locks: part of their hairs that grow, where there is a mask
MARGIN = 1e-4  # [m] distance of hairs from surfaces, twice the radius of a hair


class HairSettings(Section):
    """Render hairs of each lock."""

    per_lock: Annotated[Varied, Quantity("", 1, IDS_PER_LOCK)] = Field(
        default=Varied(value=20), description="hairs of a lock; the first of them is the groom guide itself"
    )
    density: Annotated[Varied | None, Quantity("/cm2", 0.1, 2000.0)] = Field(
        default=None,
        description="hairs per cm² of scalp, in place of `per_lock`: 120 is a full head. Roots fill the share of the "
        "scalp that is nearest to their lock",
    )
    cover: Annotated[float | None, Quantity("", 0.0, 0.999)] = Field(
        default=None,
        description="part of the scalp that hair hides from cameras around the head; the density is raised to that",
    )
    mask: Annotated[Mask | None, Quantity("", 0.0, 1.0)] = Field(
        default=None, description="part of the hairs that grow: a number, map, region or expression; all when absent"
    )
    points: int | None = Field(
        default=None, ge=2, le=10_000, description="points of a hair; those of the lock when absent"
    )
    radius: Annotated[Ramped, Quantity("m", 0.0, 0.1)] = Field(
        default=Ramped(value=0.0012, ramp=[(0, 1), (0.5, 0.8), (1, 0.5)]),
        description="radius of a lock's cross-section",
    )
    taper: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.0), description="how much narrower a lock gets towards its tip besides: 1 to a point"
    )
    flatness: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.0), description="cross-section of a lock: 0 round, 1 a flat ribbon"
    )
    hollow: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.0), description="where hairs are in it: 0 everywhere, 1 at the rim"
    )
    spread: Annotated[Varied, Quantity("m", 0.0, 0.1)] = Field(
        default=Varied(value=0.003),
        description="radius on the scalp that a lock's roots cover; those of a section's strand cover its share of the "
        "section, and lie flat up to where it grows",
    )
    gather: Annotated[float, Quantity("", 0.001, 1.0)] = Field(
        default=0.15, description="part of the lock over which they come together"
    )
    width: Annotated[Ramped, Quantity("m", 1e-6, 0.01)] = Field(
        default=Ramped(value=0.00009, vary=0.2, ramp=[(0, 1), (0.7, 0.9), (1, 0.3)]), description="diameter of a hair"
    )
    shorter: Annotated[Varied, Quantity("", 0.0, 0.9)] = Field(
        default=Varied(value=0.08), description="by how much the shortest hairs of a lock are shorter"
    )
    frizz: Annotated[Varied, Quantity("m", 0.0, 0.05)] = Field(
        default=Varied(value=0.0004), description="how far hairs wander from their place in the lock"
    )
    stray: Annotated[Varied, Quantity("", 0.0, 1.0)] = Field(
        default=Varied(value=0.04), description="part of the hairs that leave their lock"
    )
    stray_radius: Annotated[Varied, Quantity("m", 0.0, 0.1)] = Field(
        default=Varied(value=0.004), description="how far those wander"
    )
    blend: Annotated[Ramped, Quantity("", 0.0, 1.0)] = Field(
        default=Ramped(value=0.0),
        description="how far hairs between two locks mix both: 0 each follows its own; mixed curls get narrower",
    )
    apart: Annotated[float, Quantity("deg", 1.0, 180.0)] = Field(
        default=60.0, description="locks that lean further apart than this, as across a parting, are not mixed"
    )
    families: Families | None = Field(default=None, description="sub-clumps of each lock; none when absent")
    curl: HairCurl | None = Field(
        default=None, description="how hairs follow the coil of their lock; all in the same phase when absent"
    )
    coil: HairCoil | None = Field(default=None, description="a coil of each hair's own; none when absent")
    seed: int = Field(default=1, ge=0, le=2**31, description="another seed, other places in the locks")

    @property
    def sections(self) -> dict[str, Section]:
        """Tables of settings that are given, by name."""
        tables = {"families": self.families, "curl": self.curl, "coil": self.coil}
        return {name: table for name, table in tables.items() if table is not None}


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
        roots, frames = _root_frames(self._groom, at, "this frame")
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
    """Cache of the last hairs, valid while the locks keep their roots."""

    key: bytes = b""
    hairs: Hairs | None = None


def hair_count(groom: Groom) -> int:
    """Number of hairs of the whole groom."""
    settings = _settings(groom.hairs)
    return int(_counts(groom, settings, _Values(settings, groom.locks, groom.scalp), _areas(groom, settings)).sum())


def hairs_per_cm2(groom: Groom) -> float:
    """Mean number of hairs per cm² of the region that carries hair."""
    return hair_count(groom) / (density.PER_CM2 * density.region_area(groom.scalp, _region(groom)))


def hair_cover(groom: Groom, hairs: Hairs | None = None) -> Cover:
    """Cover of the scalp by all hairs of a groom at rest; ``hairs``: those, where they are made already."""
    return measure(groom.scalp, _region(groom), (hairs or make_hairs(groom)).curves)


def raise_density(groom: Groom, settings: HairSettings) -> None:
    """Sets the density of a groom to the least that has the cover of the settings, or leaves it if that has more.

    Adds to the groom's conflicts where MOST_PER_CM2 hairs do not suffice.
    """
    assert settings.cover is not None
    start = settings.density or Varied(value=FIRST_PER_CM2)
    groom.hairs["density"] = start.model_dump(mode="json")
    cover, least = hair_cover(groom), 1.0 if settings.density else 0.0
    factor = max(cover.factor_for(settings.cover, MOST_PER_CM2 / start.value), least)
    groom.hairs["density"]["value"] = min(factor * start.value, MOST_PER_CM2)
    if (seen := cover.seen(factor)) > 1.001 * (1.0 - settings.cover):
        groom.conflicts.append(
            f"hairs.cover is {settings.cover:g}, but at {MOST_PER_CM2:g} hairs/cm² {100 * seen:.1f} % of the scalp are "
            "still seen; let locks grow closer, longer or flatter"
        )


def lock_thickness(groom: Groom) -> float:
    """Largest diameter of a lock with its hairs [m], but for chance and maps."""
    radius = _settings(groom.hairs).radius
    largest = max([radius.value, *radius.region.values(), *radius.lock.values()])
    thickness = _strand_radius(groom.locks, np.full(len(groom.locks), largest)) * felt.most_thick(groom.locks)
    return 2.0 * float(thickness.max(initial=0.0)) * radius.peak


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
    settings = _settings(groom.hairs)
    if not 0.0 < fraction <= 1.0:
        raise UserError(f"hairs: fraction is {fraction}; must be more than 0 and at most 1")
    memory = memory or HairMemory()
    frames = _root_frames(groom, groom.scalp.points, "rest pose")[1]
    key = _key(groom, settings, fraction, wider)
    if memory.hairs is None or memory.key != key:
        memory.key, memory.hairs = key, _place(groom, settings, fraction, wider)
    cached = memory.hairs
    axis = np.einsum("lxk,lx->lk", frames, axes(groom.locks, frames))
    layout = _with_lengths(cached, groom.locks)
    # Whoever keeps a layout compares curves: with a curl of hairs it changes with the locks.
    curves = cached.curves if layout is cached._layout else replace(cached.curves)
    return Hairs(curves, groom, axis, layout, cached._root)


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
    locks, scalp, fiber = groom.locks, groom.scalp, _fiber(groom)
    shape = settings.model_dump_json(), fiber.model_dump_json(include={"flatness", "twist_pitch"})
    digest = blake2b(f"{shape} {groom.region} {fraction} {wider}".encode(), digest_size=16)
    values = _Values(settings, locks, scalp)
    for array in (
        locks.ids,
        locks.offsets,
        locks.curve["root_triangle"],
        locks.curve["root_barycentric"],
        locks.curve.get(REACH, np.empty(0)),
        _joins(locks),
        *((locks.points, locks.curve[LAID]) if LAID in locks.curve else ()),
        *(locks.curve[name] for name in (felt.PROFILE, felt.MATTING, felt.FUZZ) if name in locks.curve),
        *(values(name) for name in _varied(settings)),
        *(
            Values(table, locks, scalp, settings.seed, f"hairs.{section}")(name)
            for section, table in settings.sections.items()
            for name in _varied(table)
        ),
        scalp.points,
        scalp.triangles,
        *((locks.curve[HAIR_SHARE],) if HAIR_SHARE in locks.curve else ()),
        *((locks.points,) if settings.blend != HairSettings().blend else ()),
        *((locks.lengths(),) if fiber.flatness else ()),
    ):
        digest.update(np.ascontiguousarray(array).data)
    return digest.digest()


def _varied(settings: Section) -> list[str]:
    """Names of the settings that vary from lock to lock."""
    return [name for name in type(settings).model_fields if isinstance(getattr(settings, name), Varied)]


def _place(groom: Groom, settings: HairSettings, fraction: float, wider: bool) -> Hairs:
    """Hairs with all attributes and unset points.

    Raises UserError when the groom's region is not in its mesh.
    """
    locks, scalp = groom.locks, groom.scalp
    roots, frames = _root_frames(groom, groom.scalp.points, "rest pose")
    per_lock = _Values(settings, locks, scalp)
    areas = _areas(groom, settings)
    full_count = _counts(groom, settings, per_lock, areas)
    counts = np.maximum(1, np.round(full_count * fraction)).astype(np.int64)
    lock = np.repeat(np.arange(len(locks), dtype=np.int32), counts)
    first = offsets_from_counts(counts)
    number = np.arange(len(lock)) - first[lock]
    ids = locks.ids[lock] * IDS_PER_LOCK + number
    points = settings.points or int(locks.counts.max())

    disk = _disk(settings, ids, number, full_count[lock])
    spread = np.maximum(per_lock("spread"), np.sqrt(areas / np.pi))
    places = roots[lock] + spread[lock, None] * np.einsum("hxk,hk->hx", frames[lock][:, :, :2], disk)
    laid = locks.curve.get(LAID, np.zeros(len(locks))) > 0.0
    shared = (_shared(locks) & ~laid)[lock]
    joins = _joins(locks)[lock]
    if laid.any():
        solid = _core.Solid(np.ascontiguousarray(scalp.points, np.float64), scalp.triangles)
        for k in np.flatnonzero(laid).tolist():
            of = slice(first[k], first[k + 1])
            places[of], joins[of] = _fed(settings, locks, solid, k, number[of])
    if shared.any():
        of = lock[shared]
        places[shared] = scattered(locks.curve[REACH][of], roots[of], frames[of, :, 2], disk[shared])
    root_triangle, root_barycentric, _ = _core.bind_roots(scalp.points, scalp.triangles, places, _region(groom))
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
    uniform = settings.model_copy(update={"width": settings.width.model_copy(update={"vary": 0.0})})
    thickness = _Values(uniform, locks, scalp)("width")[lock]
    thickness *= Varied(value=1.0, vary=settings.width.vary).factors(Random(settings.seed, "hairs/width"), ids, ids)
    if wider:
        thickness *= (full_count / counts)[lock]
    thickness = Quantity.of(settings, "width").clipped(thickness, settings.width.peak)
    widths = (thickness.astype(np.float32)[:, None] * settings.width.along(u).astype(np.float32)).reshape(-1)

    curves = Curves(
        np.empty((len(lock) * points, 3), np.float32),
        offsets_from_counts(np.full(len(lock), points)),
        ids,
        attributes,
        {"width": widths},
    )
    _flatten(groom, curves)
    layout = _layout(settings, per_lock, ids, number, lock, disk, u)
    layout["join"] = np.where(is_lock, 0.0, joins).astype(np.float32)
    if felt.is_felted(locks):
        layout["frizz"] = _felted(settings, per_lock, ids, lock, disk, layout["frizz"])
    placed = Placed(ids, lock, _section(per_lock, lock, disk), per_lock("radius")[lock], number > 0)
    layout |= _curl(settings, per_lock, layout, placed, u)
    layout |= _neighbours(settings, per_lock, groom, curves, is_lock, roots, u)
    hairs = Hairs(curves, groom, np.empty(0), {"first": first, **layout})
    hairs._root = hairs._root_offsets(scalp.points, roots)
    return hairs


def _flatten(groom: Groom, hairs: Curves) -> None:
    """Gives fibres with an elliptical section the angle ``twist`` of that section, and the widths that are seen."""
    fiber = _fiber(groom)
    if not fiber.flatness or not len(hairs):
        return
    lengths = groom.locks.lengths()[hairs.curve["lock"]]
    twist = fiber.twist(hairs.ids, lengths, int(hairs.counts[0]))
    seen = fiber.seen_widths(twist, lengths).astype(np.float32)
    hairs.point |= {TWIST: twist.ravel(), "width": hairs.point["width"] * seen.ravel()}


def _region(groom: Groom) -> NDArray[np.int32]:
    """Triangles that carry hair; raises UserError when the groom's region is not in its mesh."""
    try:
        region = np.ascontiguousarray(groom.scalp.region(groom.region), np.int32)
    except KeyError as error:
        raise UserError(f"hairs: {error.args[0]}") from None
    if len(region) == 0:
        raise UserError(
            f"hairs: region '{groom.region}' of {groom.scalp.name} has no faces; choose the faces that carry hair"
        )
    return region


def _areas(groom: Groom, settings: HairSettings) -> NDArray[np.float64]:
    """Share of the scalp that each lock's hairs cover [m²], shape (locks,); 0 without a density."""
    if settings.density is None:
        return np.zeros(len(groom.locks))
    return density.lock_areas(groom.scalp, _region(groom), np.asarray(groom.locks.roots, np.float64))


def _counts(groom: Groom, settings: HairSettings, per_lock: _Values, areas: NDArray[np.float64]) -> NDArray[np.int64]:
    """Number of hairs of each lock, at least 1, shape (locks,)."""
    count = per_lock("per_lock") if settings.density is None else density.PER_CM2 * per_lock("density") * areas
    count = count * groom.locks.curve.get(HAIR_SHARE, 1.0)
    return np.clip(np.round(count), 1, IDS_PER_LOCK).astype(np.int64)


@dataclass
class _Values:
    """Hair settings evaluated per lock."""

    settings: HairSettings
    locks: Curves
    scalp: Mesh

    def __call__(self, name: str) -> NDArray[np.float64]:
        """Values of a setting, shape (locks,)."""
        random = Random(self.settings.seed, f"hairs/{name}")
        values = for_each_lock(self.settings, name, random, self.locks, self.scalp, f"hairs.{name}")
        return _strand_radius(self.locks, values) if name == "radius" else values


def _strand_radius(locks: Curves, radius: NDArray[np.float64]) -> NDArray[np.float64]:
    """Radius of each lock [m], shape (locks,): hairs fill the strands of a braid."""
    woven = locks.curve.get(STRAND_RADIUS, np.zeros(len(locks)))
    return np.where(woven > 0.0, woven, radius)


def _shared(locks: Curves) -> NDArray[np.bool_]:
    """Whether the hairs of a lock come from its share of a section, shape (locks,)."""
    if REACH not in locks.curve:
        return np.zeros(len(locks), np.bool_)
    return np.asarray(locks.curve[REACH].max(axis=1) > 0.0)


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


def _joins(locks: Curves) -> NDArray[np.float64]:
    """Part of each lock after which hairs come to it, shape (locks,)."""
    if JOIN not in locks.curve:
        return np.zeros(len(locks))
    return np.minimum(locks.curve[JOIN] / np.maximum(locks.lengths(), 1e-9), LATEST_JOIN)


def _settings(values: dict[str, Any]) -> HairSettings:
    try:
        return HairSettings.model_validate(values, context={"unit": 1.0})
    except ValidationError as error:
        raise explain(error, "groom: hairs", values) from error


def _fiber(groom: Groom) -> FiberSettings:
    try:
        return FiberSettings.model_validate(groom.fiber or {}, context={"unit": 1.0})
    except ValidationError as error:
        raise explain(error, "groom: fiber", groom.fiber) from error


def _root_frames(groom: Groom, at: NDArray[np.float64], when: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Roots of the locks [m], shape (locks, 3), and frames of the scalp there, shape (locks, 3, 3).

    at:   points of the scalp [m], shape (n, 3)
    when: which points these are, for messages
    """
    groom.check_roots(at, when, "hairs")
    bound = groom.locks.curve
    return _core.root_frames(
        np.ascontiguousarray(at, np.float64), groom.scalp.triangles, bound["root_triangle"], bound["root_barycentric"]
    )


def _disk(settings: HairSettings, ids: NDArray, number: NDArray, full_count: NDArray) -> NDArray[np.float64]:
    """Samples of the unit disk, uniform within a lock (a jittered Vogel spiral), shape (hairs, 2); 0 for the first."""
    random = Random(settings.seed, "hairs/place")
    radius = np.sqrt(
        (number - random.uniform(ids, 0)) / np.maximum(full_count - 1, 1), where=number > 0, out=np.zeros(len(ids))
    )
    angle = number * np.pi * (3.0 - np.sqrt(5.0)) + 2.0 * np.pi * random.uniform(ids // IDS_PER_LOCK, 1)
    return radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _layout(
    settings: HairSettings, per_lock: _Values, ids: NDArray, number: NDArray, lock: NDArray, disk: NDArray, u: NDArray
) -> dict[str, NDArray]:
    """Inputs of the kernel (src/ringlet/groom/hairs.h); offsets are zero for the first hair of each lock."""
    random = Random(settings.seed, "hairs")
    free = number > 0
    tip = 1.0 - per_lock("shorter")[lock] * free * random.uniform(ids, 0) ** 2
    strays = soft_threshold(per_lock("stray")[lock], random.uniform(ids, 1))
    frizz, stray = per_lock("frizz")[lock], per_lock("stray_radius")[lock]
    amplitude = (frizz + strays * (stray - frizz)) * free
    knots = (
        amplitude[:, None]
        * np.linspace(0.0, 1.0, FRIZZ_KNOTS).repeat(2)
        * (2.0 * Random(settings.seed, "hairs/frizz").uniforms(ids, 2 * FRIZZ_KNOTS) - 1.0)
    )
    t = np.clip(1.0 - u / settings.gather, 0.0, 1.0)
    section = _section(per_lock, lock, disk)
    return {
        "offset": (per_lock("radius")[lock, None] * section).astype(np.float32),
        "tip": tip.astype(np.float32),
        "flat": (_shared(per_lock.locks)[lock] & free).astype(np.float32),
        "taper": per_lock("taper")[lock].astype(np.float32),
        "frizz": knots.astype(np.float32),
        "profile": settings.radius.along(u).astype(np.float32),
        "hold": (t * t * (3.0 - 2.0 * t)).astype(np.float32),
        "pace": _pace(u, settings.gather).astype(np.float32),
    }


def _pace(u: NDArray, gather: float) -> NDArray[np.float64]:
    """How far along its lock a flat hair is at its parameters u: it starts once it has come there, smoothly."""
    soft = PACE_EASE * gather
    late = np.clip(u - gather + soft, 0.0, None)
    pace = np.where(late < 2.0 * soft, late * late / (4.0 * soft), late - soft)
    return pace / max(1.0 - gather, 1e-9) if gather < 1.0 else 0.0 * u


def _felted(
    settings: HairSettings, per_lock: _Values, ids: NDArray, lock: NDArray, disk: NDArray, frizz: NDArray
) -> NDArray[np.float32]:
    """Knots of hairs with the thickness and the matting of their locks, shape (hairs, 2 · felt.KNOTS)."""
    u = np.linspace(0.0, 1.0, felt.KNOTS)
    radius = per_lock("radius")[:, None] * settings.radius.along(u) * (1.0 - per_lock("taper")[:, None] * u)
    section = _section(per_lock, lock, disk)
    return felt.felted(per_lock.locks, lock, ids, section, radius[lock], frizz, settings.seed).astype(np.float32)


def _curl(
    settings: HairSettings, per_lock: _Values, layout: dict[str, NDArray], hairs: Placed, u: NDArray
) -> dict[str, Any]:
    """Inputs of the kernel for the curl of hairs; empty where these only follow their lock."""
    if not settings.sections:
        return {"window": np.empty(0, np.int32), "curl": {}}
    values = {
        name: Values(table, per_lock.locks, per_lock.scalp, settings.seed, f"hairs.{name}")
        for name, table in settings.sections.items()
    }
    knots = layout["frizz"].shape[1] // 2
    curl, wander = hair_curl.curl_layout(
        values.get("families"), values.get("curl"), values.get("coil"), hairs, u, knots
    )
    return {
        "window": np.empty(0, np.int32),
        "curl": curl,
        "frizz": layout["frizz"] + wander.astype(np.float32),
    }


def _section(per_lock: _Values, lock: NDArray, disk: NDArray) -> NDArray[np.float64]:
    """Positions in the cross-section of the locks, relative to its radius, shape (hairs, 2).

    ``hollow`` moves the disk's samples to the rim; ``flatness`` flattens the disk along a random direction per lock.
    """
    radius = np.linalg.norm(disk, axis=1)
    disk = disk * (np.maximum(radius, 1e-9) ** -np.minimum(per_lock("hollow"), 1.0)[lock])[:, None]
    angle = np.pi * Random(per_lock.settings.seed, "hairs/ribbon").uniform(per_lock.locks.ids)[lock]
    thin = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    pressed = np.minimum(per_lock("flatness"), 1.0)[lock] * np.sum(disk * thin, axis=1)
    return disk - pressed[:, None] * thin


def _neighbours(
    settings: HairSettings,
    per_lock: _Values,
    groom: Groom,
    curves: Curves,
    is_lock: NDArray,
    roots: NDArray,
    u: NDArray,
) -> dict[str, NDArray]:
    """Neighbouring lock that each hair blends with, and the blend weight: one half midway, 0 across a parting."""
    blend = settings.blend.along(u).astype(np.float32)
    locks, lock, amount = groom.locks, curves.curve["lock"], per_lock("blend")
    if not amount.any() or len(locks) < 2:
        return {"other": np.empty(0, np.int32), "share": np.empty(0, np.float32), "blend": blend}
    bound = curves.curve
    at = np.einsum(
        "hc,hcx->hx", bound["root_barycentric"], groom.scalp.points[groom.scalp.triangles[bound["root_triangle"]]]
    )
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
        "share": np.where(is_lock, 0.0, np.minimum(share, 1.0)).astype(np.float32),
        "blend": blend,
    }
