"""Playback of a shot or a cache: simulate, pause, restart from a frame, and compare with another cache."""

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

PackFrame = Callable[[float, Moved], bytes]  # packs the number and contents of a frame into a message

MAX_OPEN_TRIES = 20  # attempts to open a file that is being replaced


class Playing:
    """The timeline of a session: simulated frames, frames of a cache, and frames to compare with.

    call:   runs a function on the thread that owns the board
    failed: reports an error message
    """

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
        self._run, self._shown, self._beside = Run(), OpenFrames(), OpenFrames()
        self._stage: Stage | None = None
        self._against = ""
        self._replaced = 0
        self._span: tuple[float, float] | None = None
        self._simulation = Simulation(
            self._run,
            lambda: call(self.post_timeline),
            lambda message: call(failed, message),
        )

    def stop(self) -> None:
        """Stops the simulation and closes the open files."""
        self._simulation.stop()
        self._shown.close()
        self._beside.close()

    def frame_sources(self, message: protocol.Watch) -> dict[str, Callable[[], bytes | None]]:
        """Functions that make the messages of the requested frames that exist, by subject."""
        sources: dict[str, Callable[[], bytes | None]] = {}
        for layer, reel, frames in (
            ("shot", self._shot, message.shot),
            ("against", self._beside.reel, message.against),
        ):
            if reel is not None:
                existing = set(reel.frames.tolist())
                sources |= {
                    f"{layer}/{frame:g}": partial(self._frame, reel, frame) for frame in frames if frame in existing
                }
        return sources

    def _frame(self, reel: Reel, frame: float) -> bytes | None:
        """Message of a frame, or an error message; None for a frame of a replaced file."""
        try:
            return reel.message(frame)
        except ReplacedError:
            self._call(self._reopen, reel)
            return None
        except UserError as error:
            return trouble(str(error))

    def _reopen(self, reel: Reel) -> None:
        """Reopens a replaced file and announces its frames; ignores a reel that is no longer open."""
        for opened in (self._shown, self._beside):
            if opened.reel is not reel:
                continue
            self._replaced += 1
            try:
                opened.reopen()
            except UserError as error:
                self._failed(str(error))
                if opened is self._beside:
                    self.set_comparison("")
            self.post_timeline()

    @property
    def _shot(self) -> Reel | None:
        return self._run if self._files.mode == "shot" else self._shown.reel

    def play(self, message: protocol.Play) -> None:
        """Starts, pauses, resumes or restarts the simulation of the shot.

        Raises UserError before the groom of the shot is made.
        """
        if message.action == "pause":
            self._simulation.pause()
        elif message.action == "go_on":
            self._simulation.resume()
        else:
            shot = self._files.shot
            if self._stage is None:
                raise UserError("shot: its groom is not made yet; wait until it is seen")
            restart_frame = message.frame if message.action == "again_from" else None
            self._showing.show_bodies(shot, self._stage.groom)
            self._stage.bodies = self._showing.bodies
            self._simulation.start(shot, self._stage, restart_frame)

    def set_groom(self, look: Look) -> None:
        """Sets the groom of the shot; another groom discards all frames."""
        if self._stage is None or self._stage.groom.locks.points is not look.groom.locks.points:
            self._simulation.stop()
            self._simulation.reset()
            self._beside.close()
            self._against = ""
            try:
                self._showing.show_bodies(self._files.shot, look.groom)
            except UserError as error:  # starting the shot raises it again
                self._failed(str(error))
            self._stage = Stage(look.groom, look.hairs, api.scalp_clip(look.groom), self._showing.bodies)
        self.post_timeline()

    def read(self, look: Look) -> None:
        """Opens the frames of a USD file; does nothing for a file without frames."""
        static_clip = Clip(np.zeros(1), look.groom.scalp.points[None], 24.0)
        clip = api.scalp_clip(look.groom) if look.groom.scalp_file else static_clip
        self._stage = Stage(look.groom, look.hairs, clip, self._showing.bodies)
        try:
            self._shown.open(self._files.file, look, partial(self._stage.frame, "shot"))
        except UserError:  # a static groom
            return
        self.post_timeline()

    def set_comparison(self, name: str) -> None:
        """Shows the frames of a cache beside the shot; an empty name removes them.

        Raises UserError before the groom is made, and for a file that is no cache of that groom.
        """
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
        self.post_timeline()

    def post_timeline(self) -> None:
        """Posts the list of frames and the state of the simulation."""
        if self._files.mode == "shot":
            shot = self._files.shot
            first, last, preroll = float(shot.frames[0]), float(shot.frames[1]), shot.preroll
        else:
            if self._shown.reel is not None:
                self._span = float(self._shown.reel.frames[0]), float(self._shown.reel.frames[-1])
            if self._span is None:  # static
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


class OpenFrames:
    """The frames of a file that stays open during playback."""

    def __init__(self) -> None:
        self._files = ExitStack()
        self._lock = threading.Lock()
        self._arguments: tuple[Path, Look, PackFrame] | None = None
        self.reel: Reel | None = None

    def open(self, file: Path, look: Look, pack: PackFrame) -> None:
        """Opens a file with frames of a look; closes the previous one.

        Raises UserError for a file without frames of that look.
        """
        self.close()
        self._arguments = file, look, pack
        with self._lock:
            watched, frames, read = self._open_unchanged(file, look)
        if len(frames):
            self.reel = Read(watched, frames, read, pack, self._lock)

    def reopen(self) -> None:
        """Opens the current file at the path that was opened."""
        if self._arguments is not None:
            self.open(*self._arguments)

    def _open_unchanged(self, file: Path, look: Look) -> tuple[Watched, np.ndarray, ReadFrame]:
        """Opens a file; tries again when it is replaced meanwhile.

        Raises UserError after ``MAX_OPEN_TRIES`` replacements.
        """
        for _ in range(MAX_OPEN_TRIES):
            watched = Watched(file)
            try:
                frames, read = self._files.enter_context(open_frames(file, look))
            except UserError:
                if watched.unchanged():
                    raise
                continue
            if watched.unchanged():
                return watched, frames, read
            self._files.close()
        raise UserError(f"{file.name}: is replaced again and again; open it when it is done")

    def close(self) -> None:
        """Closes the file."""
        self.reel = None
        self._files.close()
