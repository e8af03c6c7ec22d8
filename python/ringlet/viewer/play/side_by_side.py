"""Looks that are compared with live hair: they move with the same head, in the same wind, under the same hand."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future
from functools import partial
from typing import NamedTuple

from ringlet.data.errors import failure
from ringlet.viewer.play.mover import Hand, LiveScene, Mover, rods_message, step_message
from ringlet.viewer.protocol import Side
from ringlet.viewer.worker import SerialWorker


class Made(NamedTuple):
    """Live hair of a scene that is being made, or has been."""

    scene: LiveScene
    mover: Future[Mover]


class Followers:
    """Live hair of the compared looks, by side. It is made on a thread of its own, and moves on that of its leader.

    failed: reports an error message
    """

    def __init__(self, failed: Callable[[str], None]) -> None:
        self._failed = failed
        self._worker: SerialWorker | None = None
        self._made: dict[Side, Made] = {}
        self._moving: dict[Side, tuple[int, Mover]] = {}

    def change(
        self, scenes: Mapping[Side, LiveScene], leader: Mover, number: Callable[[], int]
    ) -> Iterator[tuple[Side, bytes | None]]:
        """Goes on with other scenes; gives the sides whose rods are others with the message of these, None for none.

        number: gives the key of new rods
        """
        for side in self._made.keys() - scenes.keys():
            if self._end(side):
                yield side, None
        for side, scene in scenes.items():
            made = self._made.get(side)
            if made is None or made.scene.groom is not scene.groom:
                if self._end(side):
                    yield side, None
                self._made[side] = Made(scene, self._make(scene))
                continue
            if (mover := self._ready(made)) is None:
                continue
            new = side not in self._moving or self._moving[side][1] is not mover
            if new:
                mover.join(leader)
            if mover.change(scene) or new:
                self._moving[side] = number(), mover
                yield side, rods_message(self._moving[side][0], mover, side)

    def step(self, leader: Mover, hand: Hand, number: int) -> Iterator[tuple[Side, bytes]]:
        """Steps as the leader has; gives the message of each side."""
        for side, (key, mover) in self._moving.items():
            mover.follow(leader, hand)
            yield side, step_message(key, number, mover, "", side)

    def _end(self, side: Side) -> bool:
        """Ends the look of a side; returns whether it has moved."""
        self._made.pop(side, None)
        _, mover = self._moving.pop(side, (0, None))
        if mover is not None:
            mover.stop()
        return mover is not None

    def stop(self) -> None:
        """Ends all of them, and the thread."""
        for side in tuple(self._moving):
            self._end(side)
        if self._worker is not None:
            self._worker.stop(0.0)

    def _make(self, scene: LiveScene) -> Future[Mover]:
        self._worker = self._worker or SerialWorker("live looks")
        made = self._worker.submit(Mover, scene, self._failed)
        made.add_done_callback(partial(_report, self._failed))
        return made

    @staticmethod
    def _ready(made: Made) -> Mover | None:
        return made.mover.result() if made.mover.done() and made.mover.exception() is None else None


def _report(failed: Callable[[str], None], made: Future[Mover]) -> None:
    error = made.exception()
    if isinstance(error, Exception):
        failed(failure("a look that is compared could not move live", error))
