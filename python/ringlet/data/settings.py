"""The tables of TOML files: their models, and messages for their mistakes."""

from __future__ import annotations

import re
import tomllib
import warnings
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path
from types import NoneType
from typing import Any, ClassVar, get_args

from pydantic import AfterValidator, BaseModel, ConfigDict, model_validator
from pydantic_core import PydanticCustomError

from ringlet.data.errors import SURROGATE, UserError
from ringlet.data.explain import did_you_mean, explain_toml, setting_name, shown
from ringlet.data.former_names import FormerNames, note, present
from ringlet.data.lengths import measure
from ringlet.data.reads import record
from ringlet.data.regular import read_text

MOST_PARTS = 50  # of a dotted key
LONG_KEY = re.compile(rf"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){{{MOST_PARTS}}}""")
FORMAT = 2  # of recipes, shots and files of edits; those of format 1 may have former names of settings
OWN_KEYS = {"recipe": {"scalp", "extends"}, "shot": {"groom"}}  # keys of one kind of file alone


def refuse(message: str) -> PydanticCustomError:
    """An error whose message follows the setting's name, e.g. ``is -1; must be at least 0``."""
    return PydanticCustomError("ringlet", "{message}", {"message": message})


class Section(BaseModel):
    """A table of a recipe or a shot. Unknown settings are refused with the nearest name that exists."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    removed: ClassVar[dict[str, str]] = {}  # settings of earlier versions, and their replacements

    @model_validator(mode="before")
    @classmethod
    def _only_known_settings(cls, data: Any) -> Any:
        if isinstance(data, dict):
            known = _names(cls)
            for key in data:
                if key not in known:
                    hint = f" any more; {cls.removed[key]}" if key in cls.removed else did_you_mean(key, known)
                    raise PydanticCustomError("unknown", "{key}{hint}", {"key": key, "hint": hint})
        return data

    @model_validator(mode="before")
    @classmethod
    def _numbers_are_numbers(cls, data: Any) -> Any:
        """Refuses true, false and text in place of numbers, which pydantic would convert."""
        if isinstance(data, dict):
            for name, (kinds, converts) in _numbers(cls).items():
                value = data.get(name)
                if type(value) in (float, int, NoneType) or (converts and isinstance(value, bool)):
                    continue  # the setting itself says what `true` and `false` mean
                for leaf in _leaves(value):
                    text = isinstance(leaf, str) and not converts and kinds <= {int, float, NoneType}
                    if text or (isinstance(leaf, bool) and bool not in kinds):
                        whole = "" if float in kinds else "whole "
                        length = measure(leaf) if isinstance(leaf, str) else None
                        metres = f", {length:g} in metres" if length is not None else ""
                        message = f"is {shown(leaf)}; must be a {whole}number{metres}"
                        raise PydanticCustomError("setting", "{key}{message}", {"key": name, "message": message})
        return data


@cache
def _names(section: type[BaseModel]) -> dict[str, None]:
    """The names of a table's settings as a file has them, in their order."""
    return dict.fromkeys(field.alias or name for name, field in section.model_fields.items())


@cache
def _numbers(section: type[BaseModel]) -> dict[str, tuple[set[type], bool]]:
    """The settings of a table that may be numbers: types of their plain values, and whether they convert others."""
    found = {name: _kinds(field.annotation, *field.metadata) for name, field in section.model_fields.items()}
    return {name: (kinds, converts) for name, (kinds, converts) in found.items() if {int, float} & kinds}


def _kinds(*annotations: Any) -> tuple[set[type], bool]:
    """Types of the plain values that annotations allow, and whether one of them converts other values itself."""
    kinds, converts = set[type](), False
    for one in annotations:
        if parts := get_args(one):
            inner, converted = _kinds(*parts)
            kinds, converts = kinds | inner, converts or converted
        elif isinstance(one, type):
            kinds.add(one)
        elif isinstance(one, int | str):  # of a Literal
            kinds.add(type(one))
        else:
            reads = hasattr(one, "__get_pydantic_core_schema__") and not isinstance(one, AfterValidator)
            converts = converts or reads
    return kinds, converts


def _leaves(value: Any) -> Iterator[Any]:
    """Plain values of a value, those of its lists and tables."""
    left = [value]  # no recursion, which a file could nest too deep for
    while left:
        one = left.pop()
        if isinstance(one, dict | list | tuple):
            left += reversed([*(one.values() if isinstance(one, dict) else one)])
        else:
            yield one


def check_texts(value: Any, where: str) -> None:
    """Refuses texts that no file can hold or be named by: with a character of code 0, or half of a UTF-16 pair."""
    text = "".join(leaf for leaf in _leaves(value) if isinstance(leaf, str))
    if "\0" in text:
        raise UserError(f"{where}: has a text with a character of code 0; take it out")
    if SURROGATE.search(text):
        raise UserError(f"{where}: has a text with half of a UTF-16 pair; write it in UTF-8")


def check_name(name: str, names: Iterable[str], where: str, what: str) -> None:
    """Refuses a name that is not among ``names``, with the nearest one that is."""
    if name not in names:
        raise UserError(f"{where}: {name} is not a {what}{did_you_mean(name, names)}")


def read_toml(path: Path, kind: str) -> tuple[str, dict[str, Any]]:
    """Text and tables of a TOML file that begins with ``ringlet = 2``; ``kind`` (recipe, shot) is for messages."""
    text = read_text(path, f"give a {kind}" if kind.startswith("file") else f"give a {kind} file")
    record(path)
    return text, parse_toml(text, path.name, kind)


def parse_toml(text: str, where: str, kind: str) -> dict[str, Any]:
    """Tables of a TOML text that begins with ``ringlet = 2``, in the present format.

    Former names of settings in a text of format 1 are replaced by the present ones, with a warning.
    """
    read = parse_tables(text, where, kind)
    data, found = present(read, where)
    if found and read["ringlet"] == FORMAT:
        raise UserError(
            f"{where}: {setting_name(found[0].place)} is a name of format 1, and {found[0].rename.name} that of format "
            f"{FORMAT}; rename it, or run: ringlet upgrade FILE"
        )
    if found:
        warnings.warn(f"{where}: {note(found)}; ringlet upgrade rewrites the file", FormerNames, stacklevel=2)
    return {**data, "ringlet": FORMAT}


def parse_tables(text: str, where: str, kind: str) -> dict[str, Any]:
    """Tables of a TOML text as they are written there; raises UserError for one of an unknown format."""
    if LONG_KEY.search(text):  # of quadratic time in the parser
        raise UserError(f"{where}: is not valid TOML: a key of over {MOST_PARTS} parts; shorten it")
    try:
        data = tomllib.loads(text)
    except (RecursionError, ValueError) as error:
        raise explain_toml(error, where) from None
    check_texts(data, where)
    if "ringlet" not in data:
        raise UserError(f"{where}: is not a Ringlet {kind}; its first line must be 'ringlet = {FORMAT}'")
    version = data["ringlet"]
    if not isinstance(version, int) or isinstance(version, bool) or version < 1:
        raise UserError(f"{where}: ringlet is {shown(version)}; must be {FORMAT}, the version of the format")
    if version > FORMAT:
        raise UserError(
            f"{where}: ringlet is {shown(version)}; this Ringlet reads {kind} files up to {FORMAT}: update it"
        )
    for other, keys in OWN_KEYS.items():
        if kind in OWN_KEYS and other != kind and keys & data.keys() and not OWN_KEYS[kind] & data.keys():
            raise UserError(f"{where}: is a {other}; give a {kind} file")
    return data
