"""Runs in the Python of Blender: installs the extension, works with it as its buttons do, and writes what it found.

in_blender_extension.py FOUND.json EXTENSION.zip ACTION FOLDER
"""

from __future__ import annotations

import importlib
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

MODULE = "bl_ext.user_default.ringlet_groom"
LOOK = """
ringlet = 2
seed = 3

[guides] # a cap of curls
count = 14
length = 5

[locks]
count = 24
points = 90

[curl]
width = 1.0
pitch = 1.5

[hairs]
per_lock = 4

[color]
preset = "brown"
"""


FEW = LOOK.replace("count = 24", "count = 8").replace("count = 14", "count = 6").replace("points = 90", "points = 80")


def of(name: str):
    """A module of the extension."""
    return importlib.import_module(f"{MODULE}.{name}")


def wait(until, seconds: float = 120.0) -> None:
    """Runs the timer of the extension, which Blender runs only with a window, until a condition holds."""
    end = time.monotonic() + seconds
    while not until():
        if time.monotonic() > end:
            raise TimeoutError(str([vars(one) for one in of("grooming").states.values()]) + str(of("shots").shots))
        bpy.context.view_layer.update()
        of("timer").tick()
        time.sleep(0.02)


def settled() -> bool:
    """Whether every groom is up to date, or its error is reported."""
    grooming = of("grooming")
    return all(
        not (state := grooming.state_of(head)).busy
        and (grooming.is_made(head, key := grooming.key_of(head)) or (bool(state.message) and state.asked == key))
        for head in of("identity").heads()
    )


