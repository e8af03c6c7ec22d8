"""Several grooms in one recipe, by name: the tables ``[grooms.NAME]``."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from ringlet.data.errors import UserError
from ringlet.data.explain import shown

GROOMS = "grooms"
OF_ALL = ("ringlet", "name", "seed", "unit", "scalp", "maps", "curves", "collide", "hairs", "color", "fiber")
NAME = re.compile(r"[A-Za-z]\w*", re.ASCII)  # a name that USD accepts for a prim
MOST_GROOMS = 64

Tables = dict[str, Any]


def with_grooms(data: Tables, where: str, resolved: Callable[[Tables, Tables], Tables]) -> Tables:
    """Tables of a recipe with several grooms, each of which is a whole recipe.

    where:    name of the file, for messages
    resolved: the tables of a groom, from its own and from those that all grooms share

    Raises UserError for names and tables that cannot be those of a groom, and for hair outside of the grooms.
    """
    grooms = data[GROOMS]
    if not isinstance(grooms, dict) or not grooms:
        raise UserError(f"{where}: {GROOMS} is {shown(grooms)}; must be tables [{GROOMS}.NAME]")
    if len(grooms) > MOST_GROOMS:
        raise UserError(f"{where}: {GROOMS} has {len(grooms)} entries; must have at most {MOST_GROOMS}")
    if stray := [key for key in data if key not in (*OF_ALL, GROOMS)]:
        raise UserError(
            f"{where}: {stray[0]} is outside of the grooms; move it to [{GROOMS}.NAME.{stray[0]}], or put the recipe "
            f'that it is from into a groom: [{GROOMS}.NAME] extends = "FILE"'
        )
    outside = {key: value for key, value in data.items() if key not in (GROOMS, "name")}
    return {**data, GROOMS: {name: _one(name, table, outside, where, resolved) for name, table in grooms.items()}}


def _one(name: str, table: Any, outside: Tables, where: str, resolved: Callable[[Tables, Tables], Tables]) -> Tables:
    if not NAME.fullmatch(name):
        raise UserError(f"{where}: {GROOMS} has the name {shown(name)}; use letters, digits and _, a letter first")
    if not isinstance(table, dict):
        raise UserError(f"{where}: {GROOMS}.{name} is {shown(table)}; must be a table")
    for key in (GROOMS, "unit", "ringlet"):
        if key in table:
            raise UserError(f"{where}: {GROOMS}.{name}.{key} cannot be that of one groom; move it out of the grooms")
    try:
        return {**resolved(table, outside), "name": name}
    except UserError as error:
        raise UserError(str(error).replace(f"{where}: ", f"{where}: {GROOMS}.{name}: ", 1)) from error


def within_groom(setting: str) -> str:
    """The name of a setting within its groom: ``guides.whorl`` for ``grooms.brows.guides.whorl``."""
    parts = setting.split(".", 2)
    return parts[2] if parts[0] == GROOMS and len(parts) == 3 else setting
