"""Adopted hair: what the curl of a lock does not fit, and hairs by their offsets from their locks."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet import _core
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.data.groom import OFFSETS, Groom, HairOffsets
from ringlet.data.quantities import Quantity
from ringlet.groom.hair_settings import IDS_PER_LOCK, HairSettings
from ringlet.groom.operators.operator import Context, Operator, grid, packed, with_grid
from ringlet.groom.scalp import axes
from ringlet.groom.thinning import thinned

GATHER = 0.1  # part of a hair over which it comes from its root to its offset
FREE = 0.3  # least part of an offset that is solved for: the rest holds to the root
STEPS = 8  # of Newton's method for places that are abreast
LONGEST = 0.02  # step, as a part of a hair
LEAST_RATE = 0.3  # cosine of a hair to its lock from which steps are damped
SHORTEST = 0.02  # hair, as a part of its lock
WIDTHS = 8  # diameters that are kept of a hair


class Residual(Operator):
    """Moves adopted locks by what their curl does not fit, in the frames of their shapes; roots stay."""

    amount: Annotated[float, Quantity("", 0.0, 1.0)] = Field(default=1.0, description="part of it that is applied")

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the locks without the attribute that holds it."""
        points = grid(curves).copy()
        frames = lock_frames(context.shapes or curves, context, points.shape[1])
        points += self.amount * np.einsum("lpxk,lpk->lpx", frames, at_points(curves.curve[OFFSETS], points.shape[1]))
        points[:, 0] = grid(curves)[:, 0]
        kept = {name: values for name, values in curves.curve.items() if name != OFFSETS}
        return with_grid(Curves(curves.points, curves.offsets, curves.ids, kept, curves.point), points)


def lock_frames(shapes: Curves, context: Context, count: int) -> NDArray[np.float64]:
    """Rotation-minimising frames of shapes at ``count`` even places, shape (locks, count, 3, 3)."""
    across = np.ascontiguousarray(context.scalp.frames(shapes)[:, :, 0])
    frames = _core.curve_frames(*packed(shapes), across).reshape(len(shapes), -1, 3, 3)
    at = np.linspace(0.0, frames.shape[1] - 1.0, count)
    i = np.minimum(at.astype(int), frames.shape[1] - 2)
    t = (at - i)[None, :, None, None]
    left, _, right = np.linalg.svd((1.0 - t) * frames[:, i] + t * frames[:, i + 1])
    return left @ right  # the nearest rotations


def at_points(rows: NDArray, count: int) -> NDArray[np.float64]:
    """Offsets in rows, shape (locks, 3 · k), at ``count`` even places, shape (locks, count, 3)."""
    offsets = np.asarray(rows, np.float64).reshape(len(rows), -1, 3)
    at = np.linspace(0.0, offsets.shape[1] - 1.0, count)
    i = np.minimum(at.astype(int), offsets.shape[1] - 2)
    t = (at - i)[None, :, None]
    return (1.0 - t) * offsets[:, i] + t * offsets[:, i + 1]


def phase_of(target: NDArray, curls: Curves, shapes: Curves, context: Context) -> NDArray[np.float64]:
    """Part of a turn by which the phase of each curl has to grow to fit best, from 0 to 1, shape (locks,).

    target: as for ``residual_of``
    """
    count = target.shape[1]
    frames = lock_frames(shapes, context, count)
    center = _core.resample_curves(*packed(shapes), count).reshape(target.shape)

    def rotating(points: NDArray) -> NDArray[np.complex128]:
        x, y = (np.einsum("lpx,lpx->lp", frames[..., axis], points - center) for axis in (0, 1))
        return x + 1j * y

    turn = np.angle((rotating(target) * rotating(grid(curls)).conj()).sum(axis=1)) / (2.0 * np.pi)
    return turn % 1.0


def residual_of(target: NDArray, curls: Curves, shapes: Curves, context: Context) -> NDArray[np.float32]:
    """The offsets that take curls to the points that they should have, as rows, shape (locks, 3 · points).

    target: points of the locks [m], evenly spaced by arc length, shape (locks, points, 3)
    """
    frames = lock_frames(shapes, context, target.shape[1])
    local = np.einsum("lpxk,lpx->lpk", frames, target - grid(curls))
    return local.reshape(len(target), -1).astype(np.float32)


