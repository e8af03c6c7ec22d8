"""Runs in Blender with a window: walks through the extension, and takes a picture of the window at each step.

Its last argument is a task, a file of JSON: ``extension``, ``command`` (of Ringlet), ``folder`` (of the pictures, and
of the .blend), ``scalp`` (faces), and ``meshes`` of the head and what is on it: ``points``, ``faces`` and ``color``.
The window fills a screen of 1100 × 760 pixels.
"""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
from mathutils import Euler, Vector

MODULE = "bl_ext.user_default.ringlet_groom"
CURL, SIMULATION = (865, 420), (882, 549)  # headers of panels while all are closed [pixels of a screen of 1100 × 760]
Until = Callable[[], bool]


def of(name: str):
    """A module of the extension."""
    return importlib.import_module(f"{MODULE}.{name}")


def view() -> tuple[bpy.types.Window, bpy.types.Area]:
    """The window, and its 3D view."""
    window = bpy.context.window_manager.windows[0]
    return window, next(area for area in window.screen.areas if area.type == "VIEW_3D")


def make_head(task: dict) -> bpy.types.Object:
    """The mesh of a head with a vertex group of its scalp, what is on it as children, and nothing else in the scene."""
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    head, *others = (make_mesh(name, **one) for name, one in task["meshes"].items())
    for thing in others:
        thing.parent = head
    corners = {corner for face in task["scalp"] for corner in head.data.polygons[face].vertices}
    head.vertex_groups.new(name="scalp").add(sorted(corners), 1.0, "REPLACE")
    bpy.context.view_layer.objects.active = head
    head.select_set(True)
    return head


def make_mesh(name: str, points: list, faces: list, color: list[float]) -> bpy.types.Object:
    """An object with a mesh of one color."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    mesh.shade_smooth()
    material = bpy.data.materials.new(name)
    material.diffuse_color = (*color, 1.0)
    mesh.materials.append(material)
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def arrange(head: bpy.types.Object) -> None:
    """One large 3D view that looks at the head, with the sidebar open at the tab of Ringlet."""
    space = view()[1].spaces.active
    space.show_region_ui, space.show_region_toolbar = True, False
    space.overlay.show_floor = space.overlay.show_axis_x = space.overlay.show_axis_y = False
    space.overlay.show_cursor = space.overlay.show_outline_selected = False
    space.shading.light, space.shading.color_type = "STUDIO", "MATERIAL"
    corners = [head.matrix_world @ Vector(corner) for corner in head.bound_box]
    region = space.region_3d
    region.view_perspective = "PERSP"
    region.view_location = (0, 0, max(corner.z for corner in corners) - 0.12)
    region.view_rotation = Euler((1.48, 0, 0.5)).to_quaternion()
    region.view_distance = 0.7
    space.lens = 70


def click(place: tuple[int, int]) -> None:
    """Clicks into the window, which fills the screen."""
    subprocess.run(["xdotool", "mousemove", *map(str, place), "click", "1"], check=True)


def steps(task: dict) -> Iterator[str | Until]:
    """The walk through: yields conditions to wait for, and names of pictures to take."""
    head = make_head(task)
    window, area = view()
    with bpy.context.temp_override(window=window, area=area):
        bpy.ops.screen.screen_full_area()
    yield drawn()
    arrange(head)
    bpy.ops.wm.save_as_mainfile(filepath=str(Path(task["folder"]) / "walk.blend"))
    yield drawn()
    next(region for region in view()[1].regions if region.type == "UI").active_panel_category = "Ringlet"
    yield drawn()
    yield "head"
    bpy.ops.ringlet.begin(look="3C")
    yield lambda: grown(head)
    yield drawn()
    click(CURL)
    yield drawn()
    yield "groom"
    head.ringlet.recipe_curl.width__value *= 2
    head.ringlet.recipe_curl.pitch__value *= 2
    yield lambda: grown(head)
    yield drawn()
    yield "slider"
    scene, shots = bpy.context.scene, of("shots").shots
    scene.frame_start, scene.frame_end = 1, 24
    for frame, turn in ((1, 0.0), (12, 0.5), (24, 0.0)):
        head.rotation_euler.z = turn
        head.keyframe_insert("rotation_euler", frame=frame)
    click(CURL)
    yield drawn()
    click(SIMULATION)
    bpy.ops.ringlet.simulate()
    yield lambda: bool(shots.message) or (shots.stage == "Simulating" and shots.part > 0.2)
    yield drawn()
    yield "simulation"
    bpy.ops.ringlet.cancel()


def drawn() -> Until:
    """A condition that holds when the window has been drawn, opening panels too."""
    end = time.monotonic() + 5.0
    return lambda: time.monotonic() > end


def grown(head: bpy.types.Object) -> bool:
    """Whether the groom of a head is up to date."""
    grooming = of("grooming")
    message = grooming.state_of(head).message
    if message:
        raise RuntimeError(message)
    return grooming.is_made(head, grooming.key_of(head))


class Walk:
    """Takes the steps from a timer, so that Blender draws and the extension works between them."""

    def __init__(self, task: dict) -> None:
        self._folder, self._steps = Path(task["folder"]), steps(task)
        self._until: Until = lambda: True

    def tick(self) -> float | None:
        """Waits for a condition, takes a picture, or ends."""
        try:
            view()[1].tag_redraw()
            if self._until():
                found = next(self._steps)
                if isinstance(found, str):
                    picture = self._folder / f"{found}.png"
                    subprocess.run(["import", "-window", "root", str(picture)], check=True)
                else:
                    self._until = found
        except BaseException as error:
            if not isinstance(error, StopIteration):
                traceback.print_exc()
            bpy.ops.wm.quit_blender()
            return None
        return 0.2


def main() -> None:
    task = json.loads(Path(sys.argv[-1]).read_text())
    preferences = bpy.context.preferences
    preferences.view.show_splash = False
    preferences.filepaths.use_auto_save_temporary_files = False
    bpy.ops.extensions.package_install_files(filepath=task["extension"], repo="user_default", enable_on_install=True)
    preferences.addons[MODULE].preferences.path = task["command"]
    bpy.app.timers.register(Walk(task).tick, first_interval=2.0)


try:
    main()
except BaseException:
    traceback.print_exc()
    sys.exit(1)