def make_head(name: str = "Kim", x: float = 0.0) -> bpy.types.Object:
    """A ball of 18 cm with a vertex group on its upper half."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8, radius=0.09, location=(x, 0.0, 0.0))
    bpy.context.view_layer.update()
    head = bpy.context.active_object
    head.name = name
    group = head.vertex_groups.new(name="scalp")
    group.add([v.index for v in head.data.vertices if v.co.z > -0.01], 1.0, "REPLACE")
    return head


def begin(name: str = "Kim", x: float = 0.0, look: str = LOOK) -> bpy.types.Object:
    """A head with a groom."""
    head = make_head(name, x)
    of("grooming").begin(head, look, name)
    wait(settled)
    return head


def points(thing: bpy.types.Object) -> np.ndarray:
    """Points of curves in world space, in the current frame."""
    seen = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    values = np.empty(3 * len(seen.data.points), np.float32)
    seen.data.attributes["position"].data.foreach_get("vector", values)
    matrix = np.array(seen.matrix_world)
    return values.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def size(head: bpy.types.Object) -> float:
    """How far the guides reach from the middle of the head [m]."""
    return float(np.linalg.norm(points(head.ringlet.guide_curves), axis=1).max())


def off_skin(thing: bpy.types.Object, head: bpy.types.Object) -> float:
    """The largest distance of a root of curves, which are shown, from the head in the current frame [m]."""
    assert not thing.hide_viewport, thing.name
    seen = head.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = seen.to_mesh()
    places = [seen.matrix_world @ vertex.co for vertex in mesh.vertices]
    mesh.calc_loop_triangles()  # as they are drawn: a bent quad has another surface by its other diagonal
    tree = BVHTree.FromPolygons(places, [list(triangle.vertices) for triangle in mesh.loop_triangles])
    seen.to_mesh_clear()
    return max(tree.find_nearest(Vector(place))[3] for place in roots(thing))


def roots(thing: bpy.types.Object) -> np.ndarray:
    """First points of curves in world space, in the current frame."""
    counts = of("curves").counts_of(thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data)
    return points(thing)[np.cumsum(counts) - counts]


def duplicate(head: bpy.types.Object, *, everything: bool = False, linked: bool = False) -> bpy.types.Object:
    """A copy of a head, 1 m aside, as Shift D and Alt D make it."""
    bpy.ops.object.select_all(action="SELECT" if everything else "DESELECT")
    head.select_set(True)
    bpy.context.view_layer.objects.active = head
    bpy.ops.object.duplicate(linked=linked)
    made = bpy.context.active_object
    made.animation_data_clear()
    made.location.x = head.location.x + 1.0
    bpy.context.view_layer.update()
    return made


def heads(folder: Path) -> dict:
    """Heads of similar names, one that is renamed, and copies of it."""
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "scene.blend"))
    first, second = begin("Bo.1", 0.0, FEW), begin("Bo_1", 1.0, FEW.replace("length = 5", "length = 9"))
    first.ringlet.recipe_guides.length__value = 0.06
    wait(settled)
    found: dict = {"alike": [off_skin(one.ringlet.hair_curves, one) for one in (first, second)]}
    found["lengths"] = [one.ringlet.recipe_guides.length__value for one in (first, second)]
    before = of("grooming").folder_of(first)
    first.name = "Kimberly"
    first.ringlet.recipe_guides.length__value = 0.07
    wait(settled)
    found["renamed"] = [of("grooming").state_of(first).message, of("grooming").folder_of(first) == before]
    found["materials"] = sorted(one.name for one in bpy.data.materials)
    bpy.ops.ed.undo_push(message="before copies")
    found["copies"] = []
    for everything, linked in ((False, False), (True, False), (True, True)):
        first = bpy.data.objects["Kimberly"]
        copy = duplicate(first, everything=everything, linked=linked)
        bpy.ops.ed.undo_push(message="copied")
        of("timer").tick()
        id = copy.ringlet.id
        copy.ringlet.recipe_guides.length__value = 0.03
        bpy.ops.ed.undo_push(message="slider")
        wait(settled)
        own, other = copy.ringlet, first.ringlet
        found["copies"].append(
            {
                "off": [off_skin(one.ringlet.hair_curves, one) for one in (first, copy)],
                "lengths": [one.recipe_guides.length__value for one in (other, own)],
                "shared": [
                    name
                    for name in ("id", "recipe", "guide_curves", "lock_curves", "hair_curves")
                    if getattr(own, name) == getattr(other, name)
                ],
                "data": own.hair_curves.data == other.hair_curves.data,
                "material": own.hair_curves.data.materials[0] == other.hair_curves.data.materials[0],
                "message": of("grooming").state_of(copy).message,
                "folder": sorted(one.name for one in of("grooming").folder_of(copy).iterdir()),
            }
        )
        name = copy.name
        bpy.ops.ed.undo()
        of("timer").tick()
        found["copies"][-1]["undone"] = bpy.data.objects[name].ringlet.id == id
        bpy.ops.ed.undo()
        of("timer").tick()
    found["texts"] = sorted(text.name for text in bpy.data.texts)
    return found


def shot_of_three(head: bpy.types.Object) -> None:
    """Simulates a head that slides by 3 cm in three frames."""
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 3
    for frame, x in ((1, 0.0), (3, 0.03)):
        head.location.x = x
        head.keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    of("shots").begin_text(head)
    head.ringlet.shot.ringlet_changes = json.dumps([{"set": ["preroll"], "value": 0}])
    bpy.context.view_layer.objects.active = head
    bpy.ops.ringlet.simulate()
    wait(lambda: of("shots").shots.run is None)
    assert not of("shots").shots.message, of("shots").shots.message


def make_character(name: str, x: float) -> bpy.types.Object:
    """A head of 18 cm in a collection of its name: in centimetres, refined, with a shape key, below a rig of two bones
    scaled by 0.01. In five frames it nods and its brow swells."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=9.0)
    head = bpy.context.active_object
    head.name = name
    heights = {v.index: v.co.z for v in head.data.vertices}
    for group, weight in (
        ("scalp", lambda z: float(z > 1.0)),
        ("neck", lambda z: min(max(0.5 - z / 12.0, 0.0), 1.0)),  # both bones bend a part of the scalp
        ("skull", lambda z: min(max(0.5 + z / 12.0, 0.0), 1.0)),
    ):
        made = head.vertex_groups.new(name=group)
        for row, z in heights.items():
            made.add([row], weight(z), "REPLACE")
    bpy.ops.object.armature_add(location=(x, 0.0, 0.0))
    rig = bpy.context.active_object
    rig.name, rig.scale = f"{name} rig", (0.01,) * 3
    bpy.ops.object.mode_set(mode="EDIT")
    neck = rig.data.edit_bones[0]
    neck.name, neck.head, neck.tail = "neck", (0.0, 0.0, -9.0), (0.0, 0.0, -2.0)
    skull = rig.data.edit_bones.new("skull")
    skull.head, skull.tail, skull.parent = neck.tail, (0.0, 0.0, 9.0), neck
    bpy.ops.object.mode_set(mode="OBJECT")
    head.parent = rig
    head.modifiers.new("rig", "ARMATURE").object = rig
    head.modifiers.new("finer", "SUBSURF").levels = 1
    head.shape_key_add(name="Basis")
    brow = head.shape_key_add(name="brow")
    for point in brow.data:
        point.co *= 1.0 + 0.15 * max(-point.co.y, 0.0) / 9.0
    for frame, part in ((1, 0.0), (5, 1.0)):
        for bone, turn in (("neck", (0.3, 0.1, 0.0)), ("skull", (0.4, 0.0, 0.5))):
            posed = rig.pose.bones[bone]
            posed.rotation_mode, posed.rotation_euler = "XYZ", [part * one for one in turn]
            posed.keyframe_insert("rotation_euler", frame=frame)
        brow.value = part
        brow.keyframe_insert("value", frame=frame)
    own = bpy.data.collections.new(name)
    bpy.context.scene.collection.children.link(own)
    for thing in (head, rig):
        own.objects.link(thing)
        bpy.context.scene.collection.objects.unlink(thing)
    bpy.context.scene.frame_set(1)
    bpy.context.view_layer.update()
    return head


