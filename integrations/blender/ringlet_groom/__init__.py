"""Ringlet in Blender: grows, changes and simulates hair on meshes of the scene, and opens what Ringlet wrote.

Ringlet itself runs as a process of its own (``session``); this is the host at the other end of docs/host.md.
"""

from __future__ import annotations

from . import file_operators, identity, operators, panels, preferences, properties, timer

MODULES = (preferences, properties, identity, operators, file_operators, panels, timer)


def register() -> None:
    """Called by Blender when the extension is switched on."""
    for module in MODULES:
        module.register()


def unregister() -> None:
    """Called by Blender when the extension is switched off; Curves objects stay."""
    for module in reversed(MODULES):
        module.unregister()
