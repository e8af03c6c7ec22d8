"""The messages of validation and of TOML in Ringlet's own words: one line with setting, value and remedy."""

from __future__ import annotations

import difflib
import json
import tomllib
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from pydantic import ValidationError

from ringlet.data.errors import UserError

Location = tuple[int | str, ...]  # where in a model pydantic found a mistake

MOST_SHOWN = 80  # characters of a value or a name in a message
MISSING = ("missing", "union_tag_not_found")

# What a value must be, by the kind of the mistake; with the names of pydantic's context.
MUST_BE = {
    "greater_than_equal": "at least {ge}",
    "greater_than": "more than {gt}",
    "less_than_equal": "at most {le}",
    "less_than": "less than {lt}",
    "multiple_of": "a multiple of {multiple_of}",
    "finite_number": "finite",
    "literal_error": "{expected}",
    "enum": "{expected}",
    "model_type": "a table of settings",
    "model_attributes_type": "a table of settings",
    "dict_type": "a table of settings",
    "mapping_type": "a table of settings",
    "tuple_type": "a list",
    "list_type": "a list",
    "string_type": "a text",
    "string_sub_type": "a text",
    "string_unicode": "a text in UTF-8",
    "string_too_long": "a text of at most {max_length} characters",
    "string_too_short": "a text of at least {min_length} characters",
    "string_pattern_mismatch": "a text of the form {pattern}",
    "bool_type": "true or false",
    "bool_parsing": "true or false",
    "path_type": "the name of a file",
    "none_required": "left out",
    "int_type": "a whole number",
    "int_parsing": "a whole number",
    "int_parsing_size": "a smaller whole number",
    "int_from_float": "a whole number",
    "float_type": "a number",
    "float_parsing": "a number",
}


def explain(
    error: ValidationError, where: str, data: Any = None, name_of: Callable[[Location], str] | None = None
) -> UserError:
    """The first mistake that a model found, in one line: file, setting, value, remedy.

    data:    what was validated; parts of a place that are not in it are labels of pydantic and left out
    name_of: how a place in the model is called in the file, where that is not simply its path
    """
    first = error.errors(include_url=False)[0]
    kind, given = first["type"], first["input"]
    context = {key: f"{at:g}" if isinstance(at, float) else at for key, at in first.get("ctx", {}).items()}
    place = first["loc"] if data is None else _place_in(data, first["loc"], missing=kind in MISSING)
    name = (name_of or setting_name)(place)
    if kind in ("unknown", "extra_forbidden"):
        name = setting_name((name, context["key"])) if kind == "unknown" else name
        message = f"{name} is not a setting{context.get('hint', '; take it away')}".removeprefix(".")
    elif kind == "setting":
        message = f"{name}.{context['key']} {context['message']}".removeprefix(".")
    elif kind == "ringlet":
        message = f"{name} {context['message']}"
    elif kind == "missing":
        message = f"{name} is missing; it must be given"
    elif kind in ("too_long", "too_short"):
        bound = f"at most {context['max_length']}" if kind == "too_long" else f"at least {context['min_length']}"
        message = f"{name} has {context['actual_length'] or 'more'} entries; must have {bound}"
    elif kind == "union_tag_invalid":
        tag = context["discriminator"].strip("'")
        valid = [one.strip(" '") for one in context["expected_tags"].split(",")]
        message = f"{name}.{tag} is {shown(context['tag'])}{did_you_mean(context['tag'], valid)}".removeprefix(".")
    elif kind == "union_tag_not_found":
        message = f"{name}.{context['discriminator'].strip(chr(39))} is missing; it must be given".removeprefix(".")
    elif kind.startswith("float_") and isinstance(given, int):
        message = f"{name} is {shown(given)}; must be a number of fewer than 300 digits"
    elif kind == "json_invalid":
        message = "is not valid JSON; send it again"
    elif kind == "value_error":  # a word of the command line that is none of its choices
        message = f"{name} {str(context['error']).removesuffix('.')}"
    else:
        must = MUST_BE.get(kind, "of another kind").format(**context)
        message = f"{name} is {shown(given)}; must be {must}"
    return UserError(f"{where}: {message.strip()}")


def _place_in(data: Any, location: Location, *, missing: bool) -> Location:
    """The parts of a place that are keys and rows of the data, and the last if it is missing there."""
    place: list[int | str] = []
    for depth, part in enumerate(location):
        rows: Any = dict(enumerate(data)) if isinstance(data, list | tuple) else data
        if isinstance(rows, Mapping) and part in rows:
            data = rows[part]
            place.append(part)
        elif missing and depth == len(location) - 1:
            place.append(part)
    return tuple(place)


def setting_name(place: Location) -> str:
    """A setting's name as it stands in the file: ``solver.newton``, ``shape[0].amplitude``."""
    parts = (f"[{part}]" if isinstance(part, int) else f".{part[:MOST_SHOWN]}" for part in place if part != "")
    return "".join(parts).removeprefix(".")


def explain_toml(error: Exception, where: str) -> UserError:
    """The mistake of a TOML text that the parser found, in one line."""
    if isinstance(error, tomllib.TOMLDecodeError):
        reason = str(error)
        return UserError(f"{where}: is not valid TOML: {reason[:1].lower()}{reason[1:]}; correct it there")
    # Lists in lists without end, or numbers with thousands of digits.
    return UserError(f"{where}: is not valid TOML: lists too deep, or a number too long; shorten them")


def did_you_mean(name: str, valid: Iterable[str]) -> str:
    """``; did you mean 'width'?`` or, with nothing near, ``; there are: …``."""
    valid = list(valid)
    near = difflib.get_close_matches(name[:MOST_SHOWN], valid, n=1, cutoff=0.5)
    return f"; did you mean '{near[0]}'?" if near else f"; there are: {', '.join(valid)}"


def shown(value: Any) -> str:
    """A value as its file has it, shortened."""
    if isinstance(value, bool):
        return json.dumps(value)
    if isinstance(value, int) and abs(value) >= 10**20:
        return f"{'-' * (value < 0)}10^{int(abs(value).bit_length() * 0.30103)} or more"
    text = f"{value:g}" if isinstance(value, float) else repr(value)
    return text if len(text) <= MOST_SHOWN else f"{text[:MOST_SHOWN]}…"