def fit_offsets(
    groom: Groom, points: NDArray[np.float64], lengths: NDArray[np.float64], widths: NDArray, lock: NDArray[np.int64]
) -> HairOffsets:
    """Offsets of finished hairs from the locks of a groom.

    points:  evenly spaced by arc length [m], shape (hairs, k, 3)
    lengths: of the hairs [m], shape (hairs,)
    widths:  diameters at even steps [m], shape (hairs, WIDTHS)
    lock:    row of the lock of each hair, ascending; the first of each is the lock itself
    """
    locks, scalp = groom.locks, groom.scalp
    grown_from = np.ascontiguousarray(points[:, 0])
    triangle, barycentric, _ = _core.bind_roots(scalp.points, scalp.triangles, grown_from)
    roots = np.einsum("hc,hcx->hx", barycentric, scalp.points[scalp.triangles[triangle]])
    grown = grid(locks)
    frames = _carried_frames(groom)
    s = np.linspace(0.0, 1.0, points.shape[1])
    t = np.clip(1.0 - s / GATHER, 0.0, 1.0)
    hold = t * t * (3.0 - 2.0 * t)
    first = np.r_[True, lock[1:] != lock[:-1]]
    across = np.zeros((len(points), points.shape[1], 2), np.float32)
    tip = np.ones(len(points), np.float32)
    own, starts = lengths[first], np.flatnonzero(first)
    for row, (start, end) in enumerate(zip(starts, np.r_[starts[1:], len(lock)], strict=True)):
        hairs = slice(start + 1, end)
        lock_at = _Along(grown[row][None], frames[row][None], float(own[row]))
        hair_at = _Along(points[hairs], None, lengths[hairs, None])
        tip[hairs] = tips = _tips(lock_at, hair_at)
        center, frame = lock_at(tips[:, None] * s)
        root = roots[hairs] - grown[row, 0]
        places = _abreast(hair_at, center + hold[:, None] * root[:, None], frame[..., 2], s)
        off = hair_at(places)[0] - center - hold[:, None] * root[:, None]
        across[hairs] = np.einsum("hpxk,hpx->hpk", frame[..., :2], off) / np.maximum(1.0 - hold, FREE)[:, None]
    triangle[first], barycentric[first] = locks.curve["root_triangle"], locks.curve["root_barycentric"]
    return HairOffsets(locks.ids[lock], tip, across, widths.astype(np.float32), triangle, barycentric, GATHER)


def _carried_frames(groom: Groom) -> NDArray[np.float64]:
    """The frames in which the core carries hairs: across, across, along; shape (locks, points, 3, 3)."""
    bound = (groom.locks.curve[name] for name in ("root_triangle", "root_barycentric"))
    roots = _core.root_frames(groom.scalp.points, groom.scalp.triangles, *bound)[1]
    frames = _core.curve_frames(*packed(groom.locks), axes(groom.locks, roots))
    return frames.reshape(len(groom.locks), -1, 3, 3)


