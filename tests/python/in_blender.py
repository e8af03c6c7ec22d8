"""Runs in the Python of Blender: performs an action on files and writes the scene as JSON.

in_blender.py SCENE.json FOLDER ACTION [FILE …]; the folder holds the extension.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, sys.argv[2])
import ringlet_groom
from ringlet_groom.refused import Refused, need_blender

VALUES = {"FLOAT_VECTOR": ("vector", 3), "FLOAT2": ("vector", 2), "FLOAT": ("value", 1), "INT": ("value", 1)}


def scene(frames: list[int]) -> dict:
    """Frame rate, frame range and all objects, curves with attributes, and world positions of their points [m]."""
    objects = {}
    for thing in bpy.data.objects:
        one = objects[thing.name] = {"type": thing.type, "hidden": thing.hide_get(), "frames": {}}
        if thing.type == "CURVES":
            one["counts"] = [len(curve.points) for curve in thing.data.curves]
            one["kinds"] = (
                sorted({value.value for value in thing.data.attributes["curve_type"].data})
                if ("curve_type" in thing.data.attributes)
                else [0]
            )
            one["attributes"] = {a.name: [a.domain, values(a)] for a in thing.data.attributes if a.data_type in VALUES}
            one["scale"] = list(thing.matrix_world.to_scale())
            one["surface"] = thing.data.surface and thing.data.surface.name
            one["uv_map"] = thing.data.surface_uv_map
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        for thing in bpy.data.objects:
            if thing.type in ("CURVES", "MESH"):
                objects[thing.name]["frames"][str(frame)] = world(thing)
    settings = bpy.context.scene
    return {"fps": settings.render.fps, "range": [settings.frame_start, settings.frame_end], "objects": objects}


def values(attribute: bpy.types.Attribute) -> list:
    """Values of an attribute, a row for each element."""
    name, size = VALUES[attribute.data_type]
    flat = np.empty(size * len(attribute.data), np.int32 if attribute.data_type == "INT" else np.float32)
    attribute.data.foreach_get(name, flat)
    return (flat if size == 1 else flat.reshape(-1, size)).tolist()


def world(thing: bpy.types.Object) -> list:
    """Evaluated points of an object in the current frame, in metres with Z up."""
    seen = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    points = np.array(values(seen.data.attributes["position"]))
    matrix = np.array(seen.matrix_world)
    return (points @ matrix[:3, :3].T + matrix[:3, 3]).tolist()


def refused(operator, **settings) -> str:
    """The error message of an operator, empty on success."""
    try:
        operator(**settings)
    except (RuntimeError, Refused) as error:
        return str(error)
    return ""


def main(action: str, *files: str) -> dict:
    """Performs an action; returns the scene or the error messages."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    ringlet_groom.register()
    if action == "plain":
        bpy.ops.wm.usd_import(filepath=files[0], import_guide=True)
    elif action == "alembic":
        bpy.ops.wm.alembic_import(filepath=files[0], as_background_job=False)
    elif action == "add-on":
        bpy.ops.ringlet.import_groom(filepath=files[0])
        if len(files) > 1:
            bpy.ops.ringlet.play_cache(filepath=files[1])
    elif action == "refused":
        return {
            "no file": refused(bpy.ops.ringlet.import_groom, filepath=files[0]),
            "no groom": refused(bpy.ops.ringlet.import_groom, filepath=files[1]),
            "no groom to play": refused(bpy.ops.ringlet.play_cache, filepath=files[1]),
            "too old": refused(need_blender, version=(99, 1), what="a.usdc: cannot be read"),
            "objects": len(bpy.data.objects),
        }
    elif action == "back":
        bpy.ops.ringlet.import_groom(filepath=files[0])
        for thing in bpy.data.objects:
            thing.select_set(thing.name == "guides")
        for point in bpy.data.objects["guides"].data.points:
            point.position.x += 1.0
        bpy.ops.wm.usd_export(filepath=files[1], selected_objects_only=True)
    return scene([1, 2, 3])


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(json.dumps(main(*sys.argv[3:])))
    os._exit(0)  # modules of Blender 4 crash, or wait for ever, while Python ends
