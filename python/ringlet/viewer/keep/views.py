"""Looks that are kept for a recipe in ``views.toml``: bookmarks, and the one with which the review opens."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from ringlet.data.errors import UserError
from ringlet.viewer.keep.review_folder import ReviewFolder
from ringlet.viewer.protocol import Shared

FILE = "views.toml"


class Stored(BaseModel):
    """Contents of the file: looks by the number of their bookmark."""

    view: dict[str, Shared] = {}


class ViewStore:
    """The kept looks of a recipe; ``0`` is the one with which the review opens."""

    def __init__(self, folder: ReviewFolder) -> None:
        self._folder = folder
        self.reload()

    def reload(self) -> None:
        """Reads the file."""
        self.views: dict[str, Shared] = {}
        self.unreadable: list[str] = []
        try:
            if self._folder.names(FILE):
                self.views = self._folder.read(FILE, Stored).view
        except UserError as error:
            self.unreadable.append(str(error))

    def keep(self, slot: int, look: Shared) -> None:
        """Keeps a look; raises UserError while the file cannot be read, so that nothing in it is lost."""
        if self.unreadable:
            raise UserError(self.unreadable[0])
        views: dict[str, Any] = {**self.views, str(slot): look}
        self._folder.write(FILE, Stored(view=dict(sorted(views.items()))))
        self.views = views
