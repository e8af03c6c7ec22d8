"""Point instancers: the surfaces of their prototypes, and the places of their instances."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from ringlet.io.usd.surfaces import SHOWN, is_empty, is_surface
from ringlet.io.usd.values import local_to_world, read_time

# Prototypes are often abstract or undefined, so that they are drawn as instances only.
_ANY_SPECIFIER = Usd.TraverseInstanceProxies(Usd.PrimIsActive & Usd.PrimIsLoaded)


def prototype_surfaces(instancer: Usd.Prim) -> list[list[Usd.Prim]]:
    """Visible surfaces of each prototype of an instancer; a nested instancer is one of them."""
    stage = instancer.GetStage()
    targets = UsdGeom.PointInstancer(instancer).GetPrototypesRel().GetForwardedTargets()
    return [_surfaces_below(stage.GetPrimAtPath(target)) for target in targets]


def instance_transforms(instancer: Usd.Prim, time: Usd.TimeCode) -> list[tuple[int, NDArray[np.float64]]]:
    """The prototype of each visible instance, and the transform of its world positions to those of the instance.

    Transforms are for row vectors, shape (4, 4).
    """
    schema, stage = UsdGeom.PointInstancer(instancer), instancer.GetStage()
    indices = schema.GetProtoIndicesAttr()
    chosen = np.array(indices.Get(read_time(time, indices)) or [], np.int64)
    time = read_time(time, schema.GetPositionsAttr(), schema.GetOrientationsAttr(), schema.GetScalesAttr())
    placed = schema.ComputeInstanceTransformsAtTime(
        time, time, UsdGeom.PointInstancer.ExcludeProtoXform, UsdGeom.PointInstancer.IgnoreMask
    )
    mask = np.array(schema.ComputeMaskAtTime(time) or [True] * len(chosen), bool)
    targets = schema.GetPrototypesRel().GetForwardedTargets()
    parents = [local_to_world(stage.GetPrimAtPath(target).GetParent(), time) for target in targets]
    back, world = [np.linalg.inv(parent) for parent in parents], local_to_world(instancer, time)
    matrices = np.array(placed, np.float64).reshape(-1, 4, 4)
    return [(int(k), back[k] @ matrices[i] @ world) for i, k in enumerate(chosen) if mask[i]]


def instancer_motion(instancer: Usd.Prim) -> list[Usd.Attribute]:
    """Attributes that move, show or hide the instances of an instancer."""
    schema = UsdGeom.PointInstancer(instancer)
    return [
        schema.GetPositionsAttr(),
        schema.GetOrientationsAttr(),
        schema.GetScalesAttr(),
        schema.GetProtoIndicesAttr(),
        schema.GetInvisibleIdsAttr(),
    ]


def _surfaces_below(root: Usd.Prim) -> list[Usd.Prim]:
    """Visible surfaces at and below a prototype, whatever is above it."""
    found, walk = list[Usd.Prim](), iter(Usd.PrimRange(root, _ANY_SPECIFIER))
    for prim in walk:
        imageable = UsdGeom.Imageable(prim)
        hidden = imageable and imageable.GetVisibilityAttr().Get() == UsdGeom.Tokens.invisible
        if hidden or UsdGeom.PointInstancer(prim):
            walk.PruneChildren()
        if not hidden and is_surface(prim) and not is_empty(prim) and imageable.ComputePurpose() in SHOWN:
            found.append(prim)
    return found
