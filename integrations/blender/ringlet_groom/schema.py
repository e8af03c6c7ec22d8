"""The settings of a recipe or a shot, found in Ringlet's JSON schema.

A table of settings is flattened: a setting is its place below the table, ``("part_line", "offset")``. What sliders
cannot hold, such as zones or lists of dyes, stays to the text.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

SECTIONS = {
    "recipe": ("guides", "locks", "curl", "hairs", "color", "fiber", "collide"),
    "shot": ("strands", "motion", "variation", "contact", "solver", "forces", "rest"),
}
VARIATION = ("of_hair", "vary", "noise", "noise_wavelength", "map", "ramp")  # of a value that differs from lock to lock
DEPTH = 2  # tables in tables that are flattened


@dataclass(frozen=True)
class Setting:
    """A setting that a property can hold.

    place:   keys below its table
    kind:    number, integer, boolean, text, choice, vector, color, ramp, or table: whether an optional table is there
    unit:    m, deg, /cm2 or empty
    choices: of a choice; of one that may be absent the first is empty
    of:      place of the value that this one varies, or None
    default: where the recipe says nothing, in SI units
    """

    place: tuple[str, ...]
    kind: str
    description: str = ""
    unit: str = ""
    least: float | None = None
    most: float | None = None
    choices: tuple[str, ...] = ()
    of: tuple[str, ...] | None = None
    default: Any = None

    @property
    def name(self) -> str:
        """Name of the property."""
        return "__".join(self.place)

    @property
    def label(self) -> str:
        """Its name in the panel."""
        keys = self.place[:-1] if self.place[-1] == "value" else self.place
        return keys[-1].replace("_", " ").capitalize()


@cache
def load(kind: str) -> dict[str, Any]:
    """The schema of ``recipe`` or ``shot`` that the extension was built with."""
    return json.loads(Path(__file__).with_name("schema.json").read_text(encoding="utf-8"))[kind]


@cache
def sections(kind: str) -> dict[str, tuple[str, list[Setting]]]:
    """Description and settings of each section of a recipe or a shot."""
    schema, found = load(kind), {}
    for name in SECTIONS[kind]:
        entry = schema["properties"][name]
        table = _table(schema, entry) or _table(schema, {"anyOf": entry.get("oneOf", [])})
        assert table is not None, name
        found[name] = entry.get("description", ""), list(_settings(schema, table, (), DEPTH))
    return found


@cache
def operators() -> dict[str, tuple[str, list[Setting]]]:
    """Description and settings of each operator on the shape of locks."""
    schema = load("recipe")
    mapping = schema["properties"]["shape"]["items"]["discriminator"]["mapping"]
    tables = {name: _resolved(schema, {"$ref": ref}) for name, ref in mapping.items()}
    return {
        name: (" ".join(table.get("description", "").split()), list(_settings(schema, table, (), DEPTH)))
        for name, table in tables.items()
    }


def _settings(schema: dict[str, Any], table: dict[str, Any], place: tuple[str, ...], depth: int):
    for name, entry in table["properties"].items():
        yield from _of_entry(schema, name, entry, place, depth)


def _of_entry(schema: dict[str, Any], name: str, entry: dict[str, Any], place: tuple[str, ...], depth: int):
    where, common = (*place, name), {"description": entry.get("description", ""), "default": entry.get("default")}
    options = [_resolved(schema, one) for one in entry.get("anyOf", [entry])]
    options = [one for one in options if one.get("type") != "null"]
    table = next((one for one in options if one.get("type") == "object" and "properties" in one), None)
    plain = next((one for one in options if one.get("type") in ("number", "integer")), None)
    optional = any(one.get("type") == "null" for one in entry.get("anyOf", []))
    if plain is not None:
        yield from _of_number(schema, where, plain, table, entry.get("unit", ""), common)
    elif table is not None and depth:
        if optional:
            yield Setting(where, "table", **common)
        yield from _settings(schema, table, where, depth - 1)
    elif choice := next((one for one in options if "enum" in one), None):
        yield Setting(where, "choice", choices=(*(("",) if optional else ()), *map(str, choice["enum"])), **common)
    elif any(one.get("type") == "boolean" for one in options):
        yield Setting(where, "boolean", **common)
    elif vector := next((one for one in options if _is_vector(one)), None):
        bounds = vector["prefixItems"][0]
        yield Setting(where, "vector", least=bounds.get("minimum"), most=bounds.get("maximum"), **common)
    elif any(one.get("format") == "color" for one in options):
        yield Setting(where, "color", **common)
    elif any(one.get("type") == "string" and one.get("format") != "path" for one in options):
        yield Setting(where, "text", **common)


def _of_number(
    schema: dict[str, Any],
    where: tuple[str, ...],
    plain: dict[str, Any],
    table: dict[str, Any] | None,
    unit: str,
    common: dict[str, Any],
):
    """A number; with a table it may vary, and the value has a place of its own in the settings."""
    kind, bounds = plain["type"], (plain.get("minimum"), plain.get("maximum"))
    if table is None:
        yield Setting(where, kind, unit=unit, least=bounds[0], most=bounds[1], **common)
        return
    default = common["default"] if isinstance(common["default"], dict) else {"value": common["default"]}
    value = (*where, "value")
    common = {**common, "default": default.get("value")}
    yield Setting(value, kind, unit=unit, least=bounds[0], most=bounds[1], **common)
    for name in VARIATION:
        entry = table["properties"].get(name)
        if entry is None:
            continue
        number = next((one for one in entry.get("anyOf", [entry]) if one.get("type") == "number"), {})
        yield Setting(
            (*where, name),
            {"of_hair": "boolean", "map": "text", "ramp": "ramp"}.get(name, "number"),
            entry.get("description", ""),
            entry.get("unit", ""),
            number.get("minimum"),
            number.get("maximum"),
            of=value,
            default=default.get(name, entry.get("default")),
        )


def _is_vector(entry: dict[str, Any]) -> bool:
    parts = entry.get("prefixItems", [])
    return entry.get("type") == "array" and len(parts) == 3 and all(one.get("type") == "number" for one in parts)


def _table(schema: dict[str, Any], entry: dict[str, Any]) -> dict[str, Any] | None:
    """The first table of settings that an entry may be."""
    options = (_resolved(schema, one) for one in entry.get("anyOf", [entry]))
    return next((one for one in options if "properties" in one), None)


def _resolved(schema: dict[str, Any], entry: dict[str, Any]) -> dict[str, Any]:
    return schema["$defs"][entry["$ref"].rpartition("/")[2]] if "$ref" in entry else entry
