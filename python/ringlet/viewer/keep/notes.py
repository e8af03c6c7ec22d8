"""Notes about a look, each in a readable file: ``notes/ID.toml``."""

from __future__ import annotations

from pydantic import BaseModel

from ringlet.data.errors import UserError
from ringlet.viewer.keep.review_entries import Entries
from ringlet.viewer.keep.review_folder import ReviewFolder, now
from ringlet.viewer.protocol import EditNote, Note, Shared, WriteNote
from ringlet.viewer.protocol.message import Id, Position, Row
from ringlet.viewer.protocol.review import Stroke


class Stored(BaseModel):
    """Contents of the file of a note; see ``WriteNote``."""

    author: str = ""
    time: str = ""
    resolved: bool = False
    text: str = ""
    lock: Id | None = None
    point: Row = 0
    at: Position | None = None
    strokes: list[Stroke] = []
    look: Shared


class NoteStore(Entries[Stored]):
    """The notes about a recipe, by id, the oldest first."""

    def __init__(self, folder: ReviewFolder) -> None:
        super().__init__(folder, "note", Stored, most=1000)

    @property
    def notes(self) -> list[Note]:
        """All notes, the oldest first."""
        return [Note(id=id, **dict(one)) for id, one in self.entries.items()]

    def write(self, message: WriteNote) -> str:
        """Writes a note; returns its id. Raises UserError for one that says nothing."""
        if not message.text.strip() and not message.strokes:
            raise UserError("note: is empty; write something, or draw")
        values = {name: getattr(message, name) for name in ("author", "text", "look", "at", "lock", "point", "strokes")}
        return self.add(Stored(time=now(), **values))

    def edit(self, message: EditNote) -> None:
        """Changes the text of a note, or whether it is resolved."""
        changes = {"text": message.text, "resolved": message.resolved}
        self.change(message.id, {name: value for name, value in changes.items() if value is not None})
