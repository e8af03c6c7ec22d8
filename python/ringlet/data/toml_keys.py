"""Where the keys and the values of a TOML text stand, so that single ones can be replaced and all else stays."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from typing import NamedTuple

Place = tuple[str | int, ...]

SPACE = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
KEY = re.compile(r"""[A-Za-z0-9_-]+|"(?:\\.|[^"\\\n])*"|'[^'\n]*'""")
STRING = re.compile(
    r'''"""(?:\\[\s\S]|(?!""")[^\\])*""""{0,2}|\'\'\'(?:(?!\'\'\')[\s\S])*\'\'\''{0,2}|"(?:\\.|[^"\\\n])*"|'[^'\n]*\''''
)
PLAIN = re.compile(r"[^,\]}#\n]*")


class Span(NamedTuple):
    """A piece of a text.

    place: keys and rows down to the setting
    value: whether it is the value; else it is the last key of the place
    """

    place: Place
    value: bool
    start: int
    end: int


def spans(text: str) -> Iterator[Span]:
    """The keys of a TOML text and its plain values, in their order; the text must be valid."""
    return _Reader(text).file()


class _Reader:
    def __init__(self, text: str) -> None:
        self.text, self.at = text, 0
        self.rows: dict[Place, int] = {}  # last row of each array of tables

    def file(self) -> Iterator[Span]:
        table: Place = ()
        while self.skip() < len(self.text):
            if self.text[self.at] != "[":
                yield from self.setting(table)
                continue
            many = self.text.startswith("[[", self.at)
            self.at += 1 + many
            found = list(self.key(()))
            self.at += 1 + many
            table = found[-1].place
            if many:
                self.rows[table] = self.rows.get(table, -1) + 1
            table = self.with_row(table)
            yield from found

    def skip(self) -> int:
        """Goes on to what is no space and no comment."""
        return self.match(SPACE)[1]

    def match(self, pattern: re.Pattern[str]) -> tuple[int, int]:
        """Start and end of what matches here; goes on to its end."""
        found = pattern.match(self.text, self.at)
        start, self.at = self.at, found.end() if found else self.at
        return start, self.at

    def with_row(self, place: Place) -> Place:
        return (*place, self.rows[place]) if place in self.rows else place

    def key(self, table: Place) -> Iterator[Span]:
        """The parts of a dotted key in a table."""
        place = table
        while True:
            self.skip()
            start, end = self.match(KEY)
            place = (*self.with_row(place), _decoded(self.text[start:end]))
            yield Span(place, False, start, end)
            if self.text[self.skip()] != ".":
                return
            self.at += 1

    def setting(self, table: Place) -> Iterator[Span]:
        """A key and its value."""
        place = table
        for span in self.key(table):
            place = span.place
            yield span
        self.at += 1  # of the equals sign
        yield from self.value(place)

    def value(self, place: Place) -> Iterator[Span]:
        first = self.text[self.skip()]
        if first not in "[{":
            start, end = self.match(STRING if first in "\"'" else PLAIN)
            yield Span(place, True, start, end)
            return
        closing, row = "]" if first == "[" else "}", 0
        self.at += 1
        while self.text[self.skip()] != closing:
            yield from self.value((*place, row)) if first == "[" else self.setting(place)
            row += 1
            if self.text[self.skip()] == ",":
                self.at += 1
        self.at += 1


def _decoded(key: str) -> str:
    return tomllib.loads(f"key = {key}")["key"] if key[0] in "\"'" else key
