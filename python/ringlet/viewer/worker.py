"""Work in the background of which only the latest counts."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

Task = TypeVar("Task")


class Stale(Exception):
    """Raised inside work that nobody waits for any more."""


class Latest(Generic[Task]):
    """A thread that does one task at a time; of those that come meanwhile, only the last.

    do: does a task; it may call ``fresh()`` now and then, which raises Stale when a newer task is there
    """

    def __init__(self, do: Callable[[Task], None], name: str) -> None:
        self._do = do
        self._next: Task | None = None
        self._stop = self._dropped = False
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def ask(self, task: Task) -> None:
        """Wants a task done, in place of what was wanted before."""
        with self._changed:
            self._next = task
            self._changed.notify()

    def drop(self) -> None:
        """Wants nothing of it for now."""
        with self._changed:
            self._next, self._dropped = None, True

    def fresh(self) -> None:
        """Raises Stale when what is done now is wanted no more."""
        if self._next is not None or self._dropped or self._stop:
            raise Stale

    def stop(self) -> None:
        """Ends after what is done now."""
        with self._changed:
            self._stop = True
            self._changed.notify()
        self._thread.join(timeout=5.0)

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._stop or self._next is not None)
                if self._stop:
                    return
                task, self._next, self._dropped = self._next, None, False
            try:
                assert task is not None
                self._do(task)
            except Stale:
                continue
