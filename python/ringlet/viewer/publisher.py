"""Retained messages: the latest of each subject, delivered to every page.

Pages show a state, so a slow or returning page gets the latest message of each subject and skips outdated ones.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from contextlib import suppress

GLIMPSE = "/glimpse"  # ends the subject of a small message before a large one


class SendQueue:
    """Send queue of one page: waiting messages, oldest subject first, then requested messages, made on demand.

    Any thread may fill it; the event loop empties it.
    """

    def __init__(self) -> None:
        self._waiting: dict[str, bytes] = {}
        self._requested: dict[str, Callable[[], bytes | None]] = {}
        self._lock = threading.Lock()
        self._available = asyncio.Event()
        self._loop: asyncio.AbstractEventLoop | None = None  # that waits for messages

    def put(self, subject: str, message: bytes) -> None:
        """Queues a message at the end; replaces a waiting one of the same subject."""
        with self._lock:
            self._waiting.pop(subject, None)
            self._waiting[subject] = message
        self._wake()

    def request(self, sources: dict[str, Callable[[], bytes | None]]) -> None:
        """Replaces the requested messages by those of ``sources``; a source that returns None sends nothing."""
        with self._lock:
            self._requested = sources
        self._wake()

    def discard(self, prefix: str) -> None:
        """Removes waiting messages whose subject starts with a prefix."""
        with self._lock:
            self._waiting = {name: message for name, message in self._waiting.items() if not name.startswith(prefix)}

    def _wake(self) -> None:
        if self._loop is not None:
            with suppress(RuntimeError):  # the server has ended
                self._loop.call_soon_threadsafe(self._available.set)

    async def next(self) -> bytes:
        """Waits for the next message and returns it."""
        self._loop = asyncio.get_running_loop()
        while True:
            self._available.clear()
            with self._lock:
                if self._waiting:
                    return self._waiting.pop(next(iter(self._waiting)))
                source = self._requested.pop(next(iter(self._requested))) if self._requested else None
            if source is None:
                await self._available.wait()
            elif (message := await asyncio.to_thread(source)) is not None:
                return message


class Publisher:
    """Stores the latest message of each subject and delivers it to every page."""

    def __init__(self) -> None:
        self._latest: dict[str, bytes] = {}
        self._glimpses: dict[str, bytes] = {}
        self._queues: list[SendQueue] = []

    def subscribe(self, queue: SendQueue) -> None:
        """Adds a send queue, with all retained messages, those with a glimpse last."""
        for subject, message in {**self._latest, **self._glimpses}.items():
            queue.put(subject + GLIMPSE if subject in self._glimpses else subject, message)
        for subject in self._glimpses:
            queue.put(subject, self._latest[subject])
        self._queues.append(queue)

    def unsubscribe(self, queue: SendQueue) -> None:
        """Removes a send queue."""
        self._queues.remove(queue)

    def publish(self, subject: str, message: bytes, glimpse: bytes = b"") -> None:
        """Retains a message and queues it for every page.

        glimpse: a small message that a new page gets in the place of a large one, which then follows all others
        """
        self._latest[subject] = message
        self._glimpses.pop(subject, None)
        if glimpse:
            self._glimpses[subject] = glimpse
        for queue in self._queues:
            queue.discard(subject + GLIMPSE)  # of the message before
            queue.put(subject, message)

    def send(self, subject: str, message: bytes) -> None:
        """Queues a message for every page that is connected, without retaining it; on any thread."""
        for queue in tuple(self._queues):
            queue.put(subject, message)

    def retained(self) -> dict[str, bytes]:
        """The retained messages, by subject."""
        return dict(self._latest)

    def subjects(self, prefix: str) -> list[str]:
        """Retained subjects that start with a prefix."""
        return [subject for subject in self._latest if subject.startswith(prefix)]

    def clear(self, prefix: str) -> None:
        """Removes the messages whose subject starts with a prefix."""
        for subject in self.subjects(prefix):
            del self._latest[subject]
            self._glimpses.pop(subject, None)
        for queue in self._queues:
            queue.discard(prefix)
