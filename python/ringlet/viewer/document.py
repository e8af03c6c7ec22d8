"""A TOML file that is edited setting by setting, and keeps its comments and its order."""

from __future__ import annotations

import difflib
import re
import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError

from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.toml import toml_key
from ringlet.viewer import blocks
from ringlet.viewer.protocol import Change, Place

MOST_STEPS = 500  # that can be undone


@dataclass(frozen=True)
class State:
    """What undo goes back to: the text, the stages that have no effect for now, and the text of the file of edits."""

    text: str
    muted: frozenset[str] = frozenset()
    edits: str = ""


class History:
    """What was done to files that are edited together, in the order in which it was done."""

    def __init__(self) -> None:
        self.before: list[tuple[Document, State]] = []
        self.after: list[tuple[Document, State]] = []
        self._gesture: tuple[Document, int] | None = None

    def note(self, document: Document, gesture: int | None) -> None:
        """Keeps what a document is before it changes; one gesture is one step."""
        this = None if gesture is None else (document, gesture)
        if this is None or this != self._gesture:
            self.before = [*self.before, (document, document.state)][-MOST_STEPS:]
        self._gesture = this
        self.after.clear()

    def undo(self) -> Document | None:
        """Goes back a step; tells which document has changed."""
        return self._go(self.before, self.after)

    def redo(self) -> Document | None:
        """Goes forth again."""
        return self._go(self.after, self.before)

    def _go(self, there: list[tuple[Document, State]], back: list[tuple[Document, State]]) -> Document | None:
        if not there:
            return None
        document, state = there[-1]
        now = document.state
        document.take(state)
        there.pop()
        back.append((document, now))
        self._gesture = None
        return document


class Document:
    """A file as it stands, with what it was before. Nothing gets in that ``check`` does not accept.

    check:   makes of a text and that of its file of edits what they mean; raises UserError where they are not valid
    edits:   what the file of edits holds
    history: that of the files that are undone together
    model:   what ``check`` made of it
    revision: grows with each change
    """

    def __init__(
        self, path: Path, check: Callable[[str, str], Any], edits: str = "", history: History | None = None
    ) -> None:
        self.path, self.history = path, history or History()
        self.saved, self.saved_edits = path.read_text(encoding="utf-8"), edits
        self._check, self.revision = check, 0
        self.take(State(self.saved, edits=edits))

    def take(self, state: State) -> None:
        """Is as it says, if that is valid."""
        self.model = self._check(state.text, state.edits)
        self.state = state
        self.revision += 1

    @property
    def text(self) -> str:
        """The text as it stands."""
        return self.state.text

    @property
    def dirty(self) -> bool:
        """Whether there is something to save."""
        return self.text != self.saved or self.state.edits != self.saved_edits

    @property
    def can_undo(self) -> bool:
        """Whether there is something to go back to."""
        return bool(self.history.before)

    @property
    def can_redo(self) -> bool:
        """Whether something was undone."""
        return bool(self.history.after)

    def set(self, changes: Sequence[tuple[Place, Any]], gesture: int | None = None) -> None:
        """Gives settings new values; None takes a setting out. One gesture is one step of undo."""
        text = self.text
        for place, value in changes:
            try:
                text = put(text, place, value)
            except (TOMLKitError, KeyError, IndexError, TypeError, ValueError) as error:
                where = ".".join(str(part) for part in place)
                raise UserError(f"{self.path.name}: {where} cannot be set ({error}); undo, or edit the file") from None
        self.become(text, gesture=gesture)

    def arrange(self, action: str, name: str, at: int, to: int = 0, entry: dict[str, Any] | None = None) -> None:
        """Adds, removes or moves a table of the array of tables ``name``, with the comment above it."""
        parts = blocks.split(self.text)
        places = [k for k, block in enumerate(parts) if block.name == name and block.many]
        if len(places) != len(self.said().get(name, [])):
            raise UserError(f"{self.path.name}: {name} is not written as tables [[{name}]]; edit it in the file")
        if not 0 <= at < len(places) + (action == "add") or not 0 <= to < max(len(places), 1):
            raise UserError(f"{self.path.name}: {name} has {len(places)} operators; there is none at {max(at, to)}")
        if action == "add":
            lines = [f"[[{name}]]", *(f"{toml_key(part)} = {written(value)}" for part, value in (entry or {}).items())]
            parts.insert(self._new_place(parts, places, at), blocks.Block(name, True, lines))
        else:
            chosen = [parts[k] for k in places]
            moved = chosen.pop(at)
            if action == "move":
                chosen.insert(to, moved)
                for k, block in zip(places, chosen, strict=True):
                    parts[k] = block
            else:
                del parts[places[at]]
        self.become(blocks.join(parts))

    @staticmethod
    def _new_place(parts: list[blocks.Block], places: list[int], at: int) -> int:
        """Where a new table comes: among its like, or else before the curl, as recipes are read."""
        if places:
            return places[at] if at < len(places) else places[-1] + 1
        return next((k for k, block in enumerate(parts) if block.name == "curl"), len(parts))

    def become(
        self, text: str, *, muted: frozenset[str] | None = None, edits: str | None = None, gesture: int | None = None
    ) -> None:
        """Takes another text, other muted stages or other edits, if they are valid."""
        now = self.state
        state = State(text, now.muted if muted is None else muted, now.edits if edits is None else edits)
        if state == now:
            return
        model = self._check(state.text, state.edits)
        self.history.note(self, gesture)
        self.model, self.state = model, state
        self.revision += 1

    def save(self, path: Path | None = None, text: str | None = None) -> Path:
        """Writes it to its file, or a text to another one."""
        with replacing(path or self.path) as aside:
            aside.write_text(self.text if text is None else text, encoding="utf-8")
        if path is None:
            self.saved, self.saved_edits = self.text, self.state.edits
        return path or self.path

    def said(self) -> dict[str, Any]:
        """What the file says, as plain values."""
        return tomllib.loads(self.text)

    def changes(self) -> list[Change]:
        """The lines that are not as they were saved, with a line of context."""
        told = [*_differing(self.saved, self.text), *_differing(self.saved_edits, self.state.edits)]
        return [Change.model_validate({"sign": line[0], "line": line[1:120]}) for line in told[:400]]


