"""Meshes of Blender as arrays: rest pose, texture coordinates, vertex groups, and the motion through frames."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from hashlib import blake2b
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

from .names import distinct
from .refused import Refused

# Modifiers that change the topology. Ringlet wants the points of the mesh itself, moved by the others.
GENERATING = {"SUBSURF", "MULTIRES", "MIRROR", "ARRAY", "SOLIDIFY", "BEVEL", "DECIMATE", "REMESH", "TRIANGULATE"}
UV = "st"  # what texture coordinates are called in the file
IN_REGION = 0.5  # mean weight of a face that belongs to the region of a vertex group

Arrays = dict[str, np.ndarray]


def map_names(head: bpy.types.Object) -> tuple[list[str], list[str]]:
    """Names of maps, all different: of the vertex groups of a head, and of its images, as it lists both."""
    groups = [group.name for group in head.vertex_groups]
    names = [UV, *groups, *(one.image.name for one in head.ringlet.images if one.image)]
    found = distinct(names)[1:]
    return found[: len(groups)], found[len(groups) :]


def rest_arrays(thing: bpy.types.Object, matrix: Matrix) -> Arrays:
    """A mesh in its rest pose: without modifiers and shape keys, transformed by a matrix.

    ``points`` (n, 3), ``counts``, ``indices``, ``uv`` (corners, 2) of the active map, and for each vertex group
    ``map/NAME`` (n,) and ``region/NAME``, the faces of it.
    """
    mesh = thing.data
    if not len(mesh.polygons):
        raise Refused(f"{thing.name}: has no faces; choose a mesh with a surface")
    counts, indices = np.empty(len(mesh.polygons), np.int32), np.empty(len(mesh.loops), np.int32)
    mesh.polygons.foreach_get("loop_total", counts)
    mesh.loops.foreach_get("vertex_index", indices)
    arrays = {"points": _transformed(_positions(mesh), matrix), "counts": counts, "indices": indices}
    if mesh.uv_layers.active:
        uv = np.empty(2 * len(indices), np.float32)
        mesh.uv_layers.active.uv.foreach_get("vector", uv)
        arrays["uv"] = uv.reshape(-1, 2)
    starts = np.concatenate([[0], np.cumsum(counts)[:-1]])
    for name, weights in _vertex_groups(thing).items():
        arrays[f"map/{name}"] = weights
        faces = np.add.reduceat(weights[indices], starts) / counts
        inside = np.flatnonzero(faces > IN_REGION)
        if inside.size:
            arrays[f"region/{name}"] = inside.astype(np.int32)
    return arrays


def is_subdivided(thing: bpy.types.Object) -> bool:
    """Whether a mesh is the cage of a Catmull-Clark surface."""
    return bool(_subdividing(thing))


def _subdividing(thing: bpy.types.Object) -> list[bpy.types.Modifier]:
    return [one for one in thing.modifiers if one.type == "SUBSURF" and one.subdivision_type == "CATMULL_CLARK"]


def fingerprint(arrays: Arrays) -> str:
    """A digest of arrays."""
    found = blake2b(digest_size=16)
    for name in sorted(arrays):
        found.update(f"{name} {arrays[name].shape}".encode())
        found.update(np.ascontiguousarray(arrays[name]).data)
    return found.hexdigest()


@contextmanager
def readable(things: list[bpy.types.Object]) -> Iterator[None]:
    """Switches off modifiers that change the topology while the block runs, and shows things that are hidden: of these
    Blender evaluates no modifiers."""
    switched = [one for thing in things for one in thing.modifiers if one.type in GENERATING and one.show_viewport]
    hidden = [thing for thing in things if thing.hide_viewport]
    for one in switched:
        one.show_viewport = False
    for thing in hidden:
        thing.hide_viewport = False
    try:
        yield
    finally:
        for one in switched:
            one.show_viewport = True
        for thing in hidden:
            thing.hide_viewport = True


@contextmanager
def resting(thing: bpy.types.Object) -> Iterator[None]:
    """Shows a mesh in its rest pose while the block runs: with no modifiers but those that change the topology, without
    shape keys, and refined where it is a cage: the viewport may show the cage, and a render the surface."""
    refined = [(one, one.levels, one.show_viewport) for one in _subdividing(thing)]
    switched = [one for one in thing.modifiers if one.type not in GENERATING and one.show_viewport]
    keys, hidden = (thing.show_only_shape_key, thing.active_shape_key_index), thing.hide_viewport
    thing.hide_viewport = False
    for one in switched:
        one.show_viewport = False
    for one, levels, _ in refined:
        one.levels, one.show_viewport = max(levels, 1), True
    thing.show_only_shape_key, thing.active_shape_key_index = True, 0
    try:
        yield
    finally:
        for one, levels, shown in refined:
            one.levels, one.show_viewport = levels, shown
        for one in switched:
            one.show_viewport = True
        (thing.show_only_shape_key, thing.active_shape_key_index), thing.hide_viewport = keys, hidden


def rest_skin(thing: bpy.types.Object, matrix: Matrix) -> np.ndarray:
    """Vertices of a mesh in the rest pose where the modifiers that change the topology place them, transformed by a
    matrix; shape (n, 3) of the n vertices of the mesh itself, or fewer where there are fewer."""
    with resting(thing):
        seen = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
        return _transformed(_positions(seen.data), matrix)[: len(thing.data.vertices)]


def posed_points(thing: bpy.types.Object) -> np.ndarray:
    """Points of a mesh in world space at the current frame, shape (n, 3), with the modifiers that are on."""
    seen = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    if len(seen.data.vertices) != len(thing.data.vertices):
        raise Refused(
            f"{thing.name}: its modifiers change {len(thing.data.vertices)} vertices to {len(seen.data.vertices)}; "
            "apply or switch off those that do"
        )
    return _transformed(_positions(seen.data), seen.matrix_world)


def message(things: list[tuple[str, bpy.types.Object, Arrays]]) -> tuple[list[dict[str, Any]], Arrays]:
    """Descriptions and arrays of meshes, each with its name in the file, for the request ``write_meshes``."""
    described = [{"name": name, "subdivided": is_subdivided(thing)} for name, thing, _ in things]
    arrays = {f"{k}/{name}": values for k, (_, _, own) in enumerate(things) for name, values in own.items()}
    return described, arrays


def _positions(mesh: bpy.types.Mesh) -> np.ndarray:
    points = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", points)
    return points.reshape(-1, 3)


def _transformed(points: np.ndarray, matrix: Matrix) -> np.ndarray:
    placed = np.array(matrix, np.float64)
    return (points @ placed[:3, :3].T + placed[:3, 3]).astype(np.float32)


def _vertex_groups(thing: bpy.types.Object) -> Arrays:
    names, _ = map_names(thing)
    weights = np.zeros((len(names), len(thing.data.vertices)), np.float32)
    if names:
        for vertex in thing.data.vertices:
            for member in vertex.groups:
                if member.group < len(names):
                    weights[member.group, vertex.index] = member.weight
    return dict(zip(names, weights, strict=True))