def production(folder: Path) -> dict:
    """Two characters with rigs and shape keys, one of them the override of a library: their hair before and after it
    is simulated, frame by frame, and in the .blend as it is opened again."""
    library, path = folder / "library/kim.blend", folder / "shot/shot.blend"
    for one in (library, path):
        one.parent.mkdir()
    kim = make_character("Kim", 0.0)
    of("grooming").begin(kim, FEW, "Kim")
    wait(settled)
    bpy.ops.wm.save_as_mainfile(filepath=str(library))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module=MODULE)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 5
    with bpy.data.libraries.load(str(library), link=True, relative=True) as (_, target):
        target.collections = ["Kim"]
    scene.collection.children.link(target.collections[0])
    target.collections[0].override_hierarchy_create(scene, bpy.context.view_layer, do_fully_editable=True)
    bo = make_character("Bo", 0.5)
    of("grooming").begin(bo, FEW.replace("length = 5", "length = 8"), "Bo")
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    wait(settled)
    characters = list(of("identity").heads())
    found: dict = {"names": sorted(one.name_full for one in characters), "still": {}, "moving": {}, "rest": {}}
    for head in characters:
        head.ringlet.recipe_guides.length__value = 0.06  # in any pose
    bo.modifiers["finer"].levels = 0  # at any level
    scene.frame_set(4)
    wait(settled)
    found["messages"] = [
        of("grooming").state_of(one).message + of("grooming").state_of(one).still for one in characters
    ]
    scene.frame_set(1)
    bo.modifiers["finer"].levels = 1
    for head in characters:
        hairs = head.ringlet.hair_curves
        rest = np.empty(3 * len(hairs.data.points), np.float32)
        hairs.data.attributes["position"].data.foreach_get("vector", rest)
        matrix = np.array(hairs.matrix_world)
        rest = rest.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
        moved = (points(hairs) - rest).reshape(len(hairs.data.curves), -1, 3)
        onto = moved[:, :1]  # the skin of this level
        found["rest"][head.name] = [float(np.linalg.norm(one, axis=2).max()) for one in (onto, moved - onto)]
    shots = of("shots").shots
    for head in characters:
        found["still"][head.name] = off_each(head, "hair_curves")
        bpy.context.view_layer.objects.active = head
        of("shots").begin_text(head)
        head.ringlet.shot.ringlet_changes = json.dumps([{"set": ["preroll"], "value": 0}])
        scene.frame_set(3, subframe=0.25)
        bpy.ops.ringlet.simulate()
        wait(lambda: shots.run is None)
        found["frame"] = scene.frame_current_final
        found["messages"].append(shots.message)
        bpy.ops.ringlet.bake()
        wait(lambda: shots.run is None)
        found["messages"].append(shots.message)
    bpy.ops.wm.save_mainfile()
    opened(path)
    for head in of("identity").heads():
        found["moving"][head.name] = off_each(head, "hair_motion")
    return found


