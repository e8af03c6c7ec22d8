"""Words of motion of the lock that a page has chosen."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ringlet.data.errors import failure
from ringlet.groom import Groom
from ringlet.shot import Shot
from ringlet.sim.motion_words import describe_lock
from ringlet.viewer import protocol
from ringlet.viewer.publisher import SendQueue
from ringlet.viewer.wire import pack
from ringlet.viewer.worker import LatestTaskWorker


@dataclass(frozen=True)
class Question:
    """A lock of a groom in a shot, and who asks for its words."""

    shot: Shot
    groom: Groom
    lock: int
    page: SendQueue


class LockMotions:
    """Answers what pages ask, in a thread; only the latest question counts."""

    def __init__(self) -> None:
        self._worker = LatestTaskWorker(self._answer, "motion")

    def ask(self, question: Question) -> None:
        """Answers a question soon."""
        self._worker.submit(question)

    def stop(self, patience: float) -> None:
        """Stops the thread; waits for it up to ``patience`` [s]."""
        self._worker.stop(patience)

    def _answer(self, question: Question) -> None:
        rows = np.flatnonzero(question.groom.locks.ids == question.lock)
        if not rows.size:
            return
        try:
            text = describe_lock(question.shot, question.groom, int(rows[0]))
        except Exception as error:
            text = failure("the motion of a lock could not be found", error)
        question.page.put("lock_motion", pack(protocol.LockMotion(lock=question.lock, text=text)))
