"""Shared review session: one open file and its connected pages."""

from __future__ import annotations

import asyncio
import secrets
from collections import Counter
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from ringlet.api.schema import schema
from ringlet.data.errors import UserError
from ringlet.data.former_names import note
from ringlet.viewer import protocol
from ringlet.viewer.disk_changes import DiskChanges
from ringlet.viewer.edit.operator_list import operator_names
from ringlet.viewer.editing import Editing
from ringlet.viewer.files.document_message import document_message
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.files.problems import LIGHT, OF_OPENING, RECOVERED, RENAMED, ProblemList, dismiss
from ringlet.viewer.files.recovery import Recovery
from ringlet.viewer.files.saving import Saving
from ringlet.viewer.keep.comparer import Comparer
from ringlet.viewer.keep.reviewing import Reviewing
from ringlet.viewer.keep.sharing import Sharer
from ringlet.viewer.pages import Page, Pages
from ringlet.viewer.play.live_hair import LiveHair
from ringlet.viewer.play.lock_motion import LockMotions, Question
from ringlet.viewer.play.mover import LiveScene
from ringlet.viewer.play.playback import Playback
from ringlet.viewer.play.take_shot import FIRST, write_take_shot
from ringlet.viewer.project import Project
from ringlet.viewer.publisher import Publisher
from ringlet.viewer.show import display_colors
from ringlet.viewer.show.display_groom import DisplayGroom
from ringlet.viewer.show.grooming import Grooming
from ringlet.viewer.show.lights import live_rigs_of
from ringlet.viewer.show.rendering import Rendering
from ringlet.viewer.show.scene import read_scene, worn_meshes
from ringlet.viewer.show.stage_cameras import StageCameras
from ringlet.viewer.show.viewport import Viewport
from ringlet.viewer.wire import pack
from ringlet.viewer.worker import SerialWorker

PATIENCE = 1.0  # that the end of the server waits for work in progress [s]


@cache
def schemas() -> dict[str, Any]:
    """JSON schemas of recipes and shots, made once: it takes half a second."""
    return schema()


