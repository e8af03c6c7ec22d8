"""Grooms of heads: made by Ringlet whenever what they are made of has changed, and shown as Curves objects.

Nothing asks for a groom: ``watch`` compares what the curves were made of with what there is now. Sliders, the text
editor, sculpting, undo and reload all come out right by that.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from hashlib import blake2b

import bpy
import numpy as np
from mathutils import Matrix

from . import curves, folders, images, material, meshes, names, skin
from .edited_text import stem_of
from .identity import STILL, folder_of, head_with, link_with, new_text
from .link import Message
from .properties import Document, keep_settings, scale
from .refused import Refused
from .session import Request, session

HEAD, GUIDES = "head.usdc", "guides.usdc"
PRIM = "head"  # of the head in its file, whatever it is called here
MADE_OF = "ringlet_made_of"  # custom property of curves: a digest of what they were made of


@dataclass
class State:
    """What is known of a head in this session, and not kept in the .blend.

    asked:     key of the groom that was asked for last
    busy:      whether its answer is outstanding
    sent:      what Ringlet has: fingerprints of files by name, for an epoch of the session and a folder
    message:   the error of the last request; empty when it went well
    missing:   a line of the simulated frames that are not there
    still:     why the groom does not follow the skin before it is simulated; empty where it does
    conflicts: what Ringlet says of the groom
    progress:  stage in progress, and its fraction
    """

    asked: str = ""
    busy: bool = False
    sent: dict[str, str] = field(default_factory=dict)
    of: tuple[int, str] = (0, "")
    message: str = ""
    missing: str = ""
    still: str = ""
    conflicts: list[str] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)
    progress: tuple[str, float] = ("", 1.0)


states: dict[str, State] = {}  # of heads by id
# Of meshes and guides by the number of the object, with fingerprints, until they change.
_arrays: dict[int, tuple[dict[str, np.ndarray], str]] = {}
# The last answers by what they were made of, so that undo, redo and a slider there and back show them at once.
_answers: dict[str, Message] = {}
MOST_ANSWERS = 3
# Of heads by the number of the object: the fingerprint of the rest pose, and its vertices where the head shows them.
_skins: dict[int, tuple[str, np.ndarray]] = {}


def state_of(head: bpy.types.Object) -> State:
    """The state of a head."""
    return _state(head.ringlet.id)


def _state(id: str) -> State:
    return states.setdefault(id, State())


def forget(thing: bpy.types.Object | None = None) -> None:
    """Forgets the arrays of an object that has changed, or of all and the states too."""
    if thing is None:
        states.clear()
        _arrays.clear()
        images.forget()
    else:
        _arrays.pop(thing.session_uid, None)


def rest_matrix(head: bpy.types.Object) -> Matrix:
    """Where the head was when its groom began: the groom is made there, and goes with the head."""
    values = head.ringlet.rest_matrix
    return Matrix([values[4 * row : 4 * row + 4] for row in range(4)])


def begin(head: bpy.types.Object, text: str, name: str) -> None:
    """Gives a head a recipe, in a new text of the .blend."""
    own = head.ringlet
    own.id = own.id or folders.new_id(head.name)
    own.recipe = new_text(name, "recipe", head, text)
    if not any(own.rest_matrix):
        own.rest_matrix = [value for row in head.matrix_world for value in row]
    regions, _ = meshes.map_names(head)
    Document(head, "recipe").change(set=["scalp", "region"], value="scalp" if "scalp" in regions else None)


def recipe_message(head: bpy.types.Object, text: bpy.types.Text | None = None, file: str = HEAD) -> dict:
    """The recipe of a head, or another text of it, with its mesh and what the panel adds, as Ringlet takes it.

    file: with the mesh of the head
    """
    own, folder = head.ringlet, folder_of(head)
    text = text or own.recipe
    overlay = [{"set": ["scalp", "file"], "value": file}, {"set": ["scalp", "mesh"], "value": f"/scene/{PRIM}"}]
    if own.guides is not None:
        overlay.append({"set": ["guides"], "value": {"file": GUIDES}})
    shown = [one.image for one in own.images if one.image is not None]
    maps = meshes.map_names(head)[1]
    for image, name, stem in zip(shown, maps, names.distinct(maps, compared=names.folded), strict=True):
        overlay.append({"set": ["maps", name], "value": images.file_of(image, folder, stem)})
    changes = json.loads(text.ringlet_changes or "[]")
    return {"name": recipe_file(text), "text": text.as_string(), "changes": changes, "overlay": overlay}


def recipe_file(text: bpy.types.Text) -> str:
    """Name of the file of a recipe in the folder of its head."""
    return f"{names.file_name(stem_of(text.name))}.recipe.toml"


def key_of(head: bpy.types.Object, inputs: str = "") -> str:
    """A digest of all that the groom of a head depends on: the recipe, and ``inputs`` or else those of now."""
    document = Document(head, "recipe")
    return _digest([document.text, document.changes, inputs or inputs_of(head)])


def inputs_of(head: bpy.types.Object) -> str:
    """A digest of what a groom depends on besides its recipe. Raises Refused for a mesh, guides or images that are
    empty."""
    own = head.ringlet
    parts = [head_arrays(head)[1], f"{own.show_hairs} {own.fraction:.6g} {scale():g} {meshes.is_subdivided(head)}"]
    if own.guides is not None:
        parts.append(guide_arrays(head)[1])
    parts += [f"{one.image.name} {images.stamp(one.image)}" for one in own.images if one.image]
    return _digest(parts)


def _digest(parts: list[str]) -> str:
    return blake2b("\0".join(parts).encode(), digest_size=16).hexdigest()


def head_arrays(head: bpy.types.Object) -> tuple[dict[str, np.ndarray], str]:
    """The rest pose of a head, and its fingerprint."""
    return _kept(head.session_uid, lambda: meshes.rest_arrays(head, rest_matrix(head)))


def rest_skin(head: bpy.types.Object) -> np.ndarray:
    """Vertices of a head in its rest pose where its modifiers place them; kept, since Blender evaluates it for them."""
    digest = _digest([head_arrays(head)[1], *(f"{one.type} {one.show_viewport}" for one in head.modifiers)])
    if _skins.get(head.session_uid, ("",))[0] != digest:
        _skins[head.session_uid] = digest, meshes.rest_skin(head, rest_matrix(head))
    return _skins[head.session_uid][1]


def guide_arrays(head: bpy.types.Object) -> tuple[dict[str, np.ndarray], str]:
    """The guides of a head in the space of its rest pose, and their fingerprint."""
    guides = head.ringlet.guides
    matrix = rest_matrix(head) @ head.matrix_world.inverted() @ guides.matrix_world
    return _kept(guides.session_uid, lambda: curves.read_curves(guides, matrix))


def _kept(number: int, make) -> tuple[dict[str, np.ndarray], str]:
    if number not in _arrays:
        made = make()
        _arrays[number] = made, meshes.fingerprint(made)
    return _arrays[number]


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
        elif key in _answers:
            document = Document(head, "recipe")
            _take(own.id, (document.text, document.changes), inputs_of(head), _answers[key])
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
    return [thing for name in STILL.values() if (thing := getattr(head.ringlet, name)) is not None]


def ask(head: bpy.types.Object) -> None:
    """Asks for the groom of a head."""
    own, state = head.ringlet, state_of(head)
    sent, inputs = (Document(head, "recipe").text, Document(head, "recipe").changes), inputs_of(head)
    recipe, id = recipe_message(head), own.id
    send_files(head)
    state.busy = True
    request = Request(
        done=lambda message: _take(id, sent, inputs, message),
        failed=lambda line: _fail(id, line),
        lost=lambda line: _lose(id, line),
        progress=lambda stage, done, total: _progress(id, stage, done, total),
    )
    fraction = own.fraction if own.show_hairs else None
    session.send("groom", request, folder=str(folder_of(head)), recipe=recipe, hairs=fraction)


def send_files(head: bpy.types.Object) -> None:
    """Sends the head and its guides where Ringlet has not got them as they are now."""
    state, id, folder = state_of(head), head.ringlet.id, folder_of(head)
    if state.of != (session.epoch, str(folder)):
        state.sent, state.of = {}, (session.epoch, str(folder))
    arrays, digest = head_arrays(head)
    digest += f" {meshes.is_subdivided(head)}"
    request = Request(lambda _: None, lambda line: _fail(id, line), lambda line: _lose(id, line))
    if state.sent.get(HEAD) != digest:
        described, sent = meshes.message([(PRIM, head, arrays)])
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


def _progress(id: str, stage: str, done: int, total: int) -> None:
    _state(id).progress = stage, done / max(total, 1)


def _fail(id: str, line: str) -> None:
    state = _state(id)
    state.busy, state.message, state.sent = False, line, {}
    state.progress = "", 1.0


def _lose(id: str, line: str) -> None:
    """Ringlet ended before it answered: it is asked again."""
    _fail(id, line)
    _state(id).asked = ""


def _take(id: str, sent: tuple[str, str], inputs: str, message: Message) -> None:
    """Shows a groom, and takes the text that has the changes in it if it has not changed meanwhile.

    id:           of the head, which may have been renamed or removed
    sent, inputs: text and changes, and the digest of all else, that the groom was made of
    """
    state, head, header = _state(id), head_with(id), message.header
    state.busy, state.message, state.progress = False, "", ("", 1.0)
    if head is None:
        return
    _answers[_digest([*sent, inputs])] = message
    for old in list(_answers)[:-MOST_ANSWERS]:
        del _answers[old]
    document = Document(head, "recipe")
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
    state = state_of(head)
    arrays, hairs = message.arrays, any(name.startswith("hairs/") for name in message.arrays)
    color, fiber = message.header["settings"].get("color"), message.header["fiber"]
    dyed = color is not None and (color.get("dye") is not None or bool(color["dyes"]))
    slots = [one for thing in shown_curves(head) for one in thing.data.materials if one is not None]
    made = next((one for one in slots if material.is_ours(one)), None) or bpy.data.materials.new(f"{head.name} hair")
    material.hair_material(
        made,
        fiber,
        material.viewport_color(_own(arrays, "hairs" if hairs else "locks"), fiber, dyed=dyed),
        pigments=any(name.endswith("/melanin") for name in arrays),
        dyed=dyed,
    )
    for name, pointer in STILL.items():
        own = _own(arrays, name)
        thing = getattr(head.ringlet, pointer)
        if not own:
            if thing is not None:
                remove(thing)
            continue
        if thing is None:
            thing = bpy.data.objects.new(f"{head.name} {name}", bpy.data.hair_curves.new(f"{head.name} {name}"))
            link_with(head, thing)
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
        if "skinprim" in own:
            state.still = skin.bind(thing.data, own["skinprim"], head, head_arrays(head)[0], rest_skin(head))
            if state.still:
                skin.leave(thing)
            else:
                skin.follow(thing, head)
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