def off_each(head: bpy.types.Object, name: str) -> list[list[float]]:
    """The largest distances of roots [m] from a head, and from their own places on its finest skin. There are five
    frames, at three levels of subdivision and with it out of the viewport."""
    found, finer, thing = [], head.modifiers["finer"], getattr(head.ringlet, name)
    places: dict[int, np.ndarray] = {}
    for level in (2, 1, 0, None):
        finer.show_viewport, finer.levels = level is not None, level or 0
        for frame in (1, 2, 3, 4, 5):
            bpy.context.scene.frame_set(frame)
            away = roots(thing) - places.setdefault(frame, roots(thing))
            found.append([off_skin(thing, head), float(np.linalg.norm(away, axis=1).max())])
    return found


def opened(path: Path) -> bpy.types.Object:
    """A .blend that is opened, and the extension has looked at it; its head."""
    bpy.ops.wm.open_mainfile(filepath=str(path))
    of("timer").tick()
    wait(settled)
    return next(of("identity").heads())


def off_through(thing: bpy.types.Object, head: bpy.types.Object) -> float:
    """The largest distance of a root from the head in three frames [m]."""
    found = []
    for frame in (1, 2, 3):
        bpy.context.scene.frame_set(frame)
        found.append(off_skin(thing, head))
    return max(found)


def moved(folder: Path) -> dict:
    """A simulated project: opened again and changed, moved, without its frames, saved as another, and renamed."""
    path = folder / "one/scene.blend"
    path.parent.mkdir()
    head = begin("Kim", 0.0, FEW)
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    shot_of_three(head)
    bpy.ops.wm.save_mainfile()
    head = opened(path)
    bpy.context.view_layer.objects.active = head
    head.ringlet.recipe_guides.length__value = 0.06  # the cache is of the head, which has not changed
    wait(settled)
    bpy.ops.ringlet.bake()
    wait(lambda: of("shots").shots.run is None)
    found: dict = {"baked": of("shots").shots.message}
    bpy.ops.wm.save_mainfile()
    found["paths"] = [file.filepath for file in bpy.data.cache_files]
    path.parent.rename(folder / "two")
    head = opened(folder / "two/scene.blend")
    found["moved"] = off_through(head.ringlet.hair_motion, head)
    (folder / "two/scene.ringlet").rename(folder / "away")
    head = opened(folder / "two/scene.blend")
    state = of("grooming").state_of(head)
    found |= {"missing": state.missing, "still": off_through(head.ringlet.hair_curves, head)}
    (folder / "away").rename(folder / "two/scene.ringlet")
    of("timer").tick()
    found["back"] = [state.missing, off_through(head.ringlet.hair_motion, head)]
    (folder / "other").mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "other/version 2.blend"))
    found["saved as"] = [file.filepath.split("/")[2] for file in bpy.data.cache_files]
    (folder / "other/version 2.blend").rename(folder / "other/final.blend")
    head = opened(folder / "other/final.blend")
    found["renamed"] = (of("grooming").folder_of(head) / "cache.usdc").is_file()
    found["folders"] = sorted(one.name for one in (folder / "other").iterdir())
    return found


