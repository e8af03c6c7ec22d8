"""Ringlet in Blender: File > Import > Ringlet groom, and Object > Play a Ringlet cache."""

from __future__ import annotations

from typing import ClassVar

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from . import groom


class ImportGroom(bpy.types.Operator, ImportHelper):
    """Opens a groom, a cache or hairs that Ringlet wrote, and binds the curves to the scalp"""

    bl_idname = "ringlet.import_groom"
    bl_label = "Import Ringlet groom"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default="*.usdc;*.usda;*.usd", options={"HIDDEN"})
    show_locks: BoolProperty(name="Locks", description="Show locks and guides also where there are hairs")

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            found = groom.import_groom(context, self.filepath, show_locks=self.show_locks)
        except groom.Refused as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if found.surface is None:
            self.report({"WARNING"}, "No mesh has the texture coordinates of the roots: the surface is not set")
        return {"FINISHED"}


class PlayCache(bpy.types.Operator, ImportHelper):
    """Lets the grooms that are selected, or all there are, follow another simulation of the same groom"""

    bl_idname = "ringlet.play_cache"
    bl_label = "Play a Ringlet cache"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default="*.usdc;*.usda;*.usd", options={"HIDDEN"})

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            groom.play_cache(context, self.filepath)
        except groom.Refused as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


def _import_menu(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    menu.layout.operator(ImportGroom.bl_idname, text="Ringlet groom (.usdc)")


def _object_menu(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    menu.layout.operator(PlayCache.bl_idname)


MENUS = ((bpy.types.TOPBAR_MT_file_import, _import_menu), (bpy.types.VIEW3D_MT_object, _object_menu))


def register() -> None:
    """Called by Blender when the add-on is switched on."""
    for operator in (ImportGroom, PlayCache):
        bpy.utils.register_class(operator)
    for menu, entry in MENUS:
        menu.append(entry)


def unregister() -> None:
    """Called by Blender when the add-on is switched off."""
    for menu, entry in MENUS:
        menu.remove(entry)
    for operator in (PlayCache, ImportGroom):
        bpy.utils.unregister_class(operator)
