"""Simulation of a shot in a thread: start, pause, resume, and restart from an existing frame."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.api.shots import start_motion
from ringlet.data.errors import UserError, failure
from ringlet.data.precision import compact
from ringlet.shot import Shot
from ringlet.sim.motion import Motion
from ringlet.viewer.play.runs import Run, Swing, Take, inputs
from ringlet.viewer.play.stage import Stage
from ringlet.viewer.show.scene import FrameState

MAX_CHECKPOINT_BYTES = 1_500_000_000  # memory for the checkpoints of frames
MAX_TAKES = 8  # earlier takes of a groom that are kept


class Simulation:
    """A simulation thread, and the takes that it made of one groom.

    number:  gives the number of the next run
    changed: called after a change of the state
    failed:  called with an error message, or with a warning of long work
    take:    the frames of the timeline
    takes:   earlier takes with other settings, by the number of their last run
    """

    def __init__(self, number: Callable[[], int], changed: Callable[[], None], failed: Callable[[str], None]) -> None:
        self._number, self._changed, self._failed = number, changed, failed
        self.take = Take({})
        self.takes: dict[int, Take] = {}
        self.state = "still"
        self.rolled = 0
        self.key = 0
        self._running = threading.Event()
        self._stopping = threading.Event()  # of the current run
        self._thread: threading.Thread | None = None
        self._results = threading.Lock()  # guards frames and checkpoints: a run that is stopped adds no more
        self._checkpoints: dict[int, dict[str, NDArray[Any]]] = {}

    def start(self, shot: Shot, text: str, stage: Stage, restart_frame: int | None = None) -> None:
        """Simulates a shot with its current settings, from the start or from a checkpoint. Frames that other settings
        made are kept as an earlier take.

        text:          text of the shot
        restart_frame: restarts from the last checkpoint up to this frame

        Raises UserError when there is no such checkpoint.
        """
        previous = self._thread
        self.stop()
        checkpoint = None
        if restart_frame is not None:
            earlier = [frame for frame in self._checkpoints if frame <= restart_frame]
            if not earlier:
                raise UserError(f"shot: the run cannot continue from frame {restart_frame}; run it from its start")
            restart_frame = max(earlier)
            checkpoint = self._checkpoints[restart_frame]
            self._checkpoints = {frame: kept for frame, kept in self._checkpoints.items() if frame <= restart_frame}
        else:
            self._checkpoints = {}
        before, self.take = self.take, self.take.up_to(restart_frame)
        if len(self.take.made) < len(before.made):
            self._keep(before, shot)
        self.rolled, self.key, self.state = 0, self.key + 1, "rolling"
        self._stopping = threading.Event()
        self._running.set()
        run = Run(self._number(), shot, text, stage, restart_frame, checkpoint, self._stopping)
        self._thread = threading.Thread(target=self._run, args=(run, previous), daemon=True)
        self._thread.start()
        self._changed()

    def _keep(self, take: Take, shot: Shot) -> None:
        """Keeps an earlier take, unless a run of this shot makes the same frames again."""
        if inputs(take.last.shot) != inputs(shot):
            self.takes.setdefault(take.last.number, take)
            while len(self.takes) > MAX_TAKES:
                del self.takes[min(self.takes)]

    def pause(self) -> None:
        """Pauses after the current frame."""
        if self.state in ("rolling", "running"):
            self._running.clear()
            self.state = "paused"
            self._changed()

    def resume(self) -> None:
        """Resumes a paused simulation."""
        if self.state == "paused":
            self.state = "running"
            self._running.set()
            self._changed()

    def stop(self, patience: float = 0.0) -> None:
        """Stops the run after the frame in progress, which is dropped; existing frames stay.

        patience: how long to wait for that [s]
        """
        with self._results:
            self._stopping.set()
        self._running.set()
        if self._thread is not None and patience > 0.0:
            self._thread.join(patience)
        self._thread = None

    def set_aside(self) -> None:
        """Stops, and keeps what is needed to show the frames again and to go on from the last one."""
        self.stop()
        self._checkpoints = {frame: self._checkpoints[frame] for frame in sorted(self._checkpoints)[-1:]}
        if self.state != "done":
            self.state = "still"

    def _run(self, run: Run, previous: threading.Thread | None) -> None:
        """Simulates once the thread of the previous run has ended."""
        if previous is not None:
            previous.join()
        try:
            self._simulate(run)
        except Exception as error:
            self._fail(failure("a shot could not be run", error), run.stopping)
        self._changed()

    def _fail(self, message: str, stopping: threading.Event) -> None:
        if not stopping.is_set():
            self.state = "still"
            self._failed(message)

    def _simulate(self, run: Run) -> None:
        shot, stage, stopping = run.shot, run.stage, run.stopping
        first, last = shot.frames
        motion = start_motion(shot, stage.groom, on_warning=self._failed)
        if run.checkpoint is not None:
            motion.recall(run.checkpoint)
        before = None if run.restart_frame is None else np.array(motion.points(run.restart_frame))
        begin = 0 if run.restart_frame is None else shot.preroll + run.restart_frame - first + 1
        for step in range(begin, shot.preroll + last - first + 1):
            self._running.wait()
            if stopping.is_set():
                return
            k = step - shot.preroll
            statistics = motion.reach(k)
            cloths = {garment.name: garment.cloth.positions for garment in motion.garments}
            points = np.array(motion.points(first + max(k, 0)))  # the motion goes on in place
            state = FrameState(compact(points), statistics, cloths)
            message = stage.frame("shot", first + k, state, motion) if k >= 0 else b""
            with self._results:
                if stopping.is_set():
                    return
                if k < 0:
                    self.rolled = step + 1
                else:
                    self._store_checkpoint(first + k, motion)
                    if self.state == "rolling":
                        self.state = "running"
                    run.add(first + k, message, _swing(stage, before, points, statistics))
                    self.take = self.take.with_frame(first + k, run)
                    before = points
            self._changed()
        self.state = "done"

    def _store_checkpoint(self, frame: int, motion: Motion) -> None:
        """Stores a checkpoint; removes the oldest ones beyond the memory limit."""
        checkpoint = {name: np.array(values) for name, values in motion.memory.items()}
        self._checkpoints[frame] = checkpoint
        size = sum(values.nbytes for values in checkpoint.values())
        while len(self._checkpoints) > 1 and size * len(self._checkpoints) > MAX_CHECKPOINT_BYTES:
            del self._checkpoints[min(self._checkpoints)]


def _swing(
    stage: Stage, before: NDArray[np.float64] | None, now: NDArray[np.float64], statistics: dict[str, Any]
) -> Swing:
    """How the hair moved to a frame from the one before, if there is one."""
    tips, roots = (math.nan, math.nan) if before is None else stage.speeds(before, now)
    kept = statistics.get("contact", {}).get("motion_kept")
    return Swing(tips, roots, math.nan if kept is None else kept)
