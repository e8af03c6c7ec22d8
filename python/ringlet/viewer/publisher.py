"""Retained messages: the latest of each subject, delivered to every page.

Pages show a state, so a slow or returning page gets the latest message of each subject and skips outdated ones.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable


class SendQueue:
    """Send queue of one page: waiting messages, oldest subject first, then requested messages, made on demand."""

    def __init__(self) -> None:
        self._waiting: dict[str, bytes] = {}
        self._requested: dict[str, Callable[[], bytes | None]] = {}
        self._available = asyncio.Event()

    def put(self, subject: str, message: bytes) -> None:
        """Queues a message at the end; replaces a waiting one of the same subject."""
        self._waiting.pop(subject, None)
        self._waiting[subject] = message
        self._available.set()

    def request(self, sources: dict[str, Callable[[], bytes | None]]) -> None:
        """Replaces the requested messages by those of ``sources``; a source that returns None sends nothing."""
        self._requested = sources
        self._available.set()

    def discard(self, prefix: str) -> None:
        """Removes waiting messages whose subject starts with a prefix."""
        for subject in [name for name in self._waiting if name.startswith(prefix)]:
            del self._waiting[subject]

    async def next(self) -> bytes:
        """Waits for the next message and returns it."""
        while True:
            if self._waiting:
                return self._waiting.pop(next(iter(self._waiting)))
            if self._requested:
                message = await asyncio.to_thread(self._requested.pop(next(iter(self._requested))))
                if message is not None:
                    return message
            else:
                self._available.clear()
                await self._available.wait()


class Publisher:
    """Stores the latest message of each subject and delivers it to every page."""

    def __init__(self) -> None:
        self._latest: dict[str, bytes] = {}
        self._queues: list[SendQueue] = []

    def subscribe(self, first: bytes) -> SendQueue:
        """Returns a new send queue with the welcome message and all retained messages."""
        queue = SendQueue()
        queue.put("welcome", first)
        for subject, message in self._latest.items():
            queue.put(subject, message)
        self._queues.append(queue)
        return queue

    def unsubscribe(self, queue: SendQueue) -> None:
        """Removes a send queue."""
        self._queues.remove(queue)

    def publish(self, subject: str, message: bytes) -> None:
        """Retains a message and queues it for every page."""
        self._latest[subject] = message
        for queue in self._queues:
            queue.put(subject, message)

    def subjects(self, prefix: str) -> list[str]:
        """Retained subjects that start with a prefix."""
        return [subject for subject in self._latest if subject.startswith(prefix)]

    def clear(self, prefix: str) -> None:
        """Removes the messages whose subject starts with a prefix."""
        for subject in self.subjects(prefix):
            del self._latest[subject]
        for queue in self._queues:
            queue.discard(prefix)
