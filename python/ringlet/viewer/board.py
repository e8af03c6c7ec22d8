"""The latest message of each subject, and who has not seen it yet.

What is shown is a state, not a story: a page that is slow, or comes back, gets the latest of everything and misses
nothing but what is no longer true.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable


class Mailbox:
    """What one page has yet to be sent, oldest subject first, and then what it asked for, made when it is its turn."""

    def __init__(self) -> None:
        self._waiting: dict[str, bytes] = {}
        self._wanted: dict[str, Callable[[], bytes | None]] = {}
        self._some = asyncio.Event()

    def put(self, subject: str, message: bytes) -> None:
        """Sends a message after all others, in place of one of the same subject that is still waiting."""
        self._waiting.pop(subject, None)
        self._waiting[subject] = message
        self._some.set()

    def want(self, wanted: dict[str, Callable[[], bytes | None]]) -> None:
        """Sends messages that are made by what is given, in place of those that were wanted before.

        Nothing is sent where there is nothing to say any more.
        """
        self._wanted = wanted
        self._some.set()

    def drop(self, beginning: str) -> None:
        """Sends nothing more of subjects that begin so."""
        for subject in [name for name in self._waiting if name.startswith(beginning)]:
            del self._waiting[subject]

    async def next(self) -> bytes:
        """The next message to send."""
        while True:
            if self._waiting:
                return self._waiting.pop(next(iter(self._waiting)))
            if self._wanted:
                message = await asyncio.to_thread(self._wanted.pop(next(iter(self._wanted))))
                if message is not None:
                    return message
            else:
                self._some.clear()
                await self._some.wait()


class Board:
    """Keeps the latest message of each subject and hands it to every mailbox."""

    def __init__(self) -> None:
        self._latest: dict[str, bytes] = {}
        self._boxes: list[Mailbox] = []

    def join(self, first: bytes) -> Mailbox:
        """A mailbox that begins with a welcome, and all there is."""
        box = Mailbox()
        box.put("welcome", first)
        for subject, message in self._latest.items():
            box.put(subject, message)
        self._boxes.append(box)
        return box

    def leave(self, box: Mailbox) -> None:
        """Forgets a mailbox."""
        self._boxes.remove(box)

    def post(self, subject: str, message: bytes) -> None:
        """Tells everybody."""
        self._latest[subject] = message
        for box in self._boxes:
            box.put(subject, message)

    def subjects(self, beginning: str) -> list[str]:
        """What there is that begins so."""
        return [subject for subject in self._latest if subject.startswith(beginning)]

    def wipe(self, beginning: str) -> None:
        """Takes down what begins so."""
        for subject in self.subjects(beginning):
            del self._latest[subject]
        for box in self._boxes:
            box.drop(beginning)
