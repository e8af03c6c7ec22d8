"""Shared review session: connected pages, edit lock, message dispatch."""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections import Counter
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from ringlet import api
from ringlet.data.errors import UserError
from ringlet.data.pigment import HAIR_COLORS
from ringlet.viewer import eyedropper, protocol
from ringlet.viewer.caches import Caches
from ringlet.viewer.comparer import Comparer
from ringlet.viewer.display_groom import DisplayGroom
from ringlet.viewer.edit_lock import EditLock
from ringlet.viewer.files import Files, operator_names
from ringlet.viewer.grooming import Grooming
from ringlet.viewer.manipulator import LockManipulator
from ringlet.viewer.playback import Playback
from ringlet.viewer.presence import Presence
from ringlet.viewer.problems import GROOM, RECOVERED, SAVE, ProblemList, conflict_fixes, dismiss
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import File, Fix
from ringlet.viewer.publisher import Publisher, SendQueue
from ringlet.viewer.recovery import Recovery
from ringlet.viewer.reviewing import Reviewing
from ringlet.viewer.scene import read_scene
from ringlet.viewer.sculpting import Sculptor
from ringlet.viewer.stage_cameras import StageCameras
from ringlet.viewer.viewport import Viewport
from ringlet.viewer.watcher import FileWatcher
from ringlet.viewer.wire import pack, trouble
from ringlet.viewer.worker import SerialWorker, Timer

PATIENCE = 1.0  # that the end of the server waits for work in progress [s]
FILES_INTERVAL = 2.0  # interval at which the list of files is refreshed [s]
WATCH_INTERVAL = 0.4  # interval at which open files are looked at [s]
REST_AFTER = 1.0  # time without a message of a gesture after which its whole groom is made [s]

log = logging.getLogger("ringlet.viewer")


@cache
def _schemas() -> dict[str, Any]:
    """JSON schemas of recipes and shots, made once: it takes half a second."""
    return api.schema()


class Page:
    """A connected page."""

    def __init__(self, name: str, queue: SendQueue) -> None:
        self.name, self.queue = name, queue


