"""The project folder: a session reads and writes nothing outside it."""

from __future__ import annotations

from pathlib import Path

from ringlet.data.errors import UserError


class Project:
    """The project folder; ``inside`` checks every path of a session."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder.resolve()

    def inside(self, path: Path | str, what: str) -> Path:
        """Resolves links and dots of a path; raises UserError when it is outside the folder.

        what: name of the path, for messages
        """
        resolved = (self.folder / path).resolve()
        if not resolved.is_relative_to(self.folder):
            raise UserError(
                f"{what} is '{path}', outside of the project {self.folder}; move it there, or start with "
                "--project FOLDER"
            )
        return resolved

    def new_file(self, name: str, suffix: str) -> Path:
        """Path of a new file in the folder; appends ``suffix`` to a name without ``.toml``.

        Raises UserError for a name with a folder.
        """
        if not name or name != Path(name).name or name.startswith("."):
            raise UserError(f"save: name is '{name}'; give a file name without a folder")
        return self.inside(name if name.endswith(".toml") else f"{name}{suffix}", "save: name")

    def files(self, *patterns: str) -> list[str]:
        """Relative paths of files in the folder that match patterns; at most 500."""
        found = {path for pattern in patterns for path in self.folder.glob(pattern)}
        return sorted(str(path.relative_to(self.folder)) for path in found if path.is_file())[:500]
