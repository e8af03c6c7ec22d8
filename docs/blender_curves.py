"""Runs in Blender's Python: grows curves on a head, curls them with Blender's own nodes, and exports them as USD.

blender_curves.py HEAD.usdc CURVES.usdc
"""

from __future__ import annotations

import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

COUNT, POINTS, LENGTH = 1200, 60, 0.11  # curves, points of each, and their length [m]
SETTINGS = {"Radius": 0.005, "Frequency": 12.0, "Curl Start": 0.1, "Subdivision": 1, "Guide Distance": 0.008}
NODES = "datafiles/assets/nodes/procedural_hair_node_assets.blend"


def grown(skin: bpy.types.Object) -> bpy.types.Object:
    """Straight curves on the upper part of a skin, which bend towards the ground."""
    matrix, mesh = skin.matrix_world, skin.data
    centers = [(matrix @ face.center, (matrix.to_3x3() @ face.normal).normalized()) for face in mesh.polygons]
    top = max(center.z for center, _ in centers)
    able = [(center, normal) for center, normal in centers if center.z > top - 0.08 + 0.6 * min(-center.y, 0.04)]
    chosen = np.random.default_rng(1).choice(len(able), COUNT, replace=False)
    points = []
    for root, normal in (able[k] for k in chosen):
        place, way = root.copy(), normal.copy()
        for _ in range(POINTS):
            points.append(place.copy())
            way = (way + Vector((0, 0, -2.6 / POINTS))).normalized()
            place += way * LENGTH / (POINTS - 1)
    data = bpy.data.hair_curves.new("curves")
    data.add_curves([POINTS] * COUNT)
    data.attributes["position"].data.foreach_set("vector", np.array(points, np.float32).ravel())
    radius = data.attributes.new("radius", "FLOAT", "POINT")
    radius.data.foreach_set("value", np.full(COUNT * POINTS, 4e-4, np.float32))
    thing = bpy.data.objects.new("curves", data)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def curl(thing: bpy.types.Object) -> None:
    """Curls curves with the nodes Curl Hair Curves."""
    name = "Curl Hair Curves"
    with bpy.data.libraries.load(str(Path(bpy.utils.resource_path("LOCAL")) / NODES)) as (_, wanted):
        wanted.node_groups = [name]
    modifier = thing.modifiers.new(name, "NODES")
    modifier.node_group = bpy.data.node_groups[name]
    for socket in modifier.node_group.interface.items_tree:
        if socket.item_type == "SOCKET" and socket.name in SETTINGS:
            modifier[socket.identifier] = SETTINGS[socket.name]


def main(head: str, curves: str) -> None:
    """Does it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.usd_import(filepath=head)
    thing = grown(bpy.data.objects["skin"])
    curl(thing)
    bpy.context.view_layer.update()
    seen = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    print(f"{len(seen.data.curves)} curves, {len(seen.data.points)} points", file=sys.stderr)
    for other in bpy.data.objects:
        other.select_set(other is thing)
    bpy.ops.wm.usd_export(filepath=curves, selected_objects_only=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
