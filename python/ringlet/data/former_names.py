"""Former names of settings: read in files of format 1, refused in those of format 2."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from typing import Any, NamedTuple

from ringlet.data.errors import UserError

NAMED = ("curves", "lock", "maps", "meshes", "region")  # tables whose keys are names that users chose
STAGES = ("color", "curl", "hairs")  # stages that edits of locks name; any other is an operator
DEEPEST = 24  # tables and rows around a setting, at most


class Rename(NamedTuple):
    """A setting with a new name.

    place:  its former name, in tables by their present names. ``shape.OP`` is an operator, and its table in longer
            places; ``*.`` stands for any tables
    name:   its present name
    joined: whether it became one with another that has the present name all along
    """

    place: str
    name: str
    joined: bool = False

    @property
    def former(self) -> str:
        """The former name for messages, such as ``cornrow.droop``."""
        return self.place.removeprefix("*.").removeprefix("shape.")


RECIPE = (
    Rename("nail", "pin"),
    Rename("pin.reach", "length"),
    Rename("pin.fade", "falloff"),
    Rename("clean", "collide"),
    Rename("guides.droop", "gravity_bend"),
    Rename("guides.zone.droop", "gravity_bend"),
    Rename("guides.zone.spread", "angle"),
    Rename("guides.part", "part_line"),
    Rename("locks.sections.partings", "part_lines"),
    Rename("locks.hairline.flat", "laid"),
    Rename("shape.gather", "tie", joined=True),
    Rename("shape.loft", "volume"),
    Rename("shape.tie.tie", "curve"),
    Rename("shape.clump.amount", "tightness"),
    Rename("shape.edges.gather", "tightness"),
    Rename("shape.tie.spread", "flare"),
    Rename("shape.frizz.amount", "magnitude"),
    Rename("shape.frizz.size", "wavelength"),
    Rename("shape.noise.amount", "magnitude"),
    Rename("shape.noise.size", "wavelength"),
    Rename("shape.scraggle.amount", "magnitude"),
    Rename("shape.scraggle.size", "wavelength"),
    Rename("shape.smooth.size", "wavelength"),
    Rename("shape.cornrow.droop", "gravity_bend"),
    Rename("shape.part.parting", "part_line"),
    Rename("shape.attract.reach", "falloff"),
    Rename("shape.cut.soft", "spread"),
    Rename("shape.grow_to.soft", "spread"),
    Rename("guides.part_line.line", "curve"),
    Rename("guides.part_line.reach", "falloff"),
    Rename("shape.part.part_line.line", "curve"),
    Rename("shape.part.part_line.reach", "falloff"),
    Rename("curl.phase_alike", "phase_coherence"),
    Rename("curl.phase_lock", "phase_groups"),
    Rename("hairs.radius", "lock_radius"),
    Rename("hairs.taper", "lock_taper"),
    Rename("hairs.flatness", "lock_flatness"),
    Rename("hairs.spread", "root_radius"),
    Rename("hairs.gather", "root_falloff"),
    Rename("hairs.stray_radius", "stray_distance"),
    Rename("hairs.families.amount", "tightness"),
    Rename("hairs.families.size", "radius"),
    Rename("hairs.curl.alike", "coherence"),
    Rename("hairs.coil.alike", "coherence"),
    Rename("edit.move.reach", "falloff"),
    Rename("curl.phase_size", "phase_wavelength"),
    Rename("*.noise_size", "noise_wavelength"),
    Rename("*.mask.soft", "falloff"),
)
SHOT = (
    Rename("contact.parting_speed", "separation_speed"),
    Rename("*.noise_size", "noise_wavelength"),
)
RENAMES = tuple(dict.fromkeys(RECIPE + SHOT))
ATTRIBUTES = {"nail": "pin", "led_by_nail": "led_by_pin"}  # of curves in stored grooms and rest shapes


class Found(NamedTuple):
    """A former name in a file.

    place: keys and rows down to it, as the file has them; for an operator, down to its ``op``
    key:   the key, or the value of ``op``, in place of the former one
    """

    place: tuple[str | int, ...]
    key: str
    rename: Rename

    @property
    def is_operator(self) -> bool:
        """Whether the name is the value of ``op``."""
        return self.place[-1] == "op"


class FormerNames(UserWarning):
    """A file has former names of settings."""


def note(found: Iterable[Found]) -> str:
    """The present names of settings, in one sentence."""
    return ", ".join(f"{one.former} is now {one.name}" for one in dict.fromkeys(each.rename for each in found))


def present(data: dict[str, Any], where: str) -> tuple[dict[str, Any], list[Found]]:
    """The tables of a recipe, a shot or a file of edits by present names, and the former names in them.

    Raises UserError for a setting by both of its names.
    """
    found: list[Found] = []
    return _table(data, (), (), where, found), found


def _table(
    data: dict[str, Any], tables: tuple[str, ...], place: tuple[str | int, ...], where: str, found: list[Found]
) -> dict[str, Any]:
    """A table by present names.

    tables: names of the tables around its settings
    place:  keys and rows down to it in the file
    """
    if tables == ("shape",) and isinstance(op := data.get("op"), str):
        tables = ("shape", op)
        if rename := _rename(tables):
            found.append(Found((*place, "op"), rename.name, rename))
            tables, data = ("shape", rename.name), {**data, "op": rename.name}
    result: dict[str, Any] = {}
    for key, value in data.items():
        name, inside, rename = _key(tables, key)
        if rename and name in data:
            raise UserError(
                f"{where}: has both {rename.former} and {rename.name}, which is its name now; take one of them away"
            )
        if rename:
            found.append(Found((*place, key), name, rename))
        result[name] = _value(value, inside, (*place, key), where, found)
    return result


def _value(value: Any, tables: tuple[str, ...], place: tuple[str | int, ...], where: str, found: list[Found]) -> Any:
    if len(place) > DEEPEST:
        return value
    if isinstance(value, dict):
        return _table(value, tables, place, where, found)
    if isinstance(value, list):
        return [
            _table(one, tables, (*place, k), where, found) if isinstance(one, dict) else one
            for k, one in enumerate(value)
        ]
    return value


def _key(tables: tuple[str, ...], key: str) -> tuple[str, tuple[str, ...], Rename | None]:
    """Present name of a key in a table, the tables around what is inside of it, and its rename."""
    if tables == ("grooms",):
        return key, (), None
    if tables == ("shape",):  # of a variant: `[shape."clump 2"]`, `[[shape.append]]`
        kind, number = _stage(key)
        rename = _rename(("shape", kind))
        kind = rename.name if rename else kind
        return f"{kind}{number}", ("shape",) if key == "append" else ("shape", kind), rename
    if tables == ("edit", "set"):  # `"clump 2.amount"`
        stage, dot, setting = key.rpartition(".")
        kind, number = _stage(stage)
        operator = None if kind in STAGES else _rename(("shape", kind))
        kind = operator.name if operator else kind
        rename = _rename((kind, setting) if kind in STAGES else ("shape", kind, setting))
        return f"{kind}{number}{dot}{rename.name if rename else setting}", (*tables, key), rename or operator
    named = bool(tables) and tables[-1] in NAMED
    rename = None if named else _rename((*tables, key))
    name = rename.name if rename else key
    return name, (*tables, name), rename


def _stage(name: str) -> tuple[str, str]:
    """Kind of an operator, and what tells it from others of its kind: ``clump 2``, ``pin[0]``."""
    number = re.search(r"( \d+|\[\d+\])?$", name)
    return (name[: number.start()], number[0]) if number else (name, "")


def _rename(place: tuple[str, ...]) -> Rename | None:
    exact, anywhere = _by_place()
    return exact.get(place) or next((anywhere[place[k:]] for k in range(len(place)) if place[k:] in anywhere), None)


@cache
def _by_place() -> tuple[dict[tuple[str, ...], Rename], dict[tuple[str, ...], Rename]]:
    """The renames by their place, and those in any tables by its end."""
    places = {rename: tuple(rename.place.split(".")) for rename in RENAMES}
    exact = {place: rename for rename, place in places.items() if place[0] != "*"}
    return exact, {place[1:]: rename for rename, place in places.items() if place[0] == "*"}


@cache
def first_name(purpose: str) -> str:
    """A purpose of random numbers by the first names of its stage and setting, so that a rename changes no groom.

    purpose: such as ``cornrow 2/gravity_bend`` or ``hairs/families/tightness``
    """
    stage, slash, setting = purpose.partition("/")
    kind, number = _stage(stage)
    place, name = [kind], _first().get((kind,), kind) + number + slash
    for between, part in re.findall(r"(^|[./])([^./]*)", setting):
        place.append(part)
        name += between + _first().get(tuple(place), part)
    return name


@cache
def _first() -> dict[tuple[str, ...], str]:
    """First names by the place of the present name; operators are in no table."""
    found = {}
    for rename in RENAMES:
        *tables, former = rename.place.split(".")
        if not rename.joined:
            found[(*tables[tables[:1] == ["shape"] :], rename.name)] = former
    return found
