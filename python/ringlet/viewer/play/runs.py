"""Runs of a shot, and takes: the frames of a timeline, each made by one of the runs."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ringlet.shot import Shot
from ringlet.viewer.play.frame_cache import FrameCache
from ringlet.viewer.play.stage import Stage
from ringlet.viewer.wire import join, split


class Swing(NamedTuple):
    """How the hair moved to a frame.

    tips, roots: mean speed of those of all locks [m/s]; NaN for a frame without one before
    kept:        fraction of the converged motion that the solver reached, estimated; NaN without contact
    """

    tips: float
    roots: float
    kept: float


@dataclass(frozen=True, eq=False)
class Run:
    """One run of a shot.

    number:        number of the run in the session, from 1
    text:          text of the shot
    restart_frame: frame of the checkpoint that it starts from; None for the start of the shot
    checkpoint:    state of the motion there
    stopping:      set to end it
    """

    number: int
    shot: Shot
    text: str
    stage: Stage
    restart_frame: int | None
    checkpoint: dict[str, NDArray[Any]] | None
    stopping: threading.Event
    frames: FrameCache = field(default_factory=FrameCache)
    swings: dict[float, Swing] = field(default_factory=dict)

    def add(self, frame: float, message: bytes, swing: Swing) -> None:
        """Stores a frame; raises UserError when the disk is full."""
        self.frames.add(frame, message)
        self.swings[frame] = swing


class Take:
    """Frames of a timeline.

    made:   of each frame, the run that made it
    frames: their numbers, shape (k,)
    """

    def __init__(self, made: Mapping[float, Run]) -> None:
        self.made, self.frames = made, np.array(sorted(made), np.float64)

    @property
    def last(self) -> Run:
        """The newest run that made a frame; there must be one."""
        return max(self.made.values(), key=lambda run: run.number)

    def message(self, frame: float) -> bytes:
        """Message of a frame; raises UserError when it cannot be read."""
        return self.made[frame].frames.message(frame)

    @property
    def runs(self) -> NDArray[np.int32]:
        """Number of the run of each frame, shape (k,)."""
        return np.array([self.made[frame].number for frame in self.frames], np.int32)

    @property
    def swings(self) -> NDArray[np.float32]:
        """Speeds of tips and roots, and the motion kept, of each frame (see ``Swing``), shape (k, 3)."""
        return np.array([self.made[frame].swings[frame] for frame in self.frames], np.float32).reshape(-1, 3)

    def stale(self, shot: Shot) -> NDArray[np.bool_]:
        """Which frames were made with other settings than those of a shot, shape (k,)."""
        other = {run.number: inputs(run.shot) != inputs(shot) for run in {*self.made.values()}}
        return np.array([other[self.made[frame].number] for frame in self.frames], bool)

    def up_to(self, frame: float | None) -> Take:
        """The frames up to one; none for None."""
        return Take({one: run for one, run in self.made.items() if frame is not None and one <= frame})

    def with_frame(self, frame: float, run: Run) -> Take:
        """The take with a frame that a run has made."""
        return Take({**self.made, frame: run})


class ComparedTake:
    """The frames of a take as those that the timeline is compared with."""

    def __init__(self, take: Take) -> None:
        self.take, self.frames = take, take.frames

    def message(self, frame: float) -> bytes:
        """Message of a frame; raises UserError when it cannot be read."""
        header, arrays = split(self.take.message(frame))
        return join({**header, "layer": "against"}, arrays)


def inputs(shot: Shot) -> dict[str, Any]:
    """Settings of a shot that its frames depend on."""
    return shot.model_dump(exclude={"frames"})
