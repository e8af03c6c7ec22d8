"""Another motion of a head: a layer over its file, in which its meshes are elsewhere in each frame."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Usd, UsdGeom

from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.io.space import to_file, to_metres
from ringlet.io.usd.mesh import mesh_at
from ringlet.io.usd.pose import rest_time
from ringlet.io.usd.stage import Source, new_stage, reading, writing
from ringlet.io.usd.surfaces import shown_surfaces
from ringlet.io.usd.values import float3, local_to_world, read_points, transformed

STALE = (  # attributes of a mesh that no longer hold when its points move otherwise
    *("normals", "primvars:normals", "velocities", "accelerations"),
    *("primvars:skel:jointIndices", "primvars:skel:jointWeights", "skel:blendShapes"),
)

Array = NDArray[np.float64]
Motion = Callable[[Mesh, Array, int], Array]


def write_head_clip(head: Path | str, path: Path | str, frames: tuple[int, int], motion: Motion) -> None:
    """Writes a layer over the file of a head, whose visible meshes move otherwise; their rest pose stays.

    frames: first and last frame
    motion: gives the points of a mesh in a frame [m], from the mesh and its points at rest, shape (n, 3)

    Raises UserError for a file with a point instancer, which has no points of its own.
    """
    with reading(head) as source, writing(path) as aside:
        below = source.stage.GetRootLayer()
        stage = new_stage(aside, source.space, head)
        layer = stage.GetRootLayer()
        layer.defaultPrim, layer.customLayerData = below.defaultPrim, below.customLayerData
        stage.SetStartTimeCode(frames[0])
        stage.SetEndTimeCode(frames[1])
        for prim in shown_surfaces(source):
            if not UsdGeom.Mesh(prim) or prim.IsInstanceProxy():
                raise UserError(f"{source.where(prim)}: is an instance and cannot follow a take; export it as a mesh")
            _write_mesh(source, stage, prim, frames, motion)
        stage.Save()


def _write_mesh(source: Source, stage: Usd.Stage, prim: Usd.Prim, frames: tuple[int, int], motion: Motion) -> None:
    """Writes the points of a mesh in each frame. The transforms over it stand as at rest."""
    time, where, space = rest_time(source, prim), source.where(prim), source.space
    points, parent = read_points(prim, time, where), prim
    if deformer := source.skinning.deformer(prim):
        points, parent = deformer.deform(points, time, where)
    rest = to_metres(transformed(points, parent, time), space)
    to_world = local_to_world(prim, time)
    over = stage.GetPrimAtPath(prim.GetPath())
    _hold(prim, over, time)
    for name in STALE:
        if over.HasAttribute(name):
            over.GetAttribute(name).Block()

    def local(places: Array) -> Array:
        return (to_file(places, space) - to_world[3, :3]) @ np.linalg.inv(to_world[:3, :3])

    attribute, mesh = UsdGeom.PointBased(over).GetPointsAttr(), mesh_at(source, prim)
    attribute.Set(float3(local(rest)))
    ends = [local(rest)]
    for frame in range(frames[0], frames[1] + 1):
        placed = local(motion(mesh, rest, frame))
        attribute.Set(float3(placed), frame)
        ends += [placed.min(axis=0, keepdims=True), placed.max(axis=0, keepdims=True)]
    all_ends = np.concatenate(ends)
    extent = [Gf.Vec3f(*map(float, end)) for end in (all_ends.min(axis=0), all_ends.max(axis=0))]
    UsdGeom.Boundable(over).GetExtentAttr().Set(extent)


def _hold(prim: Usd.Prim, over: Usd.Prim, time: Usd.TimeCode) -> None:
    """Lets the transforms of a prim and of those above it stand as they are at a time."""
    while prim and not prim.IsPseudoRoot():
        if xformable := UsdGeom.Xformable(prim):
            for op in xformable.GetOrderedXformOps():
                if op.GetAttr().GetNumTimeSamples():
                    over.GetAttribute(op.GetAttr().GetName()).Set(op.GetAttr().Get(time))
        prim, over = prim.GetParent(), over.GetParent()