class _Along:
    """Polylines of evenly spaced points, evaluated at places from 0 to 1.

    points: shape (hairs or 1, k, 3); frames: (hairs or 1, k, 3, 3) or None; lengths: [m], broadcast over places
    """

    def __init__(self, points: NDArray, frames: NDArray | None, lengths: NDArray | float) -> None:
        self._points, self._frames, self.lengths = points, frames, lengths

    def __call__(self, u: NDArray) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Points, and frames or else edges, at places u, shape (hairs, n)."""
        points, last = self._points, self._points.shape[1] - 1
        rows = np.arange(len(points))[:, None]
        i = np.clip((u * last).astype(int), 0, last - 1)
        t = (u * last - i)[..., None]
        at = (1.0 - t) * points[rows, i] + t * points[rows, i + 1]
        if self._frames is None:
            return at, (points[rows, i + 1] - points[rows, i]) * last
        return at, (1.0 - t[..., None]) * self._frames[rows, i] + t[..., None] * self._frames[rows, i + 1]


def _tips(lock: _Along, hair: _Along) -> NDArray[np.float32]:
    """Places on a lock that are abreast of the tips of its hairs, shape (hairs,)."""
    u = np.minimum(np.asarray(hair.lengths) / lock.lengths, 1.0)
    ends = hair(np.ones_like(u))[0]
    for _ in range(STEPS):
        center, frame = lock(u)
        u = np.clip(u + np.einsum("hpx,hpx->hp", ends - center, frame[..., 2]) / lock.lengths, SHORTEST, 1.0)
    return u[:, 0].astype(np.float32)


def _abreast(hair: _Along, center: NDArray, along: NDArray, s: NDArray) -> NDArray[np.float64]:
    """Places on hairs in the planes across a lock, shape (hairs, points), in order from root to tip.

    center, along: points and tangents of the lock, shape (hairs, points, 3)
    s:             places of these points on the hair, from 0 to 1, shape (points,)
    """
    at = np.broadcast_to(s, center.shape[:2])
    for _ in range(STEPS):
        points, edges = hair(at)
        rate = np.einsum("hpx,hpx->hp", edges, along)
        off = np.einsum("hpx,hpx->hp", points - center, along)
        at = np.clip(at - np.clip(off / np.maximum(rate, LEAST_RATE * hair.lengths), -LONGEST, LONGEST), 0.0, 1.0)
        at = np.maximum.accumulate(at, axis=1)
    at[:, 0] = 0.0
    return at


def place_adopted(
    groom: Groom, offsets: HairOffsets, settings: HairSettings, fraction: float, wider: bool
) -> tuple[Curves, dict[str, Any]]:
    """Adopted hairs with unset points, and the inputs of the kernel, as ``place_hairs`` has them.

    Raises UserError for a lock without hairs, and for a root on a triangle that is not there.
    """
    rows = {int(name): row for row, name in enumerate(groom.locks.ids)}
    row = np.array([rows.get(int(name), -1) for name in offsets.lock], np.int64)
    order = np.argsort(row, kind="stable")
    order = order[row[order] >= 0]
    full = np.bincount(row[order], minlength=len(rows))
    if (bare := np.flatnonzero(full == 0)).size:
        raise UserError(
            f"hairs.file: has no hairs of lock {groom.locks.ids[bare[0]]}, and of {bare.size} locks in all; take "
            "hairs.file away, so that the settings make them, or adopt the hair again"
        )
    counts, made = thinned(full, fraction)
    order = order[made]
    kept, lock = offsets.take(order), row[order].astype(np.int32)
    first, triangles = offsets_from_counts(counts), len(groom.scalp.triangles)
    if (off := np.flatnonzero((kept.root_triangle < 0) | (kept.root_triangle >= triangles))).size:
        raise UserError(
            f"hairs.file: has a root on triangle {kept.root_triangle[off[0]]}, but {groom.scalp.name} has {triangles}; "
            "the head has changed: adopt the hair again"
        )
    u = np.linspace(0.0, 1.0, settings.points or kept.across.shape[1])
    attributes: dict[str, NDArray] = {
        "lock": lock,
        "guide_id": groom.locks.ids[lock],
        "root_triangle": np.ascontiguousarray(kept.root_triangle, np.int32),
        "root_barycentric": np.ascontiguousarray(kept.root_barycentric, np.float64),
    }
    uv = groom.scalp.uv
    if uv is not None:
        st = np.einsum("hc,hcx->hx", kept.root_barycentric, uv[kept.root_triangle])
        attributes["st"] = st.astype(np.float32)
    wide = (full / counts)[lock] if wider else np.ones(len(lock))
    along = np.linspace(0.0, 1.0, kept.width.shape[1])
    width = np.stack([np.interp(u, along, values) for values in kept.width]) * wide[:, None]
    ids = groom.locks.ids[lock] * IDS_PER_LOCK + (np.arange(len(lock)) - np.repeat(first[:-1], counts))
    curves = Curves(
        np.empty((len(lock) * len(u), 3), np.float32),
        offsets_from_counts(np.full(len(lock), len(u))),
        ids,
        attributes,
        {"width": width.astype(np.float32).ravel()},
    )
    none, t = np.zeros(len(lock), np.float32), np.clip(1.0 - u / kept.root_falloff, 0.0, 1.0)
    layout = {
        "first": first,
        "offset": np.zeros((len(lock), 2), np.float32),
        "tip": np.ascontiguousarray(kept.tip, np.float32),
        "join": none,
        "flat": none,
        "taper": none,
        "frizz": np.ascontiguousarray(settings.offset * kept.across.reshape(len(lock), -1), np.float32),
        "profile": np.ones(len(u), np.float32),
        "hold": (t * t * (3.0 - 2.0 * t)).astype(np.float32),
        "pace": u.astype(np.float32),
        "window": np.empty(0, np.int32),
        "curl": {},
        "other": np.empty(0, np.int32),
        "share": np.empty(0, np.float32),
        "blend": np.zeros(len(u), np.float32),
    }
    return curves, layout
