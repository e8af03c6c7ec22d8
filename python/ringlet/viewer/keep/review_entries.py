"""Entries of a review folder, such as notes: a readable file each, whose name is the id of the entry."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime
from typing import Any, Generic, TypeVar

from pydantic import BaseModel

from ringlet.data.errors import UserError
from ringlet.viewer.keep.review_folder import ReviewFolder

Stored = TypeVar("Stored", bound=BaseModel)


class Entries(Generic[Stored]):
    """Entries of one kind by id, the oldest first.

    name:       of the kind, for messages: ``note``
    suffixes:   of the files of an entry besides its own
    unreadable: errors of files that are left out
    """

    def __init__(
        self, folder: ReviewFolder, name: str, kind: type[Stored], most: int, suffixes: tuple[str, ...] = ()
    ) -> None:
        self.folder, self.name, self._kind, self._most = folder, name, kind, most
        self._suffixes = suffixes
        self.reload()

    def reload(self) -> None:
        """Reads all files."""
        self.entries: dict[str, Stored] = {}
        self.unreadable: list[str] = []
        for name in self.folder.names(f"{self.name}s/*.toml"):
            id = name.removeprefix(f"{self.name}s/").removesuffix(".toml")
            if "." in id or len(self.entries) == self._most:
                continue
            try:
                self.entries[id] = self.folder.read(name, self._kind)
            except UserError as error:
                self.unreadable.append(str(error))

    def __getitem__(self, id: str) -> Stored:
        """An entry; raises UserError for an unknown id."""
        if id not in self.entries:
            raise UserError(f"{self.name}: there is no {id}; it may have been deleted")
        return self.entries[id]

    def file(self, id: str, suffix: str = ".toml") -> str:
        """Name of a file of an entry in the folder."""
        return f"{self.name}s/{id}{suffix}"

    def new_id(self) -> str:
        """An unused id from the present time; raises UserError when there are too many entries."""
        if len(self.entries) >= self._most:
            raise UserError(f"{self.name}: there are {self._most}; delete some first")
        return next(id for id in _numbered(datetime.now().strftime("%Y%m%d-%H%M%S")) if id not in self.entries)

    def add(self, entry: Stored, id: str = "") -> str:
        """Writes a new entry; returns its id."""
        id = id or self.new_id()
        self.folder.write(self.file(id), entry)
        self.entries[id] = entry
        return id

    def change(self, id: str, changes: dict[str, Any]) -> None:
        """Writes an entry with other values of some fields."""
        changed = self[id].model_copy(update=changes)
        self.folder.write(self.file(id), changed)
        self.entries[id] = changed

    def delete(self, id: str) -> None:
        """Removes an entry and its files."""
        self.__getitem__(id)
        self.folder.remove(*(self.file(id, suffix) for suffix in (".toml", *self._suffixes)))
        del self.entries[id]


def _numbered(name: str) -> Iterator[str]:
    yield name
    k = 2
    while True:
        yield f"{name}-{k}"
        k += 1
