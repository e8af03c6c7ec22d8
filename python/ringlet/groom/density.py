"""Density of hairs: how many grow from the share of the scalp that belongs to each lock."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from ringlet.data.errors import UserError
from ringlet.data.groom import HAIR_SHARE, Groom
from ringlet.data.mesh import Mesh
from ringlet.data.random import Random
from ringlet.groom.hair_settings import IDS_PER_LOCK, hair_settings, hair_values
from ringlet.groom.part_line import TO_PART, on_side
from ringlet.groom.several import grooms_of
from ringlet.groom.shares import share_areas

SAMPLES_PER_LOCK = 60
NEIGHBOURS = 6  # nearest locks that a place near a part line may belong to
LARGEST_SHARE = 1.5  # of a lock, relative to the median: hair stays sparse where locks are
PER_CM2 = 1e4  # 1/cm² in 1/m²


def hair_count(groom: Groom) -> int:
    """Number of hairs of the whole groom, or of all grooms that are joined in it."""
    return sum(int(lock_counts(one, groom_areas(one)).sum()) for one in grooms_of(groom).values())


def hairs_per_cm2(groom: Groom) -> float:
    """Mean number of hairs per cm² of the scalp that the groom covers; of its whole region where hairs have no density.

    Of several grooms that are joined, per cm² of the whole region.
    """
    covered = 0.0 if groom.grooms else float(groom_areas(groom).sum())
    return hair_count(groom) / (PER_CM2 * (covered or region_area(groom.scalp, hair_region(groom))))


def lock_counts(groom: Groom, areas: NDArray[np.float64]) -> NDArray[np.int64]:
    """Number of hairs of each lock, at least 1, shape (locks,); ``areas`` are those of ``groom_areas``."""
    if groom.offsets is not None:
        order = np.argsort(groom.locks.ids)
        at = np.searchsorted(groom.locks.ids[order], groom.offsets.lock).clip(0, len(order) - 1)
        there = groom.locks.ids[order[at]] == groom.offsets.lock
        return np.maximum(np.bincount(order[at[there]], minlength=len(order)), 1)
    settings = hair_settings(groom)
    values = hair_values(groom, settings)[""]
    count = values("per_lock") if settings.density is None else PER_CM2 * values("density") * areas
    count = count * groom.locks.curve.get(HAIR_SHARE, 1.0)
    return np.clip(np.round(count), 1, IDS_PER_LOCK).astype(np.int64)


def hair_region(groom: Groom) -> NDArray[np.int32]:
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


def groom_areas(groom: Groom) -> NDArray[np.float64]:
    """Share of the scalp that each lock's hairs cover [m²], shape (locks,); 0 where the settings have no density.

    That of a section's strand is its share of the section, that of a loose lock what is nearest to its root.
    """
    if hair_settings(groom).density is None:
        return np.zeros(len(groom.locks))
    of_sections = share_areas(groom.locks)
    if of_sections.all():
        return of_sections
    to_part = groom.locks.curve.get(TO_PART, None)
    nearest = lock_areas(groom.scalp, hair_region(groom), np.asarray(groom.locks.roots, np.float64), to_part)
    return np.where(of_sections > 0.0, of_sections, nearest)


def lock_areas(
    scalp: Mesh, region: NDArray[np.int32], roots: NDArray[np.float64], to_part: NDArray | None = None
) -> NDArray[np.float64]:
    """Area of the scalp that is nearer to a lock's root than to others [m²], shape (locks,), estimated by samples.

    It is at most 1.5 times the median, so that a hairline with few locks stays sparse.

    region: triangles that carry hair
    roots:  shape (locks, 3) [m]
    to_part: ``TO_PART`` of locks that part, shape (locks, 3); places belong to locks on their side of the line
    """
    places, _ = region_samples(scalp, region, SAMPLES_PER_LOCK * len(roots))
    count = 1 if to_part is None else min(NEIGHBOURS, len(roots))
    near = np.asarray(KDTree(roots).query(places, k=count)[1]).reshape(len(places), count)
    nearest = near[:, 0]
    if to_part is not None:
        own = on_side(places[:, None] - roots[near], to_part[near])
        nearest = near[np.arange(len(near)), own.argmax(axis=1)]
    shares = np.bincount(nearest, minlength=len(roots)) * (region_area(scalp, region) / len(places))
    return np.minimum(shares, LARGEST_SHARE * np.median(shares))


def region_area(scalp: Mesh, region: NDArray[np.int32]) -> float:
    """Area of triangles [m²]."""
    return 0.5 * float(np.linalg.norm(_normals(scalp, region), axis=1).sum())


def region_samples(
    scalp: Mesh, region: NDArray[np.int32], count: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """About ``count`` random samples of triangles, uniform by area: places [m] and unit normals, each (n, 3)."""
    a, b, c = np.asarray(scalp.points, np.float64)[scalp.triangles[region]].transpose(1, 0, 2)
    normals = _normals(scalp, region)
    doubled = np.linalg.norm(normals, axis=1)
    random = Random(0, "density")
    each = np.floor(doubled * (count / doubled.sum()) + random.uniform(region)).astype(np.int64)
    row = np.repeat(np.arange(len(region)), each)
    number = np.arange(len(row))
    root, v = np.sqrt(random.uniform(number, 1))[:, None], random.uniform(number, 2)[:, None]
    places = (1.0 - root) * a[row] + root * (1.0 - v) * b[row] + root * v * c[row]
    return places, normals[row] / np.maximum(doubled, 1e-300)[row, None]


def _normals(scalp: Mesh, region: NDArray[np.int32]) -> NDArray[np.float64]:
    """Normals of triangles times twice their area [m²], shape (n, 3)."""
    a, b, c = np.asarray(scalp.points, np.float64)[scalp.triangles[region]].transpose(1, 0, 2)
    return np.cross(b - a, c - a)