class Session:
    """One file and its connected pages.

    ``join``, ``leave`` and ``handle`` run on the session's own thread, in the order of ``submit``, so that no message
    blocks the server. Grooming runs in worker threads.
    """

    def __init__(self, file: Path, project: Project) -> None:
        self.project, self.id = project, secrets.token_hex(8)
        self.publisher = Publisher()
        self.problems = ProblemList(self.publisher)
        self.pages = Pages(self.publisher, self.submit, self._end_gesture)
        self._heard = Counter[str]()
        self._thread = SerialWorker("session")
        notice, trouble = self.pages.notice, self.pages.trouble
        self._grooming = Grooming(project, self.publisher, self.problems, self._call, self._show, trouble)
        self._review = Reviewing(project, self.publisher, notice)
        self._comparer = Comparer(project, self.publisher, self._call, self._show_live)
        self._rendering, self._sharer = Rendering(project), Sharer(project)
        self._motions = LockMotions()
        self._live = LiveHair(self.publisher, self._call, trouble, lambda: len(self.pages) > 0)
        self._editing = Editing(self.publisher, self.pages, self.submit, self._show_live)
        self._disk = DiskChanges(
            project, self.publisher, self.problems, self._review, self._call, self._editing.edited, notice, self._record
        )
        self._saving = Saving(self.problems, self._open)
        self._load(file)

    def _load(self, file: Path) -> None:
        """Opens a file; raises UserError for one that cannot be read, before anything changes."""
        files, viewport = Files(file, self.project), Viewport(self.publisher)
        self._when_shown: Callable[[], None] | None = None
        scene = None if "recipe" in files.documents else read_scene(file)
        self.files, self._viewport = files, viewport
        self._recovery = Recovery(files, self.problems)
        self._playback = Playback(files, self.publisher, viewport, self._call, self.pages.trouble)
        self._cameras = StageCameras(self.publisher)
        self._grooming.open(files, viewport)
        self._review.open(files)
        self._comparer.open(files, viewport, self._review)
        self._disk.open(files)
        self._saving.open(files)
        self._editing.open(files, viewport, self._grooming, self._comparer, self._playback, self._review, self._disk)
        for document in files.documents.values():
            if document.renamed:
                message = f"{document.path.name}: {note(document.renamed)}; the next save writes these names"
                self.problems.show(RENAMED, message, [dismiss(RENAMED)])
        entry = self._recovery.recover()
        self.recovered = entry is not None
        if entry is not None:
            self._heard.update(entry.heard)
            self.pages.lock.leader = entry.leader
        if scene is not None:
            bodies, display = scene
            viewport.stage(display, bodies)
            self._cameras.show(display.groom, None)
            self._playback.read(display)

    def start(self, loop: asyncio.AbstractEventLoop) -> None:
        """Publishes the documents, starts grooming and watches the project's files."""
        self._publish()
        self._disk.start(loop)

    def _publish(self) -> None:
        for file in self.files.documents:
            self.publisher.publish(f"document/{file}", document_message(self.files, file))
            self._disk.show_conflict(file)
        self._review.publish()
        if "recipe" in self.files.documents:
            self._grooming.request()

    def _open(self, file: Path, *, discard: bool) -> None:
        """Opens another file; raises UserError when it cannot be read, and when unsaved changes would be lost."""
        if not discard and not self.files.clean:
            raise UserError(f"open: {self.files.file.name} has unsaved changes; save them, or discard them")
        before, recovery, playback = self.publisher.retained(), self._recovery, self._playback
        self._editing.stop()
        self._grooming.cancel()
        self._comparer.cancel()
        self._live.stop()
        self.publisher.clear("")
        try:
            self._load(file)
        except UserError:
            for subject, message in before.items():
                self.publisher.publish(subject, message)
            raise
        playback.stop()
        recovery.close(discard=True)
        self.problems.clear(*(self.problems.subjects - OF_OPENING))
        self.problems.publish()
        if files := before.get("files"):
            self.publisher.publish("files", files)
        for page in self.pages:
            page.queue.put("welcome", self._welcome(page.name))
        self._publish()

    def stop(self) -> None:
        """Stops the background work; what takes longer than ``PATIENCE`` ends with the program."""
        self._disk.stop()
        self._editing.stop()
        self.pages.lock.stop()
        self._thread.submit(self._finish)
        self._thread.stop(PATIENCE)
        self._playback.stop()
        self._live.stop(PATIENCE)
        self._grooming.stop(PATIENCE)
        self._comparer.stop(PATIENCE)
        self._sharer.stop(PATIENCE)
        self._motions.stop(PATIENCE)

    def _finish(self) -> None:
        self._end_gesture()
        self._record()
        self._recovery.close()
        self._rendering.stop()

    def _record(self) -> None:
        self._recovery.record(self._heard, self.pages.lock.leader)

    def submit(self, do: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Runs a call on the session's thread, after those submitted before it."""
        return self._thread.submit(do, *arguments)

    def _call(self, do: Callable[..., None], *arguments: Any) -> None:
        self._thread.post(do, *arguments)

    # Pages

    def join(self, name: str, leads: bool = False, person: str = "") -> Page:
        """Adds a page. It gets the edit lock when it held it before, or when no connected page holds it.

        leads:  whether the page held it when it was connected last
        person: name of the person at the page; empty where it is not known
        """
        return self.pages.join(name, self._welcome(name), person, led=leads)

    def leave(self, page: Page) -> None:
        """Removes a page; the edit lock stays reserved for it until another page requests it."""
        self._rendering.cancel(page.queue)
        self.pages.leave(page)
        self._record()

    def _end_gesture(self) -> None:
        self._editing.end_gesture()
        self._live.let_go()

    def _welcome(self, name: str) -> bytes:
        """First message to the page of a name."""
        lights, wrong = live_rigs_of(self.project)
        if wrong:
            self.problems.show(LIGHT, "; ".join(wrong), [dismiss(LIGHT)])
        else:
            self.problems.clear(LIGHT)
        return pack(
            protocol.Welcome.model_validate(
                {
                    "version": protocol.VERSION,
                    "session": self.id,
                    "heard": self._heard[name],
                    "name": str(self.files.file.relative_to(self.project.folder)),
                    "mode": self.files.mode,
                    "schemas": schemas(),
                    "operators": operator_names(schemas()["recipe"]),
                    "recovered": self.recovered,
                    "colors": display_colors.named(),
                    "rigs": lights,
                }
            )
        )

    def _show(self, display: DisplayGroom, revision: int) -> None:
        """Shows a groom that was made."""
        before = self._viewport.display
        self._viewport.show(display, "a", revision)
        self._cameras.show(display.groom, self.files.shot if self.files.mode == "shot" else None)
        guides_changed = before is None or before.groom.guides is not display.groom.guides
        if guides_changed and (guides := self._editing.strokes.guides()) is not None:
            self.publisher.publish("guides", guides)
        if self.files.mode == "shot" and not display.draft:
            self._playback.set_groom(display)
            do, self._when_shown = self._when_shown, None
            if do is not None:
                self._do(do)
        self._show_live()

    def _do(self, do: Callable[[], None]) -> None:
        """Does what waited for a groom; what it refuses is said."""
        try:
            do()
        except UserError as error:
            self.pages.trouble(str(error))

    def _live_scene(self) -> LiveScene:
        """What would move live now; raises UserError where nothing can."""
        shot = self.files.shot if self.files.mode == "shot" else None
        return LiveScene.of(self._viewport.made("live"), shot, self._viewport.bodies)

    def _compared_scenes(self) -> dict[protocol.Side, LiveScene]:
        """The compared looks that move live, but for takes, which play."""
        scenes: dict[protocol.Side, LiveScene] = {}
        for side, (asked, display) in self._comparer.shown.items():
            shot = asked.shot.model if asked.shot else self.files.shot if self.files.mode == "shot" else None
            with suppress(UserError):  # there are no locks
                if not asked.take:
                    scenes[side] = LiveScene.of(display, shot, worn_meshes(display.groom))
        return scenes

    def _show_live(self) -> None:
        """Hair that moves live goes on with what has changed."""
        if self._live.on:
            self._live.show(self._live_scene(), self._compared_scenes())

    def _keep_take(self, message: protocol.KeepTake) -> None:
        """Keeps the last seconds of live hair; raises UserError where the groom that moved is not the open one."""
        groom = self._viewport.made("take").groom
        current = self._viewport.revision == self.files.recipe.revision
        motion = self._live.recent.take(groom if current else None)
        self._review.keep_take(message, motion)
        self.pages.notice(f"{motion.seconds:.1f} s of live hair are kept among the snapshots (T)")

    def _make_shot(self, message: protocol.MakeShot, page: Page) -> None:
        """Writes a shot of a take and opens it; it starts, compared with the take, once its groom is made."""
        review = self._review
        motion = review.take_of_shot(message.id)
        made = write_take_shot(self.files, motion, review.snapshots.shot(message.id), message.name)
        try:
            review.keep_with_shot(message.id, made.recipe, made.text, FIRST)
        except UserError:
            made.remove()
            raise
        self._open(made.shot, discard=False)
        self._when_shown = lambda: self._start_made(message.id, page)

    def _start_made(self, take: str, page: Page) -> None:
        self._playback.play(protocol.Play(action="start"))
        self._comparer.compare(protocol.Compare(to="snapshot", name=take), page.queue)

    # Messages

    def handle(self, page: Page, message: protocol.FromPage) -> None:
        """Handles a message of a page and acknowledges it; raises UserError for a request that fails."""
        if isinstance(message, protocol.HoldHead | protocol.TouchHair):
            if self.pages.leads(page):
                self._live.hold(message)
            return
        if isinstance(message, protocol.PRESENCE):
            self.pages.present(page, message)
            return
        try:
            self._dispatch(page, message)
        finally:
            self._heard[page.name] += 1
            self._record()
            page.queue.put("heard", pack(protocol.Heard(count=self._heard[page.name])))

    def _dispatch(self, page: Page, message: protocol.FromPage) -> None:
        """Handles what every page may ask for; the rest is for the one that leads."""
        match message:
            case protocol.Lead():
                self.pages.ask(page)
            case protocol.Render():
                self._rendering.render(message, self._viewport, page.queue)
            case protocol.StopRender():
                self._rendering.cancel(page.queue)
            case protocol.AskMotion():
                display = self._viewport.display
                if self.files.mode == "shot" and display is not None:
                    self._motions.ask(Question(self.files.shot, display.groom, message.lock, page.queue))
            case protocol.Watch():
                page.queue.request(self._playback.frame_sources(message))
            case protocol.KeepTake():
                self._keep_take(message)
            case protocol.Share():
                self._sharer.share(self.publisher.retained(), self.files.file, message, page.queue)
            case _ if isinstance(message, protocol.AnyReview):
                self._review.handle(message)
            case _:
                if not self.pages.leads(page):
                    raise UserError("another page leads this session; take the lead to edit")
                self.pages.lock.keep()
                self._lead(page, message)

    def _lead(self, page: Page, message: protocol.FromPage) -> None:
        """Handles a message of the page that leads."""
        match message:
            case protocol.Hand():
                self.pages.lock.answer(over=message.over)
            case protocol.Save():
                self._save(message)
            case protocol.Open():
                self._open(self.project.inside(message.name, "open"), discard=message.discard)
            case protocol.UseCopy():
                self._saving.use_copy()
            case protocol.Dismiss():
                self.problems.clear(message.subject)
            case protocol.Proceed():
                self._grooming.request(large=True)
            case protocol.Cancel():
                self._grooming.cancel_by_hand()
            case protocol.MakeShot():
                self._make_shot(message, page)
            case protocol.Compare():
                self._comparer.compare(message, page.queue)
            case protocol.Play():
                self._playback.play(message)
            case protocol.GoLive():
                if message.on:
                    self._live.start(self._live_scene(), self._compared_scenes())
                else:
                    self._live.stop()
            case protocol.MoveHead():
                self._live.move_head(message.motion)
            case protocol.Blow():
                self._live.blow(message.side)
            case protocol.Against():
                self._playback.set_comparison(message)
            case protocol.Restore() if self.recovered:
                pass  # the journal had what the page still knows
            case _:
                if isinstance(message, protocol.Step):
                    self.problems.clear(RECOVERED)
                self._editing.handle(page, message)

    def _save(self, message: protocol.Save) -> None:
        files = self.files
        try:
            path = self._saving.save(message)
        finally:
            self._disk.show_conflict(message.file)
        if path is not None:
            if self.files is files:
                self.publisher.publish(f"document/{message.file}", document_message(files, message.file))
            self.pages.send("saved", pack(protocol.Saved(name=path.name)))
