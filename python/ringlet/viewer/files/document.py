"""A TOML file edited by setting, which keeps its comments and its order, with undo and redo."""

from __future__ import annotations

import difflib
import re
import time
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError

from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.regular import read_text
from ringlet.data.toml import toml_key
from ringlet.data.upgrade import in_present_names
from ringlet.viewer.files import blocks
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import Change, Place

MAX_UNDO_STEPS = 500
MOST_SECONDS = 10.0  # of the changes of one message
MOST_COMPARED = 4_000_000  # pairs of lines that a diff compares


@dataclass(frozen=True)
class State:
    """A state for undo: text, muted stages, the one stage that acts alone, text of the file of edits, and the maps that
    were painted, as pictures by name of the file."""

    text: str
    muted: frozenset[str] = frozenset()
    edits: str = ""
    solo: str = ""
    maps: Mapping[str, bytes] = field(default_factory=dict)


class History:
    """Undo and redo stacks of files that are edited together."""

    def __init__(self) -> None:
        self.undo_stack: list[tuple[Document, State]] = []
        self.redo_stack: list[tuple[Document, State]] = []
        self._gesture: tuple[Document, int] | None = None

    def record(self, document: Document, gesture: int | None) -> None:
        """Pushes a document's state before a change; all changes of one gesture are one step."""
        current = None if gesture is None else (document, gesture)
        if current is None or current != self._gesture:
            self.undo_stack = [*self.undo_stack, (document, document.state)][-MAX_UNDO_STEPS:]
        self._gesture = current
        self.redo_stack.clear()

    def undo(self) -> Document | None:
        """Undoes a step; returns the changed document, None when there is no step."""
        return self._step(self.undo_stack, self.redo_stack)

    def redo(self) -> Document | None:
        """Redoes a step; returns the changed document, None when there is no step."""
        return self._step(self.redo_stack, self.undo_stack)

    def _step(self, source: list[tuple[Document, State]], target: list[tuple[Document, State]]) -> Document | None:
        if not source:
            return None
        document, state = source[-1]
        current = document.state
        document.restore(state)
        source.pop()
        target.append((document, current))
        self._gesture = None
        return document


