"""The frames of a shot or a cache: run, held, run again from one that is there, and compared with others."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from pathlib import Path

import numpy as np

from ringlet import api
from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip
from ringlet.viewer import protocol
from ringlet.viewer.board import Board
from ringlet.viewer.files import Files
from ringlet.viewer.looks import Look
from ringlet.viewer.reel import Read, Reel, ReplacedError, Run, Watched
from ringlet.viewer.scene import Moved, ReadFrame, open_frames
from ringlet.viewer.showing import Showing
from ringlet.viewer.simulation import Simulation, Stage
from ringlet.viewer.wire import pack, trouble

PackFrame = Callable[[float, Moved], bytes]  # makes the message of a frame of its number and what it holds

TRIES = 20  # to open a file that is replaced again and again


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
        self._call, self._failed = call, failed
        self._run, self._shown, self._beside = Run(), Opened(), Opened()
        self._stage: Stage | None = None
        self._against = ""
        self._replaced = 0
        self._span: tuple[float, float] | None = None
        self._simulation = Simulation(
            self._run,
            lambda: call(self.tell),
            lambda message: call(failed, message),
        )

    def stop(self) -> None:
        """Ends what runs, and closes what is open."""
        self._simulation.stop()
        self._shown.close()
        self._beside.close()

    def wanted(self, message: protocol.Watch) -> dict[str, Callable[[], bytes | None]]:
        """What makes the messages of the frames that a page wants and that are there, by their subjects."""
        wanted: dict[str, Callable[[], bytes | None]] = {}
        for layer, reel, frames in (
            ("shot", self._shot, message.shot),
            ("against", self._beside.reel, message.against),
        ):
            if reel is not None:
                there = set(reel.frames.tolist())
                wanted |= {
                    f"{layer}/{frame:g}": partial(self._frame, reel, frame) for frame in frames if frame in there
                }
        return wanted

    def _frame(self, reel: Reel, frame: float) -> bytes | None:
        """The message of a frame, or what is wrong with it; nothing of a file that has been replaced."""
        try:
            return reel.message(frame)
        except ReplacedError:
            self._call(self._open_again, reel)
            return None
        except UserError as error:
            return trouble(str(error))

    def _open_again(self, reel: Reel) -> None:
        """Frames of a file that has been replaced are void: those that it has now are told of, unless they were."""
        for opened in (self._shown, self._beside):
            if opened.reel is not reel:
                continue
            self._replaced += 1
            try:
                opened.again()
            except UserError as error:
                self._failed(str(error))
                if opened is self._beside:
                    self.lay_against("")
            self.tell()

    @property
    def _shot(self) -> Reel | None:
        return self._run if self._files.mode == "shot" else self._shown.reel

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
            self._showing.dress(shot, self._stage.groom)
            self._stage.bodies = self._showing.bodies
            self._simulation.start(shot, self._stage, again)

    def set_groom(self, look: Look) -> None:
        """The groom of the shot has changed: frames of the one before are void."""
        if self._stage is None or self._stage.groom.locks.points is not look.groom.locks.points:
            self._simulation.stop()
            self._simulation.reset()
            self._beside.close()
            self._against = ""
            try:
                self._showing.dress(self._files.shot, look.groom)
            except UserError as error:  # it is told again when the shot is to run
                self._failed(str(error))
            self._stage = Stage(look.groom, look.hairs, api.scalp_clip(look.groom), self._showing.bodies)
        self.tell()

    def read(self, look: Look) -> None:
        """Opens the frames of a USD file, if it has some."""
        still = Clip(np.zeros(1), look.groom.scalp.points[None], 24.0)
        clip = api.scalp_clip(look.groom) if look.groom.scalp_file else still
        self._stage = Stage(look.groom, look.hairs, clip, self._showing.bodies)
        try:
            self._shown.open(self._files.file, look, partial(self._stage.frame, "shot"))
        except UserError:  # a groom that does not move
            return
        self.tell()

    def lay_against(self, name: str) -> None:
        """Shows the frames of a cache beside the shot."""
        self._beside.close()
        self._showing.clear_beside()
        self._against = ""
        if name:
            stage, look = self._stage, self._showing.look
            if stage is None or look is None:
                raise UserError("shot: its groom is not made yet; wait until it is seen")
            self._beside.open(self._files.project.inside(name, "against"), look, partial(stage.frame, "against"))
            self._against = name
            self._showing.show(look, "b")
        self._board.post("b/none", pack(protocol.Compared(name=name)))
        self.tell()

    def tell(self) -> None:
        """Tells everybody which frames there are, and what the simulation does."""
        if self._files.mode == "shot":
            shot = self._files.shot
            first, last, preroll = float(shot.frames[0]), float(shot.frames[1]), shot.preroll
        else:
            if self._shown.reel is not None:
                self._span = float(self._shown.reel.frames[0]), float(self._shown.reel.frames[-1])
            if self._span is None:  # it does not move
                return
            (first, last), preroll = self._span, 0
        simulation, runs = self._simulation, self._files.mode == "shot"
        timeline = protocol.Timeline.model_validate(
            {
                "first": first,
                "last": last,
                "fps": self._stage.clip.fps if self._stage else 24.0,
                "state": simulation.state if runs else "none",
                "rolled": simulation.rolled,
                "preroll": preroll,
                "key": simulation.key + self._replaced,
                "against": self._against,
            }
        )
        frames, beside = (reel.frames if reel else np.empty(0) for reel in (self._shot, self._beside.reel))
        self._board.post("timeline", pack(timeline, frames=frames, beside=beside))


class Opened:
    """The frames of a file, open as long as they may be looked at."""

    def __init__(self) -> None:
        self._files = ExitStack()
        self._one = threading.Lock()
        self._what: tuple[Path, Look, PackFrame] | None = None
        self.reel: Reel | None = None

    def open(self, file: Path, look: Look, pack: PackFrame) -> None:
        """Opens a file with the frames of a look, in place of the one before."""
        self.close()
        self._what = file, look, pack
        with self._one:
            watched, frames, read = self._whole(file, look)
        if len(frames):
            self.reel = Read(watched, frames, read, pack, self._one)

    def again(self) -> None:
        """Opens what is there now in the place of what was opened."""
        if self._what is not None:
            self.open(*self._what)

    def _whole(self, file: Path, look: Look) -> tuple[Watched, np.ndarray, ReadFrame]:
        """Opens a file, and not a part of it before and a part after it was replaced."""
        for _ in range(TRIES):
            watched = Watched(file)
            try:
                frames, read = self._files.enter_context(open_frames(file, look))
            except UserError:
                if watched.same():
                    raise
                continue
            if watched.same():
                return watched, frames, read
            self._files.close()
        raise UserError(f"{file.name}: is replaced again and again; open it when it is done")

    def close(self) -> None:
        """Closes the file."""
        self.reel = None
        self._files.close()
