"""Which head is which: each has an id of its own in the .blend, which its name, place and copies leave alone.

A head of a library belongs to the library and is not changed here. Its library override is a head of this .blend.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
from bpy.app.handlers import persistent

from . import edited_text, folders, material, names, skin
from .properties import KINDS
from .refused import Refused

STILL = {"guides": "guide_curves", "locks": "lock_curves", "hairs": "hair_curves"}  # properties, by name of the curves
MOVING = ("lock_motion", "hair_motion")
MOST_NAME = 63  # bytes of a name before Blender 5

notes: dict[str, str] = {}  # of heads by id: what happened to their files, for the panel
_known: dict[int, str] = {}  # ids of this session by the number of the data-block: undo takes back the id, not that


def _all_heads() -> list[bpy.types.Object]:
    return [thing for thing in bpy.data.objects if thing.type == "MESH" and thing.ringlet.recipe is not None]


def heads() -> Iterator[bpy.types.Object]:
    """Objects with a recipe that belong to this .blend."""
    return (head for head in _all_heads() if head.library is None)


def head_with(id: str) -> bpy.types.Object | None:
    """The head with an id; None where it is gone."""
    return next((head for head in heads() if head.ringlet.id == id), None)


def refuse_linked(head: bpy.types.Object) -> None:
    """Raises Refused for a head of a library."""
    if head.library is not None:
        raise Refused(
            f"{head.name}: belongs to {head.library.filepath}; change its hair there, or make a library override "
            "of it (Object > Library Override > Make), which has hair of its own here"
        )


def folder_of(head: bpy.types.Object) -> Path:
    """The folder of a head's files: next to its .blend, or a temporary one before that is saved."""
    blend = bpy.path.abspath(head.library.filepath) if head.library else bpy.data.filepath
    return _root(blend) / (head.ringlet.id or names.identifier(head.name))


def _root(blend: str) -> Path:
    return folders.root_of(Path(blend)) if blend else Path(bpy.app.tempdir) / "ringlet"


def link_with(head: bpy.types.Object, thing: bpy.types.Object) -> None:
    """Puts an object into the collections of a head, or into the scene where all those are of a library."""
    ours = [one for one in head.users_collection if one.library is None and one.override_library is None]
    for collection in ours or [bpy.context.scene.collection]:
        collection.objects.link(thing)


def new_text(name: str, kind: str, head: bpy.types.Object, content: str) -> bpy.types.Text:
    """A new text of the .blend for the recipe or the shot of a head, with a name that no other has."""
    extension = f".{kind}.toml"
    stem = names.shortened(edited_text.stem_of(name), MOST_NAME - len(extension) - 4)
    taken = [edited_text.stem_of(text.name) for text in bpy.data.texts]
    text = bpy.data.texts.new(f"{names.unique(stem, taken, names.folded)}{extension}")
    text.from_string(content)
    text.ringlet_head = head.ringlet.id if kind == "recipe" else ""
    return text


def settle() -> None:
    """Gives an id to each head without one, and another to each copy of a head, with copies of its texts, curves and
    files."""
    there = list(heads())
    elsewhere = {head.ringlet.id for head in _all_heads() if head.library is not None}
    claims = [folders.Claim(head.session_uid, head.ringlet.id, _is_parent(head)) for head in there]
    for row in folders.wrong_ids(claims, _known, elsewhere):
        _part(there[row], _known.get(there[row].session_uid) or folders.new_id(there[row].name))
    without = [head for head in there if not head.ringlet.id]
    for head in without:
        _adopt(head, [other for other in without if other != head])
    for head in there:
        if _known.get(head.session_uid) != head.ringlet.id:
            _known[head.session_uid] = head.ringlet.id
            _try(head, lambda head=head: folders.find(folder_of(head)))


def _is_parent(head: bpy.types.Object) -> bool:
    return any(thing.parent == head for name in STILL.values() if (thing := getattr(head.ringlet, name)))


def _part(head: bpy.types.Object, id: str) -> None:
    """Makes a copy of a head a head of its own. What it shares with the other is copied; it is not simulated yet."""
    own, source = head.ringlet, folder_of(head)
    own.id = id
    _own_texts(head)
    others = [other.ringlet for other in _all_heads() if other != head]
    copies: dict[bpy.types.Material, bpy.types.Material] = {}
    for name in ("guides", *STILL.values()):
        thing = getattr(own, name)
        if thing is None or (name == "guides" and thing.parent is None):
            continue
        if _is_anothers(thing) or any(getattr(other, name) == thing for other in others):
            setattr(own, name, _copied(thing, head))
        else:
            if thing.data.users > 1:
                thing.data = thing.data.copy()
            if skin.MODIFIER in thing.modifiers:
                skin.follow(thing, head)
        slots = getattr(own, name).data.materials
        for row, one in enumerate(slots):
            if one is not None and material.is_ours(one):
                slots[row] = copies.get(one) or copies.setdefault(one, one.copy())
    for name in MOVING:
        thing = getattr(own, name)
        setattr(own, name, None)
        if thing is not None and _is_anothers(thing):
            _put_away(thing)
        elif thing is not None and not any(getattr(other, name) == thing for other in others):
            bpy.data.objects.remove(thing)
    own.cloth_motion.clear()
    if own.hair_curves or own.lock_curves:
        show = own.hair_curves or own.lock_curves
        show.hide_viewport = show.hide_render = False
    _try(head, lambda: folders.copy(source, folder_of(head), folders.SIMULATED))


