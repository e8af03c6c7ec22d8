"""The settings of recipes and shots as text, so that those of several are compared line by line."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from typing import Any

from ringlet.data.digest import digest
from ringlet.groom import Recipe
from ringlet.groom.load import stage_names
from ringlet.viewer.files.document import toml_value
from ringlet.viewer.files.variant import OWN

LONGEST = 1000  # characters of a value; of a longer one its size is shown


def settings_text(recipe: Recipe) -> dict[str, str]:
    """Settings that a recipe and those that it extends set, by name, each as a whole value in TOML."""
    return settings_of_text(recipe.text or "")


def settings_of_text(text: str) -> dict[str, str]:
    """Settings of a recipe or shot by name, each as a whole value in TOML."""
    data = tomllib.loads(text)
    return dict(_flat({key: value for key, value in data.items() if key not in OWN}, ""))


def _flat(table: dict[str, Any], place: str) -> Iterator[tuple[str, str]]:
    for key, value in table.items():
        name = f"{place}.{key}" if place else key
        if isinstance(value, dict):
            yield from _flat(value, name)
        elif isinstance(value, list) and value and all(isinstance(entry, dict) for entry in value):
            names = stage_names(value) if key == "shape" else [f"{key} {k + 1}" for k in range(len(value))]
            for row, entry in zip(names, value, strict=True):
                yield from _flat(
                    {k: v for k, v in entry.items() if k != "op"} or {"op": row}, f"{place}.{row}".lstrip(".")
                )
        else:
            yield name, _whole(value)


def changes(settings: dict[str, str], others: dict[str, str]) -> list[str]:
    """The settings that differ from those of another file, each with its value; a dash where it is not set."""
    names = dict.fromkeys([*settings, *others])
    return [f"{name} = {settings.get(name, '–')}" for name in names if settings.get(name) != others.get(name)]


def _whole(value: Any) -> str:
    """A value as text; of one that is too long to be read its size, and a digest that tells it from others."""
    text = toml_value(value)
    if len(text) <= LONGEST:
        return text
    size = f"{len(value)} entries" if isinstance(value, list) else f"{len(text)} characters"
    return f"{size} ({digest(text)[:6]})"
