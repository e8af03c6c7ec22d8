"""Preferences of the extension: where Ringlet is, and its installation."""

from __future__ import annotations

import bpy
from bpy.props import StringProperty

from . import installation
from .session import session


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    path: StringProperty(
        name="Ringlet's command", subtype="FILE_PATH", description="The file ringlet; found by itself when empty"
    )
    wheel: StringProperty(
        name="Wheel", subtype="FILE_PATH", description="A wheel of Ringlet to install; from the internet when empty"
    )
    python: StringProperty(
        name="Python", subtype="FILE_PATH", description="Python for Ringlet's environment; Blender's own when empty"
    )

    def draw(self, _context: bpy.types.Context) -> None:
        layout, found = self.layout, installation.command()
        layout.label(text=f"Ringlet {session.version}: {found[0]}" if found else "Ringlet is not installed")
        layout.prop(self, "path")
        layout.prop(self, "wheel")
        layout.prop(self, "python")
        layout.operator("ringlet.install")
        if installation.installation.state:
            layout.label(text=installation.installation.state)


def register() -> None:
    bpy.utils.register_class(Preferences)


def unregister() -> None:
    bpy.utils.unregister_class(Preferences)