def _own_texts(head: bpy.types.Object) -> None:
    """Gives a head copies of its texts."""
    for kind in KINDS:
        if (text := getattr(head.ringlet, kind)) is not None:
            made = new_text(text.name, kind, head, text.as_string())
            made.ringlet_changes = text.ringlet_changes
            setattr(head.ringlet, kind, made)


def _is_anothers(thing: bpy.types.Object) -> bool:
    """Whether an object belongs to a library, as itself or as an override."""
    return thing.library is not None or thing.override_library is not None


def _copied(thing: bpy.types.Object, head: bpy.types.Object) -> bpy.types.Object:
    """A copy of curves below a head."""
    made = thing.copy()
    made.data = thing.data.copy()
    made.parent = head
    link_with(head, made)
    if made.type == "CURVES" and made.data.surface is not None:
        made.data.surface = head
    if skin.MODIFIER in made.modifiers:
        skin.follow(made, head)
    if _is_anothers(thing):
        _put_away(thing)
    return made


def _put_away(thing: bpy.types.Object) -> None:
    """Hides an object of a library in this .blend, since the head has one of its own."""
    if thing.library is None:
        thing.hide_viewport = thing.hide_render = True
    for collection in thing.users_collection if thing.library else ():
        if collection.library is None:
            collection.objects.unlink(thing)


def _adopt(head: bpy.types.Object, others: list[bpy.types.Object]) -> None:
    """Gives a head of an extension without ids an id and its folder, which had its name."""
    own, earlier = head.ringlet, names.identifier(head.name)
    own.id = folders.earlier_id(head.name)
    if any(kind.library for name in KINDS if (kind := getattr(own, name)) is not None):
        _own_texts(head)
    for text in bpy.data.texts:
        if not text.ringlet_head and f'"/scene/{earlier}"' in text.as_string():
            text.ringlet_head = own.id
    shared = [other.name for other in others if names.identifier(other.name) == earlier]
    place = folder_of(head)
    if not shared:
        _try(head, lambda: folders.find(place, earlier))
        return
    for name in MOVING:
        if (thing := getattr(own, name)) is not None:
            setattr(own, name, None)
            bpy.data.objects.remove(thing)
    own.cloth_motion.clear()
    notes[own.id] = f"Shared the folder {earlier} with {', '.join(shared)}; it has its own now: simulate again"


def _try(head: bpy.types.Object, act: Callable[[], None]) -> None:
    """Does something with the folder of a head; a failure is a line in the panel."""
    try:
        act()
    except OSError as error:
        notes[head.ringlet.id] = f"{folder_of(head)}: cannot be made ({error.strerror or error}); check the place"
    mend_paths(head)


def players(head: bpy.types.Object) -> list[bpy.types.Object]:
    """Objects that play the simulation of a head."""
    own = head.ringlet
    there = [*(getattr(own, name) for name in MOVING), *(pair.moving for pair in own.cloth_motion)]
    return [thing for thing in there if thing is not None]


def cache_files(thing: bpy.types.Object) -> list[bpy.types.CacheFile]:
    """Files that an object plays."""
    return [one.cache_file for one in thing.modifiers if one.type == "MESH_SEQUENCE_CACHE" and one.cache_file]


def path_of(file: bpy.types.CacheFile) -> Path:
    """Where a file is."""
    return Path(bpy.path.abspath(file.filepath, library=file.library))


def mend_paths(head: bpy.types.Object) -> None:
    """Lets a head play the files of its own folder where they are, by paths that move with the .blend."""
    for file in {file for thing in players(head) for file in cache_files(thing)}:
        place = folder_of(head) / re.split(r"[/\\]", file.filepath)[-1]
        own = file.filepath.startswith("//") and path_of(file).resolve() == place.resolve()
        if bpy.data.filepath and place.is_file() and not own:
            file.filepath = bpy.path.relpath(str(place))


@persistent
def _before_save(path: str) -> None:
    """Copies the folders of heads where the .blend is saved to another place."""
    settle()
    if path and _root(path) != _root(bpy.data.filepath):
        for head in heads():
            _try(head, lambda head=head: folders.copy(folder_of(head), _root(path) / head.ringlet.id))


@persistent
def _after_save(_path: str) -> None:
    """Lets heads play the files next to the .blend that was saved, not those of the one before."""
    for head in heads():
        mend_paths(head)


@persistent
def _loaded(*_arguments: object) -> None:
    notes.clear()


def register() -> None:
    bpy.app.handlers.save_pre.append(_before_save)
    bpy.app.handlers.save_post.append(_after_save)
    bpy.app.handlers.load_post.append(_loaded)


def unregister() -> None:
    bpy.app.handlers.save_pre.remove(_before_save)
    bpy.app.handlers.save_post.remove(_after_save)
    bpy.app.handlers.load_post.remove(_loaded)
