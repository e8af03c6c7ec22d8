"""The journal of a session: its unsaved changes in a hidden file, so that no end of the server loses them."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from pydantic import Base64Bytes, BaseModel, ConfigDict, ValidationError

from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.regular import read_text


class Unsaved(BaseModel):
    """An open file with unsaved changes: its texts now, and as they were read or saved last."""

    model_config = ConfigDict(frozen=True)

    name: str
    text: str
    edits: str
    saved: str
    saved_edits: str
    maps: dict[str, Base64Bytes] = {}


class Entry(BaseModel):
    """State of a session.

    documents: files with unsaved changes, by kind
    heard:     number of handled messages of each page, so that none is handled twice
    leader:    name of the page that holds the edit lock
    """

    model_config = ConfigDict(frozen=True)

    documents: dict[str, Unsaved]
    heard: dict[str, int]
    leader: str


class Journal:
    """The journal of one file, next to it; it exists while there is something to recover."""

    def __init__(self, file: Path) -> None:
        self.path = file.with_name(f".{file.name}.unsaved")
        self._written = self.path.exists()

    def read(self) -> Entry | None:
        """State of the last session that ended with unsaved changes, or was killed; None without one.

        Raises UserError for a journal that cannot be read, and sets it aside.
        """
        if not self._written:
            return None
        try:
            return Entry.model_validate_json(read_text(self.path, "remove it"))
        except (UserError, ValidationError) as error:
            aside = self.path.with_name(f"{self.path.name}.unreadable")
            with suppress(OSError):
                self.path.replace(aside)
            raise UserError(f"{aside.name}: holds unsaved changes that cannot be read; look into it") from error

    def write(self, entry: Entry) -> None:
        """Writes a state; nothing where there is nothing to recover. An unwritable folder has no journal."""
        if not entry.documents and not self._written:
            return
        with suppress(UserError), replacing(self.path) as aside:
            aside.write_text(entry.model_dump_json(), encoding="utf-8")
            self._written = True

    def close(self, *, clean: bool) -> None:
        """Ends the session; removes the journal when there are no unsaved changes."""
        if clean and self._written:
            with suppress(OSError):
                self.path.unlink(missing_ok=True)
            self._written = False
