"""A grid of settings: a shot with every combination of a few values, each as a task with a folder of its own."""

from __future__ import annotations

import hashlib
import itertools
import os
import re
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

from ringlet.data.errors import UserError
from ringlet.data.settings import Location, Section, did_you_mean, read_toml, setting_name
from ringlet.data.toml import to_toml
from ringlet.shot import Shot, parse_shot

MOST_TASKS = 10_000
LONGEST_NAME = 100  # of a folder


@dataclass(frozen=True)
class Choice:
    """A setting of a shot, and the values that it is to have one after the other.

    name:  as it stands in the file: ``strands.bend_scale``, ``collider[0].friction``
    place: the same as a path in the file's tables
    """

    name: str
    place: Location
    values: tuple[Any, ...]


@dataclass(frozen=True)
class Task:
    """One combination.

    folder:   where all of it is written
    settings: its values by their names
    order:    which of its values each setting has, counted from 0
    shot:     the text of its shot, whose relative names count from the folder
    """

    folder: Path
    settings: dict[str, Any]
    order: tuple[int, ...]
    shot: str

    @property
    def name(self) -> str:
        """The name of its folder, which no other task has."""
        return self.folder.name


def choose(name: str, values: Sequence[Any] | str) -> Choice:
    """A choice among values of a setting; each part of its name may be cut short where it can be no other.

    values: a list, or text such as ``1,2,4``, in which what is no value of TOML is text itself
    """
    if isinstance(values, str):
        values = [_value(part) for part in _parts(values) if part.strip()]
    place: list[str | int] = []
    table: type[Section] | None = Shot
    for part in re.findall(r"[^.\[\]\s]+", name):
        if part.isdigit():
            place.append(int(part))
        elif table is None:
            place.append(part)
        else:
            names = list(table.model_fields)
            found = [part] if part in names else [other for other in names if other.startswith(part)]
            if len(found) != 1:
                raise UserError(f"wedge: {name}: {part} is not a setting{did_you_mean(part, found or names)}")
            place.append(found[0])
            table = _table_in(table.model_fields[found[0]].annotation)
    if not place or not values:
        raise UserError(f"wedge: '{name}': names no setting, or no value for it; give SETTING=VALUE,VALUE…")
    return Choice(setting_name(tuple(place)), tuple(place), tuple(values))


def make_tasks(shot: Path, choices: Sequence[Choice], folder: Path) -> list[Task]:
    """All combinations, the last setting changing fastest; each is checked before any of them runs."""
    for choice in choices:
        if sum(other.place == choice.place for other in choices) > 1:
            raise UserError(f"wedge: {choice.name} is given twice; name all its values in one --set")
    count = 1
    for choice in choices:
        count *= len(choice.values)
    if count > MOST_TASKS:
        raise UserError(f"wedge: these are {count:,} combinations; must be at most {MOST_TASKS:,}")
    _, tables = read_toml(shot, "shot")
    tasks: dict[str, Task] = {}
    for order in itertools.product(*(range(len(choice.values)) for choice in choices)):
        task = _task(shot, tables, choices, order, folder)
        tasks[task.name] = task
    return list(tasks.values())


def _task(shot: Path, tables: dict[str, Any], choices: Sequence[Choice], order: tuple[int, ...], folder: Path) -> Task:
    settings = {choice.name: choice.values[k] for choice, k in zip(choices, order, strict=True)}
    for choice in choices:
        tables = _with(tables, choice.place, settings[choice.name], choice.name)
    parse_shot(to_toml(tables), shot)  # tells what is wrong with a value by the name of the shot
    own = folder / folder_name(settings)
    text = to_toml(_moved(tables, shot.parent, own))
    parse_shot(text, own / "shot.toml")
    return Task(own, settings, order, text)


def folder_name(settings: dict[str, Any]) -> str:
    """A name that says the settings; it cannot lead out of the folder that it is in."""
    text = ",".join(f"{name}={_told(value)}" for name, value in settings.items()) or "as-it-is"
    plain = re.sub(r"[^A-Za-z0-9._=,+-]", "_", text)
    if plain == text and len(plain) <= LONGEST_NAME:
        return plain
    return f"{plain[: LONGEST_NAME - 10]}-{hashlib.sha256(text.encode()).hexdigest()[:8]}"


def _told(value: Any) -> str:
    return value if isinstance(value, str) else "".join(to_toml({"v": value})[4:].split())


def _table_in(annotation: Any) -> type[Section] | None:
    """The table that a setting is, or is a list of; None for a plain value."""
    if isinstance(annotation, type) and issubclass(annotation, Section):
        return annotation
    return next((found for part in get_args(annotation) if (found := _table_in(part))), None)


def _with(tables: Any, place: Location, value: Any, name: str) -> Any:
    """The tables with one value changed."""
    if not place:
        return value
    key, *rest = place
    if isinstance(key, int):
        if not isinstance(tables, list) or key >= len(tables):
            raise UserError(f"wedge: {name}: there is no number {key} in the shot; they count from 0")
        return [_with(table, tuple(rest), value, name) if k == key else table for k, table in enumerate(tables)]
    if not isinstance(tables, dict):
        raise UserError(f"wedge: {name}: is a list in the shot; say which of it: {key} of number 0 is …[0].{key}")
    return {**tables, key: _with(tables.get(key, {}), tuple(rest), value, name)}


def _moved(tables: dict[str, Any], before: Path, after: Path) -> dict[str, Any]:
    """The tables of a shot with the names of files as they count from another folder; a loft is made anew there."""

    def named(table: dict[str, Any]) -> dict[str, Any]:
        return {**table, "file": _relative(before / table["file"], after)} if "file" in table else table

    tables = {**tables, "groom": _relative(before / tables["groom"], after)}
    for key in ("collider", "cloth"):
        if key in tables:
            tables[key] = [named(table) for table in tables[key]]
    if tables.get("rest", {}).get("mode", "none") != "none":
        tables["rest"] = {**tables["rest"], "file": "rest.usdc"}
    return tables


def _relative(file: Path, folder: Path) -> str:
    try:
        return Path(os.path.relpath(file.absolute(), folder.absolute())).as_posix()
    except ValueError:  # another drive
        return file.absolute().as_posix()


def _parts(text: str) -> Iterator[str]:
    """The parts between commas, but for those in brackets or quotes."""
    depth, quote, start = 0, "", 0
    for at, letter in enumerate(text):
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "\"'":
            quote = letter
        elif letter in "[{":
            depth += 1
        elif letter in "]}":
            depth -= 1
        elif letter == "," and depth == 0:
            yield text[start:at]
            start = at + 1
    yield text[start:]


def _value(text: str) -> Any:
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (tomllib.TOMLDecodeError, RecursionError, ValueError):
        return text.strip()
