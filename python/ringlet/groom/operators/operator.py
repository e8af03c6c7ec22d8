"""The base class of operators, their context, and functions on polylines that they share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.data.painted import per_lock
from ringlet.data.quantities import Section
from ringlet.data.random import Random
from ringlet.data.settings import did_you_mean
from ringlet.deform.orientation import outward
from ringlet.groom.helpers import Names
from ringlet.groom.part_line import PartLine
from ringlet.groom.scalp import Scalp
from ringlet.groom.sections import Sections

UP = np.array([0.0, 1.0, 0.0])
LOCK_POINTS = 64  # of a groom guide that needs no more


@dataclass(frozen=True)
class Context:
    """Inputs of an operator besides the curves and its settings.

    seed:        seed of the recipe
    scalp:       surface that the curves grow on
    purpose:     unique name of the operator in the stack, which keys its random numbers
    lock_points: points of a groom guide; None for as many as operators need
    curves:      helper curves by name
    meshes:      helper meshes by name
    shapes:      the locks before the curl operator; None up to it
    sections:    settings of the sections of the scalp; None without
    density:     name of the painted density of locks; None without
    part_line:   where guides part; None without
    """

    seed: int
    scalp: Scalp
    purpose: str
    lock_points: int | None = None
    curves: Mapping[str, Curves] = field(default_factory=dict)
    meshes: Mapping[str, Mesh] = field(default_factory=dict)
    shapes: Curves | None = None
    sections: Sections | None = None
    density: str | None = None
    part_line: PartLine | None = None

    def random(self, setting: str = "") -> Random:
        """Random numbers of one setting of this operator."""
        return Random(self.seed, f"{self.purpose}/{setting}")

    def helper(self, name: Names, setting: str) -> Curves:
        """Helper curves that a setting names, those of several names together; raises UserError for an unknown name."""
        if not isinstance(name, str):
            sets = [self.helper(one, setting) for one in name]
            return Curves.from_list([curves[k] for curves in sets for k in range(len(curves))])
        if name not in self.curves:
            remedy = did_you_mean(name, self.curves) if self.curves else f"; add a table [curves.{name}]"
            raise UserError(f"{self.purpose}.{setting} is '{name}', which is no helper curve{remedy}")
        return self.curves[name]

    def mesh(self, name: str, setting: str) -> _core.Solid:
        """The helper mesh that a setting names, for distances; raises UserError for an unknown name."""
        if name not in self.meshes:
            remedy = did_you_mean(name, self.meshes) if self.meshes else f"; add a table [meshes.{name}]"
            raise UserError(f"{self.purpose}.{setting} is '{name}', which is no helper mesh{remedy}")
        mesh = self.meshes[name]
        return _core.Solid(np.ascontiguousarray(mesh.points, np.float64), outward(mesh.points, mesh.triangles))

    def values(self, settings: Section, name: str, curves: Curves, table: str = "") -> NDArray[np.float64]:
        """Values of a varied setting per curve, shape (count,).

        table: name of the table of ``settings`` in that of the operator, with a dot after it
        """
        name_here = f"{table}{name}"
        random = self.random(name_here)
        return per_lock(settings, name, random, curves, self.scalp.mesh, f"{self.purpose}.{name_here}")


class Operator(Section):
    """A pure function from curves to curves, given its settings and a context."""

    starter: ClassVar[Mapping[str, Any]] = {}  # settings that the page adds it with, in TOML notation

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the curves after this operator."""
        raise NotImplementedError


class Uncurled(Operator):
    """Gives locks without a curl their points."""

    def apply(self, curves: Curves, context: Context) -> Curves:
        """Returns the curves with ``lock_points`` points each."""
        return resampled(curves, context.lock_points) if context.lock_points else with_lock_points(curves, context)


def grid(curves: Curves) -> NDArray[np.floating]:
    """Points of curves with equal point counts as an array of shape (count, points, 3)."""
    return curves.points.reshape(len(curves), -1, 3)


def packed(curves: Curves) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Points (n, 3) and offsets (count + 1,) as contiguous arrays of the core's types."""
    return np.ascontiguousarray(curves.points, np.float64), np.ascontiguousarray(curves.offsets, np.int32)


def resampled(curves: Curves, points: int) -> Curves:
    """The curves with that many points each, at even distances along their splines."""
    fine = _core.resample_curves(*packed(curves), points)
    offsets = offsets_from_counts(np.full(len(curves), points))
    return Curves(fine, offsets, curves.ids, curves.curve, at_even_lengths(curves, points))


