"""Shots of heads: frames of the scene are sent to Ringlet, simulated there, and played as a cache.

Frames are evaluated one at a time from the timer, so that Blender stays usable meanwhile.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

from . import grooming, identity, meshes, skin
from .edited_text import stem_of
from .identity import head_with, new_text
from .names import distinct, file_name
from .properties import Document, scale
from .refused import Refused
from .session import Request, session

# The cache is of the head in HEAD, which stays as it was simulated while the groom goes on.
HEAD, COLLIDERS, CLOTH, CACHE, HAIR = "shot_head.usdc", "colliders.usdc", "cloth.usdc", "cache.usdc", "hair.usdc"
CLOTH_PRIMS = "/groom/cloths/cloth"  # in the cache, where the scene of the file of cloth is referenced
PIN = "pin"  # vertex group of cloth that is held
MODIFIER = "Ringlet cache"
STAGES = {"sim": "Simulating"}  # of Ringlet, as the panel says it
STARTING_SHOT = """# How the hair of {head} moves. SI units; all settings: ringlet schema shot.
ringlet = 2
groom = "{recipe}"
frames = [1, 24]
preroll = 12          # frames for the hair to hang before the first

[strands]
damping = 0.004       # s; how soon a bounce dies away
drag = 2e-5           # kg/(m s)
bend_scale = 6        # a lock is stiffer than one of its hairs

