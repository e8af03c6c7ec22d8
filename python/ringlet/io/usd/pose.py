"""Poses: world positions of a prim's points at any time code, and the times at which they change.

The points of an instancer are those of all its instances, the points of a subdivision surface those of its refinement.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from pxr import Ts, Usd, UsdGeom

from ringlet.data.errors import UserError
from ringlet.io.space import to_metres
from ringlet.io.usd.instancer import instance_transforms, instancer_motion, prototype_surfaces
from ringlet.io.usd.refinement import refinement
from ringlet.io.usd.stage import Source
from ringlet.io.usd.values import read_points, transformed

MAX_INSTANCED = 2**26  # points of all instances together


def posed_points(source: Source, prim: Usd.Prim, time: Usd.TimeCode, where: str) -> NDArray[np.float64]:
    """Points of a mesh, of curves or of instances in world space [m], shape (n, 3), deformed by their skeletons."""
    return to_metres(_world_points(source, prim, time, where), source.space)


def _world_points(source: Source, prim: Usd.Prim, time: Usd.TimeCode, where: str) -> NDArray[np.float64]:
    """Points in the unit and up-axis of the stage."""
    if UsdGeom.PointInstancer(prim):
        return _instanced_points(source, prim, time, where)
    points, space = read_points(prim, time, where), prim
    if deformer := source.skinning.deformer(prim):
        points, space = deformer.deform(points, time, where)
    points = transformed(points, space, time)
    made = refinement(source, prim)
    if made is None:
        return points
    if len(points) != (expected := made.points.shape[1]):
        raise UserError(f"{where}: has {len(points)} points, {expected} in its rest pose; must not change")
    return made.points @ points


def _instanced_points(source: Source, prim: Usd.Prim, time: Usd.TimeCode, where: str) -> NDArray[np.float64]:
    """Points of all instances, one after the other; raises UserError for too many."""
    prototypes = [
        np.concatenate([np.empty((0, 3)), *(_world_points(source, one, time, where) for one in surfaces)])
        for surfaces in prototype_surfaces(prim)
    ]
    instances = instance_transforms(prim, time)
    if (count := sum(len(prototypes[k]) for k, _ in instances)) > MAX_INSTANCED:
        raise UserError(f"{where}: its instances have {count:,} points, more than {MAX_INSTANCED:,}; leave it out")
    placed = [prototypes[k] @ matrix[:3, :3] + matrix[3, :3] for k, matrix in instances]
    return np.concatenate([np.empty((0, 3)), *placed])


def motion_samples(source: Source, prim: Usd.Prim) -> list[float]:
    """Time codes of the samples and spline knots that move a prim's points; empty for a prim that does not move.

    Those of a spline that goes on beyond its knots are infinite.
    """
    samples = [time for a in _motion(source, prim) if a.ValueMightBeTimeVarying() for time in _times(a)]
    deformer = source.skinning.deformer(prim)
    return samples + (deformer.samples if deformer and len(deformer.samples) > 1 else [])


def rest_time(source: Source, prim: Usd.Prim) -> Usd.TimeCode:
    """Time code of a prim's rest pose: the default values, or the first sample when there are only samples."""
    moving = [attribute for attribute in _motion(source, prim) if _times(attribute)]
    default = all(attribute.Get(Usd.TimeCode.Default()) is not None for attribute in moving)
    return Usd.TimeCode.Default() if default else Usd.TimeCode.EarliestTime()


def _motion(source: Source, prim: Usd.Prim) -> list[Usd.Attribute]:
    """Attributes that determine the world positions of a prim's points: points and all transforms above."""
    if UsdGeom.PointInstancer(prim):
        inner = [surface for surfaces in prototype_surfaces(prim) for surface in surfaces]
        moving = [attribute for surface in inner for attribute in _motion(source, surface)]
        return [*(a for a in instancer_motion(prim) if a), *_transforms(prim), *moving]
    found = [UsdGeom.PointBased(prim).GetPointsAttr(), *_transforms(prim)]
    deformer = source.skinning.deformer(prim)
    return found + (_transforms(deformer.skeleton.GetPrim()) if deformer else [])


def _transforms(prim: Usd.Prim) -> list[Usd.Attribute]:
    """Attributes of the transforms of a prim and of all prims above it."""
    found = []
    while prim and not prim.IsPseudoRoot():
        if xformable := UsdGeom.Xformable(prim):
            found += [op.GetAttr() for op in xformable.GetOrderedXformOps()]
        prim = prim.GetParent()
    return found


def _times(attribute: Usd.Attribute) -> list[float]:
    """Time codes of the samples of an attribute, or of the knots of its spline."""
    if not attribute.HasSpline():  # pyright: ignore[reportAttributeAccessIssue]
        return attribute.GetTimeSamples()
    spline = attribute.GetSpline()  # pyright: ignore[reportAttributeAccessIssue]
    ends = (-math.inf, spline.GetPreExtrapolation()), (math.inf, spline.GetPostExtrapolation())
    held = Ts.ExtrapHeld  # pyright: ignore[reportAttributeAccessIssue]
    return [*spline.GetKnots(), *(time for time, beyond in ends if beyond.mode != held)]
