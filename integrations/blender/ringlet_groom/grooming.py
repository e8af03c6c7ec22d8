"""Grooms of heads: made by Ringlet whenever what they are made of has changed, and shown as Curves objects.

Nothing asks for a groom: ``watch`` compares what the curves were made of with what there is now. Sliders, the text
editor, sculpting, undo and reload all come out right by that.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from hashlib import blake2b
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

from . import curves, images, material, meshes
from .link import Message
from .properties import Document, keep_settings, scale
from .refused import Refused
from .session import Request, session

HEAD, GUIDES = "head.usdc", "guides.usdc"
MADE_OF = "ringlet_made_of"  # custom property of curves: a digest of what they were made of
SHOWN = {"guides": "guide_curves", "locks": "lock_curves", "hairs": "hair_curves"}


@dataclass
class State:
    """What is known of a head in this session, and not kept in the .blend.

    asked:     key of the groom that was asked for last
    busy:      whether its answer is outstanding
    sent:      what Ringlet has: fingerprints of files by name, for an epoch of the session and a folder
    message:   the error of the last request; empty when it went well
    conflicts: what Ringlet says of the groom
    progress:  stage in progress, and its fraction
    """

    asked: str = ""
    busy: bool = False
    sent: dict[str, str] = field(default_factory=dict)
    of: tuple[int, str] = (0, "")
    message: str = ""
    conflicts: list[str] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)
    progress: tuple[str, float] = ("", 1.0)


states: dict[str, State] = {}
_arrays: dict[str, tuple[dict[str, np.ndarray], str]] = {}  # of meshes and guides, with fingerprints, until they change


def state_of(head: bpy.types.Object) -> State:
    """The state of a head."""
    return states.setdefault(head.name_full, State())


def forget(name: str | None = None) -> None:
    """Forgets the arrays of an object that has changed, or of all and the states too."""
    if name is None:
        states.clear()
        _arrays.clear()
        images.forget()
    else:
        _arrays.pop(name, None)


def heads() -> Iterator[bpy.types.Object]:
    """Objects with a recipe."""
    return (thing for thing in bpy.data.objects if thing.type == "MESH" and thing.ringlet.recipe is not None)


def folder_of(head: bpy.types.Object) -> Path:
    """The folder of a head's files: next to the .blend, or a temporary one before that is saved."""
    name = meshes.identifier(head.name)
    if bpy.data.filepath:
        blend = Path(bpy.data.filepath)
        return blend.with_name(f"{blend.stem}.ringlet") / name
    return Path(bpy.app.tempdir) / "ringlet" / name


def rest_matrix(head: bpy.types.Object) -> Matrix:
    """Where the head was when its groom began: the groom is made there, and goes with the head."""
    values = head.ringlet.rest_matrix
    return Matrix([values[4 * row : 4 * row + 4] for row in range(4)])


def begin(head: bpy.types.Object, text: str, name: str) -> None:
    """Gives a head a recipe, in a new text of the .blend."""
    head.ringlet.recipe = bpy.data.texts.new(f"{name}.recipe.toml")
    head.ringlet.recipe.from_string(text)
    if not any(head.ringlet.rest_matrix):
        head.ringlet.rest_matrix = [value for row in head.matrix_world for value in row]
    document = Document(head, "recipe")
    document.change(set=["scalp", "file"], value=HEAD)
    document.change(set=["scalp", "mesh"], value=f"/scene/{meshes.identifier(head.name)}")
    regions = [meshes.identifier(group.name) for group in head.vertex_groups]
    document.change(set=["scalp", "region"], value="scalp" if "scalp" in regions else None)


def recipe_message(head: bpy.types.Object) -> dict:
    """The recipe of a head, with what the panel adds to it, as Ringlet takes it."""
    document, own = Document(head, "recipe"), head.ringlet
    overlay = []
    if own.guides is not None:
        overlay.append({"set": ["guides"], "value": {"file": GUIDES}})
    folder = folder_of(head)
    for one in own.images:
        if one.image is not None:
            file = images.file_of(one.image, folder)
            overlay.append({"set": ["maps", meshes.identifier(one.image.name)], "value": file})
    changes = json.loads(document.changes or "[]")
    return {"name": own.recipe.name, "text": document.text, "changes": changes, "overlay": overlay}