class Document:
    """A file in its current state, with its history. Every state passes ``check``.

    saved, saved_edits: the texts on disk, as they were read or written last, by the present names of settings
    renamed:  former names of settings in the text as it was opened
    theirs:   texts of another program that are not loaded, for unsaved changes or since ``check`` refuses them
    check:    parses a text and the text of its file of edits; raises UserError for invalid ones
    edits:    text of the file of edits
    history:  undo history shared with other files
    model:    result of ``check``
    revision: counter of changes
    """

    def __init__(
        self,
        path: Path,
        check: Callable[[str, str], Any],
        edits: str = "",
        history: History | None = None,
        text: str | None = None,
    ) -> None:
        """Opens a file; ``text`` is in place of its own."""
        self.path, self.history = path, history or History()
        self.saved, self.renamed = in_present_names(read_text(path) if text is None else text)
        self.saved_edits = in_present_names(edits)[0]
        self.theirs: tuple[str, str] | None = None
        self._maps_before: dict[str, bytes] = {}  # as they were on disk before they were painted
        self.saved_maps: dict[str, bytes] = {}
        self._check, self.revision = check, 0
        self.restore(State(self.saved, edits=self.saved_edits))

    def restore(self, state: State) -> None:
        """Sets a state; raises UserError and keeps the current one when the state is invalid."""
        self.model = self._check(state.text, state.edits)
        self.state = state
        self.revision += 1

    @property
    def text(self) -> str:
        """Current text."""
        return self.state.text

    @property
    def dirty(self) -> bool:
        """Whether there are unsaved changes."""
        return self.text != self.saved or self.state.edits != self.saved_edits or bool(self.painted)

    @property
    def maps(self) -> dict[str, bytes]:
        """Maps that were painted in this session, in their current state: pictures by name of the file."""
        return {**self._maps_before, **self.state.maps}

    @property
    def painted(self) -> dict[str, bytes]:
        """Maps that differ from those on disk."""
        return {name: picture for name, picture in self.maps.items() if self.saved_maps.get(name) != picture}

    def map_picture(self, name: str, project: Project) -> bytes:
        """Picture of a map in its current state, from its file where it was not painted yet.

        Raises UserError for a file that cannot be read.
        """
        if name not in self.maps:
            path = project.inside(self.path.parent / name, f"{self.path.name}: map")
            try:
                self._maps_before[name] = self.saved_maps[name] = path.read_bytes()
            except OSError as error:
                raise UserError(f"{path}: cannot be read ({error.strerror}); name a picture that is there") from error
        return self.maps[name]

    @property
    def can_undo(self) -> bool:
        """Whether the undo stack has a step."""
        return bool(self.history.undo_stack)

    @property
    def can_redo(self) -> bool:
        """Whether the redo stack has a step."""
        return bool(self.history.redo_stack)

    def recheck(self) -> None:
        """Checks the current state again, after a file changed that it refers to; raises UserError as ``check``."""
        self.restore(self.state)

    def recover(
        self, text: str, edits: str, saved: str, saved_edits: str, maps: Mapping[str, bytes] | None = None
    ) -> None:
        """Sets unsaved texts and maps of an earlier session as one undo step; a version on disk other than ``saved`` is
        then a conflict. Raises UserError when they are invalid."""
        on_disk = self.saved, self.saved_edits
        text, edits = _present(text, edits)
        self.apply(text, edits=edits, maps=maps)
        self.saved, self.saved_edits = _present(saved, saved_edits)
        self.meet(*on_disk)

    def meet(self, text: str, edits: str) -> bool:
        """Takes in the texts on disk: a document without unsaved changes loads them as one undo step, for another they
        become ``theirs``. Returns whether the current state changed. A text that is as in the current state is saved,
        also where the other one is not: a server was killed while it wrote them.

        Raises UserError when they are invalid; they are then ``theirs``.
        """
        self.theirs, (text, edits) = None, _present(text, edits)
        if (text, edits) == (self.saved, self.saved_edits):
            return False
        if text not in (self.saved, self.text) or edits not in (self.saved_edits, self.state.edits):
            if self.dirty:
                self.theirs = text, edits
                return False
            try:
                self.apply(text, edits=edits)
            except UserError:
                self.theirs = text, edits
                raise
        self.saved, self.saved_edits = text, edits
        return True

    def resolve(self, text: str, edits: str) -> None:
        """Ends a conflict with the given texts as one undo step; raises UserError when they are invalid."""
        if self.theirs is not None:
            self.apply(text, edits=edits)
            (self.saved, self.saved_edits), self.theirs = self.theirs, None

    def set(
        self,
        changes: Sequence[tuple[Place, Any]],
        gesture: int | None = None,
        maps: Mapping[str, bytes] | None = None,
    ) -> None:
        """Sets values of settings, and maps; None removes a setting. One gesture is one undo step.

        Raises UserError when a setting cannot be set or the result is invalid.
        """
        text, begin = self.text, time.monotonic()
        for place, value in changes:
            if time.monotonic() - begin > MOST_SECONDS:
                raise UserError(
                    f"{self.path.name}: {len(changes)} changes take over {MOST_SECONDS:g} s; make fewer at a time"
                )
            try:
                text = set_value(text, place, value)
            except (TOMLKitError, KeyError, IndexError, TypeError, ValueError) as error:
                where = ".".join(str(part) for part in place)
                raise UserError(f"{self.path.name}: {where} cannot be set ({error}); edit it in the file") from None
        self.apply(text, gesture=gesture, maps={**self.state.maps, **(maps or {})})

    def add_tables(self, name: str, at: int, entries: Sequence[dict[str, Any]]) -> None:
        """Adds tables with the keys of ``entries`` to the array of tables ``name``, the first in row ``at``.

        Raises UserError for a row out of range, and for tables in another notation.
        """
        tables, places = self._tables(name, at, new=1)
        new = [
            blocks.Block(
                name, True, [f"[[{name}]]", *(f"{toml_key(key)} = {toml_value(value)}" for key, value in entry.items())]
            )
            for entry in entries
        ]
        place = self._new_place(tables, places, at)
        self.apply(blocks.join([*tables[:place], *new, *tables[place:]]))

    def remove_tables(self, name: str, rows: Sequence[int]) -> None:
        """Removes rows of an array of tables, each with the comment above it; raises UserError as ``add_tables``."""
        tables, places = self._tables(name, *rows)
        removed = {places[row] for row in rows}
        self.apply(blocks.join([block for k, block in enumerate(tables) if k not in removed]))

    def move_table(self, name: str, at: int, to: int) -> None:
        """Moves a row of an array of tables with the comment above it; raises UserError as ``add_tables``."""
        tables, places = self._tables(name, at, to)
        chosen = [tables[k] for k in places]
        chosen.insert(to, chosen.pop(at))
        for k, block in zip(places, chosen, strict=True):
            tables[k] = block
        self.apply(blocks.join(tables))

    def _tables(self, name: str, *rows: int, new: int = 0) -> tuple[list[blocks.Block], list[int]]:
        """Blocks of the text, and which of them are the tables ``name``; checks rows of these, and of ``new`` more."""
        tables = blocks.split(self.text)
        places = [k for k, block in enumerate(tables) if block.name == name and block.many]
        if len(places) != len(_table_at(self.contents(), name)):
            raise UserError(f"{self.path.name}: {name} is not written as tables [[{name}]]; edit it in the file")
        for row in rows:
            if not 0 <= row < len(places) + new:
                raise UserError(f"{self.path.name}: {name} has {len(places)} operators; there is none at {row}")
        return tables, places

    @staticmethod
    def _new_place(tables: list[blocks.Block], places: list[int], at: int) -> int:
        """Position of a new table: among its array of tables, or else before the curl."""
        if places:
            return places[at] if at < len(places) else places[-1] + 1
        return blocks.place_of_new_array(tables)

    def apply(
        self,
        text: str,
        *,
        muted: frozenset[str] | None = None,
        edits: str | None = None,
        solo: str | None = None,
        gesture: int | None = None,
        maps: Mapping[str, bytes] | None = None,
    ) -> None:
        """Sets another text, muted stages, edits or painted maps as one undo step; raises UserError when they are
        invalid."""
        changes = {"muted": muted, "edits": edits, "solo": solo, "maps": maps}
        state = replace(self.state, text=text, **{name: one for name, one in changes.items() if one is not None})
        current = self.state
        if state == current:
            return
        model = self._check(state.text, state.edits)
        self.history.record(self, gesture)
        self.model, self.state = model, state
        self.revision += 1

    def keep(self, *, muted: frozenset[str], solo: str) -> None:
        """Sets the muted stages as part of the last step: they are the same, but their places changed."""
        self.state = replace(self.state, muted=muted, solo=solo)

    def save(self, path: Path | None = None, text: str | None = None) -> Path:
        """Writes the text to the document's file, or a text to another file; returns the path."""
        with replacing(path or self.path, update=path is None) as aside:
            aside.write_text(self.text if text is None else text, encoding="utf-8")
        if path is None:
            self.saved, self.saved_edits, self.saved_maps = self.text, self.state.edits, self.maps
        return path or self.path

    def contents(self) -> dict[str, Any]:
        """Contents of the text as plain values."""
        return tomllib.loads(self.text)

    def diff(self) -> list[Change]:
        """Diff of the current text against the saved one, with one line of context."""
        lines = [*_diff(self.saved, self.text), *_diff(self.saved_edits, self.state.edits)]
        return [Change.model_validate({"sign": line[0], "line": line[1:]}) for line in lines[:400]]


