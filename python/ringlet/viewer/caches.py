"""Which files of a project are caches: what can be played beside a shot."""

from __future__ import annotations

import time

from ringlet import io
from ringlet.errors import UserError
from ringlet.viewer.project import Project

PATTERNS = ("*.usdc", "*.usda", "*.usd")
PATIENCE = 0.1  # a page waits no longer for files to be looked at [s]

Stamp = tuple[int, int, int]


class Caches:
    """The caches of a project. A file is looked into once, and again when it has changed."""

    def __init__(self, project: Project) -> None:
        self._project = project
        self._known: dict[str, tuple[Stamp, bool]] = {}

    def names(self) -> list[str]:
        """Their names; where looking takes too long, those of files that are still to be looked into as well."""
        end = time.monotonic() + PATIENCE
        return [name for name in self._project.files(*PATTERNS) if self._may_be(name, time.monotonic() < end)]

    def _may_be(self, name: str, look: bool) -> bool:
        """Whether a file is a cache, or may be one as far as is known."""
        try:
            path = self._project.inside(name, "compare")
            found = path.stat()
        except (UserError, OSError):  # a link to elsewhere, or just gone
            return False
        stamp = found.st_ino, found.st_size, found.st_mtime_ns
        before, known = self._known.get(name, (None, True))
        if before == stamp or not look:
            return known
        self._known[name] = stamp, io.is_cache(path)
        return self._known[name][1]