class Session:
    """One file and its connected pages.

    ``join``, ``leave`` and ``handle`` run on the session's own thread, in the order of ``submit``, so that no message
    blocks the server. Grooming runs in worker threads.
    """

    def __init__(self, file: Path, project: Project) -> None:
        self.project, self.id = project, secrets.token_hex(8)
        self.publisher = Publisher()
        self.problems = ProblemList(self.publisher)
        self.pages: list[Page] = []
        self._presence = Presence()
        self._lock = EditLock(self.submit, self._answered)
        self._heard = Counter[str]()
        self._thread = SerialWorker("session")
        self._watching: asyncio.Task[None] | None = None
        self._watcher = FileWatcher()
        self._rest = Timer(REST_AFTER, self.submit)
        self._caches = Caches(project)
        self._grooming = Grooming(project, self.publisher, self.problems, self._call, self._show, self.trouble)
        self._review = Reviewing(project, self.publisher, self._notice)
        self._comparer = Comparer(project, self.publisher, self._call)
        self._load(file)

    def _load(self, file: Path) -> None:
        """Opens a file; raises UserError for one that cannot be read, before anything changes."""
        files, viewport = Files(file, self.project), Viewport(self.publisher)
        scene = None if "recipe" in files.documents else read_scene(file)
        self.files, self._viewport = files, viewport
        self._recovery = Recovery(files, self.problems)
        self._playback = Playback(files, self.publisher, viewport, self._call, self.trouble)
        self._manipulator, self._sculptor = LockManipulator(files), Sculptor(files)
        self._cameras = StageCameras(self.publisher)
        self._grooming.open(files, viewport)
        self._review.open(files)
        self._comparer.open(files, viewport, self._review)
        self._watcher.changed(files.watched())
        entry = self._recovery.recover()
        self.recovered = entry is not None
        if entry is not None:
            self._heard.update(entry.heard)
            self._lock.leader = entry.leader
        if scene is not None:
            bodies, display = scene
            viewport.stage(display, bodies)
            self._cameras.show(display.groom, None)
            self._playback.read(display)

    # Pages

    def start(self, loop: asyncio.AbstractEventLoop) -> None:
        """Publishes the documents, starts grooming and watches the project's files."""
        self._publish()
        self._watching = loop.create_task(self._watch())

    def _publish(self) -> None:
        for file in self.files.documents:
            self.publisher.publish(f"document/{file}", self.files.message(file))
            self._show_conflict(file)
        self._review.publish()
        if "recipe" in self.files.documents:
            self._grooming.request()

    async def _watch(self) -> None:
        """Takes in what other programs write: the open files, and the recipes and caches of the project."""
        posted, looks = None, 0
        while True:
            if changed := await asyncio.to_thread(self._changed_files):
                self._call(self._meet_disk, changed)
            if looks * WATCH_INTERVAL % FILES_INTERVAL < WATCH_INTERVAL:
                names = await asyncio.to_thread(self._names)
                if names != posted:
                    self._call(self.publisher.publish, "files", pack(protocol.Files(names=names)))
                posted = names
                if await asyncio.to_thread(self._review.watch):
                    self._call(self._review.reload)
            looks += 1
            await asyncio.sleep(WATCH_INTERVAL)

    def _changed_files(self) -> set[Path]:
        try:
            return self._watcher.changed(self.files.watched())
        except Exception:
            log.exception("files could not be watched")
            return set()

    def _names(self) -> list[str]:
        return [*self.project.files("*.recipe.toml", "*.shot.toml"), *self._caches.names()]

    def stop(self) -> None:
        """Stops the background work; what takes longer than ``PATIENCE`` ends with the program."""
        if self._watching is not None:
            self._watching.cancel()
        self._rest.cancel()
        self._lock.stop()
        self._thread.submit(self._finish)
        self._thread.stop(PATIENCE)
        self._playback.stop()
        self._grooming.stop(PATIENCE)
        self._comparer.stop(PATIENCE)

    def _finish(self) -> None:
        self._end_gesture()
        self._record()
        self._recovery.close()

    def _record(self) -> None:
        self._recovery.record(self._heard, self._lock.leader)

    def submit(self, do: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Runs a call on the session's thread, after those submitted before it."""
        return self._thread.submit(do, *arguments)

    def join(self, name: str, leads: bool = False, person: str = "") -> Page:
        """Adds a page. It gets the edit lock when it held it before, or when no connected page holds it.

        leads:  whether the page held it when it was connected last; it does not take it from a page that asked for it
        person: name of the person at the page; empty where it is not known
        """
        page = Page(name, self.publisher.subscribe(self._welcome(self._heard[name])))
        self._presence.join(page, name, person)
        self._lock.join(name, self._connected, led=leads)
        self.pages.append(page)
        self._send_roles()
        return page

    def leave(self, page: Page) -> None:
        """Removes a page; the edit lock stays reserved for it until another page requests it."""
        self.pages.remove(page)
        self._presence.leave(page)
        self.publisher.unsubscribe(page.queue)
        if page.name == self._lock.leader:
            self._end_gesture()
            self._record()
        self._lock.leave(page.name)
        self._send_roles()

    @property
    def _connected(self) -> set[str]:
        """Names of the connected pages."""
        return {page.name for page in self.pages}

    def _welcome(self, heard: int) -> bytes:
        schemas = _schemas()
        return pack(
            protocol.Welcome.model_validate(
                {
                    "version": protocol.VERSION,
                    "session": self.id,
                    "heard": heard,
                    "name": str(self.files.file.relative_to(self.project.folder)),
                    "mode": self.files.mode,
                    "schemas": schemas,
                    "operators": operator_names(schemas["recipe"]),
                    "recovered": self.recovered,
                    "colors": {name: (*color.reflectance, color.roughness) for name, color in HAIR_COLORS.items()},
                }
            )
        )

    def _answered(self, asked: str, before: str) -> None:
        """The page that asked for the edit lock has it, or ``before`` keeps it."""
        leader = self._lock.leader
        if asked == leader:
            self._end_gesture()
        if asked and leader != before:
            self._notice(f"{self._called(leader)} can edit now")
        elif asked != leader:
            self._notice(f"{self._called(leader)} goes on editing", to=asked)
        self._send_roles()

    def _called(self, name: str) -> str:
        """Name of the person at a page."""
        return next((self._presence[page].name for page in self.pages if page.name == name), "Another page")

    def _present(self, page: Page, message: protocol.FromPage) -> None:
        """Handles a message of presence; what a page shares that no longer leads is outdated."""
        if isinstance(message, protocol.Introduce):
            self._presence.rename(page, message.person)
            self._presence[page].follows = message.follows
            self._send_roles()
        elif page.name != self._lock.leader:
            return
        elif isinstance(message, protocol.Look):  # also for those that join later
            self.publisher.publish("followed", pack(protocol.Followed(**message.model_dump(exclude={"kind"}))))
            page.queue.discard("followed")
        elif isinstance(message, protocol.Point):
            for other in self.pages:
                if other is not page:
                    other.queue.put("pointer", pack(protocol.Pointer(at=message.at)))

    def _send_roles(self) -> None:
        people = [
            protocol.Person(**vars(self._presence[page]), leads=page.name == self._lock.leader, you=False)
            for page in self.pages
        ]
        for k, page in enumerate(self.pages):
            mine = [person.model_copy(update={"you": k == other}) for other, person in enumerate(people)]
            role = {"people": mine, **self._lock.role(page.name)}
            if role["asked"]:
                role["asking"] = self._called(self._lock.asking)
            page.queue.put("role", pack(protocol.Role.model_validate(role)))

    # Messages

    def handle(self, page: Page, message: protocol.FromPage) -> None:
        """Handles a message of a page and acknowledges it; raises UserError for a request that fails."""
        if isinstance(message, protocol.PRESENCE):
            self._present(page, message)
            return
        try:
            self._dispatch(page, message)
        finally:
            self._heard[page.name] += 1
            self._record()
            page.queue.put("heard", pack(protocol.Heard(count=self._heard[page.name])))

    def _dispatch(self, page: Page, message: protocol.FromPage) -> None:
        if isinstance(message, protocol.Lead):
            self._lock.ask(page.name, self._connected)
            self._send_roles()
            return
        if isinstance(message, protocol.Watch):
            page.queue.request(self._playback.frame_sources(message))
            return
        if isinstance(message, protocol.AnyReview):
            self._review.handle(message)
            return
        if page.name != self._lock.leader:
            raise UserError("another page leads this session; take the lead to edit")
        files = self.files
        self._lock.keep()
        if isinstance(message, protocol.Hand):
            self._lock.answer(over=message.over)
        elif isinstance(message, protocol.Set):
            files.set(message.file, message.changes, message.gesture)
            self._edited(message.file, resting=message.resting)
        elif isinstance(message, protocol.Arrange):
            files.edit_operators(message.action, message.at, message.to, message.op, message.values)
            self._edited("recipe")
        elif isinstance(message, protocol.Choose):
            files.choose(message.groom)
            self._edited("recipe")
        elif isinstance(message, protocol.Mute):
            files.recipe.apply(files.recipe.text, muted=frozenset(message.stages), solo=message.solo)
            self._edited("recipe")
        elif isinstance(message, protocol.Step):
            self.problems.clear(RECOVERED)
            for file in files.step(message.kind):
                self._edited(file)
        elif isinstance(message, protocol.Save):
            self._save(message)
        elif isinstance(message, protocol.Open):
            self._open(self.project.inside(message.name, "open"), discard=message.discard)
        elif isinstance(message, protocol.Resolve):
            files.resolve(message.file, message.choice, message.mine, message.theirs)
            self._edited(message.file)
        elif isinstance(message, protocol.Dismiss):
            self.problems.clear(message.subject)
        elif isinstance(message, protocol.Proceed):
            self._grooming.request(large=True)
        elif isinstance(message, protocol.Cancel):
            self._grooming.cancel_by_hand()
        elif isinstance(message, protocol.Restore):
            if not self.recovered:
                files.recover(message.file, message.text, message.edits, message.saved, message.saved_edits)
                self._edited(message.file)
        elif isinstance(message, protocol.LoadSnapshot):
            self._review.load_snapshot(message.id)
            self._edited("recipe")
        elif isinstance(message, protocol.PickColor):
            self._notice(eyedropper.pick(files, message.color))
            self._edited("recipe")
        elif isinstance(message, protocol.Compare):
            self._comparer.compare(message, page.queue)
        elif isinstance(message, protocol.Isolate):
            self._manipulator.isolate(message, self._viewport.display)
            self._edited("recipe")
        elif isinstance(message, protocol.Drag):
            self._manipulator.drag(message, self._viewport.display)
            self._edited("recipe", resting=message.resting)
        elif isinstance(message, protocol.Sculpt):
            self._sculpt(message)
        elif isinstance(message, protocol.Unsculpt):
            self._sculptor.remove_all()
            self._edited("recipe")
        elif isinstance(message, protocol.Play):
            self._playback.play(message)
        elif isinstance(message, protocol.Against):
            self._playback.set_comparison(message.name)
        else:
            raise UserError(f"message: {message.kind} is not for this file")

    def _sculpt(self, message: protocol.Sculpt) -> None:
        """Publishes the sculpted guides at once and requests a draft of the locks.

        Raises UserError before the groom is made.
        """
        self.files.refuse_several()
        display = self._viewport.display
        if display is None:
            raise UserError("sculpt: the groom is not made yet; wait until it is seen")
        if message.tool in ("freeze", "thaw"):
            guides = self._sculptor.freeze(message, display.groom)
            self.publisher.publish("guides", self._sculptor.message(guides, display.groom))
            return
        guides = self._sculptor.move(message, display.groom)
        self.publisher.publish("guides", self._sculptor.message(guides, display.groom))
        if message.resting:
            self._edited("recipe")
        else:
            self._preview(draft=True)
            self._rest.restart(self._settle)

    def _preview(self, *, draft: bool) -> None:
        """Requests the groom with the current stroke."""
        self._grooming.request_of(self._sculptor.preview(self.files.recipe.model), draft=draft)

    # Files

    def _save(self, message: protocol.Save) -> None:
        """Saves a file, and goes on with a copy; asks first when its groom cannot be made."""
        files = self.files
        if message.file == "recipe" and GROOM in self.problems and not message.anyway:
            anyway = Fix(label="Save anyway", message={**message.model_dump(), "anyway": True})
            reason = f"{files.recipe.path.name} is not saved: {self.problems[GROOM].message}"
            self.problems.show(SAVE, reason, [anyway, dismiss(SAVE)])
            return
        self.problems.clear(SAVE, RECOVERED)
        try:
            path = files.save(message.file, message.name, message.variant)
        finally:
            self._show_conflict(message.file)
        if message.name:
            self._go_on_with(message.file, path)
        else:
            self.publisher.publish(f"document/{message.file}", files.message(message.file))
        for page in self.pages:
            page.queue.put("saved", pack(protocol.Saved(name=path.name)))

    def _go_on_with(self, file: File, path: Path) -> None:
        """Goes on with a copy that was saved: it holds the changes, and the file that it is a copy of has none."""
        files = self.files
        if files.mode == "shot" and file == "recipe":
            message = f"{path.name} is saved; the shot goes on with {files.recipe.path.name}, which its groom names"
            self.problems.show(SAVE, message, [dismiss(SAVE)])
            return
        other = [kind for kind, document in files.documents.items() if kind != file and document.dirty]
        self._open(path, discard=not other)

    def _open(self, file: Path, *, discard: bool) -> None:
        """Opens another file; raises UserError when it cannot be read, and when unsaved changes would be lost."""
        if not discard and not self.files.clean:
            raise UserError(f"open: {self.files.file.name} has unsaved changes; save them, or discard them")
        before, recovery, playback = self.publisher.retained(), self._recovery, self._playback
        self._rest.cancel()
        self._grooming.cancel()
        self._comparer.cancel()
        self.publisher.clear("")
        try:
            self._load(file)
        except UserError:
            for subject, message in before.items():
                self.publisher.publish(subject, message)
            raise
        playback.stop()
        recovery.close(discard=True)
        self.problems.clear(*(self.problems.subjects - {RECOVERED}))
        self.problems.publish()
        if files := before.get("files"):
            self.publisher.publish("files", files)
        for page in self.pages:
            page.queue.put("welcome", self._welcome(self._heard[page.name]))
        self._publish()

    def _meet_disk(self, changed: set[Path]) -> None:
        """Takes in files that other programs changed: loads them, or shows the conflict with unsaved changes."""
        watched = self.files.watched()
        for file, document in self.files.documents.items():
            if not any(watched.get(path) == file for path in changed):
                continue
            try:
                if self.files.meet_disk(file):
                    self._notice(f"{document.path.name} was changed by another program, and is loaded again")
                    self._edited(file)
                elif document.theirs is None and not changed <= self.files.own(file):
                    self._recheck(file)
            except UserError as error:
                self.problems.show(f"conflict/{file}", str(error), conflict_fixes(file), place=(file, ""))
                continue
            self._show_conflict(file)
        self._record()

    def _recheck(self, file: File) -> None:
        """Takes in a change of a file that a document refers to."""
        try:
            self.files.document(file).recheck()
        except UserError as error:
            self.problems.show(GROOM, str(error))
            return
        self._edited(file)

    def _show_conflict(self, file: File) -> None:
        """Shows the conflict of a document with its file on disk, or that there is none."""
        document = self.files.documents.get(file)
        if document is None or document.theirs is None:
            self.problems.clear(f"conflict/{file}")
            return
        message = f"{document.path.name} was changed by another program while it has unsaved changes here"
        differences = self.files.differences(file)
        self.problems.show(f"conflict/{file}", message, conflict_fixes(file), place=(file, ""), differences=differences)

    def _notice(self, message: str, to: str = "") -> None:
        """Shows a short message on the page of a name, or on all pages."""
        for page in self.pages:
            if to in ("", page.name):
                page.queue.put("notice", pack(protocol.Notice(message=message)))

    # Grooming

    def _edited(self, file: File, *, resting: bool = True) -> None:
        document = self.files.document(file)
        if document.theirs is not None and not document.dirty:
            with suppress(UserError):  # theirs is invalid, and the conflict stays
                document.meet(*document.theirs)
        self._show_conflict(file)
        self.publisher.publish(f"document/{file}", self.files.message(file))
        if file == "recipe":
            self._grooming.request(draft=not resting)
            self._comparer.recompute()
        else:
            self._playback.publish_timeline()
        if resting:
            self._rest.cancel()
        else:  # the hand may never be heard to rest
            self._rest.restart(self._settle)

    def _settle(self) -> None:
        """Makes the whole groom of a gesture whose hand was not heard to rest."""
        if not self._rest.cancel() or "recipe" not in self.files.documents:
            return
        if self._sculptor.busy:
            self._preview(draft=False)
        else:
            self._grooming.request()

    def _end_gesture(self) -> None:
        """Ends the gesture of a page that is gone: its stroke is kept, and the whole groom is made."""
        if self._sculptor.busy:
            self._sculptor.finish()
            self._edited("recipe")
        self._settle()

    def _show(self, display: DisplayGroom, revision: int) -> None:
        before = self._viewport.display
        self._viewport.show(display, "a", revision)
        self._cameras.show(display.groom, self.files.shot if self.files.mode == "shot" else None)
        guides_changed = before is None or before.groom.guides is not display.groom.guides
        if guides_changed and display.groom.unsculpted is not None and not self._sculptor.busy:
            self.publisher.publish("guides", self._sculptor.message(display.groom.guides, display.groom))
        if self.files.mode == "shot" and not display.draft:
            self._playback.set_groom(display)

    def _call(self, do: Callable[..., None], *arguments: Any) -> None:
        self._thread.post(do, *arguments)

    def trouble(self, message: str) -> None:
        """Sends an error message to all pages."""
        for page in self.pages:
            page.queue.put("trouble", trouble(message))
