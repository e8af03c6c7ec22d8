"""Loads the tables of a recipe: resolves the recipe that it extends and its file of manual edits."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path
from typing import Any

from ringlet.data.errors import UserError
from ringlet.data.explain import did_you_mean, shown
from ringlet.data.settings import FORMAT, parse_toml, read_toml
from ringlet.data.toml import to_toml
from ringlet.groom.named import GROOMS, with_grooms, within_groom

FILES = (("scalp", "file"), ("guides", "file"), ("hairs", "file"))
MOST_NAME = 255  # bytes of the name of a file or a folder
APPEND = "append"  # key of a variant's operators that follow those of its base
MAY_BE_FALSE = ("guides.whorl",)  # settings whose value may be `false`, which then does not remove them
LOCK_TABLES = ("curl", "hairs", "color")  # tables, operators aside, whose settings single locks may have
EMPTY = f"ringlet = {FORMAT}\n"  # a file of edits without edits
RELATIVE = re.compile(r"\s*(\d+(?:\.\d+)?)\s*%\s*")  # of the value of the base
MEASURED = re.compile(r"\s*(-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?)(\s*/?[a-z]+2?\s*)")
EDITS = ("edit", "sculpt")  # tables of a file of edits: edits of locks, edits of guides


def load(path: Path) -> tuple[str, dict[str, Any]]:
    """Text and tables of a recipe file with its base and its edits resolved.

    The text of a recipe that refers to other files is that of the resolved recipe.
    """
    text, data = read_toml(path, "recipe")
    return resolve(text, data, path, ())


def load_text(text: str, path: Path | None, edits: str | None = None) -> tuple[str, dict[str, Any]]:
    """Text and tables of a recipe from its text.

    path:  path that relative file names are resolved against
    edits: text that replaces the contents of the file of edits
    """
    data = parse_toml(text, path.name if path else "recipe", "recipe")
    return resolve(text, data, path or Path("recipe"), (), edits)


def resolve(
    text: str, data: dict[str, Any], path: Path, extending: tuple[Path, ...], edits: str | None = None
) -> tuple[str, dict[str, Any]]:
    """Resolves the base and the edits of a recipe.

    extending: the files that extend this one, to detect cycles
    """
    resolved = data
    if "extends" in data:
        resolved = _extended(data, path, (*extending, path.resolve()))
    if extending:
        return text, _with_settings_of_locks(resolved, path)
    if GROOMS in resolved:
        resolved = with_grooms(resolved, path.name, lambda table, shared: _groom(table, shared, path))
    else:
        resolved = _edited(resolved, path, edits)
    if {"extends", "edits", GROOMS} & data.keys():
        text = resolved_text(resolved)
    return text, resolved


def resolved_text(data: dict[str, Any]) -> str:
    """Text of a recipe that refers to no other recipe: edits are in its tables, and so is what grooms share."""
    kept = {key: value for key, value in data.items() if key != "edits"}
    if GROOMS not in kept:
        return to_toml(kept)
    apart = ("edits", "ringlet", "unit", "name")
    grooms = {
        name: {key: value for key, value in table.items() if key not in apart} for name, table in kept[GROOMS].items()
    }
    return to_toml({**{key: kept[key] for key in ("ringlet", "name", "unit") if key in kept}, GROOMS: grooms})


def _groom(table: dict[str, Any], outside: dict[str, Any], path: Path) -> dict[str, Any]:
    """Tables of one groom of several: what it extends, changed by what is outside of the grooms, then by its own.

    table:   the groom's own
    outside: those that all grooms share
    """
    base = _base(table, path, (path.resolve(),)) if "extends" in table else {}
    if GROOMS in base:
        raise UserError(f"{path.name}: a groom extends {table['extends']}, which has several; must have one")
    shared = _merged(base, outside, path.name, "")
    own = {key: value for key, value in table.items() if key != "extends"}
    return _edited(_merged(shared, own, path.name, ""), path, None)


def _edited(data: dict[str, Any], path: Path, edits: str | None) -> dict[str, Any]:
    """Tables with their manual edits; ``edits`` replaces the contents of the file of edits."""
    return _with_settings_of_locks(_with_edits(data, path, edits) if "edits" in data else data, path)


def read_edits(path: Path) -> dict[str, list[dict[str, Any]]]:
    """Edits of locks (``edit``) and of guides (``sculpt``) of a file; empty when the file does not exist."""
    return parse_edits(read_toml(path, "file of edits")[0] if path.exists() else EMPTY, path)


def parse_edits(text: str, path: Path) -> dict[str, list[dict[str, Any]]]:
    """Parses the text of a file of edits; raises UserError for any other table."""
    data = parse_toml(text, path.name, "file of edits")
    edits = {kind: data.get(kind, []) for kind in EDITS}
    unexpected = sorted(data.keys() - {"ringlet", *EDITS}) + [
        kind for kind in EDITS if not isinstance(edits[kind], list)
    ]
    if unexpected:
        raise UserError(
            f"{path.name}: {', '.join(unexpected)} does not belong there; it holds [[edit]] and [[sculpt]] tables only"
        )
    return edits


def _extended(data: dict[str, Any], path: Path, extending: tuple[Path, ...]) -> dict[str, Any]:
    """Merges the changes of a variant into the tables of its base."""
    base = _base(data, path, extending)
    return _merged(base, {key: value for key, value in data.items() if key != "extends"}, path.name, "")


def _base(data: dict[str, Any], path: Path, extending: tuple[Path, ...]) -> dict[str, Any]:
    """Tables of the recipe that ``data`` extends, with file names that count from the folder of ``path``."""
    name = _file_name(data, "extends", path)
    base_path = path.parent / name
    if base_path.resolve() in extending:
        raise UserError(f"{path.name}: extends {name}, which extends it in turn; take one of the two away")
    text, base = read_toml(base_path, "recipe")
    _, base = resolve(text, base, base_path, extending)
    unit = base.get("unit", "cm")
    if data.get("unit", unit) != unit:
        raise UserError(
            f"{path.name}: unit is {shown(data['unit'])}, that of {name} is {shown(unit)}; must be the same"
        )
    if base_path.parent.resolve() != path.parent.resolve():
        base = _with_absolute_paths(base, base_path.parent.resolve())
    return base


def _file_name(data: dict[str, Any], setting: str, path: Path) -> str:
    """The file that a setting names; raises UserError for what cannot be the name of one."""
    name = data[setting]
    parts = Path(name).parts if isinstance(name, str) and name.isprintable() else ()
    if not parts or max(len(part.encode()) for part in parts) > MOST_NAME:
        raise UserError(f"{path.name}: {setting} is {shown(name)}; must be the name of a file")
    return name


def _merged(base: dict[str, Any], changes: dict[str, Any], where: str, place: str) -> dict[str, Any]:
    """Merges changes into a table: tables merge, ``false`` removes an entry, ``"130 %"`` scales a value, any other
    replaces it."""
    result = dict(base)
    for key, value in changes.items():
        old = base.get(key)
        name = within_groom(f"{place}.{key}".removeprefix("."))
        if name == "shape" and isinstance(value, dict) and not isinstance(old, dict):
            result[key] = _merged_shape(old if isinstance(old, list) else [], value, where)
        elif name in EDITS and isinstance(value, list) and isinstance(old, list):
            result[key] = old + value
        elif value is False and key in base and not isinstance(old, bool) and name not in MAY_BE_FALSE:
            del result[key]
        elif isinstance(value, str) and (share := RELATIVE.fullmatch(value)):
            result[key] = _scaled(old, 0.01 * float(share[1]), value, f"{where}: {place}.{key}".replace(": .", ": "))
        elif isinstance(value, dict) and isinstance(old, dict) and not ("file" in value) > ("file" in old):
            result[key] = _merged(old, value, where, f"{place}.{key}".removeprefix("."))
        elif isinstance(value, dict) and key in base and not isinstance(old, dict | list) and _is_relative(value):
            plain = {"value": old}  # promotes a plain value to a table
            result[key] = _merged(plain, value, where, f"{place}.{key}".removeprefix("."))
        else:
            result[key] = value
    return result


def _is_relative(value: dict[str, Any]) -> bool:
    """Whether a table of a varied value goes on from the value of the base."""
    given = value.get("value")
    return given is None or (isinstance(given, str) and RELATIVE.fullmatch(given) is not None)


def _scaled(old: Any, factor: float, said: str, what: str) -> Any:
    """A value of a base times a factor: a number, a text such as ``5 mm``, or a table with one of them."""
    if isinstance(old, dict) and "value" in old:
        return {**old, "value": _scaled(old["value"], factor, said, what)}
    if isinstance(old, int | float) and not isinstance(old, bool):
        return factor * old
    if isinstance(old, str) and (measured := MEASURED.fullmatch(old)):
        return f"{factor * float(measured[1]):.12g}{measured[2]}"
    given = "has no value for it" if old is None else f"has {shown(old)}"
    raise UserError(f"{what} is '{said}', but what it extends {given}; give it a value of its own")


def _merged_shape(base: list[Any], changes: dict[str, Any], where: str) -> list[Any]:
    """Merges changes into the operators of a base by name: ``[shape.clump]``, ``[shape."scraggle 2"]``.

    ``[[shape.append]]`` adds operators after those of the base.
    """
    names = stage_names(base)
    result = list(base)
    for name, change in changes.items():
        if name == APPEND:
            if not isinstance(change, list):
                raise UserError(f"{where}: shape.{APPEND} is {shown(change)}; must be tables [[shape.{APPEND}]]")
            continue
        if name not in names:
            raise UserError(f"{where}: shape.{name} is no operator of what it extends{did_you_mean(name, names)}")
        at = names.index(name)
        if change is False:
            result[at] = None
        elif isinstance(change, dict):
            result[at] = _merged(base[at], change, where, f"shape.{name}")
        else:
            raise UserError(f"{where}: shape.{name} is {shown(change)}; must be a table of settings, or false")
    return [operator for operator in result if operator is not None] + changes.get(APPEND, [])


def inherited(data: dict[str, Any], path: Path) -> list[str] | None:
    """Names of the operators that a recipe inherits; None when the recipe lists its operators itself.

    data: the recipe's own tables
    """
    own = data.get("shape", {})
    if not isinstance(data.get("extends"), str) or isinstance(own, list):
        return None
    base = load(path.parent / data["extends"])[1].get("shape", [])
    return [name for name in stage_names(base) if own.get(name) is not False]


def stage_names(shape: list[Any]) -> list[str]:
    """Unique names of operators: their kind, and ``scraggle 2`` for the second of a kind."""
    used = Counter[str]()
    names = []
    for operator in shape:
        kind = str(operator.get("op") if isinstance(operator, dict) else getattr(operator, "op", operator))
        used[kind] += 1
        names.append(kind if used[kind] == 1 else f"{kind} {used[kind]}")
    return names


def _with_edits(data: dict[str, Any], path: Path, text: str | None) -> dict[str, Any]:
    """Appends the edits of the file that ``edits`` names to those of the recipe."""
    file = path.parent / _file_name(data, "edits", path)
    edits = read_edits(file) if text is None else parse_edits(text, file)
    own = {kind: data.get(kind, []) for kind in EDITS}
    return {
        **data,
        **{kind: [*own[kind], *edits[kind]] for kind in EDITS if isinstance(own[kind], list) and edits[kind]},
    }


def _with_settings_of_locks(data: dict[str, Any], path: Path) -> dict[str, Any]:
    """Moves the settings of manual edits into the ``lock`` tables of their settings."""
    edits = data.get("edit", [])
    for edit in edits if isinstance(edits, list) else []:
        settings = edit.get("set", {}) if isinstance(edit, dict) else {}
        for name, value in settings.items() if isinstance(settings, dict) else ():
            data = _with_lock(data, name, str(edit.get("lock")), value, path)
    return data


def _with_lock(data: dict[str, Any], name: str, lock: str, value: Any, path: Path) -> dict[str, Any]:
    """Adds the override of one setting for one lock."""
    stage, _, setting = name.rpartition(".")
    shape = data.get("shape", [])
    names = stage_names(shape) if isinstance(shape, list) else []
    if stage not in (known := [*names, *LOCK_TABLES]):
        hint = did_you_mean(stage, known)
        raise UserError(f"{path.name}: edit of lock {lock}: {name} is no setting of an operator{hint}")
    table = shape[names.index(stage)] if stage in names else data.get(stage, {})
    old = table.get(setting, {}) if isinstance(table, dict) else {}
    old = old if isinstance(old, dict) else {"value": old}
    changed = {**table, setting: {**old, "lock": {**old.get("lock", {}), lock: value}}}
    if stage in names:
        return {**data, "shape": [changed if other == stage else op for other, op in zip(names, shape, strict=True)]}
    return {**data, stage: changed}


def _with_absolute_paths(data: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Makes the file names of a base in another folder absolute."""
    data = {**data}
    for table, key in FILES:
        if isinstance(data.get(table), dict) and isinstance(name := data[table].get(key), str):
            data[table] = {**data[table], key: str(folder / name)}
    if isinstance(maps := data.get("maps"), dict):
        data["maps"] = {key: str(folder / name) for key, name in maps.items()}
    for table in ("curves", "meshes"):
        if isinstance(named := data.get(table), dict):
            data[table] = {
                key: {**one, "file": str(folder / one["file"])} if isinstance(one, dict) and "file" in one else one
                for key, one in named.items()
            }
    for key in ("edits", "extends"):
        if isinstance(data.get(key), str):
            data[key] = str(folder / data[key])
    if isinstance(grooms := data.get(GROOMS), dict):
        data[GROOMS] = {
            name: _with_absolute_paths(table, folder) if isinstance(table, dict) else table
            for name, table in grooms.items()
        }
    return data
