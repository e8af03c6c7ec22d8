"""Saves the open files of a session, which goes on with the copy that was saved."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from ringlet.data.errors import UserError
from ringlet.viewer import protocol
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.files.problems import COPIED, GROOM, RECOVERED, RENAMED, SAVE, ProblemList, dismiss, gone
from ringlet.viewer.files.writing import write, write_copy
from ringlet.viewer.protocol import File, Fix


class Saving:
    """Saves files, and asks first when the groom of one cannot be made.

    go_on: opens another file in the session, and discards unsaved changes if ``discard`` is set
    """

    def __init__(self, problems: ProblemList, go_on: Callable[..., None]) -> None:
        self._problems, self._go_on = problems, go_on

    def open(self, files: Files) -> None:
        """Saves other files from now on."""
        self._files = files
        self._copy: tuple[Path, int] | None = None  # of the recipe of a shot that was saved last, and its revision

    def save(self, message: protocol.Save) -> Path | None:
        """Saves a file, or a copy with which the session goes on; returns its path, None where it asks first."""
        files = self._files
        if message.file == "recipe" and GROOM in self._problems and not message.anyway:
            anyway = Fix(label="Save anyway", message={**message.model_dump(), "anyway": True})
            reason = f"{files.recipe.path.name} is not saved: {self._problems[GROOM].message}"
            self._problems.show(SAVE, reason, [anyway, dismiss(SAVE)])
            return None
        self._problems.clear(SAVE, COPIED, RECOVERED, RENAMED, gone(message.file))
        if not message.name:
            return write(files, message.file)
        with_copy = message.file == "shot" and message.with_copy
        if with_copy:
            self._name_copy()
        path = write_copy(files, message.file, message.name, as_variant=message.variant)
        self._go_on_with(message.file, path, discard=with_copy)
        return path

    def _go_on_with(self, file: File, path: Path, *, discard: bool) -> None:
        """Goes on with a copy that was saved: it holds the changes, and the file that it is a copy of has none."""
        files = self._files
        if files.mode == "shot" and file == "recipe":
            self._copy = path, files.recipe.revision
            message = f"{path.name} is saved; the shot still names {files.recipe.path.name}"
            use = Fix(label=f"Use {path.name} in the shot", message={"kind": "use_copy"})
            self._problems.show(COPIED, message, [use, dismiss(COPIED)])
            return
        other = [kind for kind, document in files.documents.items() if kind != file and document.dirty]
        self._go_on(path, discard=discard or not other)

    def use_copy(self) -> None:
        """Lets the shot name the copy of its recipe, saves the shot, and opens both.

        Raises UserError when there is no copy, or the recipe has changed since.
        """
        self._name_copy()
        write(self._files, "shot")
        self._go_on(self._files.file, discard=True)

    def _name_copy(self) -> None:
        """Lets the shot name the copy of its recipe."""
        files = self._files
        path, revision = self._copy or (files.file, -1)
        if revision != files.recipe.revision:
            raise UserError(f"{files.recipe.path.name}: was changed since its copy was saved; save a copy again")
        files.set("shot", [(["groom"], os.path.relpath(path, files.file.parent))], 0)
