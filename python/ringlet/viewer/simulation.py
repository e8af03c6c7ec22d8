"""Simulation of a shot in a thread: start, pause, resume, and restart from an existing frame."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import api
from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip
from ringlet.data.precision import compact
from ringlet.groom import AnyHairs, Groom
from ringlet.shot import Shot
from ringlet.sim.motion import Motion
from ringlet.viewer import overlays, protocol
from ringlet.viewer.display_groom import spread_order
from ringlet.viewer.frame_cache import FrameCache
from ringlet.viewer.scene import FrameState, VisibleMesh
from ringlet.viewer.wire import pack
from ringlet.viewer.worker import report_mistake

MAX_CHECKPOINT_BYTES = 1_500_000_000  # memory for the checkpoints of frames


@dataclass
class Stage:
    """The scene of a simulation: groom, hairs, animated scalp and bodies."""

    groom: Groom
    hairs: AnyHairs | None
    clip: Clip
    bodies: list[VisibleMesh]
    _lock: threading.Lock = field(default_factory=threading.Lock, init=False)  # guards the buffer of hairs

    @cached_property
    def _buffer(self) -> NDArray[np.float32] | None:
        return self.hairs.new_buffer() if self.hairs is not None else None

    @cached_property
    def turning(self) -> NDArray[np.float64]:
        """Turning of the groomed locks [rad], shape (n,)."""
        return overlays.turning(self.groom.locks, self.groom.locks.points)

    def frame(
        self,
        layer: str,
        frame: float,
        state: FrameState,
        motion: Motion | None = None,
    ) -> bytes:
        """Message of a frame; contact and depth need ``motion``."""
        points, statistics, _ = state
        axis, root, left = np.empty(0), np.empty(0), np.empty((0, 0), np.uint8)
        corners, locks = self.clip.at(frame), self.groom.locks
        bodies = [body.at(frame, state) for body in self.bodies]
        if self.hairs is not None:
            deformation = self.hairs.deformation(corners)
            order = spread_order(deformation["first"])
            axis, root = deformation["axis"], deformation["root"][order]
            beside = [(at, body.mesh.triangles) for at, body in zip(bodies, self.bodies, strict=True)]
            with self._lock:
                left = self.hairs.offset_fractions(points, deformation, beside, buffer=self._buffer)[order]
        drawn = np.flatnonzero((left < 255).any(axis=1))
        shown, contact, depth = shown_statistics(statistics), np.empty(0), np.empty(0)
        if motion is not None:
            contact = overlays.contact(motion)
            depth = np.concatenate(list(overlays.depths(self.groom.scalp, corners, locks, points)))
            shown["inside"] = int(np.count_nonzero(depth))
        return pack(
            protocol.Frame.model_validate({"layer": layer, "frame": frame, "statistics": shown}),
            points=points - self.groom.origin,
            axis=axis,
            root=root,
            drawn=drawn,
            left=left[drawn],
            bodies=np.concatenate([np.empty((0, 3)), *bodies]) - self.groom.origin,
            stretch=overlays.stretch(locks, points),
            contact=contact,
            depth=overlays.as_bytes(depth / overlays.DEPTH_SHOWN),
            curl=overlays.curl_loss(locks, self.turning, points),
        )


def shown_statistics(statistics: dict[str, Any]) -> dict[str, Any]:
    """Statistics of a frame that the page displays."""
    contact = statistics.get("contact", {})
    return {
        "wall_ms": statistics.get("wall_ms"),
        "max_stretch": statistics.get("max_stretch"),
        "newton": statistics.get("newton"),
        "nan": statistics.get("nan", 0),
        "contacts": contact.get("contacts"),
        "inside": None,
    }


@dataclass(frozen=True)
class Run:
    """One run of a shot.

    restart_frame: frame of the checkpoint that it starts from; None for the start of the shot
    checkpoint:    state of the motion there
    number:        number of the run, from 1
    stopping:      set to end it
    """

    shot: Shot
    stage: Stage
    restart_frame: int | None
    checkpoint: dict[str, NDArray[Any]] | None
    number: int
    stopping: threading.Event


class Simulation:
    """A simulation thread.

    frames:  stores the frames
    changed: called after a change of the state
    failed:  called with an error message, or with a warning of long work
    """

    def __init__(self, frames: FrameCache, changed: Callable[[], None], failed: Callable[[str], None]) -> None:
        self._frames, self._changed, self._failed = frames, changed, failed
        self.state = "still"
        self.rolled = 0
        self.key = 0
        self._running = threading.Event()
        self._stopping = threading.Event()  # of the current run
        self._thread: threading.Thread | None = None
        self._results = threading.Lock()  # guards frames and checkpoints: a run that is stopped adds no more
        self._checkpoints: dict[int, dict[str, NDArray[Any]]] = {}
        self._runs: list[Shot] = []  # shot of each run
        self._run_of: dict[float, int] = {}  # number of the run of each frame

    def start(self, shot: Shot, stage: Stage, restart_frame: int | None = None) -> None:
        """Simulates a shot with its current settings, from the start or from a checkpoint.

        restart_frame: restarts from the last checkpoint up to this frame

        Raises UserError when there is no such checkpoint.
        """
        previous = self._thread
        self.stop()
        checkpoint = None
        if restart_frame is not None:
            earlier = [frame for frame in self._checkpoints if frame <= restart_frame]
            if not earlier:
                raise UserError(f"shot: frame {restart_frame} cannot be gone on from; run it from its start")
            restart_frame = max(earlier)
            checkpoint = self._checkpoints[restart_frame]
            self._checkpoints = {frame: kept for frame, kept in self._checkpoints.items() if frame <= restart_frame}
        else:
            self._checkpoints = {}
        self._frames.truncate(restart_frame)
        self.rolled, self.key, self.state = 0, self.key + 1, "rolling"
        self._stopping = threading.Event()
        self._running.set()
        self._runs.append(shot)
        run = Run(shot, stage, restart_frame, checkpoint, len(self._runs), self._stopping)
        self._thread = threading.Thread(target=self._run, args=(run, previous), daemon=True)
        self._thread.start()
        self._changed()

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

    def origins(self, shot: Shot) -> tuple[NDArray[np.int32], NDArray[np.bool_]]:
        """Number of the run that made each frame, and whether it ran with other settings than those of a shot."""
        runs = np.array([self._run_of.get(frame, 0) for frame in self._frames.frames.tolist()], np.int32)
        other = np.array([False, *(_inputs(run) != _inputs(shot) for run in self._runs)])
        return runs, other[runs]

    def _run(self, run: Run, previous: threading.Thread | None) -> None:
        """Simulates once the thread of the previous run has ended."""
        if previous is not None:
            previous.join()
        try:
            self._simulate(run)
        except UserError as error:
            self._fail(str(error), run.stopping)
        except Exception as error:
            self._fail(report_mistake("a shot could not be run", error), run.stopping)
        self._changed()

    def _fail(self, message: str, stopping: threading.Event) -> None:
        if not stopping.is_set():
            self.state = "still"
            self._failed(message)

    def _simulate(self, run: Run) -> None:
        shot, stage, stopping = run.shot, run.stage, run.stopping
        first, last = shot.frames
        motion = api.start_motion(shot, stage.groom, on_warning=self._failed)
        if run.checkpoint is not None:
            motion.recall(run.checkpoint)
        begin = 0 if run.restart_frame is None else shot.preroll + run.restart_frame - first + 1
        for step in range(begin, shot.preroll + last - first + 1):
            self._running.wait()
            if stopping.is_set():
                return
            k = step - shot.preroll
            statistics = motion.reach(k)
            cloths = {garment.name: garment.cloth.positions for garment in motion.garments}
            state = FrameState(compact(motion.points(first + max(k, 0))), statistics, cloths)
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
                    self._frames.add(first + k, message)
                    self._run_of[float(first + k)] = run.number
            self._changed()
        self.state = "done"

    def _store_checkpoint(self, frame: int, motion: Motion) -> None:
        """Stores a checkpoint; removes the oldest ones beyond the memory limit."""
        checkpoint = {name: np.array(values) for name, values in motion.memory.items()}
        self._checkpoints[frame] = checkpoint
        size = sum(values.nbytes for values in checkpoint.values())
        while len(self._checkpoints) > 1 and size * len(self._checkpoints) > MAX_CHECKPOINT_BYTES:
            del self._checkpoints[min(self._checkpoints)]


def _inputs(shot: Shot) -> dict[str, Any]:
    """Settings of a shot that its frames depend on."""
    return shot.model_dump(exclude={"frames"})
