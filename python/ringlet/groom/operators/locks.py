"""Interpolation of locks between the guides."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from scipy.spatial import KDTree

from ringlet import _core
from ringlet.data import limits
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.data.groom import ADOPTED, SECTION
from ringlet.data.quantities import Quantity, refuse
from ringlet.groom.hairline import Hairline
from ringlet.groom.operators.operator import Context, Operator, arc_lengths, packed, unit
from ringlet.groom.part_line import TO_PART
from ringlet.groom.sections import AREA, STRAND, Sections
from ringlet.groom.shares import DIRECTIONS, REACH, reaches

STRAND_IDS, IDS_PER_SECTION = 10**13, 100  # id of a strand: 10¹³ + section · 100 + number in the section


class Locks(Operator):
    """Samples locks on the scalp and interpolates their shapes from the nearest guides. Without ``count`` and
    ``spacing`` every guide becomes a lock, with what was fitted to it if it is adopted.

    ``shape = Σ wᵢ Rᵢ (guideᵢ - rootᵢ)``, scaled to the weighted length. Rᵢ is the smallest rotation from the guide's
    normal to the lock's normal, and the weight wᵢ is 1/d². Guides that lean away from the nearest one by more than
    ``apart``, as across a part line, have weight 0.
    """

    count: int | None = Field(default=None, ge=1, le=1_000_000, description="number of locks; give this or `spacing`")
    spacing: Annotated[float | None, Quantity("m", 1e-4, 1.0)] = Field(
        default=None, description="distance between locks"
    )
    density: str | None = Field(
        default=None,
        description="painted values: where they are higher, locks stand closer; none grow where they are 0. Sections "
        "and their strands are only where they are over 0",
    )
    points: int | None = Field(
        default=None,
        ge=4,
        le=limits.POINTS,
        description="points of a lock, curl included; when absent 12 per turn of the closest curl, which simulate "
        "well, what its braids, twists and knots need, and at least 64",
    )
    shape_points: int = Field(default=20, ge=4, le=1000, description="points of a lock's shape, before it is curled")
    neighbours: int = Field(default=4, ge=1, le=16, description="number of guides that a lock takes its shape from")

    apart: Annotated[float, Quantity("deg", 1.0, 180.0)] = Field(
        default=60.0, description="guides that lean further apart than this, as across a part line, are not mixed"
    )

    sections: Sections | None = Field(
        default=None, description="sections of the scalp between part lines, for braids and twists; none when absent"
    )

    hairline: Hairline | None = Field(
        default=None, description="softer hair along the border of the scalp; a hard edge when absent"
    )

    @model_validator(mode="after")
    def _one_density(self) -> Locks:
        if self.count is not None and self.spacing is not None:
            raise refuse("has both 'count' and 'spacing'; give one of them")
        if self.hairline is not None and self.count is None and self.spacing is None and self.sections is None:
            raise refuse("has a hairline, but every guide becomes a lock; give it 'count' or 'spacing'")
        if self.density is not None and self.count is None and self.spacing is None and self.sections is None:
            raise refuse(
                "has a density, but every guide becomes a lock; give it 'count' or 'spacing', or paint guides.density"
            )
        return self

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns one shape curve per lock, with ``shape_points`` points each."""
        guides = _core.resample_curves(*packed(curves), self.shape_points)
        shapes = guides.reshape(len(curves), self.shape_points, 3)
        if self.count is None and self.spacing is None and self.sections is None:
            attributes = dict(context.scalp.attributes(np.asarray(curves.roots, np.float64)))
            root = curves.curve["root_triangle"], curves.curve["root_barycentric"]
            attributes |= {name: values for name, values in curves.curve.items() if name.startswith(ADOPTED)}
            return _pack(shapes, curves.ids, *root, attributes)

        scalp = context.scalp
        count = self.count or scalp.count_for_spacing(self.spacing or 0.01, "locks.spacing")
        ids, triangle, barycentric = scalp.sample(count, context.seed, self.density, "locks.density")
        fade = self.hairline.of(scalp) if self.hairline is not None else None
        if fade:
            grows = fade.grows(scalp.positions(triangle, barycentric), ids, context.random("hairline"))
            ids, triangle, barycentric = ids[grows], triangle[grows], barycentric[grows]
        attributes: dict[str, NDArray] = {**scalp.attributes(scalp.positions(triangle, barycentric))}
        if self.sections is not None:
            ids, triangle, barycentric, attributes = self._sectioned(ids, triangle, barycentric, context)
        if not len(ids):
            raise UserError("locks.hairline leaves no hair: raise its density, or make it narrower")
        points = self._interpolated(shapes, curves, triangle, barycentric, context)
        normals = _core.root_frames(scalp.points, scalp.triangles, triangle, barycentric)[1][:, :, 2]
        if fade:
            loose = attributes.get(STRAND, np.full(len(ids), -1)) < 0
            points[loose] = fade.shaped(points[loose], normals[loose])
        if (part := context.part_line) is not None:
            across, off, _ = part.sides(points[:, 0], normals, scalp.middle, context.helper)
            attributes[TO_PART] = (-off[:, None] * across).astype(np.float32)
        return _pack(points, ids, triangle, barycentric, attributes)

    def _sectioned(
        self, ids: NDArray, triangle: NDArray, barycentric: NDArray, context: Context
    ) -> tuple[NDArray, NDArray, NDArray, dict[str, NDArray]]:
        """Roots outside of part lines, and the strands of sections: ids, triangles, barycentrics, attributes."""
        assert self.sections is not None
        scalp = context.scalp
        division = self.sections.divide(scalp, context.seed, context.helper, self.density)
        at = division.at(scalp.positions(triangle, barycentric))
        loose = division.loose(at)
        if self.sections.strands is not None and self.count is None and self.spacing is None:
            loose[:] = False
        at = {name: values[loose] for name, values in at.items()} | {STRAND: np.full(loose.sum(), -1, np.int32)}
        at[REACH] = np.zeros((loose.sum(), DIRECTIONS), np.float32)
        at[AREA] = np.zeros(loose.sum(), np.float32)
        strand_triangle, strand_barycentric, strand = division.strand_roots(scalp)
        strand[REACH] = reaches(division, scalp, strand_triangle, strand_barycentric, strand[SECTION])
        strand_ids = STRAND_IDS + IDS_PER_SECTION * strand[SECTION].astype(np.int64) + strand[STRAND]
        if not len(strand_ids) and not loose.any():
            raise UserError(
                "locks.sections leaves no hair: its gap is as wide as its size, or its mask has no section; change one "
                "of them"
            )
        return (
            np.concatenate([ids[loose], strand_ids]),
            np.concatenate([triangle[loose], strand_triangle]),
            np.concatenate([barycentric[loose], strand_barycentric]),
            {name: np.concatenate([at[name], strand[name]]) for name in at},
        )

    def _interpolated(
        self, shapes: NDArray, curves: Curves, triangle: NDArray, barycentric: NDArray, context: Context
    ) -> NDArray[np.float64]:
        """Shapes of locks from those of the guides around their roots, shape (locks, points, 3)."""
        scalp, count = context.scalp, len(triangle)
        roots = scalp.positions(triangle, barycentric)
        lengths = arc_lengths(shapes)[:, -1]
        local = shapes - shapes[:, :1]
        guide_normal = scalp.frames(curves)[:, :, 2]
        normal = _core.root_frames(scalp.points, scalp.triangles, triangle, barycentric)[1][:, :, 2]

        distance, index = self._nearest(curves, guide_normal, roots, normal, context)
        near = index.shape[1]
        rotated = np.empty((near, count, self.shape_points, 3))
        for k in range(near):
            rotated[k] = local[index[:, k]] @ _smallest_rotation(guide_normal[index[:, k]], normal).transpose(0, 2, 1)
        lean = unit(rotated[:, :, self.shape_points // 3])
        aligned = np.einsum("klx,lx->lk", lean, lean[0]) >= np.cos(np.radians(self.apart))
        weight = aligned / np.maximum(distance, 1e-6) ** 2
        weight /= weight.sum(axis=1, keepdims=True)
        blended = np.einsum("lk,klpx->lpx", weight, rotated)
        length = np.sum(weight * lengths[index], axis=1)
        blended *= (length / np.maximum(arc_lengths(blended)[:, -1], 1e-9))[:, None, None]
        return roots[:, None] + blended

    def _nearest(
        self, guides: Curves, guide_normals: NDArray, roots: NDArray, normals: NDArray, context: Context
    ) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Distances [m] and rows of the guides that are nearest to roots, shape (locks, neighbours) each.

        Close to a part line only guides of the same side count, so that hair parts along the line and not between
        guides.
        """
        count = min(self.neighbours, len(guides))
        found, rows = KDTree(guides.roots).query(roots, k=count)
        distance: NDArray[np.float64] = np.asarray(found).reshape(-1, count)
        index: NDArray[np.int64] = np.asarray(rows).reshape(-1, count)
        if (part := context.part_line) is None:
            return distance, index
        given = context.scalp.middle, context.helper
        _, off, away = part.sides(roots, normals, *given)
        _, of_guides, _ = part.sides(np.asarray(guides.roots, np.float64), guide_normals, *given)
        for one in (-1.0, 1.0):
            here = np.flatnonzero((np.sign(off) == one) & (away < part.falloff))
            own = np.flatnonzero(np.sign(of_guides) == one)
            if len(own) >= count and len(here):
                apart, near = KDTree(guides.roots[own]).query(roots[here], k=count)
                distance[here], index[here] = apart.reshape(-1, count), own[near.reshape(-1, count)]
        return distance, index


def _smallest_rotation(a: NDArray, b: NDArray) -> NDArray[np.float64]:
    """The smallest rotations from unit vectors a to b, shape (n, 3, 3): two reflections, H(a + b) H(a) up to sign."""
    half = unit(a + b)
    eye = np.eye(3)
    reflection = eye - 2.0 * half[:, :, None] * half[:, None, :]
    first = eye - 2.0 * a[:, :, None] * a[:, None, :]
    return reflection @ first


def _pack(
    points: NDArray, ids: NDArray, triangle: NDArray, barycentric: NDArray, attributes: dict[str, NDArray] | None = None
) -> Curves:
    bound = {"root_triangle": triangle, "root_barycentric": barycentric, **(attributes or {})}
    offsets = offsets_from_counts(np.full(len(points), points.shape[1]))
    return Curves(np.ascontiguousarray(points.reshape(-1, 3)), offsets, ids, bound)
