"""Which files of a project are caches: what can be played beside a shot."""

from __future__ import annotations

from ringlet import io
from ringlet.data.errors import UserError
from ringlet.viewer.project import Project

PATTERNS = ("*.usdc", "*.usda", "*.usd")

Stamp = tuple[int, int, int]


class Caches:
    """The caches of a project. A file is looked into once, and again when it has changed."""

    def __init__(self, project: Project) -> None:
        self._project = project
        self._known: dict[str, tuple[Stamp, bool]] = {}

    def names(self) -> list[str]:
        """Their names. The first time this opens every USD file of the project."""
        return [name for name in self._project.files(*PATTERNS) if self._is(name)]

    def _is(self, name: str) -> bool:
        try:
            path = self._project.inside(name, "compare")
            found = path.stat()
        except (UserError, OSError):  # a link to elsewhere, or just gone
            return False
        stamp = found.st_ino, found.st_size, found.st_mtime_ns
        if self._known.get(name, (None, False))[0] != stamp:
            self._known[name] = stamp, io.is_cache(path)
        return self._known[name][1]
