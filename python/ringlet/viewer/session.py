"""Shared review session: connected pages, edit lock, message dispatch."""

from __future__ import annotations

import asyncio
import logging
import secrets
from collections import Counter
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ringlet import api
from ringlet.data.errors import UserError
from ringlet.data.pigment import HAIR_COLORS
from ringlet.data.regular import read_text
from ringlet.groom import Recipe
from ringlet.viewer import overlays, protocol
from ringlet.viewer.caches import Caches
from ringlet.viewer.display_groom import DisplayGroom, GroomEvaluator
from ringlet.viewer.files import Files, operator_names
from ringlet.viewer.manipulator import LockManipulator
from ringlet.viewer.playback import Playback
from ringlet.viewer.project import Project
from ringlet.viewer.publisher import Publisher, SendQueue
from ringlet.viewer.scene import read_scene
from ringlet.viewer.sculpting import Sculptor
from ringlet.viewer.viewport import Viewport, measured
from ringlet.viewer.wire import pack, trouble
from ringlet.viewer.worker import LatestTaskWorker, SerialWorker, Stale

PATIENCE = 1.0  # that the end of the server waits for work in progress [s]
FILES_INTERVAL = 2.0  # interval at which the list of files is refreshed [s]
NO_GROOM = "groom/trouble"  # subject of the error that prevents a groom

log = logging.getLogger("ringlet.viewer")


@dataclass(frozen=True)
class Work:
    """A request for a groom: a recipe, its revision, its muted stages, whether a draft suffices, and the
    chosen one of several grooms."""

    recipe: Recipe
    revision: int
    muted: frozenset[str]
    draft: bool
    chosen: str


class Page:
    """A connected page."""

    def __init__(self, name: str, queue: SendQueue) -> None:
        self.name, self.queue = name, queue


@dataclass(frozen=True)
class Comparison:
    """A request for a groom to compare with: a recipe, its muted stages, its name, and the page that asks."""

    recipe: Recipe
    muted: frozenset[str]
    name: str
    page: Page


