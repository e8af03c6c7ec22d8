"""Background work in which only the latest task counts."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

Task = TypeVar("Task")


class Stale(Exception):
    """Raised inside a task that is outdated."""


class LatestTaskWorker(Generic[Task]):
    """A thread that runs one task at a time and queues only the latest.

    do: runs a task; may call ``raise_if_stale()`` to abort when a newer task is queued
    """

    def __init__(self, do: Callable[[Task], None], name: str) -> None:
        self._do = do
        self._next: Task | None = None
        self._stop = self._cancelled = False
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def submit(self, task: Task) -> None:
        """Queues a task; replaces a queued one."""
        with self._changed:
            self._next = task
            self._changed.notify()

    def cancel(self) -> None:
        """Removes the queued task and marks the running one as outdated."""
        with self._changed:
            self._next, self._cancelled = None, True

    def raise_if_stale(self) -> None:
        """Raises Stale when the running task is outdated."""
        if self._next is not None or self._cancelled or self._stop:
            raise Stale

    def stop(self) -> None:
        """Stops the thread after the running task."""
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
                task, self._next, self._cancelled = self._next, None, False
            try:
                assert task is not None
                self._do(task)
            except Stale:
                continue
