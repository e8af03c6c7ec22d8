"""Progress of a groom, reported once it takes long."""

from __future__ import annotations

import threading
from collections.abc import Callable

Report = Callable[[str, float], None]


class ProgressReport:
    """Reports stages with a callback, from ``after`` seconds on; a report of an empty stage ends it."""

    def __init__(self, report: Report, after: float) -> None:
        self._report = report
        self._stage = "", 0.0
        self._late = False
        self._timer = threading.Timer(after, self._begin)
        self._timer.daemon = True
        self._timer.start()

    def __call__(self, stage: str, done: float) -> None:
        """A stage begins. done: fraction of the stages before it."""
        self._stage = stage, done
        if self._late:
            self._report(stage, done)

    def _begin(self) -> None:
        self._late = True
        self._report(*self._stage)

    def close(self) -> None:
        """Ends the report."""
        self._timer.cancel()
        if self._late:
            self._report("", 1.0)