def linked(folder: Path) -> dict:
    """A head that is linked from another .blend, and its override, simulated and opened again."""
    library, path = folder / "kim.blend", folder / "scene.blend"
    begin("Kim", 0.0, FEW)
    bpy.ops.wm.save_as_mainfile(filepath=str(library))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module=MODULE)
    with bpy.data.libraries.load(str(library), link=True) as (source, target):
        target.objects = list(source.objects)
    for thing in target.objects:
        bpy.context.scene.collection.objects.link(thing)
    head = next(thing for thing in target.objects if thing.type == "MESH")
    bpy.context.view_layer.objects.active = head
    for _ in range(5):
        of("timer").tick()
    found: dict = {"heads": len(list(of("identity").heads())), "refused": refused(bpy.ops.ringlet.simulate)}
    head = head.override_create(remap_local_usages=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    wait(settled)
    head.ringlet.recipe_guides.length__value = 0.06
    shot_of_three(head)
    found["motion"] = off_through(head.ringlet.lock_motion, head)
    bpy.ops.wm.save_mainfile()
    head = opened(path)
    found |= {"opened": off_through(head.ringlet.lock_motion, head), "text": head.ringlet.recipe.library is None}
    found |= {"length": head.ringlet.recipe_guides.length__value}
    found["curves"] = sorted(thing.name_full for thing in bpy.context.scene.objects if thing.type == "CURVES")
    found["folder"] = of("grooming").folder_of(head).parent.name
    return found


def earlier(folder: Path) -> dict:
    """A .blend of an extension without ids, whose folder had the name of the head and whose paths were absolute."""
    path = folder / "scene.blend"
    head, twin = begin("Kim", 0.0, FEW), begin("Bo.1", 1.0, FEW)
    other = begin("Bo_1", 2.0, FEW)
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    shot_of_three(head)
    bpy.app.handlers.save_pre.remove(of("identity")._before_save)
    of("grooming").folder_of(head).rename(folder / "scene.ringlet/Kim")
    for file in bpy.data.cache_files:
        file.filepath = str(folder / "scene.ringlet/Kim" / Path(file.filepath).name)
    for one in (head, twin, other):
        one.ringlet.id = one.ringlet.recipe.ringlet_head = ""
        of("properties").Document(one, "recipe").change(set=["scalp", "mesh"], value=f"/scene/{one.name}")
    bpy.ops.wm.save_mainfile()
    found: dict = {"ids": []}
    for _ in range(2):  # it is not saved in between
        opened(path)
        head = bpy.data.objects["Kim"]
        found["ids"].append([bpy.data.objects[name].ringlet.id for name in ("Kim", "Bo.1", "Bo_1")])
        found["motion"] = off_through(head.ringlet.lock_motion, head)
    found["paths"] = [file.filepath for file in bpy.data.cache_files]
    found["note"] = of("identity").notes.get(bpy.data.objects["Bo.1"].ringlet.id)
    found["folders"] = sorted(one.name for one in (folder / "scene.ringlet").iterdir())
    return found


def slider(_folder: Path) -> dict:
    """A groom from scratch; a slider, its undo and redo, and a value that Ringlet refuses."""
    bpy.ops.ed.undo_push(message="scene")
    head = begin()
    own = head.ringlet
    found = {
        "message": of("grooming").state_of(head).message,
        "counts": of("grooming").state_of(head).counts,
        "curves": [
            len(own.guide_curves.data.curves),
            len(own.lock_curves.data.curves),
            len(own.hair_curves.data.curves),
        ],
        "surface": own.hair_curves.data.surface.name,
        "roots": float(np.abs(np.linalg.norm(points(own.lock_curves)[::90], axis=1) - 0.09).max()),
        "lowest root": float(points(own.lock_curves)[::90, 2].min()),
        "length": own.recipe_guides.length__value,
        "before": size(head),
        "material": own.hair_curves.data.materials[0].node_tree.nodes["Ringlet hair"].parametrization,
        "viewport": list(own.hair_curves.data.materials[0].diffuse_color),
        "subdivisions": bpy.context.scene.render.hair_subdiv,
    }
    own.recipe_hairs.per_lock__value = 8
    of("timer").tick()  # asks for the groom; the fraction changes before it is there
    assert of("grooming").state_of(head).busy
    own.fraction = 1.0
    wait(settled)
    found["all hairs"] = of("grooming").state_of(head).counts["hairs"]
    bpy.ops.ed.undo_push(message="groomed")
    own.recipe_guides.length__value = 0.1
    bpy.ops.ed.undo_push(message="length")
    wait(settled)
    found |= {"after": size(head), "text": own.recipe.as_string(), "changes": own.recipe.ringlet_changes}
    bpy.ops.ed.undo()
    head = bpy.data.objects["Kim"]
    wait(settled)
    found |= {"undone": size(head), "undone length": head.ringlet.recipe_guides.length__value}
    bpy.ops.ed.redo()  # to before the curves of the slider
    head = bpy.data.objects["Kim"]
    of("timer").tick()
    found |= {"redone": size(head), "asked again": of("grooming").state_of(head).busy}
    wait(settled)
    head.ringlet.recipe_curl.width__value = 50.0
    wait(settled)
    found["refused"] = of("grooming").state_of(head).message
    found["kept"] = size(head)
    head.ringlet.recipe_curl.width__value = 0.01
    wait(settled)
    found["mended"] = of("grooming").state_of(head).message
    head.ringlet.recipe_color.dye__color = (1.0, 0.5, 0.0)
    wait(settled)
    found["dye"] = [list(head.ringlet.recipe_color.dye__color), head.ringlet.recipe.as_string()]
    found["dyed"] = head.ringlet.hair_curves.data.materials[0].node_tree.nodes["Ringlet hair"].parametrization
    head.modifiers.new("fewer", "DECIMATE").ratio = 0.3
    head.ringlet.recipe_curl.width__value = 0.012
    wait(settled)
    found["renumbered"] = of("grooming").state_of(head).still
    return found


def stored(folder: Path) -> dict:
    """The .blend, saved and opened again; then opened without the extension."""
    head = begin()
    head.ringlet.recipe_guides.length__value = 0.1
    wait(settled)
    found, path = {"before": size(head)}, str(folder / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    head = bpy.data.objects["Kim"]
    wait(lambda: bool(of("properties").Document(head, "recipe").settings) and settled())
    found |= {"after": size(head), "length": head.ringlet.recipe_guides.length__value}
    head.ringlet.recipe_guides.length__value = 0.05
    wait(settled)
    found["slider"] = size(head)
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.preferences.addon_disable(module=MODULE)
    bpy.ops.wm.open_mainfile(filepath=path)
    found["property"] = hasattr(bpy.data.objects["Kim"], "ringlet")
    found["left"] = {thing.name: len(thing.data.curves) for thing in bpy.data.objects if thing.type == "CURVES"}
    found["recipe"] = [text.as_string() for text in bpy.data.texts if "recipe" in text.name]
    return found


def root_motion(thing: bpy.types.Object) -> list[float]:
    """Mean displacement of the roots of curves from frame 1 to 4 [m]."""
    rows, places = np.concatenate([[0], np.cumsum(of("curves").counts_of(thing.data))[:-1]]), []
    for frame in (1, 4):
        bpy.context.scene.frame_set(frame)
        places.append(points(thing)[rows])
    return (places[1] - places[0]).mean(axis=0).tolist()


def shot(folder: Path) -> dict:
    """A shot of a head that slides: canceled, resumed and played, and its hairs baked."""
    head = begin()
    shots = of("shots")
    found = {"unsaved": refused(bpy.ops.ringlet.simulate)}
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "scene.blend"))
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 4
    for frame in (1, 4):
        head.location.x = 0.01 * frame
        head.keyframe_insert("location", frame=frame)
    scene.frame_set(1)
    wait(settled)
    shots.begin_text(head)
    head.ringlet.shot.ringlet_changes = json.dumps([{"set": ["preroll"], "value": 300}])
    floor = bpy.data.collections.new("floor")
    bpy.ops.mesh.primitive_plane_add(size=1.0, location=(0, 0, -0.2))
    scene.collection.children.link(floor)
    floor.objects.link(bpy.context.active_object)
    head.ringlet.colliders = floor
    bpy.context.view_layer.objects.active = head
    bpy.ops.ringlet.simulate()
    wait(lambda: (shots.shots.stage == "Simulating" and shots.shots.part > 0.1) or shots.shots.run is None)
    found["stage"] = shots.shots.stage
    bpy.ops.ringlet.cancel()
    wait(lambda: shots.shots.run is None)
    found |= {"left": shots.shots.left, "canceled": shots.shots.message}
    bpy.ops.ringlet.simulate(resume=bool(shots.shots.left))
    wait(lambda: shots.shots.run is None)
    found |= {"message": shots.shots.message, "notes": shots.shots.notes}
    assert head.ringlet.lock_motion is not None, f"{found} {shots.shots}"
    found["lock_motion"] = root_motion(head.ringlet.lock_motion)
    bpy.ops.ringlet.bake()
    wait(lambda: shots.shots.run is None)
    found |= {"baked": shots.shots.message, "hair_motion": root_motion(head.ringlet.hair_motion)}
    bpy.ops.ringlet.clear_motion()
    found["cleared"] = [len(bpy.data.cache_files), head.ringlet.hair_curves.hide_viewport]
    return found


