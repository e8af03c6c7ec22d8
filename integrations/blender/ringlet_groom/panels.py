"""The sidebar of the 3D view: Ringlet."""

from __future__ import annotations

import bpy

from . import grooming, identity, schema
from .operators import head_of
from .properties import is_set
from .refused import Refused
from .session import session
from .shots import shots

IN_SIDEBAR = {"bl_space_type": "VIEW_3D", "bl_region_type": "UI", "bl_category": "Ringlet"}
CLOSED = {**IN_SIDEBAR, "bl_parent_id": "RINGLET_PT_main", "bl_options": {"DEFAULT_CLOSED"}}
MOST_LINES = 4  # of notes


def draw_settings(layout: bpy.types.UILayout, group: bpy.types.PropertyGroup, kind: str, settings: list) -> None:
    """Draws settings: a value with its variation folded below it, those without a value in gray, and those
    of an optional table that is not there."""
    absent = [one.place for one in settings if one.kind == "table" and not is_set(group, kind, one)]
    for setting in settings:
        if setting.of is not None:
            continue
        row = layout.row(align=True)
        valued = setting.kind in ("table", "boolean") or is_set(group, kind, setting)
        row.active = valued and not any(setting.place[: len(one)] == one != setting.place for one in absent)
        row.prop(group, setting.name)
        more = [one for one in settings if one.of == setting.place]
        if more:
            header, body = layout.panel(f"{group.path_from_id()}.{setting.name}", default_closed=True)
            header.label(text=f"{setting.label}: variation")
            if body is not None:
                for one in more:
                    body.prop(group, one.name)


def lines(layout: bpy.types.UILayout, text: str, icon: str = "NONE", width: int = 46) -> None:
    """Draws a sentence in lines."""
    words, line = text.split(), ""
    for word in words:
        if line and len(line) + len(word) >= width:
            layout.label(text=line, icon=icon)
            line, icon = "", "BLANK1" if icon != "NONE" else "NONE"
        line = f"{line} {word}".strip()
    layout.label(text=line, icon=icon)


class Main(bpy.types.Panel):
    bl_idname, bl_label = "RINGLET_PT_main", "Ringlet"

    def draw(self, context: bpy.types.Context) -> None:
        layout, head = self.layout, head_of(context)
        if session.error:
            lines(layout, session.error, "ERROR")
            layout.operator("ringlet.restart")
        if head is None:
            layout.label(text="Choose the mesh of a head")
            return
        try:
            identity.refuse_linked(head)
        except Refused as error:
            lines(layout, str(error), "INFO")
            return
        own = head.ringlet
        if own.recipe is None:
            layout.operator_menu_enum("ringlet.begin", "look")
            layout.operator("ringlet.open_recipe")
            return
        state = grooming.state_of(head)
        layout.prop(own, "recipe")
        row = layout.row(align=True)
        row.operator("ringlet.new_variant")
        row.operator_menu_enum("ringlet.begin", "look", text="Other Look")
        row = layout.row(align=True)
        row.prop(own, "live", toggle=True)
        row.prop(own, "show_hairs", toggle=True)
        row = layout.row()
        row.active = own.show_hairs
        row.prop(own, "fraction")
        if state.progress[0]:  # in place of what it will change, so that all below stays under the pointer
            layout.progress(text=f"Grooming: {state.progress[0]}", factor=state.progress[1])
        elif state.message:
            lines(layout, state.message, "INFO" if state.message.startswith("Wrote") else "ERROR")
        elif state.counts:
            layout.label(text=", ".join(f"{count:,} {name}" for name, count in state.counts.items()))
        for sentence in [*filter(None, [identity.notes.get(own.id), state.still]), *state.conflicts[:MOST_LINES]]:
            lines(layout, sentence, "INFO")
        row = layout.row(align=True)
        row.operator("ringlet.view")
        row.operator("ringlet.take_saved")
        layout.operator("ringlet.export")


