"""Plain values as TOML."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

import numpy as np


def to_toml(data: dict[str, Any]) -> str:
    """The text of a TOML file: single values first, then tables, and lists of tables as ``[[name]]``."""
    return "".join(_lines(data, ())).lstrip("\n")


def tables_of(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Tables of settings that are given by name: ``{"curl.width": 1}`` is ``{"curl": {"width": 1}}``."""
    tables = dict[str, Any]()
    for name, value in settings.items():
        *places, key = name.split(".")
        table = tables
        for place in places:
            table = table.setdefault(place, {})
        table[key] = value.item() if isinstance(value, np.generic) else value
    return tables


def merged(tables: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """Tables with changes, table by table."""
    return {
        **tables,
        **{
            key: merged(tables[key], value) if isinstance(value, dict) and isinstance(tables.get(key), dict) else value
            for key, value in changes.items()
        },
    }


def _lines(table: dict[str, Any], place: tuple[str, ...]) -> list[str]:
    tables = {key: value for key, value in table.items() if isinstance(value, dict)}
    lists = {key: value for key, value in table.items() if _is_tables(value)}
    lines = [f"{toml_key(key)} = {_value(v)}\n" for key, v in table.items() if key not in tables and key not in lists]
    for key, value in tables.items():
        name = ".".join(map(toml_key, (*place, key)))
        lines += [f"\n[{name}]\n", *_lines(value, (*place, key))]
    for key, values in lists.items():
        name = ".".join(map(toml_key, (*place, key)))
        for value in values:
            lines += [f"\n[[{name}]]\n", *(f"{toml_key(k)} = {_value(v)}\n" for k, v in value.items())]
    return lines


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(part, dict) for part in value)


def toml_key(key: str) -> str:
    """A key in TOML, quoted where it must be."""
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else json.dumps(key, ensure_ascii=False)


def _value(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{toml_key(key)} = {_value(part)}" for key, part in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return repr(value) if isinstance(value, float) else json.dumps(value)
