"""Grooms in a scene: what Blender's own importer of USD leaves to do.

It brings in curves, widths, attributes, the head and all motion. What it does not know is on which mesh the curves grow
(`surface`), and how an object that is there already is to follow another file.
"""

from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from . import installation
from .curves import draw_curls
from .refused import Refused, need_blender
from .session import clean_environment

HAIRS = "/groom/hairs"
PATH = "ringlet_path"  # custom property: the prim that an object came from
CACHE = "Ringlet cache"  # the modifier that plays
MARGIN = 1e-4  # of texture coordinates


@dataclass
class Found:
    """A groom in the scene: its curves by name (``locks``, ``guides``, ``hairs``), and the mesh they grow on."""

    curves: dict[str, bpy.types.Object]
    surface: bpy.types.Object | None


def import_groom(context: bpy.types.Context, path: str, *, show_locks: bool = False) -> Found:
    """Brings in a groom, a cache or hairs. Where there are hairs, locks and guides are hidden unless wanted.

    Hairs on demand are expanded to a file next to theirs, meanwhile Blender waits.
    """
    require_file(path)
    need_blender((4, 4), f"{Path(path).name}: cannot be read with its unit and its prims")
    before = set(bpy.data.objects)
    # Locks are guides to USD; and only with every transform an object of its own do objects tell their prims.
    bpy.ops.wm.usd_import(filepath=path, import_guide=True, merge_parent_xform=False)
    new = [thing for thing in bpy.data.objects if thing not in before]
    for thing in new:
        thing[PATH] = prim_path(thing)
    curves = {plain_name(thing): thing for thing in new if thing.type == "CURVES" and thing[PATH].startswith("/groom/")}
    if not {"locks", "guides"} <= curves.keys():
        for thing in new:
            bpy.data.objects.remove(thing)
        raise Refused(f"{Path(path).name}: is not a Ringlet groom; open it with Universal Scene Description instead")
    if not any(thing[PATH].startswith(HAIRS) for thing in curves.values()):
        procedural = [thing for thing in new if thing[PATH].startswith(HAIRS)]  # Blender shows it as an empty
        if procedural:
            for thing in new:
                bpy.data.objects.remove(thing)
            return import_groom(context, expanded(path), show_locks=show_locks)

    surface, uv_map = find_surface(curves["locks"], [thing for thing in new if thing.type == "MESH"])
    for thing in curves.values() if surface else ():
        thing.data.surface = surface
        thing.data.surface_uv_map = uv_map
    for name in ("locks", "guides"):
        hidden = "hairs" in curves and not show_locks
        curves[name].hide_render = hidden
        curves[name].hide_set(hidden)
    draw_curls(context.scene)
    context.view_layer.update()
    return Found(curves, surface)


def expanded(path: str) -> str:
    """Writes the hairs on demand of a file with their points, next to it; returns the new path."""
    source = Path(path)
    target = source.with_name(f"{source.stem}_points.usdc")
    command = installation.command()
    if command is None:
        raise Refused(f"{source.name}: holds hairs on demand, which Ringlet expands; install it in the preferences")
    arguments = [*command, "hair", str(source), "-o", str(target)]
    done = subprocess.run(arguments, capture_output=True, text=True, env=clean_environment(), check=False)
    if done.returncode:
        reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise Refused(f"{source.name}: its hairs cannot be expanded ({reason.removeprefix('error: ')})")
    return str(target)


def find_surface(locks: bpy.types.Object, meshes: list[bpy.types.Object]) -> tuple[bpy.types.Object | None, str | None]:
    """The mesh that locks grow on and its texture coordinates: the one in whose faces the roots lie, face by face."""
    faces, roots = attribute(locks, "skinprim", 1), attribute(locks, "st", 2)
    if faces is None or roots is None:
        return None, None
    faces, best = faces[:, 0], (0.9, None, None)  # nearly all, since coordinates are rounded
    for mesh in meshes:
        starts = np.array([polygon.loop_start for polygon in mesh.data.polygons])
        if faces.max() >= len(starts):
            continue
        for layer in mesh.data.uv_layers:
            uv = np.empty(2 * len(mesh.data.loops), np.float32)
            layer.uv.foreach_get("vector", uv)
            low, high = (extreme.reduceat(uv.reshape(-1, 2), starts)[faces] for extreme in (np.minimum, np.maximum))
            inside = np.mean(np.all((low - MARGIN <= roots) & (roots <= high + MARGIN), axis=1))
            if inside > best[0]:
                best = (inside, mesh, layer.name)
    return best[1:]


def play_cache(context: bpy.types.Context, path: str) -> list[bpy.types.Object]:
    """Lets the grooms that are selected, or all of them, play a file; gives the objects that do."""
    require_file(path)
    grooms = {top(thing) for thing in context.selected_objects} or {top(thing) for thing in bpy.data.objects}
    players = [
        thing
        for thing in bpy.data.objects
        if PATH in thing and thing.type in ("CURVES", "MESH") and top(thing) in grooms
    ]
    if not players:
        raise Refused("There is no groom in the scene to play it; open one with File > Import > Ringlet groom")
    known = set(bpy.data.cache_files)
    bpy.ops.cachefile.open(filepath=path)
    cache = next(file for file in bpy.data.cache_files if file not in known)
    for thing in players:
        modifier = next((own for own in thing.modifiers if own.type == "MESH_SEQUENCE_CACHE"), None)
        modifier = modifier or thing.modifiers.new(CACHE, "MESH_SEQUENCE_CACHE")
        modifier.cache_file, modifier.object_path = cache, thing[PATH]
    context.view_layer.update()
    return players


def attribute(curves: bpy.types.Object, name: str, size: int) -> np.ndarray | None:
    """An attribute of curves, shape (count, size); None where there is none."""
    if (found := curves.data.attributes.get(name)) is None:
        return None
    values = np.empty(size * len(found.data), np.float32 if size > 1 else np.int32)
    found.data.foreach_get("vector" if size > 1 else "value", values)
    return values.reshape(-1, size)


def prim_path(thing: bpy.types.Object) -> str:
    """The prim that an object was imported from: the names from the top down."""
    above = prim_path(thing.parent) if thing.parent else ""
    return f"{above}/{plain_name(thing)}"


def plain_name(thing: bpy.types.Object) -> str:
    """The name of an object without the number that Blender adds to names that are taken."""
    return re.sub(r"\.\d{3,}$", "", thing.name)


def top(thing: bpy.types.Object) -> bpy.types.Object:
    """The object above all others."""
    return top(thing.parent) if thing.parent else thing


def require_file(path: str) -> None:
    """Refuses a file that is not there."""
    if not Path(path).is_file():
        raise Refused(f"{path}: there is no such file; choose a groom, a cache or hairs that Ringlet wrote")