def heights(thing: bpy.types.Object) -> np.ndarray:
    """Heights of the vertices of a mesh above the middle of the head, in the current frame [m]."""
    seen = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return np.array([(seen.matrix_world @ vertex.co).z for vertex in seen.data.vertices])


def cloth(folder: Path) -> dict:
    """A sheet that is held at one edge and falls at the other: played, saved and opened again, and cleared."""
    head = begin()
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=6, y_subdivisions=6, size=0.2, location=(0, 0, 0.25))
    sheet = bpy.context.active_object
    sheet.name, sheet.parent = "Silk sheet", head
    held = [v.index for v in sheet.data.vertices if v.co.x < -0.09]
    sheet.vertex_groups.new(name="pin").add(held, 1.0, "REPLACE")
    inner = [v.index for v in sheet.data.vertices if abs(v.co.y) < 0.09]  # subdivision draws corners in
    held, free = ([v for v in inner if sign * sheet.data.vertices[v].co.x > 0.09] for sign in (-1, 1))
    sheet.modifiers.new("finer", "SUBSURF")
    bend = sheet.modifiers.new("raised", "DISPLACE")
    bend.strength, bend.mid_level = 0.01, 0.0
    worn = bpy.data.collections.new("worn")
    bpy.context.scene.collection.children.link(worn)
    worn.objects.link(sheet)
    head.ringlet.cloth = worn
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 4
    bpy.context.view_layer.objects.active = head
    path = str(folder / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    of("shots").begin_text(head)
    head.ringlet.shot.ringlet_changes = json.dumps([{"set": ["preroll"], "value": 0}])
    found: dict = {"runs": []}
    for _ in range(2):  # the second reads a sheet that its moving copy hides
        bpy.ops.ringlet.simulate()
        wait(lambda: of("shots").shots.run is None)
        copies = [pair.moving.name for pair in head.ringlet.cloth_motion]
        found |= {"message": of("shots").shots.message, "copies": copies}
        found["runs"].append([])
        for frame in (1, 4):
            scene.frame_set(frame)
            seen = heights(head.ringlet.cloth_motion[0].moving)
            found["runs"][-1].append([seen[held].tolist(), seen[free].tolist()])
    found["hidden"] = [sheet.hide_viewport, sheet.hide_render]
    found["vertices"] = [len(seen), len(sheet.data.vertices)]
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    head, scene = bpy.data.objects["Kim"], bpy.context.scene
    scene.frame_set(4)
    found["opened"] = heights(head.ringlet.cloth_motion[0].moving)[free].tolist()
    bpy.context.view_layer.objects.active = head
    bpy.ops.ringlet.clear_motion()
    sheet = bpy.data.objects["Silk sheet"]
    found["cleared"] = [len(bpy.data.cache_files), len(head.ringlet.cloth_motion)]
    found["shown"] = [not sheet.hide_viewport, not sheet.hide_render]
    found["meshes"] = sorted(thing.name for thing in bpy.data.objects if thing.type == "MESH")
    return found


def images(folder: Path) -> dict:
    """An image that is painted in Blender as the density of locks; painted on, and taken without pixels."""
    head = begin()
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "scene.blend"))
    own = head.ringlet
    painted = bpy.data.images.new("Thin crown", 64, 32)
    bpy.ops.ringlet.add_image()
    own.images[0].image = painted
    own.recipe_locks.count = 400
    own.recipe_locks.density = "Thin_crown"
    found: dict = {}
    for name, left, right in (("left", 1.0, 0.0), ("right", 0.0, 1.0), ("both", 1.0, 0.25)):
        pixels = np.ones((32, 64, 4), np.float32)
        pixels[:, :32, :3], pixels[:, 32:, :3] = left, right
        painted.pixels.foreach_set(pixels.ravel())
        painted.update()
        time.sleep(0.2)  # longer than the extension leaves the pixels of a small image alone
        wait(settled)
        u = np.empty(2 * len(own.lock_curves.data.curves), np.float32)
        own.lock_curves.data.attributes["surface_uv_coordinate"].data.foreach_get("vector", u)
        found[name] = [int((u[::2] < 0.5).sum()), int((u[::2] >= 0.5).sum())]
    found |= {"message": of("grooming").state_of(head).message, "dirty": painted.is_dirty, "file": painted.filepath}
    own.images[0].image = bpy.data.images.new("Nowhere", 8, 8)
    own.images[0].image.source, own.images[0].image.filepath = "FILE", "/nowhere.png"
    wait(lambda: bool(of("grooming").state_of(head).message))
    found["refused"] = of("grooming").state_of(head).message
    own.images[0].image = painted
    wait(lambda: not of("grooming").state_of(head).message)
    found["mended"] = settled()
    return found


