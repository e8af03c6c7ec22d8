"""Runs in Blender's Python: opens an Alembic archive, and renders its guides and its hairs.

blender_archive.py ARCHIVE.abc FOLDER writes FOLDER/guides.jpg and FOLDER/hairs.jpg.
"""

from __future__ import annotations

import sys
from pathlib import Path

import bpy
from blender_render import light_and_camera, render

CENTIMETRES = 0.01
SKIN, DARK = (0.37, 0.14, 0.09), (0.01, 0.006, 0.005)
COLORS = {  # by the beginning of the name; archives hold none
    "guides": (0.9, 0.25, 0.05),
    "hairs": (0.03, 0.012, 0.006),
    "shirt": (0.55, 0.31, 0.085),
    "eyeball": (0.8, 0.8, 0.8),
    "iris": (0.1, 0.04, 0.016),
    "pupil": DARK,
    "brow": DARK,
    "lash": DARK,
}
GUIDE_WIDTH = 1e-3  # m; guides have the width of a hair


def paint(thing: bpy.types.Object, color: tuple[float, float, float]) -> None:
    """Gives an object a plain material."""
    made = bpy.data.materials.new(thing.name)
    if made.node_tree is None:
        made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    shader.inputs["Roughness"].default_value = 0.5
    thing.data.materials.clear()
    thing.data.materials.append(made)


def main(archive: str, folder: str) -> None:
    """Does it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.alembic_import(filepath=archive, scale=CENTIMETRES, as_background_job=False)
    things = {thing.name: thing for thing in bpy.data.objects}
    for thing in things.values():
        if thing.type in ("MESH", "CURVES"):
            paint(thing, next((COLORS[one] for one in COLORS if thing.name.startswith(one)), SKIN))
            print(thing.name, len(getattr(thing.data, "curves", ())), file=sys.stderr)
    radii = things["guides"].data.attributes["radius"].data
    radii.foreach_set("value", [0.5 * GUIDE_WIDTH / CENTIMETRES] * len(radii))
    light_and_camera(things["skin"])
    bpy.context.scene.camera.data.lens = 105
    for name, other in (("guides", "hairs"), ("hairs", "guides")):
        things[name].hide_render, things[other].hide_render = False, True
        render(str(Path(folder) / f"{name}.jpg"))


if __name__ == "__main__":
    main(*sys.argv[1:])
