"""A shot that runs beside the page: frame by frame, held and gone on with, or run again from a frame that is there."""

from __future__ import annotations

import logging
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
from ringlet.groom import Groom, Hairs
from ringlet.shot import Shot
from ringlet.sim.motion import Motion
from ringlet.viewer import overlays, protocol
from ringlet.viewer.looks import spread_order
from ringlet.viewer.reel import Run
from ringlet.viewer.scene import Moved, Seen
from ringlet.viewer.wire import pack

MOST_KEPT = 1_500_000_000  # bytes of what frames can be gone on from

log = logging.getLogger("ringlet.viewer")


@dataclass
class Stage:
    """What is seen with the locks while they move: hairs, bodies and how those move."""

    groom: Groom
    hairs: Hairs | None
    clip: Clip
    bodies: list[Seen]
    _one: threading.Lock = field(default_factory=threading.Lock, init=False)  # who works in the room for all hairs

    @cached_property
    def _room(self) -> NDArray[np.float32] | None:
        return self.hairs.room() if self.hairs is not None else None

    @cached_property
    def turning(self) -> NDArray[np.float64]:
        """How the groomed locks turn."""
        return overlays.turning(self.groom.locks, self.groom.locks.points)

    def frame(
        self,
        layer: str,
        frame: float,
        moved: Moved,
        motion: Motion | None = None,
    ) -> bytes:
        """The message of a frame; what touches is known while ``motion`` is there."""
        points, statistics, cloths = moved
        axis, root, left = np.empty(0), np.empty(0), np.empty((0, 0), np.uint8)
        corners, locks = self.clip.at(frame), self.groom.locks
        bodies = [seen.at(frame, cloths) for seen in self.bodies]
        if self.hairs is not None:
            carriage = self.hairs.carriage(corners)
            order = spread_order(carriage["first"])
            axis, root = carriage["axis"], carriage["root"][order]
            beside = [(at, seen.mesh.triangles) for at, seen in zip(bodies, self.bodies, strict=True)]
            with self._one:
                left = self.hairs.left_beside(points, carriage, beside, room=self._room)[order]
        drawn = np.flatnonzero((left < 255).any(axis=1))
        kept, contact, depth = told(statistics), np.empty(0), np.empty(0)
        if motion is not None:
            contact = overlays.contact(motion)
            depth = np.concatenate(list(overlays.depths(self.groom.scalp, corners, locks, points)))
            kept["inside"] = int(np.count_nonzero(depth))
        return pack(
            protocol.Frame.model_validate({"layer": layer, "frame": frame, "statistics": kept}),
            points=points,
            axis=axis,
            root=root,
            drawn=drawn,
            left=left[drawn],
            bodies=np.concatenate([np.empty((0, 3)), *bodies]),
            stretch=overlays.stretch(locks, points),
            contact=contact,
            depth=overlays.as_bytes(depth / overlays.DEPTH_SHOWN),
            curl=overlays.curl_loss(locks, self.turning, points),
        )


def told(statistics: dict[str, Any]) -> dict[str, Any]:
    """The numbers of a frame that are kept in sight."""
    contact = statistics.get("contact", {})
    return {
        "wall_ms": statistics.get("wall_ms"),
        "max_stretch": statistics.get("max_stretch"),
        "newton": statistics.get("newton"),
        "nan": statistics.get("nan", 0),
        "contacts": contact.get("contacts"),
        "inside": None,
    }


class Simulation:
    """Runs in a thread of its own.

    run:     keeps the frames
    changed: called when the state has changed
    failed:  called with what went wrong
    """

    def __init__(self, run: Run, changed: Callable[[], None], failed: Callable[[str], None]) -> None:
        self._kept, self._changed, self._failed = run, changed, failed
        self.state = "still"
        self.rolled = 0
        self.key = 0
        self._go = threading.Event()
        self._end = threading.Event()
        self._thread: threading.Thread | None = None
        self._memories: dict[int, dict[str, NDArray[Any]]] = {}

    def start(self, shot: Shot, stage: Stage, again_from: int | None = None) -> None:
        """Runs a shot from its start, or from a frame that was reached before, with what it says now."""
        self.stop()
        memory = None
        if again_from is not None:
            there = [frame for frame in self._memories if frame <= again_from]
            if not there:
                raise UserError(f"shot: frame {again_from} cannot be gone on from; run it from its start")
            again_from = max(there)
            memory = self._memories[again_from]
            self._memories = {frame: kept for frame, kept in self._memories.items() if frame <= again_from}
        else:
            self._memories = {}
        self._kept.cut(again_from)
        self.rolled, self.key, self.state = 0, self.key + 1, "rolling"
        self._end.clear()
        self._go.set()
        self._thread = threading.Thread(target=self._run, args=(shot, stage, again_from, memory), daemon=True)
        self._thread.start()
        self._changed()

    def pause(self) -> None:
        """Holds after the frame that is being computed."""
        if self.state in ("rolling", "running"):
            self._go.clear()
            self.state = "paused"
            self._changed()

    def go_on(self) -> None:
        """Goes on from where it was held."""
        if self.state == "paused":
            self.state = "running"
            self._go.set()
            self._changed()

    def stop(self) -> None:
        """Ends it; frames that are there stay."""
        self._end.set()
        self._go.set()
        if self._thread is not None:
            self._thread.join(timeout=60.0)
        self._thread = None

    def reset(self) -> None:
        """Forgets all frames."""
        self._memories.clear()
        self._kept.cut()
        self.state, self.rolled, self.key = "still", 0, self.key + 1

    def _run(self, shot: Shot, stage: Stage, again_from: int | None, memory: dict[str, NDArray[Any]] | None) -> None:
        try:
            self._simulate(shot, stage, again_from, memory)
        except UserError as error:
            self.state = "still"
            self._failed(str(error))
        except Exception as error:
            log.exception("a shot could not be run")
            self.state = "still"
            self._failed(f"this is a mistake in Ringlet ({error}); see the terminal")
        self._changed()

    def _simulate(
        self, shot: Shot, stage: Stage, again_from: int | None, memory: dict[str, NDArray[Any]] | None
    ) -> None:
        first, last = shot.frames
        motion = api.start_motion(shot, stage.groom)
        if memory is not None:
            motion.recall(memory)
        begin = 0 if again_from is None else shot.preroll + again_from - first + 1
        for step in range(begin, shot.preroll + last - first + 1):
            self._go.wait()
            if self._end.is_set():
                return
            k = step - shot.preroll
            statistics = motion.advance(first + max(k - 1, 0), first + max(k, 0))
            if k < 0:
                self.rolled = step + 1
            else:
                self._keep(first + k, motion)
                if self.state == "rolling":
                    self.state = "running"
                cloths = {worn.name: worn.cloth.positions for worn in motion.worn}
                moved = Moved(np.asarray(motion.strands.positions, np.float32), statistics, cloths)
                self._kept.add(first + k, stage.frame("shot", first + k, moved, motion))
            self._changed()
        self.state = "done"

    def _keep(self, frame: int, motion: Motion) -> None:
        memory = {name: np.array(values) for name, values in motion.memory.items()}
        self._memories[frame] = memory
        size = sum(values.nbytes for values in memory.values())
        while len(self._memories) > 1 and size * len(self._memories) > MOST_KEPT:
            del self._memories[min(self._memories)]