def killed(_folder: Path) -> dict:
    """A process that is killed: a line in the panel, and another process with the next change."""
    head = begin()
    session, state = of("session").session, of("grooming").state_of(head)
    pid = session._process.pid
    os.kill(pid, signal.SIGKILL)
    time.sleep(0.3)
    head.ringlet.recipe_guides.length__value = 0.1
    wait(settled)
    found = {"another": session._process.pid != pid, "message": state.message, "size": size(head)}
    session.stop()
    os.environ["PATH"] = "/nowhere"
    head.ringlet.recipe_guides.length__value = 0.08
    wait(lambda: bool(state.message))
    found["missing"] = state.message
    return found


def install(folder: Path) -> dict:
    """The button Install Ringlet, offline, with a wheel: one that is not there, one that needs another, and both."""
    preferences = bpy.context.preferences.addons[MODULE].preferences
    installation, place = of("installation").installation, of("installation").environment()
    os.environ["PATH"] = "/usr/bin:/bin"  # without a command of Ringlet
    preferences.python = (folder / "python").read_text()
    preferences.wheel = str(folder / "nowhere.whl")
    found = {"no file": refused(bpy.ops.ringlet.install)}
    preferences.wheel = ""
    found["offline"] = refused(bpy.ops.ringlet.install)
    preferences.wheel = str(next(folder.glob("ringlet-*.whl")))
    for name in ("alone", "together"):
        bpy.ops.ringlet.install()
        wait(lambda: not installation.running)
        found[name] = [installation.state, place.exists(), of("installation").command()]
        for needed in (folder / "needed").glob("*.whl"):
            needed.rename(folder / needed.name)
    head = begin()
    found |= {"message": of("grooming").state_of(head).message}
    found["session"] = [of("session").session.version, of("session").session.error]
    found["locks"] = of("grooming").state_of(head).counts["locks"]
    where = [*found["together"][2][:-1], "import ringlet; print(ringlet.__file__)"]
    found["where"] = [subprocess.check_output(where, text=True, cwd=folder), str(place)]
    return found