def _present(text: str, edits: str) -> tuple[str, str]:
    """A text and that of its file of edits by the present names of settings, which the page knows alone."""
    return in_present_names(text)[0], in_present_names(edits)[0]


def _diff(before: str, now: str) -> list[str]:
    """Lines of the diff of two texts, with one line of context; the number of lines alone where many differ."""
    old, new = before.splitlines(), now.splitlines()
    alike = _alike(old, new)
    alike_at_end = _alike(old[alike:][::-1], new[alike:][::-1])
    begin = max(alike - 1, 0)
    old, new = (lines[begin : len(lines) - max(alike_at_end - 1, 0)] for lines in (old, new))
    if len(old) * len(new) > MOST_COMPARED:
        return [f"-{len(old):,} lines", f"+{len(new):,} lines"]
    lines = difflib.unified_diff(old, new, lineterm="", n=1)
    return [line for line in lines if not line.startswith(("---", "+++", "@@"))]


def _alike(one: list[str], other: list[str]) -> int:
    """Number of equal lines at the beginning of both lists."""
    pairs = zip(one, other, strict=False)
    return next((k for k, (a, b) in enumerate(pairs) if a != b), min(len(one), len(other)))


def _table_at(data: dict[str, Any], name: str) -> list[Any]:
    """An array of tables by its dotted name; empty where there is none."""
    found: Any = data
    for part in name.split("."):
        found = found.get(part, []) if isinstance(found, dict) else []
    return found


