"""From files to the tables of one recipe: what it extends, and what was done by hand."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

from ringlet.data.errors import UserError
from ringlet.data.settings import did_you_mean, parse_toml, read_toml
from ringlet.data.toml import to_toml

FILES = (("scalp", "file"), ("guides", "file"))
EDITS = ("edit", "sculpt")  # tables of a file of edits: of locks, of guides


def load(path: Path) -> tuple[str, dict[str, Any]]:
    """The text and the tables of a recipe file with all that it refers to; the text of one that refers to others is
    that of the whole."""
    text, data = read_toml(path, "recipe")
    return resolve(text, data, path, ())


def load_text(text: str, path: Path | None, edits: str | None = None) -> tuple[str, dict[str, Any]]:
    """The same for a recipe from its text; names in it count from ``path``. ``edits`` stands for its file of edits."""
    data = parse_toml(text, path.name if path else "recipe", "recipe")
    return resolve(text, data, path or Path("recipe"), (), edits)


def resolve(
    text: str, data: dict[str, Any], path: Path, below: tuple[Path, ...], edits: str | None = None
) -> tuple[str, dict[str, Any]]:
    """The recipe with its base and its edits in it; ``below``: the files that extend it."""
    told = data
    if "extends" in data:
        told = _extended(data, path, (*below, path.resolve()))
    if "edits" in told and not below:
        told = _with_edits(told, path, edits)
    told = _with_settings_of_locks(told, path)
    if {"extends", "edits"} & data.keys():
        text = to_toml({key: value for key, value in told.items() if key != "edits"})
    return text, told


def read_edits(path: Path) -> dict[str, list[dict[str, Any]]]:
    """What a file of edits says of locks (``edit``) and of guides (``sculpt``); nothing where it is not there yet."""
    return parse_edits(read_toml(path, "file of edits")[0] if path.exists() else "ringlet = 1", path)


def parse_edits(text: str, path: Path) -> dict[str, list[dict[str, Any]]]:
    """The same for the text of such a file."""
    data = parse_toml(text, path.name, "file of edits")
    edits = {kind: data.get(kind, []) for kind in EDITS}
    wrong = sorted(data.keys() - {"ringlet", *EDITS}) + [kind for kind in EDITS if not isinstance(edits[kind], list)]
    if wrong:
        raise UserError(
            f"{path.name}: {', '.join(wrong)} does not belong there; it holds [[edit]] and [[sculpt]] tables only"
        )
    return edits


def _extended(data: dict[str, Any], path: Path, below: tuple[Path, ...]) -> dict[str, Any]:
    """The tables of the base with the changes of a variant."""
    if not isinstance(name := data["extends"], str):
        raise UserError(f"{path.name}: extends is {name!r}; must be the name of a recipe file")
    base_path = path.parent / name
    if base_path.resolve() in below:
        raise UserError(f"{path.name}: extends {name}, which extends it in turn; take one of the two away")
    text, base = read_toml(base_path, "recipe")
    _, base = resolve(text, base, base_path, below)
    unit = base.get("unit", "cm")
    if data.get("unit", unit) != unit:
        raise UserError(f"{path.name}: unit is {data['unit']!r}, that of {name} is {unit!r}; must be the same")
    if base_path.parent.resolve() != path.parent.resolve():
        base = _from(base, base_path.parent.resolve())
    return _merged(base, {key: value for key, value in data.items() if key != "extends"}, path.name, "")


def _merged(base: dict[str, Any], changes: dict[str, Any], where: str, place: str) -> dict[str, Any]:
    """A table with changes: tables are merged, ``false`` takes away what was said, everything else is replaced."""
    result = dict(base)
    for key, value in changes.items():
        old = base.get(key)
        name = f"{place}.{key}".removeprefix(".")
        if name == "shape" and isinstance(value, dict):
            result[key] = _merged_shape(old if isinstance(old, list) else [], value, where)
        elif name in EDITS and isinstance(value, list) and isinstance(old, list):
            result[key] = old + value
        elif value is False and key in base and not isinstance(old, bool):
            del result[key]
        elif isinstance(value, dict) and isinstance(old, dict) and not ("file" in value) > ("file" in old):
            result[key] = _merged(old, value, where, name)
        elif isinstance(value, dict) and key in base and not isinstance(old, dict | list) and "value" not in value:
            result[key] = {"value": old, **value}  # a plain value is changed into a table
        else:
            result[key] = value
    return result


def _merged_shape(base: list[Any], changes: dict[str, Any], where: str) -> list[Any]:
    """The operators of a base with changes by their names: ``[shape.clump]``, ``[shape."scraggle 2"]``."""
    names = stage_names(base)
    result = list(base)
    for name, change in changes.items():
        if name not in names:
            raise UserError(f"{where}: shape.{name} is no operator of what it extends{did_you_mean(name, names)}")
        at = names.index(name)
        if change is False:
            result[at] = None
        elif isinstance(change, dict):
            result[at] = _merged(base[at], change, where, f"shape.{name}")
        else:
            raise UserError(f"{where}: shape.{name} is {change!r}; must be a table of settings, or false")
    return [operator for operator in result if operator is not None]


def inherited(data: dict[str, Any], path: Path) -> list[str] | None:
    """The names of the operators that a recipe has from the one that it extends; None where all are its own.

    data: its own tables
    """
    own = data.get("shape", {})
    if not isinstance(data.get("extends"), str) or isinstance(own, list):
        return None
    base = load(path.parent / data["extends"])[1].get("shape", [])
    return [name for name in stage_names(base) if own.get(name) is not False]


def stage_names(shape: list[Any]) -> list[str]:
    """The names of operators: that of their kind, ``scraggle 2`` for the second of a kind."""
    used = Counter[str]()
    names = []
    for operator in shape:
        kind = str(operator.get("op") if isinstance(operator, dict) else getattr(operator, "op", operator))
        used[kind] += 1
        names.append(kind if used[kind] == 1 else f"{kind} {used[kind]}")
    return names


def _with_edits(data: dict[str, Any], path: Path, text: str | None) -> dict[str, Any]:
    """The tables with the edits of the file that ``edits`` names, after those in the recipe."""
    if not isinstance(name := data["edits"], str):
        raise UserError(f"{path.name}: edits is {name!r}; must be the name of a file")
    file = path.parent / name
    edits = read_edits(file) if text is None else parse_edits(text, file)
    own = {kind: data.get(kind, []) for kind in EDITS}
    return {
        **data,
        **{kind: [*own[kind], *edits[kind]] for kind in EDITS if isinstance(own[kind], list) and edits[kind]},
    }


def _with_settings_of_locks(data: dict[str, Any], path: Path) -> dict[str, Any]:
    """The tables with the settings of single locks, which edits make, as ``lock`` tables of the settings."""
    edits = data.get("edit", [])
    for edit in edits if isinstance(edits, list) else []:
        settings = edit.get("set", {}) if isinstance(edit, dict) else {}
        for name, value in settings.items() if isinstance(settings, dict) else ():
            data = _with_lock(data, name, str(edit.get("lock")), value, path)
    return data


def _with_lock(data: dict[str, Any], name: str, lock: str, value: Any, path: Path) -> dict[str, Any]:
    """The tables with one setting of one lock."""
    stage, _, setting = name.rpartition(".")
    shape = data.get("shape", [])
    names = stage_names(shape) if isinstance(shape, list) else []
    if stage not in (*names, "curl", "hairs"):
        hint = did_you_mean(stage, [*names, "curl", "hairs"])
        raise UserError(f"{path.name}: edit of lock {lock}: {name} is no setting of an operator{hint}")
    table = shape[names.index(stage)] if stage in names else data.get(stage, {})
    old = table.get(setting, {}) if isinstance(table, dict) else {}
    old = old if isinstance(old, dict) else {"value": old}
    changed = {**table, setting: {**old, "lock": {**old.get("lock", {}), lock: value}}}
    if stage in names:
        return {**data, "shape": [changed if other == stage else op for other, op in zip(names, shape, strict=True)]}
    return {**data, stage: changed}


def _from(data: dict[str, Any], folder: Path) -> dict[str, Any]:
    """The tables of a base in another folder, with the names of files as full paths."""
    data = {**data}
    for table, key in FILES:
        if isinstance(data.get(table), dict) and isinstance(name := data[table].get(key), str):
            data[table] = {**data[table], key: str(folder / name)}
    if isinstance(maps := data.get("maps"), dict):
        data["maps"] = {key: str(folder / name) for key, name in maps.items()}
    if isinstance(curves := data.get("curves"), dict):
        data["curves"] = {
            key: {**one, "file": str(folder / one["file"])} if isinstance(one, dict) and "file" in one else one
            for key, one in curves.items()
        }
    if isinstance(data.get("edits"), str):
        data["edits"] = str(folder / data["edits"])
    return data
