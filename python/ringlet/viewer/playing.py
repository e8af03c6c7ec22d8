"""The frames of a shot or a cache: run, held, run again from one that is there, and compared with others."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ringlet import api
from ringlet.errors import UserError
from ringlet.mesh import Clip
from ringlet.viewer import protocol
from ringlet.viewer.board import Board
from ringlet.viewer.files import Files
from ringlet.viewer.looks import Look
from ringlet.viewer.scene import read_frames
from ringlet.viewer.showing import Showing
from ringlet.viewer.simulation import Simulation, Stage
from ringlet.viewer.wire import pack


class Playing:
    """What moves. ``call`` brings a function to the thread that owns the board; ``failed`` tells what went wrong."""

    def __init__(
        self,
        files: Files,
        board: Board,
        showing: Showing,
        call: Callable[..., None],
        failed: Callable[[str], None],
    ) -> None:
        self._files, self._board, self._showing = files, board, showing
        self._frames: np.ndarray | None = None
        self._stage: Stage | None = None
        self._against = ""
        self._simulation = Simulation(
            lambda subject, message: call(board.post, subject, message),
            lambda: call(self.tell),
            lambda message: call(failed, message),
        )

    def stop(self) -> None:
        """Ends what runs."""
        self._simulation.stop()

    def play(self, message: protocol.Play) -> None:
        """Runs the shot, holds it, or goes on with it."""
        if message.action == "pause":
            self._simulation.pause()
        elif message.action == "go_on":
            self._simulation.go_on()
        else:
            shot = self._files.shot
            if self._stage is None:
                raise UserError("shot: its groom is not made yet; wait until it is seen")
            again = message.frame if message.action == "again_from" else None
            for name in [n for n in self._board.subjects("frame/shot/") if again is None or frame_of(n) > again]:
                self._board.wipe(name)
            self._simulation.start(shot, self._stage, again)

    def set_groom(self, look: Look) -> None:
        """The groom of the shot has changed: frames of the one before are void."""
        if self._stage is None or self._stage.groom.locks.points is not look.groom.locks.points:
            self._simulation.stop()
            self._simulation.reset()
            self._board.wipe("frame/")
            self._against = ""
            self._stage = Stage(look.groom, look.hairs, api.scalp_clip(look.groom), self._showing.bodies)
        self.tell()

    def read(self, look: Look) -> None:
        """Reads the frames of a USD file, if it has some."""
        self._frames, moving = read_frames(self._files.file, look)
        if self._frames is None:
            return
        still = Clip(np.zeros(1), look.groom.scalp.points[None], 24.0)
        clip = api.scalp_clip(look.groom) if look.groom.scalp_file else still
        self._stage = Stage(look.groom, look.hairs, clip, self._showing.bodies)
        for frame, points, told in moving:
            self._board.post(f"frame/shot/{frame:g}", self._stage.frame("shot", frame, points, told))
        self.tell()

    def lay_against(self, name: str) -> None:
        """Shows the frames of a cache beside the shot."""
        self._board.wipe("frame/against/")
        self._showing.clear_beside()
        self._against = ""
        if name:
            cache = api.read_cache(self._files.project.inside(name, "against"))
            stage, look = self._stage, self._showing.look
            if stage is None or look is None or cache.points.shape[1] != len(stage.groom.locks.points):
                raise UserError(f"{name}: is of another groom than that of the shot; choose a cache of the same groom")
            self._against = name
            self._showing.show(look, "b")
            for k, frame in enumerate(cache.frames):
                told: dict[str, Any] = cache.statistics[k] if k < len(cache.statistics) else {}
                message = stage.frame("against", float(frame), cache.points[k], told)
                self._board.post(f"frame/against/{frame:g}", message)
        self._board.post("b/none", pack(protocol.Compared(name=name)))
        self.tell()

    def tell(self) -> None:
        """Tells everybody which frames there are, and what the simulation does."""
        if self._files.mode == "shot":
            shot = self._files.shot
            first, last, preroll = float(shot.frames[0]), float(shot.frames[1]), shot.preroll
        elif self._frames is not None:
            first, last, preroll = float(self._frames[0]), float(self._frames[-1]), 0
        else:
            return
        simulation, runs = self._simulation, self._files.mode == "shot"
        timeline = protocol.Timeline.model_validate(
            {
                "first": first,
                "last": last,
                "fps": self._stage.clip.fps if self._stage else 24.0,
                "ready": simulation.ready if runs else last,
                "state": simulation.state if runs else "none",
                "rolled": simulation.rolled,
                "preroll": preroll,
                "key": simulation.key,
                "against": self._against,
            }
        )
        self._board.post("timeline", pack(timeline))


def frame_of(subject: str) -> float:
    """The frame that a subject is about."""
    return float(subject.rsplit("/", 1)[1])
