"""The timer and the handlers: what happens while the user works."""

from __future__ import annotations

import traceback

import bpy
from bpy.app.handlers import persistent

from . import grooming, identity, shots
from .session import session

BUSY, IDLE = 0.03, 0.2  # s between two looks
_objects = 0  # of the .blend, when they were looked through last


def tick() -> float:
    """Takes answers, reads the next frame of a shot, and asks for grooms that have changed.

    Blender ends a timer that raises: a mistake of the extension becomes a line in the panel, and the timer goes on.
    """
    try:
        identity.settle()
        session.poll()
        shots.advance()
        for head in list(identity.heads()):
            grooming.watch(head)
            shots.watch(head)
    except Exception as error:
        traceback.print_exc()
        session.error = f"This is a mistake in the extension ({error}); see the console"
    busy = session.busy or shots.shots.run is not None
    if busy:
        _redraw()
    return BUSY if busy else IDLE


def _redraw() -> None:
    """Shows progress in the sidebars."""
    manager = bpy.context.window_manager
    for window in manager.windows if manager else ():
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


@persistent
def _changed(_scene: bpy.types.Scene, graph: bpy.types.Depsgraph) -> None:
    """Looks for copies of heads among new objects, and forgets the arrays of those whose geometry or place has
    changed."""
    global _objects
    if _objects != len(bpy.data.objects):
        identity.settle()
        _objects = len(bpy.data.objects)
    for update in graph.updates:
        if isinstance(update.id, bpy.types.Object) and (update.is_updated_geometry or update.is_updated_transform):
            grooming.forget(update.id)


@persistent
def _replaced(*_arguments: object) -> None:
    """Another file, or another state of this one."""
    grooming.forget()


HANDLERS = (
    (bpy.app.handlers.depsgraph_update_post, _changed),
    (bpy.app.handlers.load_post, _replaced),
    (bpy.app.handlers.undo_post, _replaced),
    (bpy.app.handlers.redo_post, _replaced),
)


def register() -> None:
    for handlers, handler in HANDLERS:
        handlers.append(handler)
    bpy.app.timers.register(tick, persistent=True)


def unregister() -> None:
    if bpy.app.timers.is_registered(tick):
        bpy.app.timers.unregister(tick)
    for handlers, handler in HANDLERS:
        if handler in handlers:
            handlers.remove(handler)
    session.stop()
    grooming.forget()