def at_even_lengths(curves: Curves, points: int) -> dict[str, NDArray]:
    """Numbers of points at even distances along curves, linear between points, by name; shape (count · points,)."""
    u, found = np.linspace(0.0, 1.0, points), dict[str, NDArray]()
    for name, values in curves.point.items():
        if values.ndim > 1:
            continue
        rows = []
        for k in range(len(curves)):
            run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curves[k], axis=0), axis=1))])
            rows.append(np.interp(u * run[-1], run, values[curves.offsets[k] : curves.offsets[k + 1]]))
        found[name] = np.concatenate(rows).astype(values.dtype)
    return found


def with_lock_points(curves: Curves, context: Context, needed: int = LOCK_POINTS) -> Curves:
    """The curves with ``lock_points`` points each, or as many as the longest has; as they are if they have these.

    needed: points where ``lock_points`` is None, at least LOCK_POINTS
    """
    points = max(context.lock_points or max(needed, LOCK_POINTS), int(curves.counts.max()))
    return curves if int(curves.counts.min()) == points else resampled(curves, points)


def evenly(line: NDArray, points: int) -> NDArray[np.float64]:
    """A line, shape (n, 3), with that many points at even distances along its spline."""
    return _core.resample_curves(np.ascontiguousarray(line, np.float64), np.array([0, len(line)], np.int32), points)


def arc_lengths(points: NDArray) -> NDArray[np.floating]:
    """Arc length from the root to every point [m], shape (count, points), for points (count, points, 3)."""
    edges = np.linalg.norm(np.diff(points, axis=1), axis=2)
    return np.concatenate([np.zeros((len(points), 1)), np.cumsum(edges, axis=1)], axis=1)


def at_lengths(points: NDArray, along: NDArray) -> NDArray[np.floating]:
    """Positions on polylines (count, points, 3) at arc lengths (count, k) [m]; shape (count, k, 3).

    Extrapolates the last edge beyond the tip.
    """
    run = arc_lengths(points)
    i = np.clip((run[:, None, :] <= along[:, :, None]).sum(axis=2) - 1, 0, points.shape[1] - 2)
    rows = np.arange(len(points))[:, None]
    start, edge = run[rows, i], run[rows, i + 1] - run[rows, i]
    t = ((along - start) / np.maximum(edge, 1e-12))[:, :, None]
    return points[rows, i] + t * (points[rows, i + 1] - points[rows, i])


def on_splines(points: NDArray, along: NDArray) -> NDArray[np.float64]:
    """Places on the cubic splines of shapes (count, points, 3) at lengths along their polylines (count, k) [m].

    Shape (count, k, 3). A shape that is cut there stays as smooth as it was. Beyond the tip, places are on its tangent.
    """
    count, each = points.shape[:2]
    flat = np.ascontiguousarray(points.reshape(-1, 3), np.float64)
    offsets = offsets_from_counts(np.full(count, each))
    return _core.points_on_splines(flat, offsets, np.ascontiguousarray(along, np.float64).ravel()).reshape(count, -1, 3)


def along_edges(roots: NDArray, edges: NDArray) -> NDArray[np.floating]:
    """Polylines from roots (count, 3) and edge vectors (count, points - 1, 3); shape (count, points, 3)."""
    return np.concatenate([roots[:, None], roots[:, None] + np.cumsum(edges, axis=1)], axis=1)


def between_edges(edges: NDArray) -> NDArray[np.float64]:
    """Parameters of edge midpoints, from root (0) to tip (1), shape (points - 1,)."""
    return (np.arange(edges.shape[1]) + 0.5) / edges.shape[1]


def turned(vectors: NDArray, axis: NDArray, angle: NDArray) -> NDArray[np.float64]:
    """Rotates vectors (…, 3) about unit axes (…, 3) by angles (…) [rad]; a zero axis rotates nothing."""
    angle = np.where(np.linalg.norm(axis, axis=-1) > 0.5, angle, 0.0)[..., None]
    along = np.sum(axis * vectors, axis=-1, keepdims=True) * axis
    return np.cos(angle) * (vectors - along) + np.sin(angle) * np.cross(axis, vectors) + along


def pulled(edges: NDArray, amount: NDArray, target: NDArray) -> NDArray[np.float64]:
    """Rotates edges (count, k, 3) towards unit directions (count, 3) by amounts (count, k); keeps their lengths."""
    length = np.linalg.norm(edges, axis=2, keepdims=True)
    return length * unit(edges + amount[:, :, None] * length * target[:, None, :])


def unit(vectors: NDArray) -> NDArray[np.float64]:
    """Normalises vectors along the last axis; zero stays zero."""
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)


def with_grid(curves: Curves, points: NDArray) -> Curves:
    """Curves with new points of shape (count, points, 3)."""
    return curves.with_points(np.ascontiguousarray(points.reshape(-1, 3)))
