"""Properties of a head, generated from Ringlet's schema.

A property holds no value of its own: it reads the recipe or the shot that the head names, and writes a change to it. So
undo, reload and an edit of the text keep all of them right.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from . import edited_text, schema
from .edited_text import MISSING
from .schema import Setting

KINDS = ("recipe", "shot")
CURVES = ("guide_curves", "lock_curves", "hair_curves", "lock_motion", "hair_motion")
_settings: dict[tuple[str, str], dict[str, Any]] = {}  # all settings of a text, as Ringlet answered
MOST_KEPT = 64
UNITS = {"deg": "°", "/cm2": "/cm²", "Hz": "Hz", "s": "s", "kg/m³": "kg/m³"}  # in names; Blender adds that of lengths


def keep_settings(kind: str, text: str, settings: dict[str, Any]) -> None:
    """Keeps what Ringlet answered for a text."""
    if len(_settings) >= MOST_KEPT:
        _settings.pop(next(iter(_settings)))
    _settings[kind, text] = settings


class Document:
    """The recipe or the shot of a head."""

    def __init__(self, head: bpy.types.Object, kind: str) -> None:
        self._own, self.kind = head.ringlet, kind

    @property
    def block(self) -> bpy.types.Text | None:
        """The text of the .blend, None for a head without one."""
        return getattr(self._own, self.kind)

    @property
    def text(self) -> str:
        """Its text, without the changes."""
        return self.block.as_string() if self.block else ""

    @property
    def changes(self) -> str:
        """Changes that are not in the text yet, as JSON.

        They are kept with the text in one data-block: undo restores data-blocks one by one, and both belong together.
        """
        return self.block.ringlet_changes if self.block else ""

    def change(self, **change: Any) -> None:
        """Adds a change."""
        self.block.ringlet_changes = edited_text.with_change(self.changes, change)

    def fold(self, text: str) -> None:
        """Takes the text with all changes in it."""
        if text != self.text:
            self.block.from_string(text)
        self.block.ringlet_changes = ""

    @property
    def settings(self) -> dict[str, Any]:
        """All settings of the text as Ringlet answered last; empty before its first answer."""
        return _settings.get((self.kind, self.text), {})

    @property
    def unit(self) -> str:
        """Unit of lengths in the text; a shot is in metres."""
        if self.kind == "shot":
            return "m"
        found = re.search(r'^unit\s*=\s*"(\w+)"', self.text, re.MULTILINE)
        return found[1] if found and found[1] in edited_text.UNITS else "cm"

    def value(self, place: tuple[str | int, ...], setting: Setting) -> Any:
        """The value of a setting, lengths in metres; the default where nothing says it, and None where it is absent."""
        changed = edited_text.pending(self.changes, place)
        if changed is not MISSING:
            if setting.unit == "m" and changed is not None:
                return edited_text.in_metres(self.unit, changed)
            return changed
        return edited_text.value_at(self.settings, place, setting.default)

    def set(self, place: tuple[str | int, ...], setting: Setting, value: Any) -> None:
        """Sets a setting; lengths are in metres."""
        if setting.unit == "m" and value is not None:
            value = edited_text.length_in(self.unit, value)
        elif isinstance(value, float):
            value = float(f"{value:.6g}")
        self.change(set=list(place), value=value)


def place_of(group: bpy.types.PropertyGroup, setting: Setting) -> tuple[str | int, ...]:
    """The place of a setting in the recipe or the shot."""
    path = group.path_from_id()
    if row := re.search(r"\.shape\[(\d+)\]", path):
        return ("shape", int(row[1]), *setting.place)
    return (path.rpartition(".")[2].partition("_")[2], *setting.place)  # ringlet.recipe_curl is the section curl


def scale() -> float:
    """Metres of a Blender unit."""
    units = bpy.context.scene.unit_settings
    return units.scale_length if units.system != "NONE" else 1.0


def _accessors(kind: str, setting: Setting) -> tuple[Callable, Callable]:
    def get(group: bpy.types.PropertyGroup) -> Any:
        value = Document(group.id_data, kind).value(place_of(group, setting), setting)
        return _shown(setting, value)

    def put(group: bpy.types.PropertyGroup, value: Any) -> None:
        Document(group.id_data, kind).set(place_of(group, setting), setting, _stored(setting, value))

    return get, put


def is_set(group: bpy.types.PropertyGroup, kind: str, setting: Setting) -> bool:
    """Whether a setting has a value; one of two that exclude each other has none."""
    value = Document(group.id_data, kind).value(place_of(group, setting), setting)
    return value is not None and value is not False


def _shown(setting: Setting, value: Any) -> Any:
    """A value of the recipe as its property shows it."""
    if setting.kind == "table":
        return value is not None
    if setting.kind == "boolean":
        return bool(value)
    if setting.kind == "choice":
        return setting.choices.index(str(value or "")) if str(value or "") in setting.choices else 0
    if setting.kind == "text":
        return str(value or "")
    if setting.kind == "ramp":
        return edited_text.ramp_text(value)
    if setting.kind == "vector":
        return tuple(value) if isinstance(value, list | tuple) and len(value) == 3 else (0.0, 0.0, 0.0)
    if setting.kind == "color":
        return tuple(part / 255.0 for part in bytes.fromhex(str(value or "#000000")[1:]))
    if not isinstance(value, int | float):
        value = setting.least or 0
    return int(value) if setting.kind == "integer" else float(value) / (scale() if setting.unit == "m" else 1.0)


def _stored(setting: Setting, value: Any) -> Any:
    """A value of a property as the recipe states it; None takes the setting away."""
    if setting.kind == "table":
        return {} if value else None
    if setting.kind == "choice":
        return setting.choices[value] or None
    if setting.kind == "text":
        return value or None
    if setting.kind == "ramp":
        return edited_text.parse_ramp(value)
    if setting.kind == "vector":
        return [float(f"{number:.6g}") for number in value]
    if setting.kind == "color":
        return f"#{bytes(round(255.0 * part) for part in value).hex()}"
    return value * scale() if setting.unit == "m" else value


def _property(kind: str, setting: Setting) -> Any:
    """The Blender property of a setting."""
    get, put = _accessors(kind, setting)
    name = f"{setting.label} [{UNITS[setting.unit]}]" if setting.unit in UNITS else setting.label
    common = {"name": name, "description": setting.description[:1000], "get": get, "set": put}
    bounds = {"min": setting.least, "max": setting.most}
    if setting.unit == "m":  # in the unit of the scene: all but the sign is left to Ringlet
        bounds = {"min": 0.0 if setting.least is not None and setting.least >= 0 else None}
    bounds = {name: value for name, value in bounds.items() if value is not None}
    if setting.kind == "integer":
        return IntProperty(**common, **{name: int(min(value, 2**31 - 1)) for name, value in bounds.items()})
    if setting.kind == "number":
        if setting.unit == "m":
            return FloatProperty(**common, **bounds, subtype="DISTANCE", precision=4, step=0.1)
        return FloatProperty(**common, **bounds, precision=3, step=1)
    if setting.kind in ("boolean", "table"):
        return BoolProperty(**common)
    if setting.kind == "choice":
        items = [(one or "NONE", one.replace("_", " ") or "–", "", k) for k, one in enumerate(setting.choices)]
        return EnumProperty(items=items, **common)
    if setting.kind == "vector":
        return FloatVectorProperty(**common, size=3, precision=2)
    if setting.kind == "color":
        return FloatVectorProperty(**common, size=3, min=0.0, max=1.0, subtype="COLOR_GAMMA")
    if setting.place[-1] in ("map", "density", "direction", "region"):
        return StringProperty(**common, search=_names, search_options={"SUGGESTION"})
    return StringProperty(**common)


def _names(group: bpy.types.PropertyGroup, _context: bpy.types.Context, typed: str) -> list[str]:
    """Names of the maps of a head: its vertex groups and its images."""
    from .meshes import map_names

    groups, images = map_names(group.id_data)
    return [name for name in (*groups, *images) if typed.lower() in name.lower()]


def _group(name: str, kind: str, settings: list[Setting]) -> type:
    found = {setting.name: _property(kind, setting) for setting in settings}
    return type(name, (bpy.types.PropertyGroup,), {"__annotations__": found})


REGION = Setting(("region",), "text", "vertex group whose faces carry hair; all when empty")


class ImageMap(bpy.types.PropertyGroup):
    """An image over the texture coordinates of the head, as a map: black 0, white 1"""

    image: PointerProperty(type=bpy.types.Image)


class PlayedCloth(bpy.types.PropertyGroup):
    """A cloth, and the copy of it that plays its simulated motion"""

    source: PointerProperty(type=bpy.types.Object)
    moving: PointerProperty(type=bpy.types.Object)


def _curves_only(_self: Any, thing: bpy.types.Object) -> bool:
    return thing.type == "CURVES"


def _build() -> tuple[list[type], type]:
    """The classes of all sections and operators, and that of a head, in the order of their registration."""
    classes: list[type] = [ImageMap, PlayedCloth]
    sections: dict[str, Any] = {}
    for kind in KINDS:
        for name, (description, settings) in schema.sections(kind).items():
            group = _group(f"RINGLET_PG_{kind}_{name}", kind, settings)
            classes.append(group)
            sections[f"{kind}_{name}"] = PointerProperty(type=group, description=description)
    scalp = _group("RINGLET_PG_recipe_scalp", "recipe", [REGION])
    operators: dict[str, Any] = {"op": StringProperty()}
    for name, (_, settings) in schema.operators().items():
        group = _group(f"RINGLET_PG_op_{name}", "recipe", settings)
        classes.append(group)
        operators[name] = PointerProperty(type=group)
    shape = type("RINGLET_PG_shape", (bpy.types.PropertyGroup,), {"__annotations__": operators})
    kept: dict[str, Any] = {"override": {"LIBRARY_OVERRIDABLE"}}  # also of a head that overrides one of a library
    rows = {"override": {"LIBRARY_OVERRIDABLE", "USE_INSERTION"}}
    head = {
        **sections,
        "recipe_scalp": PointerProperty(type=scalp),
        "id": StringProperty(options={"HIDDEN"}, **kept),
        "shape": CollectionProperty(type=shape, **rows),
        "images": CollectionProperty(type=ImageMap, **rows),
        "recipe": PointerProperty(type=bpy.types.Text, name="Recipe", description="The recipe of this head", **kept),
        "shot": PointerProperty(type=bpy.types.Text, name="Shot", description="How the groom is simulated", **kept),
        "rest_matrix": FloatVectorProperty(size=16, options={"HIDDEN"}, **kept),
        "live": BoolProperty(name="Live", default=True, description="Groom again with every change", **kept),
        "fraction": FloatProperty(
            name="Hairs",
            default=0.25,
            min=0.001,
            max=1.0,
            subtype="FACTOR",
            description="Fraction of the hairs to make; each is as much wider as others are left out",
            **kept,
        ),
        "show_hairs": BoolProperty(
            name="Show hairs", default=True, description="Make hairs, not guides and locks alone", **kept
        ),
        "guides": PointerProperty(
            type=bpy.types.Object,
            name="Guides",
            poll=_curves_only,
            description="Curves drawn or sculpted in Blender that give silhouette and length; grown when empty",
            **kept,
        ),
        "colliders": PointerProperty(
            type=bpy.types.Collection,
            name="Colliders",
            description="Meshes that hair touches besides the head",
            **kept,
        ),
        "cloth": PointerProperty(
            type=bpy.types.Collection,
            name="Cloth",
            description="Meshes that move with the hair; the vertex group 'pin' holds them",
            **kept,
        ),
        **{name: PointerProperty(type=bpy.types.Object, **kept) for name in CURVES},
        "cloth_motion": CollectionProperty(type=PlayedCloth, **rows),
    }
    top = type("RINGLET_PG_head", (bpy.types.PropertyGroup,), {"__annotations__": head})
    return [*classes, scalp, shape, top], top


_registered: list[type] = []


def register() -> None:
    classes, top = _build()
    for one in classes:
        bpy.utils.register_class(one)
    _registered[:] = classes
    bpy.types.Object.ringlet = PointerProperty(type=top, override={"LIBRARY_OVERRIDABLE"})
    bpy.types.Text.ringlet_changes = StringProperty(options={"HIDDEN"})
    bpy.types.Text.ringlet_head = StringProperty(options={"HIDDEN"})  # of a recipe: id of the head that it was made for


def unregister() -> None:
    del bpy.types.Object.ringlet, bpy.types.Text.ringlet_changes, bpy.types.Text.ringlet_head
    for one in reversed(_registered):
        bpy.utils.unregister_class(one)
    _registered.clear()
    _settings.clear()
