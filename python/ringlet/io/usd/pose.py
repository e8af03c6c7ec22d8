"""Poses: world positions of a prim's points at any time code, and the times at which they change."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from pxr import Ts, Usd, UsdGeom

from ringlet.io.space import to_metres
from ringlet.io.usd.stage import Source
from ringlet.io.usd.values import read_points, transformed


def posed_points(source: Source, prim: Usd.Prim, time: Usd.TimeCode, where: str) -> NDArray[np.float64]:
    """Points of a mesh or of curves in world space [m], shape (n, 3), deformed by their skeleton."""
    points, space = read_points(prim, time, where), prim
    if deformer := source.skinning.deformer(prim):
        points, space = deformer.deform(points, time)
    return to_metres(transformed(points, space, time), source.space)


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
