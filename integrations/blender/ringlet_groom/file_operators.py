"""File > Import > Ringlet groom, and Object > Play a Ringlet cache: grooms that Ringlet wrote elsewhere."""

from __future__ import annotations

from typing import ClassVar

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from . import usd_files
from .refused import Refused


class ImportGroom(bpy.types.Operator, ImportHelper):
    """Opens a groom, a cache or hairs that Ringlet wrote, and binds the curves to the scalp"""

    bl_idname = "ringlet.import_groom"
    bl_label = "Import Ringlet groom"
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default="*.usdc;*.usda;*.usd", options={"HIDDEN"})
    show_locks: BoolProperty(name="Locks", description="Show locks and guides also where there are hairs")

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            found = usd_files.import_groom(context, self.filepath, show_locks=self.show_locks)
        except Refused as error:
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
            usd_files.play_cache(context, self.filepath)
        except Refused as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


def _import_menu(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    menu.layout.operator(ImportGroom.bl_idname, text="Ringlet groom (.usdc)")


def _object_menu(menu: bpy.types.Menu, _context: bpy.types.Context) -> None:
    menu.layout.operator(PlayCache.bl_idname)


CLASSES = (ImportGroom, PlayCache)
MENUS = ((bpy.types.TOPBAR_MT_file_import, _import_menu), (bpy.types.VIEW3D_MT_object, _object_menu))


def register() -> None:
    for one in CLASSES:
        bpy.utils.register_class(one)
    for menu, entry in MENUS:
        menu.append(entry)


def unregister() -> None:
    for menu, entry in MENUS:
        menu.remove(entry)
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
