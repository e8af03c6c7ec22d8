"""The tables of TOML files: their models, and messages for their mistakes."""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, ClassVar

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic_core import PydanticCustomError

from ringlet.data.errors import UserError
from ringlet.data.regular import read_text

FORMAT = 1  # of recipes, shots and files of edits
OWN_KEYS = {"recipe": {"scalp", "extends"}, "shot": {"groom"}}  # keys of one kind of file alone

Location = tuple[int | str, ...]  # where in a model pydantic found a mistake


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
            known = [field.alias or name for name, field in cls.model_fields.items()]
            for key in data:
                if key not in known:
                    hint = f" any more; {cls.removed[key]}" if key in cls.removed else did_you_mean(key, known)
                    raise PydanticCustomError("unknown", "{key}{hint}", {"key": key, "hint": hint})
        return data


def did_you_mean(name: str, valid: Iterable[str]) -> str:
    """``; did you mean 'width'?`` or, with nothing near, ``; there are: …``."""
    valid = list(valid)
    near = difflib.get_close_matches(name, valid, n=1, cutoff=0.5)
    return f"; did you mean '{near[0]}'?" if near else f"; there are: {', '.join(valid)}"


def check_name(name: str, names: Iterable[str], where: str, what: str) -> None:
    """Refuses a name that is not among ``names``, with the nearest one that is."""
    if name not in names:
        raise UserError(f"{where}: {name} is not a {what}{did_you_mean(name, names)}")


def read_toml(path: Path, kind: str) -> tuple[str, dict[str, Any]]:
    """Text and tables of a TOML file that begins with ``ringlet = 1``; ``kind`` (recipe, shot) is for messages."""
    text = read_text(path, f"give a {kind} file")
    return text, parse_toml(text, path.name, kind)


def parse_toml(text: str, where: str, kind: str) -> dict[str, Any]:
    """Tables of a TOML text that begins with ``ringlet = 1``."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise UserError(f"{where}: is not valid TOML: {str(error)[0].lower()}{str(error)[1:]}") from error
    except (RecursionError, ValueError):  # of lists in lists without end, or of numbers with thousands of digits
        raise UserError(f"{where}: is not valid TOML: lists too deep, or a number too long") from None
    if "ringlet" not in data:
        raise UserError(f"{where}: is not a Ringlet {kind}; its first line must be 'ringlet = 1'")
    if isinstance(version := data["ringlet"], int) and version > FORMAT:
        raise UserError(f"{where}: ringlet is {version}; this Ringlet reads {kind} files up to {FORMAT}: update it")
    for other, keys in OWN_KEYS.items():
        if kind in OWN_KEYS and other != kind and keys & data.keys() and not OWN_KEYS[kind] & data.keys():
            raise UserError(f"{where}: is a {other}; give a {kind} file")
    return data


def explain(error: ValidationError, where: str, name_of: Callable[[Location], str] | None = None) -> UserError:
    """The first mistake that a model found, in one line: file, setting, value, remedy.

    name_of: how a place in the model is called in the file, where that is not simply its path
    """
    first = error.errors()[0]
    name = (name_of or setting_name)(first["loc"])
    kind, context, given = first["type"], first.get("ctx", {}), first["input"]
    bounds = {
        "greater_than_equal": ("at least", "ge"),
        "greater_than": ("more than", "gt"),
        "less_than_equal": ("at most", "le"),
        "less_than": ("less than", "lt"),
    }
    if kind == "unknown":
        message = f"{name}.{context['key']} is not a setting{context['hint']}".removeprefix(".")
    elif kind == "ringlet":
        message = f"{name} {context['message']}"
    elif kind == "missing":
        message = f"{name} is missing; it must be given"
    elif kind in bounds:
        word, key = bounds[kind]
        message = f"{name} is {given!r}; must be {word} {context[key]}"
    elif kind == "literal_error":
        message = f"{name} is {given!r}; must be {context['expected']}"
    elif kind == "union_tag_invalid":
        valid = [tag.strip(" '") for tag in context["expected_tags"].split(",")]
        message = f"{name}.op is '{context['tag']}'{did_you_mean(context['tag'], valid)}"
    elif kind == "union_tag_not_found":
        message = f"{name} has no 'op'; say which operator it is"
    elif kind in ("model_type", "model_attributes_type", "dict_type"):
        message = f"{name} is {given!r}; must be a table of settings"
    elif kind.startswith(("int_", "float_")):
        message = f"{name} is {given!r}; must be a {'whole ' if kind.startswith('int') else ''}number"
    else:
        message = f"{name} is {given!r}; {first['msg'][0].lower()}{first['msg'][1:]}"
    return UserError(f"{where}: {message}")


def setting_name(place: Location) -> str:
    """A setting's name as it stands in the file: ``solver.newton``, ``shape[0].amplitude``."""
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in place).removeprefix(".")
