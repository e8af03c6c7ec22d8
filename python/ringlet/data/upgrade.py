"""Texts by present names: former names of settings are replaced where they stand, and all else stays."""

from __future__ import annotations

import json

from ringlet.data.errors import UserError
from ringlet.data.explain import explain_toml
from ringlet.data.former_names import Found, present
from ringlet.data.settings import FORMAT, parse_tables
from ringlet.data.toml import toml_key
from ringlet.data.toml_keys import spans


def upgraded(text: str, where: str) -> tuple[str, list[Found]]:
    """The text of a recipe, a shot or a file of edits in the present format, and the former names that it has.

    Raises UserError for a text that is none of these, and for a setting by both of its names.
    """
    _, found = present(parse_tables(text, where, "recipe, shot or file of edits"), where)
    keys = {one.place: toml_key(one.key) for one in found if not one.is_operator}
    values = {one.place: json.dumps(one.key) for one in found if one.is_operator} | {("ringlet",): f"{FORMAT}"}
    parts, done = [], 0
    try:
        places = list(spans(text))
    except RecursionError as error:
        raise explain_toml(error, where) from None
    for span in places:
        new = (values if span.value else keys).get(span.place)
        if new is not None:
            end = span.start + len(text[span.start : span.end].rstrip())
            parts += [text[done : span.start], new]
            done = end
    return "".join([*parts, text[done:]]), found


def in_present_names(text: str) -> tuple[str, list[Found]]:
    """A text by present names, and the former names that it has; as it is where it has none or is invalid."""
    try:
        new, found = upgraded(text, "file")
    except UserError:
        return text, []
    return (new, found) if found else (text, [])