def key_of(head: bpy.types.Object, inputs: str = "") -> str:
    """A digest of all that the groom of a head depends on: the recipe, and ``inputs`` or else those of now."""
    document = Document(head, "recipe")
    return _digest([document.text, document.changes, inputs or inputs_of(head)])


def inputs_of(head: bpy.types.Object) -> str:
    """A digest of what a groom depends on besides its recipe. Raises Refused for a mesh, guides or images that are
    empty."""
    own = head.ringlet
    parts = [head_arrays(head)[1], f"{own.show_hairs} {own.fraction:.6g} {scale():g}"]
    if own.guides is not None:
        parts.append(guide_arrays(head)[1])
    parts += [f"{one.image.name} {images.stamp(one.image)}" for one in own.images if one.image]
    return _digest(parts)


def _digest(parts: list[str]) -> str:
    return blake2b("\0".join(parts).encode(), digest_size=16).hexdigest()


def head_arrays(head: bpy.types.Object) -> tuple[dict[str, np.ndarray], str]:
    """The rest pose of a head, and its fingerprint."""
    return _kept(head.name_full, lambda: meshes.rest_arrays(head, rest_matrix(head)))


def guide_arrays(head: bpy.types.Object) -> tuple[dict[str, np.ndarray], str]:
    """The guides of a head in the space of its rest pose, and their fingerprint."""
    guides = head.ringlet.guides
    matrix = rest_matrix(head) @ head.matrix_world.inverted() @ guides.matrix_world
    return _kept(guides.name_full, lambda: curves.read_curves(guides, matrix))


def _kept(name: str, make) -> tuple[dict[str, np.ndarray], str]:
    if name not in _arrays:
        made = make()
        _arrays[name] = made, meshes.fingerprint(made)
    return _arrays[name]


def watch(head: bpy.types.Object) -> None:
    """Asks for the groom of a head if the one that is there was made of something else."""
    own, state = head.ringlet, state_of(head)
    if state.busy or not own.live or head.mode == "EDIT":
        return
    try:
        key = key_of(head)
        if state.asked == key:
            return
        state.asked = key
        if is_made(head, key) and Document(head, "recipe").settings:
            state.message = ""
        else:
            ask(head)
    except Refused as error:
        state.asked, state.message = "", str(error)


def is_made(head: bpy.types.Object, key: str) -> bool:
    """Whether all curves of a head were made of what a key stands for.

    Each data-block keeps its key with its points: undo restores data-blocks one by one.
    """
    made = [thing.data.get(MADE_OF) == key for thing in shown_curves(head)]
    return bool(made) and all(made)


def shown_curves(head: bpy.types.Object) -> list[bpy.types.Object]:
    """The Curves objects of the groom of a head."""
    return [thing for name in SHOWN.values() if (thing := getattr(head.ringlet, name)) is not None]


def ask(head: bpy.types.Object) -> None:
    """Asks for the groom of a head."""
    own, state, name = head.ringlet, state_of(head), head.name_full
    sent, inputs = (Document(head, "recipe").text, Document(head, "recipe").changes), inputs_of(head)
    recipe = recipe_message(head)
    send_files(head)
    state.busy = True
    request = Request(
        done=lambda message: _take(name, sent, inputs, message),
        failed=lambda line: _fail(name, line),
        lost=lambda line: _lose(name, line),
        progress=lambda stage, done, total: _progress(name, stage, done, total),
    )
    fraction = own.fraction if own.show_hairs else None
    session.send("groom", request, folder=str(folder_of(head)), recipe=recipe, hairs=fraction)


def send_files(head: bpy.types.Object) -> None:
    """Sends the head and its guides where Ringlet has not got them as they are now."""
    state, name, folder = state_of(head), head.name_full, folder_of(head)
    if state.of != (session.epoch, str(folder)):
        state.sent, state.of = {}, (session.epoch, str(folder))
    arrays, digest = head_arrays(head)
    digest += f" {meshes.is_subdivided(head)}"
    request = Request(lambda _: None, lambda line: _fail(name, line), lambda line: _lose(name, line))
    if state.sent.get(HEAD) != digest:
        described, sent = meshes.message([(head, arrays)])
        space = {"up_axis": "Z", "meters_per_unit": scale()}
        session.send("write_meshes", request, sent, folder=str(folder), file=HEAD, meshes=described, **space)
        state.sent[HEAD] = digest
        state.of = (session.epoch, str(folder))  # the first request starts the process
    if head.ringlet.guides is not None:
        arrays, digest = guide_arrays(head)
        if state.sent.get(GUIDES) != digest:
            space = {"up_axis": "Z", "meters_per_unit": scale()}
            session.send("write_curves", request, arrays, folder=str(folder), file=GUIDES, **space)
            state.sent[GUIDES] = digest


