"""Background work: calls in order, and tasks of which only the latest counts."""

from __future__ import annotations

import logging
import queue
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, Generic, TypeVar

Task = TypeVar("Task")


log = logging.getLogger("ringlet.viewer")


class SerialWorker:
    """A thread that runs calls one after the other, in the order of their submission.

    It ends with the program, even in the midst of a call.
    """

    def __init__(self, name: str) -> None:
        self._calls: queue.SimpleQueue[tuple[Future[Any], Callable[[], Any]] | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def submit(self, do: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Queues a call; the future has its result or its exception."""
        future: Future[Any] = Future()
        self._calls.put((future, lambda: do(*arguments)))
        return future

    def post(self, do: Callable[..., Any], *arguments: Any) -> None:
        """Queues a call without a result; its exception is logged."""
        self.submit(do, *arguments).add_done_callback(_log_exception)

    def stop(self, patience: float) -> None:
        """Ends the thread after the queued calls; waits for it up to ``patience`` [s]."""
        self._calls.put(None)
        self._thread.join(patience)

    def _run(self) -> None:
        while (call := self._calls.get()) is not None:
            future, do = call
            if future.set_running_or_notify_cancel():
                try:
                    future.set_result(do())
                except Exception as error:
                    future.set_exception(error)


def _log_exception(future: Future[Any]) -> None:
    if not future.cancelled() and (error := future.exception()) is not None:
        log.error("the review could not go on", exc_info=error)


class Timer:
    """Submits a call after some seconds without another one.

    submit: runs a call on the thread of the caller
    """

    def __init__(self, seconds: float, submit: Callable[..., Any]) -> None:
        self._seconds, self._submit = seconds, submit
        self._timer: threading.Timer | None = None

    def restart(self, do: Callable[[], None]) -> None:
        """Replaces the call that waits; the time begins again."""
        self.cancel()
        self._timer = threading.Timer(self._seconds, self._submit, (do,))
        self._timer.daemon = True
        self._timer.start()

    def cancel(self) -> bool:
        """Removes the call; returns whether one was waiting, or has just been submitted."""
        timer, self._timer = self._timer, None
        if timer is not None:
            timer.cancel()
        return timer is not None


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

    def raise_if_cancelled(self) -> None:
        """Raises Stale when the running task was cancelled; newer tasks do not count."""
        if self._cancelled or self._stop:
            raise Stale

    def stop(self, patience: float) -> None:
        """Stops the thread after the running task; waits for it up to ``patience`` [s]."""
        with self._changed:
            self._stop = True
            self._changed.notify()
        self._thread.join(patience)

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