[contact]             # with the head and the colliders
radius = 4e-4         # m
friction = 0.3
"""


@dataclass
class Run:
    """A shot in progress.

    head:   its id
    files:  what moves, the head, then colliders and cloth, by the name of the file; each with its name in there
    points: of those in each frame so far, by the number of the object
    before: the frame of the scene and the part of it, to return to
    canceled: whether cancellation is requested; it takes effect after the current step
    """

    head: str
    frames: tuple[int, int]
    resume: bool
    files: dict[str, list[tuple[str, bpy.types.Object]]]
    points: dict[int, list[np.ndarray]] = field(default_factory=dict)
    next_frame: int = 0
    before: tuple[int, float] = (0, 0.0)
    request: int = 0
    canceled: bool = False


@dataclass
class Shots:
    """The state of simulation for the panel: what it does and how far, the last error, notes of the last run, and
    the steps that a canceled one can go on from."""

    run: Run | None = None
    stage: str = ""
    part: float = 0.0
    message: str = ""
    notes: list[str] = field(default_factory=list)
    left: int = 0


shots = Shots()


def begin_text(head: bpy.types.Object) -> None:
    """Gives a head a shot to start from."""
    own = head.ringlet
    if own.shot is None:
        content = STARTING_SHOT.format(head=head.name, recipe=grooming.recipe_file(own.recipe))
        own.shot = new_text(head.name, "shot", head, content)


def start(head: bpy.types.Object, *, resume: bool = False) -> None:
    """Begins a simulation of the frames of the scene. Raises Refused for what cannot be simulated."""
    if shots.run is not None:
        raise Refused("A simulation runs already; cancel it first")
    if not bpy.data.filepath:
        raise Refused("The .blend has no file yet; save it first, since simulated frames are kept next to it")
    scene = bpy.context.scene
    files = {
        HEAD: [(grooming.PRIM, head)],
        COLLIDERS: _named(_meshes(head, "colliders")),
        CLOTH: _named(_meshes(head, "cloth")),
    }
    begin_text(head)
    # Roots take over the motion that they have from the frame before the first.
    run = Run(head.ringlet.id, (scene.frame_start, scene.frame_end), resume, files)
    run.next_frame, run.before = scene.frame_start - 1, (scene.frame_current, scene.frame_subframe)
    shots.run, shots.message, shots.notes, shots.stage, shots.part = run, "", [], "Reading the scene", 0.0


def cancel() -> None:
    """Cancels the simulation; the frames that are done are kept, to go on from."""
    if shots.run is None:
        return
    if shots.run.request:
        session.cancel(shots.run.request)
        shots.run.canceled = True
    else:
        _return(shots.run)
        _end("canceled")


def advance() -> None:
    """Reads the next frame of a simulation that is being prepared; called by the timer."""
    run = shots.run
    if run is None or run.request or shots.stage != "Reading the scene":
        return
    first, last = run.frames
    try:
        if run.next_frame <= last:
            _read_frame(run)
            shots.part = (run.next_frame - first + 1) / (last - first + 2)
        else:
            _return(run)
            _send(run)
    except (Refused, ReferenceError) as error:
        _return(run)
        _end(str(error) if isinstance(error, Refused) else "A mesh of the shot was removed; simulate again")


def _return(run: Run) -> None:
    """Shows the frame again that the scene was at."""
    frame, part = run.before
    bpy.context.scene.frame_set(frame, subframe=part)


def _read_frame(run: Run) -> None:
    things = [thing for own in run.files.values() for _, thing in own]
    with meshes.readable(things):
        bpy.context.scene.frame_set(run.next_frame)
        for thing in things:
            run.points.setdefault(thing.session_uid, []).append(meshes.posed_points(thing))
    run.next_frame += 1


def _send(run: Run) -> None:
    head = head_with(run.head)
    if head is None:
        raise Refused("The head of the shot was removed; simulate another")
    folder, scene = str(grooming.folder_of(head)), bpy.context.scene
    space = {"up_axis": "Z", "meters_per_unit": scale(), "fps": scene.render.fps / scene.render.fps_base}
    writing = Request(lambda _: None, _end)
    for file, things in run.files.items():
        if not things:
            continue
        bodies = []
        for name, thing in things:
            rest = grooming.rest_matrix(head) if thing is head else Matrix(thing.matrix_world)
            arrays = meshes.rest_arrays(thing, rest)
            bodies.append((name, thing, {**arrays, "motion": np.stack(run.points[thing.session_uid])}))
        described, arrays = meshes.message(bodies)
        sent = {"file": file, "meshes": described, "first_frame": run.frames[0] - 1, **space}
        if file == [name for name, own in run.files.items() if own][-1]:
            writing = Request(lambda _: _simulate(run), _end, canceled=lambda _: _end("canceled"))
        run.request = session.send("write_meshes", writing, arrays, folder=folder, **sent)
    run.points.clear()
    shots.stage = "Starting"


def _simulate(run: Run) -> None:
    """Simulates when Ringlet has written all files: it simulates next to what else it does."""
    head = head_with(run.head)
    if shots.run is not run or head is None:
        return
    request = Request(
        done=lambda message: _done(message.header),
        failed=_end,
        progress=_progress,
        warned=shots.notes.append,
        canceled=lambda message: _end("canceled", message.header.get("left", 0)),
    )
    texts = {"recipe": grooming.recipe_message(head, file=HEAD), "shot": shot_message(head, run)}
    folder = str(grooming.folder_of(head))
    run.request = session.send("simulate", request, folder=folder, cache=CACHE, resume=run.resume, **texts)


def shot_message(head: bpy.types.Object, run: Run) -> dict:
    """The shot of a head, with the frames of the scene and the collections of the panel, as Ringlet takes it."""
    document, own = Document(head, "shot"), head.ringlet
    text = document.text
    if run.files[COLLIDERS]:
        text += f'\n[[collider]]\n\n[[collider]]\nfile = "{COLLIDERS}"\n'
    for name, thing in run.files[CLOTH]:
        text += f'\n[[cloth]]\nfile = "{CLOTH}"\nmesh = "/scene/{name}"\n'
        if PIN in thing.vertex_groups:
            text += f'\n[[cloth.pin]]\nmap = "{PIN}"\nstiffness = 100\n'
    recipe = grooming.recipe_file(own.recipe)
    overlay = [{"set": ["frames"], "value": list(run.frames)}, {"set": ["groom"], "value": recipe}]
    return {
        "name": f"{file_name(stem_of(own.shot.name))}.shot.toml",
        "text": text,
        "changes": json.loads(document.changes or "[]"),
        "overlay": overlay,
    }


def _named(things: list[bpy.types.Object]) -> list[tuple[str, bpy.types.Object]]:
    """Objects with their names in a file of USD, all different."""
    return list(zip(distinct([thing.name for thing in things]), things, strict=True))


def _meshes(head: bpy.types.Object, collection: str) -> list[bpy.types.Object]:
    found = getattr(head.ringlet, collection)
    others = [head, *(pair.moving for pair in head.ringlet.cloth_motion)]
    return [thing for thing in found.all_objects if thing.type == "MESH" and thing not in others] if found else []


def _progress(stage: str, done: int, total: int) -> None:
    shots.stage, shots.part = STAGES.get(stage, stage.capitalize()), done / max(total, 1)


def _end(line: str, left: int = 0) -> None:
    shots.run, shots.stage, shots.part, shots.left = None, "", 0.0, left
    shots.message = "" if line == "canceled" else line


def _done(header: dict) -> None:
    run = shots.run
    head = head_with(run.head) if run else None
    _end("")
    shots.notes = header["notes"]
    if head is not None:
        cache = Path(header["path"])
        play(head, "lock_curves", "lock_motion", cache, "/groom/locks")
        play_cloth(head, cache, run.files[CLOTH])


def bake(head: bpy.types.Object) -> None:
    """Writes the hairs of the simulated shot to a USD file, and plays them. Raises Refused without a shot."""
    folder = grooming.folder_of(head)
    if not (folder / CACHE).is_file():
        raise Refused(f"{folder / CACHE}: there is no simulated shot yet; simulate first")
    if shots.run is not None:
        raise Refused("A simulation runs; wait for it or cancel it")
    run = Run(head.ringlet.id, (0, 0), False, {})
    shots.run, shots.message, shots.stage = run, "", "Hairs"

    def done(message) -> None:
        head = head_with(run.head)
        _end("")
        if head is not None and head.ringlet.hair_curves is not None:
            play(head, "hair_curves", "hair_motion", Path(message.header["path"]), "/groom/hairs")

    request = Request(done, _end, progress=_progress, canceled=lambda _: _end("canceled"))
    fraction = head.ringlet.fraction if head.ringlet.show_hairs else 1.0
    run.request = session.send("hairs", request, folder=str(folder), cache=CACHE, file=HAIR, fraction=fraction)


def play(head: bpy.types.Object, still: str, moving: str, path: Path, prim: str) -> None:
    """Shows curves that follow a cache, in place of those that stand still."""
    clear(head, moving)
    source = getattr(head.ringlet, still)
    if source is None:
        return
    thing = bpy.data.objects.new(f"{source.name} simulated", source.data.copy())
    thing.data.surface = None
    identity.link_with(head, thing)
    follow(thing, open_cache(path), prim)
    if skin.MODIFIER in source.modifiers:
        skin.follow(thing, head, bound=False)
    setattr(head.ringlet, moving, thing)
    show_motion(head)


def play_cloth(head: bpy.types.Object, path: Path, cloths: list[tuple[str, bpy.types.Object]]) -> None:
    """Shows copies of cloth that follow a cache, in place of the cloth. Modifiers that change the topology stay.

    cloths: with their names in the file that was simulated
    """
    clear_cloth(head)
    there = set(bpy.data.objects)
    worn = [(name, thing) for name, thing in cloths if thing in there and not thing.hide_viewport]
    file = open_cache(path) if worn else None
    for name, source in worn:
        thing = source.copy()
        thing.name, thing.data = f"{source.name} simulated", source.data.copy()
        thing.shape_key_clear()
        thing.animation_data_clear()
        thing.parent = None
        thing.constraints.clear()
        for one in [one for one in thing.modifiers if one.type not in meshes.GENERATING]:
            thing.modifiers.remove(one)  # the cache has what these move
        identity.link_with(head, thing)
        thing.matrix_world = Matrix()
        modifier = follow(thing, file, f"{CLOTH_PRIMS}/{name}")
        modifier.read_data = {"VERT"}
        thing.modifiers.move(len(thing.modifiers) - 1, 0)
        pair = head.ringlet.cloth_motion.add()
        pair.source, pair.moving = source, thing
        source.hide_viewport = source.hide_render = True


def open_cache(path: Path) -> bpy.types.CacheFile:
    """A file of motion, opened once more; its path moves with the .blend."""
    known = set(bpy.data.cache_files)
    bpy.ops.cachefile.open(filepath=str(path))
    file = next(file for file in bpy.data.cache_files if file not in known)
    file.filepath = bpy.path.relpath(str(path))
    return file


def follow(thing: bpy.types.Object, file: bpy.types.CacheFile, prim: str) -> bpy.types.Modifier:
    """Lets an object follow a prim of a cache."""
    modifier = thing.modifiers.new(MODIFIER, "MESH_SEQUENCE_CACHE")
    modifier.cache_file, modifier.object_path = file, prim
    return modifier


def show_motion(head: bpy.types.Object) -> None:
    """Shows the finest curves there are: simulated before still ones, hairs before locks. Those whose simulated frames
    are missing are hidden, since they would not be on the skin."""
    own = head.ringlet
    moving = [thing for thing in (own.hair_motion, own.lock_motion) if thing is not None]
    still = [own.hair_curves, own.lock_curves, own.guide_curves]
    there = [*(thing for thing in moving if not missing(thing)), *(thing for thing in still if thing is not None)]
    for thing in {*moving, *there}:
        thing.hide_viewport = thing.hide_render = thing is not there[0]


def missing(thing: bpy.types.Object) -> list[Path]:
    """Files that an object plays and that are not there."""
    return [path for file in identity.cache_files(thing) if not (path := identity.path_of(file)).is_file()]


def watch(head: bpy.types.Object) -> None:
    """Shows the groom where the simulated frames of a head have gone, and the motion when they are back."""
    gone = sorted({path for thing in identity.players(head) for path in missing(thing)})
    line = f"{gone[0]}: is missing; put it back next to the .blend, or simulate again" if gone else ""
    state = grooming.state_of(head)
    if state.missing != line:
        state.missing = line
        for file in {file for thing in identity.players(head) for file in identity.cache_files(thing)}:
            file.filepath = file.filepath  # is opened again
        show_motion(head)
        for pair in head.ringlet.cloth_motion:
            if pair.source is not None and pair.moving is not None:
                gone_one = bool(missing(pair.moving))
                pair.moving.hide_viewport = pair.moving.hide_render = gone_one
                pair.source.hide_viewport = pair.source.hide_render = not gone_one


def clear(head: bpy.types.Object, moving: str) -> None:
    """Removes curves that follow a cache; the cache stays on disk."""
    if (thing := getattr(head.ringlet, moving)) is not None:
        remove_player(thing)
    show_motion(head)


def clear_cloth(head: bpy.types.Object) -> None:
    """Shows cloth again in place of the copies that follow a cache."""
    for pair in head.ringlet.cloth_motion:
        if pair.source is not None:
            pair.source.hide_viewport = False
            pair.source.hide_render = pair.moving is not None and pair.moving.hide_render
        if pair.moving is not None:
            remove_player(pair.moving)
    head.ringlet.cloth_motion.clear()


def remove_player(thing: bpy.types.Object) -> None:
    """Removes an object that follows a cache, and the cache where nothing else does."""
    files = identity.cache_files(thing)
    grooming.remove(thing)
    for file in files:
        if not any(file == getattr(one, "cache_file", None) for own in bpy.data.objects for one in own.modifiers):
            bpy.data.batch_remove([file])
