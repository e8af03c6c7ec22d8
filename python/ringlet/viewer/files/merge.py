"""Three-way merge of TOML files, setting by setting."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from ringlet.data.explain import setting_name
from ringlet.viewer.files import blocks
from ringlet.viewer.files.document import set_value, toml_value
from ringlet.viewer.protocol import Difference, Place

MOST_SHOWN = 200  # characters of a value in a message


class _Missing:
    """The value of a setting that a text does not have."""


MISSING = _Missing()


@dataclass(frozen=True)
class Versions:
    """Three texts of a file: their common base, the one of the session, and the one on disk."""

    base: str
    mine: str
    theirs: str

    def differences(self) -> list[tuple[Place, Difference]]:
        """Settings that differ between ``mine`` and ``theirs``; raises ValueError for invalid TOML."""
        first, second, third = (tomllib.loads(text) for text in (self.base, self.mine, self.theirs))
        return [
            (
                place,
                Difference(
                    name=setting_name(tuple(place)),
                    base=_shown(base),
                    mine=_shown(mine),
                    theirs=_shown(theirs),
                    both=base != mine and base != theirs,
                ),
            )
            for place, base, mine, theirs in _differing(first, second, third, [])
        ]

    def merged(self, places: Sequence[Place]) -> str:
        """The text on disk with the values of ``mine`` at some places, and its comments."""
        text, mine = self.theirs, tomllib.loads(self.mine)
        for place in places:
            value = _at(mine, place)
            if len(place) == 1 and _is_tables(value) | _is_tables(_at(tomllib.loads(text), place)):
                text = _with_tables(text, str(place[0]), self.mine)
            else:
                text = set_value(text, place, None if value is MISSING else value)
        return text


def _differing(base: Any, mine: Any, theirs: Any, place: Place) -> Iterator[tuple[Place, Any, Any, Any]]:
    """Places at which ``mine`` and ``theirs`` differ, with the three values; inside of tables and lists of tables."""
    if mine == theirs:
        return
    if isinstance(mine, dict) and isinstance(theirs, dict):
        old = base if isinstance(base, dict) else {}
        for key in dict.fromkeys([*theirs, *mine]):
            values = (table.get(key, MISSING) for table in (old, mine, theirs))
            yield from _differing(*_tables(*values), [*place, key])
    elif _is_tables(mine) and _is_tables(theirs) and _is_tables(base) and len(mine) == len(theirs) == len(base):
        for k, values in enumerate(zip(base, mine, theirs, strict=True)):
            yield from _differing(*values, [*place, k])
    else:
        yield place, base, mine, theirs


def _tables(base: Any, mine: Any, theirs: Any) -> tuple[Any, Any, Any]:
    """A table that one side lacks counts as an empty one, so that its settings are compared one by one."""
    if isinstance(mine, dict) and theirs is MISSING and base is MISSING:
        return base, mine, {}
    if isinstance(theirs, dict) and mine is MISSING and base is MISSING:
        return base, {}, theirs
    return base, mine, theirs


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(entry, dict) for entry in value)


def _at(data: Any, place: Place) -> Any:
    for part in place:
        try:
            data = data[part]
        except (KeyError, IndexError, TypeError):
            return MISSING
    return data


def _with_tables(text: str, name: str, source: str) -> str:
    """A text whose tables ``[[name]]`` are those of another, with their comments, in the place of the first."""
    tables = blocks.split(text)
    first = next((k for k, block in enumerate(tables) if block.name == name), None)
    if first is None:
        first = blocks.place_of_new_array(tables)
    new = [block for block in blocks.split(source) if _belongs(block, name)]
    before = [block for block in tables[:first] if not _belongs(block, name)]
    after = [block for block in tables[first:] if not _belongs(block, name)]
    return blocks.join([*before, *new, *after])


def _belongs(block: blocks.Block, name: str) -> bool:
    return block.name == name or block.name.startswith(f"{name}.")


def _shown(value: Any) -> str:
    text = "–" if value is MISSING else toml_value(value)
    return text if len(text) <= MOST_SHOWN else f"{text[:MOST_SHOWN]}…"
