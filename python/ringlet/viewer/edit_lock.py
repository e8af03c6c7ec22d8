"""The edit lock of a session: which page leads, and which asks to."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any

from ringlet.viewer.worker import Timer

ANSWER_AFTER = 10.0  # time after which a page that does not answer hands the lock over [s]


class EditLock:
    """The lock, by the names of pages. It stays reserved for a page that is gone until another one gets it.

    submit:  runs a call on the thread of the session
    changed: called after an answer, with the page that asked and the one that held the lock before
    """

    def __init__(self, submit: Callable[..., Any], changed: Callable[[str, str], None]) -> None:
        self.leader = self.asking = ""
        self._claimed = False  # whether the leader asked for the lock, or held it before
        self._changed = changed
        self._answer = Timer(ANSWER_AFTER, submit)

    def join(self, name: str, connected: Collection[str], *, led: bool) -> None:
        """A page connects. It gets the lock when no connected page holds it, or back when none asked for it meanwhile.

        led: whether the page held the lock when it was connected last
        """
        if self.leader not in connected or (led and not self._claimed):
            self.leader, self._claimed = name, led

    def leave(self, name: str) -> None:
        """A page disconnects; one that asks for its lock gets it."""
        if name == self.asking:
            self.asking = ""
        elif name == self.leader and self.asking:
            self.answer(over=True)

    def ask(self, name: str, connected: Collection[str]) -> None:
        """A page asks for the lock: it gets it, or the connected page that holds it is asked."""
        self.asking = name
        if name == self.leader or self.leader not in connected:
            self.answer(over=True)
        else:
            self._wait()

    def keep(self) -> None:
        """The leader edits: the time for its answer begins again."""
        if self._answer.cancel():
            self._wait()

    def answer(self, *, over: bool) -> None:
        """Answers the page that asks."""
        self._answer.cancel()
        asking, self.asking, before = self.asking, "", self.leader
        if over and asking:
            self.leader, self._claimed = asking, True
        self._changed(asking, before)

    def _wait(self) -> None:
        self._answer.restart(lambda: self.answer(over=True))

    def role(self, name: str) -> dict[str, bool]:
        """Whether a page leads, is asked for the lock, and asks for it."""
        leads = name == self.leader
        return {"leads": leads, "asked": leads and bool(self.asking), "asks": name == self.asking}

    def stop(self) -> None:
        """Ends the wait for an answer."""
        self._answer.cancel()