def _differing(before: str, now: str) -> list[str]:
    lines = difflib.unified_diff(before.splitlines(), now.splitlines(), lineterm="", n=1)
    return [line for line in lines if not line.startswith(("---", "+++", "@@"))]


def written(value: Any) -> str:
    """A value as TOML says it inside a line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{toml_key(name)} = {written(entry)}" for name, entry in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(written(entry) for entry in value) + "]"
    return tomlkit.item(value).as_string()


def put(text: str, place: Place, value: Any) -> str:
    """The text with a value at a place, and the tables on the way to it."""
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
    there, missing = data[place[depth]], place[depth + 1]
    if value is None:
        return text
    if not isinstance(missing, str):
        raise IndexError(f"there is no entry {missing}")
    if isinstance(there, dict):
        return _add(text, place, value)
    # `width = 1.2` becomes `width = { value = 1.2, … }`, so that there is a place for more
    return _replace(text, place[: depth + 1], {"value": there, missing: _nested(place[depth + 2 :], value)})


def _has(data: Any, part: str | int) -> bool:
    if isinstance(data, dict):
        return part in data
    return isinstance(data, list) and isinstance(part, int) and 0 <= part < len(data)


def _nested(place: Place, value: Any) -> Any:
    return value if not place else {str(place[0]): _nested(place[1:], value)}


def _add(text: str, place: Place, value: Any) -> str:
    """Adds a setting to a table with a header of its own, as a line; elsewhere inside the line of its table."""
    parts = blocks.split(text)
    name, index = str(place[0]), place[1] if len(place) > 1 and isinstance(place[1], int) else None
    rest = place[1:] if index is None else place[2:]
    there = [block for block in parts if block.name == name]
    data = tomllib.loads(text)
    known = data.get(name, {}) if index is None else data[name][index]
    if not isinstance(known, dict) or (rest and rest[0] in known) or (name in data and not there):
        return _add_inside(text, place, value)
    if len(place) == 1:
        blocks.insert_line(parts[0], f"{name} = {written(value)}")
    else:
        if not there:
            there = [blocks.Block(name, False, [f"[{name}]"])]
            parts += there
        blocks.insert_line(there[index or 0], f"{toml_key(str(rest[0]))} = {written(_nested(rest[1:], value))}")
    return blocks.join(parts)


def _add_inside(text: str, place: Place, value: Any) -> str:
    document = tomlkit.parse(text)
    table: Any = document
    at = 0
    while _has(table.unwrap(), place[at]):
        table, at = table[place[at]], at + 1
    table[place[at]] = _item(_nested(place[at + 1 :], value))
    return tomlkit.dumps(document)


def _replace(text: str, place: Place, value: Any) -> str:
    """Replaces what is there, or takes it out. Only the lines of its table are read: the rest need not be understood
    anew for every step of a slider."""
    parts = blocks.split(text)
    index = place[1] if len(place) > 2 and isinstance(place[1], int) else None
    own = [block for block in parts if block.name == place[0]]
    if len(place) > 1 and len(own) > (index or 0):
        block = own[index or 0]
        inside = [place[0], *([] if index is None else [0]), *place[1 if index is None else 2 :]]
        try:
            block.lines = _replaced("\n".join(block.lines), inside, value).split("\n")
        except KeyError:  # it is in a table of its own, elsewhere
            return _replaced(text, place, value)
        return "\n".join(line for part in parts for line in part.lines) + ("\n" if text.endswith("\n") else "")
    return _replaced(text, place, value)


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
    return tomlkit.value(written(value))