def guides(folder: Path) -> dict:
    """Sculpted guides, a vertex group as a map, operators, and a variant."""
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "scene.blend"))
    head = begin()
    own = head.ringlet
    found = {"before": size(head)}
    bpy.ops.ringlet.sculpt_guides()
    drawn = own.guides
    found["sculpting"] = bpy.context.active_object == drawn and bpy.context.mode == "SCULPT_CURVES"
    tips = np.empty(3 * len(drawn.data.points), np.float32)
    drawn.data.attributes["position"].data.foreach_get("vector", tips)
    tips = tips.reshape(14, -1, 3)
    tips[:, 1:] = tips[:, :1] + 1.5 * (tips[:, 1:] - tips[:, :1])
    drawn.data.attributes["position"].data.foreach_set("vector", tips.ravel())
    drawn.data.update_tag()
    of("grooming").forget(drawn)
    wait(settled)
    found |= {"sculpted": size(head), "text": own.recipe.as_string(), "message": of("grooming").state_of(head).message}
    own.guides = None
    bpy.ops.ringlet.add_operator(op="frizz")
    wait(settled)
    found |= {"grown": size(head), "operators": [row.op for row in own.shape]}
    own.shape[0].frizz.magnitude__value = 0.004
    wait(settled)
    found["magnitude"] = own.shape[0].frizz.magnitude__value
    bpy.ops.ringlet.change_operator(row=0, what="remove")
    wait(settled)
    found["removed"] = [row.op for row in own.shape]
    own.recipe_guides.length__map = "scalp"
    wait(settled)
    found["map"] = of("grooming").state_of(head).message
    bpy.ops.ringlet.new_variant()
    own.recipe_curl.width__value = 0.02
    wait(settled)
    bpy.ops.ringlet.export()
    state = of("grooming").state_of(head)
    wait(lambda: state.message.startswith("Wrote"))
    found["written"] = state.message.removeprefix("Wrote ")
    return found


def refused(operator, **settings) -> str:
    """The error message of an operator, empty on success."""
    try:
        operator(**settings)
    except RuntimeError as error:
        return str(error)
    return ""


def main(extension: str, action: str, folder: str) -> dict:
    """Installs the extension and performs an action."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.extensions.package_install_files(filepath=extension, repo="user_default", enable_on_install=True)
    actions = (slider, stored, shot, cloth, images, killed, install, guides, heads, moved, linked, earlier, production)
    return {act.__name__: act for act in actions}[action](Path(folder))


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(json.dumps(main(*sys.argv[2:])))
    os._exit(0)  # modules of Blender 4 crash, or wait for ever, while Python ends
