"""The simulation caches of a project, for playback beside a shot."""

from __future__ import annotations

from ringlet import io
from ringlet.data.errors import UserError
from ringlet.viewer.files.watcher import Stamp, stamp_of
from ringlet.viewer.project import Project

PATTERNS = ("*.usdc", "*.usda", "*.usd")


class Caches:
    """The caches of a project. A file is inspected once, and again after it changes."""

    def __init__(self, project: Project) -> None:
        self._project = project
        self._inspected: dict[str, tuple[Stamp, bool]] = {}

    def names(self) -> list[str]:
        """Names of the caches; the first call opens every USD file of the project."""
        return [name for name in self._project.files(*PATTERNS) if self._is_cache(name)]

    def _is_cache(self, name: str) -> bool:
        try:
            path = self._project.inside(name, "compare")
        except UserError:  # a link out of the project
            return False
        if (stamp := stamp_of(path)) is None:
            return False
        if self._inspected.get(name, (None, False))[0] != stamp:
            self._inspected[name] = stamp, io.is_cache(path)
        return self._inspected[name][1]