class Session:
    """One file and its connected pages.

    ``join``, ``leave`` and ``handle`` run on the session's own thread, in the order of ``submit``, so that no message
    blocks the server. Grooming runs in worker threads.
    """

    def __init__(self, file: Path, project: Project) -> None:
        self.project, self.files = project, Files(file, project)
        self.id = secrets.token_hex(8)
        self.publisher = Publisher()
        self.pages: list[Page] = []
        self.leader = ""
        self._heard = Counter[str]()
        self._thread = SerialWorker("session")
        self._file_watcher: asyncio.Task[None] | None = None
        self._evaluator, self._beside = GroomEvaluator(project), GroomEvaluator(project)
        self._viewport, self._caches = Viewport(self.publisher), Caches(project)
        self._playback = Playback(self.files, self.publisher, self._viewport, self._call, self.trouble)
        self._manipulator, self._sculptor = LockManipulator(self.files), Sculptor(self.files)
        if "recipe" not in self.files.documents:  # raises a read error before the server starts
            bodies, display = read_scene(file)
            self._viewport.stage(display, bodies)
            self._playback.read(display)
        self._worker = LatestTaskWorker[Work](self._groom, "groom")
        self._measurer = LatestTaskWorker[DisplayGroom](self._measure, "measure")
        self._comparer = LatestTaskWorker[Comparison](self._groom_beside, "compare")

    # Pages

    def start(self, loop: asyncio.AbstractEventLoop) -> None:
        """Publishes the documents, starts grooming and watches the project's files."""
        for file in self.files.documents:
            self.publisher.publish(f"document/{file}", self.files.message(file))
        if "recipe" in self.files.documents:
            self.regroom()
        self._file_watcher = loop.create_task(self._watch_files())

    async def _watch_files(self) -> None:
        """Publishes the recipes and caches of the project whenever they change; other programs write them."""
        posted = None
        while True:
            names = await asyncio.to_thread(lambda: [*self.project.files("*.recipe.toml"), *self._caches.names()])
            if names != posted:
                self._call(self.publisher.publish, "files", pack(protocol.Files(names=names)))
            posted = names
            await asyncio.sleep(FILES_INTERVAL)

    def stop(self) -> None:
        """Stops the background work; what takes longer than ``PATIENCE`` ends with the program."""
        if self._file_watcher is not None:
            self._file_watcher.cancel()
        self._thread.stop(PATIENCE)
        self._playback.stop()
        for worker in (self._worker, self._measurer, self._comparer):
            worker.stop(PATIENCE)

    def submit(self, do: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Runs a call on the session's thread, after those submitted before it."""
        return self._thread.submit(do, *arguments)

    def join(self, name: str) -> Page:
        """Adds a page. It gets the edit lock when it held it before, or when no connected page holds it."""
        page = Page(name, self.publisher.subscribe(self._welcome(self._heard[name])))
        self.pages.append(page)
        if not self.leader or not any(other.name == self.leader for other in self.pages):
            self.leader = name
        self._send_roles()
        return page

    def leave(self, page: Page) -> None:
        """Removes a page; the edit lock stays reserved for it until another page requests it."""
        self.pages.remove(page)
        self.publisher.unsubscribe(page.queue)
        self._send_roles()

    def _welcome(self, heard: int) -> bytes:
        schemas = api.schema()
        return pack(
            protocol.Welcome.model_validate(
                {
                    "version": protocol.VERSION,
                    "session": self.id,
                    "heard": heard,
                    "name": self.files.file.name,
                    "mode": self.files.mode,
                    "schemas": schemas,
                    "operators": operator_names(schemas["recipe"]),
                    "colors": {name: (*color.reflectance, color.roughness) for name, color in HAIR_COLORS.items()},
                }
            )
        )

    def _send_roles(self) -> None:
        others = len({page.name for page in self.pages}) - 1
        for page in self.pages:
            page.queue.put("role", pack(protocol.Role(leads=page.name == self.leader, others=others)))

    # Messages

    def handle(self, page: Page, message: protocol.FromPage) -> None:
        """Handles a message of a page and acknowledges it; raises UserError for a request that fails."""
        try:
            self._dispatch(page, message)
        finally:
            self._heard[page.name] += 1
            page.queue.put("heard", pack(protocol.Heard(count=self._heard[page.name])))

    def _dispatch(self, page: Page, message: protocol.FromPage) -> None:
        if isinstance(message, protocol.Lead):
            self.leader = page.name
            self._send_roles()
            return
        if isinstance(message, protocol.Watch):
            page.queue.request(self._playback.frame_sources(message))
            return
        if page.name != self.leader:
            raise UserError("another page leads this session; take the lead to edit")
        files = self.files
        if isinstance(message, protocol.Set):
            files.set(message.file, message.changes, message.gesture)
            self._edited(message.file, resting=message.resting)
        elif isinstance(message, protocol.Arrange):
            files.edit_operators(message.action, message.at, message.to, message.op)
            self._edited("recipe")
        elif isinstance(message, protocol.Choose):
            files.choose(message.groom)
            self._edited("recipe")
        elif isinstance(message, protocol.Mute):
            files.recipe.apply(files.recipe.text, muted=frozenset(message.stages))
            self._edited("recipe")
        elif isinstance(message, protocol.Step):
            for file in files.step(message.kind):
                self._edited(file)
        elif isinstance(message, protocol.Save):
            path = files.save(message.file, message.name, message.variant)
            self.publisher.publish(f"document/{message.file}", files.message(message.file))
            for each in self.pages:
                each.queue.put("saved", pack(protocol.Saved(name=path.name)))
        elif isinstance(message, protocol.Restore):
            files.document(message.file).apply(message.text, edits=message.edits or None)
            self._edited(message.file)
        elif isinstance(message, protocol.Compare):
            self._compare(page, message)
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
        guides = self._sculptor.move(message, display.groom)
        self.publisher.publish("guides", self._sculptor.message(guides, display.groom))
        if message.resting:
            self._edited("recipe")
        else:
            document = self.files.recipe
            sculpted = self._sculptor.preview(document.model)
            self._worker.submit(Work(sculpted, document.revision, document.state.muted, True, ""))

    def _compare(self, page: Page, message: protocol.Compare) -> None:
        """Shows a groom for comparison as soon as it is made; raises UserError for a recipe that cannot be read."""
        self._viewport.clear_beside()
        self._comparer.cancel()
        if message.to == "none":
            self.publisher.publish("b/none", pack(protocol.Compared(name="")))
            return
        document = self.files.recipe
        recipe, muted, name = document.model, document.state.muted, "as it was"
        if message.to == "saved":
            recipe = self.files.parse(document.saved, document.path, document.saved_edits)
            muted, name = frozenset[str](), "as saved"
        elif message.to == "file":
            path = self.project.inside(message.name, "compare")
            recipe = self.files.parse(read_text(path, "choose a recipe of the project"), path)
            muted, name = frozenset[str](), path.name
        self._comparer.submit(Comparison(recipe, muted, name, page))

    def _groom_beside(self, asked: Comparison) -> None:
        """Grooms on a worker thread what is shown for comparison."""
        try:
            display = self._beside.groom(
                asked.recipe, asked.muted, draft=False, check_abort=self._comparer.raise_if_stale
            )
            self._comparer.raise_if_stale()
            self._call(self.publisher.publish, "b/none", pack(protocol.Compared(name=asked.name)))
            self._call(self._viewport.show, display, "b")
        except UserError as error:
            asked.page.queue.put("trouble", trouble(str(error)))
        except Stale:
            raise
        except Exception as error:
            log.exception("a groom to compare with could not be made")
            asked.page.queue.put("trouble", trouble(f"this is a mistake in Ringlet ({error}); see the terminal"))

    # Grooming

    def _edited(self, file: str, *, resting: bool = True) -> None:
        self.publisher.publish(f"document/{file}", self.files.message(file))
        if file == "recipe":
            self.regroom(draft=not resting)
        else:
            self._playback.publish_timeline()

    def regroom(self, *, draft: bool = False) -> None:
        """Requests the groom of the current recipe; a draft while a gesture is in progress."""
        document = self.files.recipe
        muted = document.state.muted
        self._worker.submit(Work(document.model, document.revision, muted, draft, self.files.groom))

    def _groom(self, work: Work) -> None:
        """Grooms on the worker thread. A draft is never aborted, so that the page updates during a gesture."""
        check_abort: Callable[[], None] = (lambda: None) if work.draft else self._worker.raise_if_stale
        self._measurer.cancel()
        try:
            display = self._evaluator.groom(
                work.recipe, work.muted, chosen=work.chosen, draft=work.draft, check_abort=check_abort
            )
            self._call(self.publisher.clear, NO_GROOM)
            self._call(self._show, display, work.revision)
            if not work.draft:
                self._measurer.submit(display)
        except UserError as error:  # retained for pages that join later and see no hair
            self._call(self.publisher.publish, NO_GROOM, trouble(str(error)))
        except Stale:
            raise
        except Exception as error:
            log.exception("a groom could not be made")
            self._call(self.trouble, f"this is a mistake in Ringlet ({error}); see the terminal")

    def _measure(self, display: DisplayGroom) -> None:
        """Measures a groom on a worker thread; a new groom cancels it."""
        groom, chunks = display.groom, []
        for chunk in overlays.depths(groom.scalp, groom.scalp.points, groom.locks, groom.locks.points):
            self._measurer.raise_if_stale()
            chunks.append(chunk)
        self._call(self.publisher.publish, "measured", measured(groom, np.concatenate([np.empty(0), *chunks])))

    def _show(self, display: DisplayGroom, revision: int) -> None:
        before = self._viewport.display
        self._viewport.show(display, "a", revision)
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