def toml_value(value: Any) -> str:
    """Formats a value as inline TOML."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{toml_key(name)} = {toml_value(entry)}" for name, entry in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(toml_value(entry) for entry in value) + "]"
    return tomlkit.item(value).as_string()


def set_value(text: str, place: Place, value: Any) -> str:
    """Sets a value in a text and creates missing tables; None removes the value."""
    if not place or not isinstance(place[0], str):
        raise KeyError("it is nowhere")
    data: Any = tomllib.loads(text)
    depth = 0
    while depth < len(place) - 1 and _has(data, place[depth]) and _has(data[place[depth]], place[depth + 1]):
        data, depth = data[place[depth]], depth + 1
    if not _has(data, place[depth]):
        return text if value is None else _add(text, place, value)
    if depth == len(place) - 1:
        return _replace(text, place, value)
    present, missing = data[place[depth]], place[depth + 1]
    if value is None:
        return text
    if not isinstance(missing, str):
        raise IndexError(f"there is no entry {missing}")
    if isinstance(present, dict):
        return _add(text, place, value)
    # Promotes a plain value to a table: `width = 1.2` becomes `width = { value = 1.2, … }`.
    return _replace(text, place[: depth + 1], {"value": present, missing: _nested(place[depth + 2 :], value)})


def _has(data: Any, part: str | int) -> bool:
    if isinstance(data, dict):
        return part in data
    return isinstance(data, list) and isinstance(part, int) and 0 <= part < len(data)


def _nested(place: Place, value: Any) -> Any:
    return value if not place else {str(place[0]): _nested(place[1:], value)}


def _add(text: str, place: Place, value: Any) -> str:
    """Adds a setting: as a line of a table with a header, else inside its inline table."""
    tables = blocks.split(text)
    name, index = str(place[0]), place[1] if len(place) > 1 and isinstance(place[1], int) else None
    rest = place[1:] if index is None else place[2:]
    own = [block for block in tables if block.name == name]
    data = tomllib.loads(text)
    table = data.get(name, {}) if index is None else data[name][index]
    if not isinstance(table, dict) or (rest and rest[0] in table) or (name in data and not own):
        return _add_inside(text, place, value)
    if len(place) == 1:
        blocks.insert_line(tables[0], f"{name} = {toml_value(value)}")
    else:
        if not own:
            own = [blocks.Block(name, False, [f"[{name}]"])]
            tables += own
        blocks.insert_line(own[index or 0], f"{toml_key(str(rest[0]))} = {toml_value(_nested(rest[1:], value))}")
    return blocks.join(tables)


def _add_inside(text: str, place: Place, value: Any) -> str:
    """Adds a setting inside an inline table."""
    data: Any = tomllib.loads(text)
    depth = 0
    while _has(data, place[depth]):
        data, depth = data[place[depth]], depth + 1
    return _in_block(text, place, lambda part, inside: _added(part, inside, depth, value))


def _added(text: str, place: Place, depth: int, value: Any) -> str:
    """Adds a setting to the table at the first ``depth`` parts of its place."""
    document = tomlkit.parse(text)
    table: Any = document
    for part in place[:depth]:
        table = table[part]
    table[place[depth]] = _item(_nested(place[depth + 1 :], value))
    return tomlkit.dumps(document)


def _replace(text: str, place: Place, value: Any) -> str:
    """Replaces or removes a value."""
    return _in_block(text, place, lambda part, inside: _replaced(part, inside, value))


def _in_block(text: str, place: Place, edit: Callable[[str, Place], str]) -> str:
    """Edits a text. Parses only the lines of the table of a place, so that dragging a slider is fast.

    edit: called with a part of the text and the place in it; raises KeyError where the place is in another part
    """
    tables = blocks.split(text)
    index = place[1] if len(place) > 2 and isinstance(place[1], int) else None
    own = [block for block in tables if block.name == place[0]]
    if len(place) > 1 and len(own) > (index or 0):
        block = own[index or 0]
        inside = [place[0], *([] if index is None else [0]), *place[1 if index is None else 2 :]]
        try:
            block.lines = edit("\n".join(block.lines), inside).split("\n")
        except KeyError:  # the value is in a table with its own header
            return edit(text, place)
        return "\n".join(line for table in tables for line in table.lines) + ("\n" if text.endswith("\n") else "")
    return edit(text, place)


def _replaced(text: str, place: Place, value: Any) -> str:
    document = tomlkit.parse(text)
    table: Any = document
    for part in place[:-1]:
        table = table[part]
    if value is None:
        table.pop(place[-1])
        return re.sub(r"(?<=\S) {2,}}", " }", tomlkit.dumps(document))
    if place[-1] not in table:
        raise KeyError(place[-1])
    table[place[-1]] = _item(value)
    return tomlkit.dumps(document)


def _item(value: Any) -> Any:
    return tomlkit.value(toml_value(value))
