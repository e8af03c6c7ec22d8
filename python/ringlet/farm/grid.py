"""A grid of settings: one task for each combination of values, each in its own folder."""

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
from ringlet.data.explain import Location, did_you_mean, setting_name
from ringlet.data.names import folded
from ringlet.data.settings import Section, read_toml
from ringlet.data.toml import to_toml
from ringlet.shot import Shot, parse_shot

MAX_TASKS = 10_000
MAX_NAME = 100  # characters of a folder's name


@dataclass(frozen=True)
class Choice:
    """A setting of a shot, and its values in the wedge.

    name:  name in the file: ``strands.bend_scale``, ``collider[0].friction``
    place: path in the file's tables
    """

    name: str
    place: Location
    values: tuple[Any, ...]


@dataclass(frozen=True)
class Task:
    """One combination of values.

    folder:   output folder
    settings: values by the name of the setting
    order:    index of each setting's value, from 0
    shot:     text of the shot, with file names relative to the folder
    """

    folder: Path
    settings: dict[str, Any]
    order: tuple[int, ...]
    shot: str

    @property
    def name(self) -> str:
        """Name of the folder, unique among the tasks."""
        return self.folder.name


def choose(name: str, values: Sequence[Any] | str) -> Choice:
    """Parses a setting and its values; components of the name may be abbreviated to a unique prefix.

    values: a list, or text such as ``1,2,4``; an item that is no TOML value is a string

    Raises UserError for an unknown or ambiguous name, and for a setting without values.
    """
    if isinstance(values, str):
        values = [_value(item) for item in _split_items(values) if item.strip()]
    place: list[str | int] = []
    table: type[Section] | None = Shot
    for part in re.findall(r"[^.\[\]\s]+", name):
        if part.isdigit():
            place.append(int(part))
        elif table is None:
            place.append(part)
        else:
            names = list(table.model_fields)
            matches = [part] if part in names else [other for other in names if other.startswith(part)]
            if len(matches) != 1:
                raise UserError(f"wedge: {name}: {part} is not a setting{did_you_mean(part, matches or names)}")
            place.append(matches[0])
            table = _section_of(table.model_fields[matches[0]].annotation)
    if not place or not values:
        raise UserError(f"wedge: '{name}': names no setting, or no value for it; give a setting and its values")
    return Choice(setting_name(tuple(place)), tuple(place), tuple(values))


def make_tasks(shot: Path, choices: Sequence[Choice], folder: Path) -> list[Task]:
    """Tasks of all combinations, the last setting varying fastest; validates each shot.

    Raises UserError for a setting given twice, too many combinations, and values that are not valid.
    """
    for choice in choices:
        if sum(other.place == choice.place for other in choices) > 1:
            raise UserError(f"wedge: {choice.name} is given twice; give all its values at once")
    count = 1
    for choice in choices:
        count *= len(choice.values)
    if count > MAX_TASKS:
        raise UserError(f"wedge: these are {count:,} combinations; must be at most {MAX_TASKS:,}")
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
    parse_shot(to_toml(tables), shot)  # reports an invalid value with the name of the given shot
    task_folder = folder / folder_name(settings)
    text = to_toml(_rebased(tables, shot.parent, task_folder))
    parse_shot(text, task_folder / "shot.toml")
    return Task(task_folder, settings, order, text)


def folder_name(settings: dict[str, Any]) -> str:
    """Folder name with the settings and their values; contains no path separators."""
    text = ",".join(f"{name}={_plain_text(value)}" for name, value in settings.items()) or "as-it-is"
    plain = re.sub(r"[^A-Za-z0-9._=,+-]", "_", text)
    if plain == text and len(plain) <= MAX_NAME and all(map(_is_plain, settings.values())):
        return plain
    exact = to_toml({name: {"value": value} for name, value in settings.items()})
    return f"{plain[: MAX_NAME - 10]}-{hashlib.sha256(exact.encode()).hexdigest()[:8]}"


def _is_plain(value: Any) -> bool:
    """Whether no other value gives the same name of a folder, also on a disk that ignores case."""
    if not isinstance(value, str):
        return True
    return _value(value) == value and folded(value) == value and not set(value) & set(",=") and not value.endswith(".")


def _plain_text(value: Any) -> str:
    return value if isinstance(value, str) else "".join(to_toml({"v": value})[4:].split())


def _section_of(annotation: Any) -> type[Section] | None:
    """Section class of a setting that is a table or a list of tables; None for a plain value."""
    if isinstance(annotation, type) and issubclass(annotation, Section):
        return annotation
    return next((found for part in get_args(annotation) if (found := _section_of(part))), None)


def _with(tables: Any, place: Location, value: Any, name: str) -> Any:
    """Sets one value in tables; raises UserError for a list without index and an index out of range."""
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


def _rebased(tables: dict[str, Any], before: Path, after: Path) -> dict[str, Any]:
    """Rebases the file names of a shot from one folder to another; its rest file is made in the new folder."""

    def rebase(table: dict[str, Any]) -> dict[str, Any]:
        return {**table, "file": _relative(before / table["file"], after)} if "file" in table else table

    tables = {**tables, "groom": _relative(before / tables["groom"], after)}
    for key in ("collider", "cloth"):
        if key in tables:
            tables[key] = [rebase(table) for table in tables[key]]
    if tables.get("rest", {}).get("mode", "none") != "none":
        tables["rest"] = {**tables["rest"], "file": "rest.usdc"}
    return tables


def _relative(file: Path, folder: Path) -> str:
    try:
        return Path(os.path.relpath(file.absolute(), folder.absolute())).as_posix()
    except ValueError:  # another drive
        return file.absolute().as_posix()


def _split_items(text: str) -> Iterator[str]:
    """Splits text at commas outside brackets and quotes."""
    depth, quote, start = 0, "", 0
    for at, character in enumerate(text):
        if quote:
            quote = "" if character == quote else quote
        elif character in "\"'":
            quote = character
        elif character in "[{":
            depth += 1
        elif character in "]}":
            depth -= 1
        elif character == "," and depth == 0:
            yield text[start:at]
            start = at + 1
    yield text[start:]


def _value(text: str) -> Any:
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (tomllib.TOMLDecodeError, RecursionError, ValueError):
        return text.strip()