def _progress(name: str, stage: str, done: int, total: int) -> None:
    if (head := bpy.data.objects.get(name)) is not None:
        state_of(head).progress = stage, done / max(total, 1)


def _fail(name: str, line: str) -> None:
    if (head := bpy.data.objects.get(name)) is not None:
        state = state_of(head)
        state.busy, state.message, state.sent = False, line, {}
        state.progress = "", 1.0


def _lose(name: str, line: str) -> None:
    """Ringlet ended before it answered: it is asked again."""
    _fail(name, line)
    if (head := bpy.data.objects.get(name)) is not None:
        state_of(head).asked = ""


def _take(name: str, sent: tuple[str, str], inputs: str, message: Message) -> None:
    """Shows a groom, and takes the text that has the changes in it if it has not changed meanwhile.

    sent, inputs: text and changes, and the digest of all else, that the groom was made of
    """
    head = bpy.data.objects.get(name)
    if head is None or head.ringlet.recipe is None:
        return
    state, document, header = state_of(head), Document(head, "recipe"), message.header
    state.busy, state.message, state.progress = False, "", ("", 1.0)
    state.conflicts, state.counts = header["conflicts"], header["counts"]
    keep_settings("recipe", header["text"], header["settings"])
    current = (document.text, document.changes) == sent
    if current:
        document.fold(header["text"])
    show(head, message)
    sync_operators(head, header["settings"])
    if current:
        state.asked = key_of(head, inputs)
        for thing in shown_curves(head):
            thing.data[MADE_OF] = state.asked


def show(head: bpy.types.Object, message: Message) -> None:
    """Shows the curves of a groom as children of the head."""
    arrays, hairs = message.arrays, any(name.startswith("hairs/") for name in message.arrays)
    color, fiber = message.header["settings"].get("color"), message.header["fiber"]
    dyed = color is not None and (color.get("dye") is not None or bool(color["dyes"]))
    made = material.hair_material(
        f"{head.name} hair",
        fiber,
        material.viewport_color(_own(arrays, "hairs" if hairs else "locks"), fiber, dyed=dyed),
        pigments=any(name.endswith("/melanin") for name in arrays),
        dyed=dyed,
    )
    for name, pointer in SHOWN.items():
        own = _own(arrays, name)
        thing = getattr(head.ringlet, pointer)
        if not own:
            if thing is not None:
                remove(thing)
            continue
        if thing is None:
            thing = bpy.data.objects.new(f"{head.name} {name}", bpy.data.hair_curves.new(f"{head.name} {name}"))
            for collection in head.users_collection or [bpy.context.scene.collection]:
                collection.objects.link(thing)
            setattr(head.ringlet, pointer, thing)
            thing.hide_viewport = thing.hide_render = name != "hairs" and (hairs or name == "guides")
            thing.data.materials.append(made)
            curves.draw_curls(bpy.context.scene)
        curves.set_curves(thing.data, material.with_pigments(own))
        thing.data.surface = head
        if head.data.uv_layers.active:
            thing.data.surface_uv_map = head.data.uv_layers.active.name
        thing.parent = head
        thing.matrix_parent_inverse = rest_matrix(head).inverted()
    if (locks := head.ringlet.lock_curves) is not None and head.ringlet.lock_motion is None:
        locks.hide_viewport = locks.hide_render = hairs


def _own(arrays: dict[str, np.ndarray], name: str) -> dict[str, np.ndarray]:
    """The arrays of some curves."""
    return {key.removeprefix(f"{name}/"): values for key, values in arrays.items() if key.startswith(f"{name}/")}


def sync_operators(head: bpy.types.Object, settings: dict) -> None:
    """Gives the panel a row for each operator."""
    rows = head.ringlet.shape
    names = [one["op"] for one in settings.get("shape", [])]
    if [row.op for row in rows] != names:
        rows.clear()
        for name in names:
            rows.add().op = name


def remove(thing: bpy.types.Object) -> None:
    """Removes an object and its data."""
    data = thing.data
    bpy.data.objects.remove(thing)
    if data is not None and not data.users:
        bpy.data.batch_remove([data])
