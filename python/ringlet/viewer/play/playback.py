"""Playback of a shot or a cache: simulate, pause, restart from a frame, and compare with another cache."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import partial
from itertools import count
from pathlib import Path

import numpy as np

from ringlet.api.caches import scalp_clip
from ringlet.data.digest import digest
from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip
from ringlet.viewer import protocol
from ringlet.viewer.files.compared_settings import changes, settings_of_text
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.play.frame_cache import FileFrames, FrameSource, ReplacedError, WatchedFile
from ringlet.viewer.play.runs import ComparedTake, Take
from ringlet.viewer.play.simulation import Simulation
from ringlet.viewer.play.stage import Stage
from ringlet.viewer.publisher import Publisher
from ringlet.viewer.show.display_groom import DisplayGroom
from ringlet.viewer.show.scene import FrameState, ReadFrame, open_frames
from ringlet.viewer.show.viewport import Viewport
from ringlet.viewer.wire import pack, trouble

PackFrame = Callable[[float, FrameState], bytes]  # packs the number and contents of a frame into a message

MAX_GROOMS = 4  # grooms of a shot whose simulated frames are kept
KEYS_PER_GROOM = 1_000_000  # distance of the keys of timelines of two grooms
MAX_OPEN_TRIES = 20  # attempts to open a file that is being replaced


class Playback:
    """The timeline of a session: simulated frames, frames of a cache, and frames to compare with.

    call:   runs a function on the thread that owns the publisher
    failed: reports an error message
    """

    def __init__(
        self,
        files: Files,
        publisher: Publisher,
        viewport: Viewport,
        call: Callable[..., None],
        failed: Callable[[str], None],
    ) -> None:
        self._files, self._publisher, self._viewport = files, publisher, viewport
        self._call, self._failed = call, failed
        self._shown, self._compared_frames = OpenFrames(), OpenFrames()
        self._stage: Stage | None = None
        self._against = ""
        self._compared: protocol.Compared | None = None
        self._replaced = 0
        self._span: tuple[float, float] | None = None
        self._numbers = count(1)
        self._kept: dict[
            str, tuple[DisplayGroom, Simulation]
        ] = {}  # by the digest of the groom, the last one at the end
        self._simulation = self._new_simulation()

    def _new_simulation(self) -> Simulation:
        changed, failed = partial(self._call, self.publish_timeline), partial(self._call, self._failed)
        return Simulation(lambda: next(self._numbers), changed, failed)

    def stop(self) -> None:
        """Stops the simulation and closes the open files."""
        self._simulation.stop(patience=1.0)
        self._shown.close()
        self._compared_frames.close()

    def frame_sources(self, message: protocol.Watch) -> dict[str, Callable[[], bytes | None]]:
        """Functions that make the messages of the requested frames that exist, by subject."""
        messages: dict[str, Callable[[], bytes | None]] = {}
        for layer, frames in (("shot", message.shot), ("against", message.against)):
            messages |= {
                f"{layer}/{frame:g}": partial(self._frame, layer, frame)
                for frame in frames
                if self._source_of(layer, frame) is not None
            }
        return messages

    def _source_of(self, layer: str, frame: float) -> FrameSource | None:
        """What has a frame now; None where it does not exist."""
        source = self._shot if layer == "shot" else self._compared_frames.source
        return source if source is not None and (source.frames == frame).any() else None

    def _frame(self, layer: str, frame: float) -> bytes | None:
        """Message of a frame, or an error message; None for one that has gone, or of a replaced file."""
        source = self._source_of(layer, frame)
        if source is None:
            return None
        try:
            return source.message(frame)
        except ReplacedError:
            self._call(self._reopen, source)
            return None
        except UserError as error:
            return trouble(str(error))

    def _reopen(self, source: FrameSource) -> None:
        """Reopens a replaced file and announces its frames; ignores a source that is no longer open."""
        for opened in (self._shown, self._compared_frames):
            if opened.source is not source:
                continue
            self._replaced += 1
            try:
                opened.reopen()
            except UserError as error:
                self._failed(str(error))
                if opened is self._compared_frames:
                    self.set_comparison(protocol.Against())
            self.publish_timeline()

    @property
    def _shot(self) -> FrameSource | None:
        return self._simulation.take if self._files.mode == "shot" else self._shown.source

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
                raise UserError("shot: its groom is still being made; wait until it is shown")
            restart_frame = message.frame if message.action == "again_from" else None
            self._viewport.show_bodies(shot, self._stage.groom)
            self._stage.bodies = self._viewport.bodies
            self._stage.clip = scalp_clip(self._stage.groom, shot.frames)
            self._simulation.start(shot, self._files.document("shot").text, self._stage, restart_frame)

    def set_groom(self, display: DisplayGroom) -> None:
        """Sets the groom of the shot. Another groom has other frames; those of the last grooms come back with them."""
        if self._stage is None or self._stage.groom.locks.points is not display.groom.locks.points:
            self._switch_simulation(display)
            if not isinstance(self._compared_frames.source, ComparedTake):
                self._compared_frames.close()
                self._against = ""
            try:
                self._viewport.show_bodies(self._files.shot, display.groom)
            except UserError as error:  # starting the shot raises it again
                self._failed(str(error))
            clip = scalp_clip(display.groom, self._files.shot.frames)
            self._stage = Stage(display.groom, display.hairs, clip, self._viewport.bodies)
        self.publish_timeline()

    def _switch_simulation(self, display: DisplayGroom) -> None:
        """Shows the frames that were simulated of a groom, or none yet."""
        groom = digest(display.groom.locks.points, display.groom.locks.ids)
        if groom in self._kept and self._kept[groom][1] is self._simulation:
            return
        self._simulation.set_aside()
        self._replaced += KEYS_PER_GROOM
        _, self._simulation = self._kept.pop(groom, None) or (display, self._new_simulation())
        self._kept[groom] = display, self._simulation
        while len(self._kept) > MAX_GROOMS:
            del self._kept[next(iter(self._kept))]

    def read(self, display: DisplayGroom) -> None:
        """Opens the frames of a USD file; does nothing for a file without frames."""
        static_clip = Clip(np.zeros(1), display.groom.scalp.points[None], 24.0)
        clip = scalp_clip(display.groom) if display.groom.scalp_file else static_clip
        self._stage = Stage(display.groom, display.hairs, clip, self._viewport.bodies)
        try:
            self._shown.open(self._files.file, display, partial(self._stage.frame, "shot"))
        except UserError:  # a static groom
            return
        self.publish_timeline()

    def set_comparison(self, message: protocol.Against) -> None:
        """Shows the frames of a cache, or of an earlier take, next to those of the shot, or no more.

        Raises UserError before the groom is made, for a file that is no cache of that groom, and for no kept take.
        """
        self._compared_frames.close()
        self._viewport.clear_compared()
        self._against, settings = "", {}
        if message.run:
            take, display = self._take(message.run)
            self._compared_frames.source = ComparedTake(take)
            self._against, settings = f"run {message.run}", settings_of_text(take.last.text)
            self._viewport.show(display, "b")
        elif message.name:
            stage, display = self._stage, self._viewport.display
            if stage is None or display is None:
                raise UserError("shot: its groom is still being made; wait until it is shown")
            file = self._files.project.inside(message.name, "against")
            self._compared_frames.open(file, display, partial(stage.frame, "against"))
            self._against = message.name
            self._viewport.show(display, "b")
        compared = protocol.Compared(side="b", name=self._against, settings=settings)
        self._publisher.publish("b/none", pack(compared))
        self.publish_timeline()

    def text_of_run(self, number: int) -> str:
        """Text of the shot of an earlier take; raises UserError for one that is not kept."""
        return self._take(number)[0].last.text

    def _take(self, number: int) -> tuple[Take, DisplayGroom]:
        for take, display in self._takes():
            if take.last.number == number:
                return take, display
        raise UserError(f"shot: run {number} is not kept; choose one that the timeline lists")

    def _takes(self) -> Iterator[tuple[Take, DisplayGroom]]:
        """Earlier takes with other settings or of other grooms, that can be shown next to the timeline."""
        if self._stage is None:
            return
        for display, simulation in self._kept.values():
            if np.array_equal(display.groom.origin, self._stage.groom.origin):
                current = simulation is self._simulation or not simulation.take.made
                yield from ((take, display) for take in simulation.takes.values())
                if not current:
                    yield simulation.take, display

    def publish_timeline(self) -> None:
        """Publishes the list of frames and the state of the simulation."""
        if self._files.mode == "shot":
            shot = self._files.shot
            first, last, preroll = float(shot.frames[0]), float(shot.frames[1]), shot.preroll
        else:
            if self._shown.source is not None:
                self._span = float(self._shown.source.frames[0]), float(self._shown.source.frames[-1])
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
                "kept": self._kept_runs() if runs else [],
            }
        )
        take = simulation.take if runs else Take({})
        frames = take.frames if runs or self._shown.source is None else self._shown.source.frames
        compared = self._compared_frames.source
        swings = compared.take.swings if isinstance(compared, ComparedTake) else np.empty((0, 3))
        self._publisher.publish(
            "timeline",
            pack(
                timeline,
                frames=frames,
                against_frames=compared.frames if compared else np.empty(0),
                runs=take.runs if runs else np.zeros(len(frames)),
                stale=take.stale(self._files.shot) if runs else np.zeros(len(frames)),
                swings=take.swings,
                against_swings=swings,
            ),
        )
        if runs:
            now = protocol.Compared(side="a", name="now", settings=settings_of_text(self._files.document("shot").text))
            self._publish_settings(now)

    def _publish_settings(self, now: protocol.Compared) -> None:
        """Publishes the settings of the shot while an earlier take is compared with it."""
        if isinstance(self._compared_frames.source, ComparedTake) and now != self._compared:
            self._publisher.publish("a/none", pack(now))
            self._compared = now

    def _kept_runs(self) -> list[protocol.KeptRun]:
        """Earlier takes, the oldest first."""
        text, found = self._files.document("shot").text, []
        for take, _ in self._takes():
            run = take.last
            found.append(
                protocol.KeptRun(
                    number=run.number,
                    first=take.frames[0],
                    last=take.frames[-1],
                    contact=run.shot.touching is not None,
                    same_groom=take in self._simulation.takes.values(),
                    changes=changes(settings_of_text(run.text), settings_of_text(text)),
                )
            )
        return sorted(found, key=lambda one: one.number)


class OpenFrames:
    """The frames of a file that stays open during playback."""

    def __init__(self) -> None:
        self._files = ExitStack()
        self._lock = threading.Lock()
        self._arguments: tuple[Path, DisplayGroom, PackFrame] | None = None
        self.source: FrameSource | None = None

    def open(self, file: Path, display: DisplayGroom, pack: PackFrame) -> None:
        """Opens a file with frames of a displayed groom; closes the previous one.

        Raises UserError for a file without frames of that groom.
        """
        self.close()
        self._arguments = file, display, pack
        with self._lock:
            watched, frames, read = self._open_unchanged(file, display)
        if len(frames):
            self.source = FileFrames(watched, frames, read, pack, self._lock)

    def reopen(self) -> None:
        """Opens the current file at the path that was opened."""
        if self._arguments is not None:
            self.open(*self._arguments)

    def _open_unchanged(self, file: Path, display: DisplayGroom) -> tuple[WatchedFile, np.ndarray, ReadFrame]:
        """Opens a file; tries again when it is replaced meanwhile.

        Raises UserError after ``MAX_OPEN_TRIES`` replacements.
        """
        for _ in range(MAX_OPEN_TRIES):
            watched = WatchedFile(file)
            try:
                frames, read = self._files.enter_context(open_frames(file, display))
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
        self.source = None
        self._files.close()
