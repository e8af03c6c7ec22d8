"""The last seconds of live hair, to be kept as a take."""

from __future__ import annotations

import threading
from collections import deque

from ringlet.data.errors import UserError
from ringlet.groom import Groom
from ringlet.viewer.show.live_take import LEAD, SECONDS, LiveTake, Vector


class TakeRing:
    """The last steps of live hair of one groom. One thread adds to it, others keep takes of it."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._steps: deque[tuple[bytes, Vector]] = deque()
        self.clear()

    def clear(self) -> None:
        """Forgets what was recorded."""
        with self._lock:
            self._groom: Groom | None = None
            self._steps.clear()

    def begin(self, rods: bytes, groom: Groom, fps: float) -> None:
        """Records steps of other rods from now on: those of a groom."""
        with self._lock:
            self._steps = deque(maxlen=round((SECONDS + LEAD) * fps))
            self._rods, self._groom, self._fps = rods, groom, fps

    def add(self, step: bytes, wind: Vector) -> None:
        """Records a step, and the wind in it [m/s]."""
        with self._lock:
            self._steps.append((step, wind))

    def take(self, groom: Groom | None) -> LiveTake:
        """The last seconds of a groom; raises UserError where hair does not move live, nothing has moved, or another
        groom has."""
        with self._lock:
            steps, rods, of = list(self._steps), self._rods if self._groom else b"", self._groom
        if of is None or not steps:
            raise UserError("take: hair does not move live; press L, and move the head")
        if of is not groom:
            raise UserError("take: the groom has changed; keep the take once it is shown in motion")
        return LiveTake.of(rods, steps, self._fps, of.origin)
