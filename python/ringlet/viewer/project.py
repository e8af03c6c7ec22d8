"""The folder that a session may read and write, and nothing outside it."""

from __future__ import annotations

from pathlib import Path

from ringlet.data.errors import UserError


class Project:
    """A folder; ``inside`` is what every path of a session goes through."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder.resolve()

    def inside(self, path: Path | str, what: str) -> Path:
        """The path, if it is in the folder, whatever links and dots are in it. ``what`` names it in messages."""
        resolved = (self.folder / path).resolve()
        if not resolved.is_relative_to(self.folder):
            raise UserError(
                f"{what} is '{path}', outside of the project {self.folder}; move it there, or start with "
                "--project FOLDER"
            )
        return resolved

    def beside(self, name: str, suffix: str) -> Path:
        """A new file by its name alone, with a suffix that it gets where it has none."""
        if not name or name != Path(name).name or name.startswith("."):
            raise UserError(f"save: name is '{name}'; give a file name without a folder")
        return self.inside(name if name.endswith(".toml") else f"{name}{suffix}", "save: name")

    def files(self, *patterns: str) -> list[str]:
        """Files of the folder, as relative paths."""
        found = {path for pattern in patterns for path in self.folder.glob(pattern)}
        return sorted(str(path.relative_to(self.folder)) for path in found if path.is_file())[:500]
