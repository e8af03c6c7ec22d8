"""Writes variants: recipes that extend another one and contain only the differences."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from ringlet.data.errors import UserError
from ringlet.data.quantities import Quantity
from ringlet.data.settings import FORMAT
from ringlet.data.toml import toml_key
from ringlet.groom import Recipe
from ringlet.groom.load import stage_names
from ringlet.viewer.files.document import Document, toml_value

OWN = ("ringlet", "extends", "edits")  # keys that a variant does not inherit
Tables = dict[str, Any]


def variant(document: Document, parse: Callable[[str, Path, str], Recipe], path: Path, edits: Path | None) -> str:
    """Text of a variant of the saved recipe that equals the recipe's current state.

    path:  path of the variant
    edits: the variant's own file of edits, if it has one

    Raises UserError when the notation of variants cannot express the difference.
    """
    text = _text(document, edits)
    try:
        equal = settings_of(parse(text, path, document.state.edits)) == settings_of(document.model)
    except UserError:
        equal = False
    if not equal:
        raise UserError(f"save: a variant of {document.path.name} cannot say all that was changed; save a copy instead")
    return text


def _text(document: Document, edits: Path | None) -> str:
    before, now = tomllib.loads(document.saved), document.contents()
    changes = _differing(_inheritable(before), _inheritable(now), document.model)
    lines = [f"# {now.get('name') or document.path.stem}, with other values.", f"ringlet = {FORMAT}"]
    lines.append(f'extends = "{document.path.name}"')
    if edits is not None:
        lines.append(f'edits = "{edits.name}"')
    lines += [
        f"{toml_key(name)} = {toml_value(value)}" for name, value in changes.items() if not _is_table(name, value)
    ]
    for name, value in changes.items():
        if _is_table(name, value):
            lines += _table(name, value)
    return "\n".join([*lines, ""])


def _differing(before: Tables, now: Tables, model: Any) -> Tables:
    """Tables that turn ``before`` into ``now`` when they are merged. A variant can remove tables alone, so a removed
    setting gets its current value.

    model: current model, with all defaults
    """
    changes: Tables = {}
    for name, value in now.items():
        old, inner = before.get(name), getattr(model, name, None)
        if name == "shape" and isinstance(value, list) and isinstance(old, list):
            if old != value:
                changes[name] = _operators(old, value, inner or [])
        elif isinstance(value, dict) and isinstance(old, dict):
            if more := _differing(old, value, inner):
                changes[name] = more
        elif name == "edit" and isinstance(old, list):
            if more := [edit for edit in value if edit not in old]:
                changes[name] = more
        elif value != old:
            changes[name] = value
    for name in before.keys() - now.keys():
        changes[name] = False if isinstance(before[name], dict) else _current_value(model, name)
    return changes


def _operators(before: list[Tables], now: list[Tables], models: list[Any]) -> Any:
    """Changes of operators by name; the whole list when an operator was added or moved."""
    matches: dict[int, int] = {}
    for k, operator in enumerate(now):
        after = max(matches, default=-1) + 1
        candidates = [i for i in range(after, len(before)) if before[i].get("op") == operator.get("op")]
        if not candidates:
            return now
        matches[next((i for i in candidates if before[i] == operator), candidates[0])] = k
    changes: Tables = {}
    for i, name in enumerate(stage_names(before)):
        if i not in matches:
            changes[name] = False
        elif more := _differing(before[i], now[matches[i]], models[matches[i]]):
            changes[name] = more
    return changes


def _current_value(model: Any, name: str) -> Any:
    """Current value of a setting in the notation of a recipe; raises UserError for one without a value."""
    value, field = getattr(model, name, None), type(model).model_fields.get(name)
    length = field is not None and any(isinstance(part, Quantity) and part.unit == "m" for part in field.metadata)
    if isinstance(value, BaseModel):
        table = value.model_dump(mode="json", exclude_defaults=True)
        return {**table, "value": f"{table['value']!r} m"} if length and "value" in table else table
    if value is None:
        raise UserError(f"save: {name} cannot be removed in a variant; save a copy instead")  # TOML has no null
    return f"{value!r} m" if length and isinstance(value, float) else value


def _is_table(name: str, value: Any) -> bool:
    return isinstance(value, dict) or (
        isinstance(value, list) and name in ("shape", "edit", "pin") and all(isinstance(one, dict) for one in value)
    )


def _table(name: str, value: Any) -> list[str]:
    """Lines of a table, of a list of tables, or of changes of operators."""
    if isinstance(value, list):
        return [line for one in value for line in ("", f"[[{name}]]", *_entries(one))]
    if name != "shape":
        return ["", f"[{toml_key(name)}]", *_entries(value)]
    removed = [f"{toml_key(one)} = false" for one, change in value.items() if change is False]
    changed = [(one, change) for one, change in value.items() if change is not False]
    lines = ["", "[shape]", *removed] if removed else []
    return lines + [line for one, change in changed for line in ("", f"[shape.{toml_key(one)}]", *_entries(change))]


def _entries(table: Tables) -> list[str]:
    return [f"{toml_key(name)} = {toml_value(value)}" for name, value in table.items()]


def _inheritable(data: Tables) -> Tables:
    return {name: value for name, value in data.items() if name not in OWN}


def settings_of(recipe: BaseModel) -> Tables:
    """Settings of a recipe, without the keys that a variant does not inherit."""
    return recipe.model_dump(mode="json", exclude=set(OWN))