class Scalp(bpy.types.Panel):
    bl_idname, bl_label = "RINGLET_PT_scalp", "Head, Maps and Guides"

    def draw(self, context: bpy.types.Context) -> None:
        layout, head = self.layout, head_of(context)
        own = head.ringlet
        layout.prop(own.recipe_scalp, "region")
        layout.prop(own, "guides")
        layout.operator("ringlet.sculpt_guides")
        for row, one in enumerate(own.images):
            line = layout.row(align=True)
            line.template_ID(one, "image", open="image.open")
            line.operator("ringlet.remove_image", text="", icon="X").row = row
        layout.operator("ringlet.add_image")


class Operators(bpy.types.Panel):
    bl_idname, bl_label = "RINGLET_PT_shape", "Shape"

    def draw(self, context: bpy.types.Context) -> None:
        layout, head = self.layout, head_of(context)
        for row, one in enumerate(head.ringlet.shape):
            if one.op not in schema.operators():
                layout.label(text=one.op, icon="ERROR")
                continue
            header, body = layout.panel(f"ringlet.shape.{row}", default_closed=True)
            header.label(text=one.op.replace("_", " ").capitalize())
            for what, icon in (("up", "TRIA_UP"), ("down", "TRIA_DOWN"), ("remove", "X")):
                button = header.operator("ringlet.change_operator", text="", icon=icon)
                button.row, button.what = row, what
            if body is not None:
                draw_settings(body, getattr(one, one.op), "recipe", schema.operators()[one.op][1])
        layout.operator_menu_enum("ringlet.add_operator", "op")


class Shot(bpy.types.Panel):
    bl_idname, bl_label = "RINGLET_PT_shot", "Simulation"

    def draw(self, context: bpy.types.Context) -> None:
        layout, own = self.layout, head_of(context).ringlet
        layout.prop(own, "shot")
        layout.prop(own, "colliders")
        layout.prop(own, "cloth")
        if shots.run is not None:
            layout.progress(text="Canceling" if shots.run.canceled else shots.stage, factor=shots.part)
            row = layout.row()
            row.enabled = not shots.run.canceled
            row.operator("ringlet.cancel")
        else:
            row = layout.row(align=True)
            row.operator("ringlet.simulate").resume = False
            if shots.left:
                row.operator("ringlet.simulate", text=f"Resume ({shots.left} steps done)").resume = True
            row = layout.row(align=True)
            row.operator("ringlet.bake")
            row.operator("ringlet.clear_motion")
        state = grooming.state_of(head_of(context))
        for sentence in filter(None, [shots.message, state.missing]):
            lines(layout, sentence, "ERROR")
        for sentence in shots.notes[:MOST_LINES]:
            lines(layout, sentence, "INFO")


def _has_recipe(_cls: type, context: bpy.types.Context) -> bool:
    return (head := head_of(context)) is not None and head.ringlet.recipe is not None


def _section(kind: str, name: str, parent: str) -> type:
    def draw(self: bpy.types.Panel, context: bpy.types.Context) -> None:
        group = getattr(head_of(context).ringlet, f"{kind}_{name}")
        draw_settings(self.layout, group, kind, schema.sections(kind)[name][1])

    found = {
        **CLOSED,
        "bl_parent_id": parent,
        "bl_idname": f"RINGLET_PT_{kind}_{name}",
        "bl_label": name.capitalize(),
        "bl_description": schema.sections(kind)[name][0],
        "poll": classmethod(_has_recipe),
        "draw": draw,
    }
    return type(found["bl_idname"], (bpy.types.Panel,), found)


_registered: list[type] = []


def register() -> None:
    for panel in (Main, Scalp, Operators, Shot):
        for name, value in (IN_SIDEBAR if panel is Main else CLOSED).items():
            setattr(panel, name, value)
        if panel is not Main:
            panel.poll = classmethod(_has_recipe)
    recipe = [_section("recipe", name, Main.bl_idname) for name in schema.SECTIONS["recipe"]]
    shot = [_section("shot", name, Shot.bl_idname) for name in schema.SECTIONS["shot"]]
    _registered[:] = [Main, Scalp, *recipe[:2], Operators, *recipe[2:], Shot, *shot]
    for one in _registered:
        bpy.utils.register_class(one)


def unregister() -> None:
    for one in reversed(_registered):
        bpy.utils.unregister_class(one)
    _registered.clear()
