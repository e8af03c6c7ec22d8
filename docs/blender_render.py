"""Runs in Blender's Python: grows hair on the example head with the extension and renders it with Cycles.

Reads a task as JSON: ``extension``, ``head``, ``scalp`` (faces), ``recipe``, ``fraction``
(of its hairs), ``picture``.
"""

from __future__ import annotations

import importlib
import json
import sys
import time

import bpy
from mathutils import Vector

MODULE = "bl_ext.user_default.ringlet_groom"
SIZE, SAMPLES = 400, 32


def skin_with_scalp(faces: list[int]) -> bpy.types.Object:
    """The skin of the imported head, with a vertex group of the scalp."""
    head = next(thing for thing in bpy.data.objects if thing.type == "MESH" and thing.name == "skin")
    group = head.vertex_groups.new(name="scalp")
    corners = {corner for face in faces for corner in head.data.polygons[face].vertices}
    group.add(sorted(corners), 1.0, "REPLACE")
    return head


def groom(head: bpy.types.Object, recipe: str, fraction: float) -> None:
    """Grows the hair of a recipe, as the button Open Recipe does."""
    grooming, timer = (importlib.import_module(f"{MODULE}.{name}") for name in ("grooming", "timer"))
    bpy.context.view_layer.objects.active = head
    bpy.ops.ringlet.open_recipe(filepath=recipe)
    head.ringlet.fraction = fraction
    state, start = grooming.state_of(head), time.monotonic()
    while not state.message and not grooming.is_made(head, grooming.key_of(head)):
        bpy.context.view_layer.update()
        timer.tick()
        time.sleep(0.05)
    print(state.message or state.counts, f"{time.monotonic() - start:.1f} s", state.conflicts, file=sys.stderr)


def light_and_camera(head: bpy.types.Object) -> None:
    """A key light, a fill and a camera in front of the head, which looks along -Y of the scene."""
    corners = [head.matrix_world @ Vector(corner) for corner in head.bound_box]
    top = max(corner.z for corner in corners)
    middle = sum(corners, Vector()) / 8
    aim = Vector((middle.x, middle.y, top - 0.11))
    lights = ((0.7, -1.1, 0.7), 0.6, 22.0), ((-1.0, -0.6, 0.2), 1.2, 5.0), ((0.2, 1.0, 0.7), 0.5, 20.0)
    for place, size, energy in lights:
        light = bpy.data.objects.new("light", bpy.data.lights.new("light", "AREA"))
        light.data.size, light.data.energy = size, energy
        _aimed(light, aim + Vector(place), aim)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.lens = 70
    _aimed(camera, aim + Vector((0.45, -1.0, 0.08)), aim)
    scene = bpy.context.scene
    scene.camera = camera
    world = bpy.data.worlds.new("world")
    if world.node_tree is None:
        world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.32, 0.34, 0.37, 1.0)
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.5
    scene.world = world


def _aimed(thing: bpy.types.Object, place: Vector, aim: Vector) -> None:
    thing.location = place
    thing.rotation_euler = (aim - place).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(thing)


def render(picture: str) -> None:
    """Renders the scene."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = SAMPLES, False
    scene.cycles.max_bounces = scene.cycles.transmission_bounces = scene.cycles.glossy_bounces = 24
    scene.cycles_curves.shape = "THICK"
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.view_settings.view_transform = "AgX"
    scene.render.image_settings.file_format = "JPEG"
    scene.render.image_settings.quality = 90
    scene.render.filepath = picture
    bpy.ops.render.render(write_still=True)


def main() -> None:
    """Does the task."""
    task = json.load(sys.stdin)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.extensions.package_install_files(filepath=task["extension"], repo="user_default", enable_on_install=True)
    bpy.ops.wm.usd_import(filepath=task["head"])
    head = skin_with_scalp(task["scalp"])
    groom(head, task["recipe"], task["fraction"])
    light_and_camera(head)
    render(task["picture"])
    importlib.import_module(f"{MODULE}.session").session.stop()


if __name__ == "__main__":
    main()
