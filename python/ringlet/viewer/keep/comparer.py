"""Grooms for comparison, up to three, each made on a worker thread of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import NamedTuple

from ringlet.data.errors import UserError, failure
from ringlet.data.regular import read_text
from ringlet.groom import Recipe
from ringlet.shot import Shot
from ringlet.viewer import protocol
from ringlet.viewer.files.compared_settings import settings_of_text, settings_text
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.keep.reviewing import Reviewing
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import Side
from ringlet.viewer.publisher import Publisher, SendQueue
from ringlet.viewer.show.display_groom import DisplayGroom, GroomEvaluator
from ringlet.viewer.show.viewport import Viewport
from ringlet.viewer.wire import pack, trouble
from ringlet.viewer.worker import LatestTaskWorker, Stale


class OwnShot(NamedTuple):
    """The shot of a look that is compared, where it is not the open one as it is."""

    text: str
    model: Shot


@dataclass(frozen=True)
class Comparison:
    """A request for a groom to compare with: a recipe, its muted stages, its name, and the page that asks.

    detail: author and time of a snapshot
    take:   id of a snapshot whose take of live hair plays; empty for none
    shot:   that it moves live in; None for the open one as it is
    """

    side: Side
    recipe: Recipe
    muted: frozenset[str]
    name: str
    detail: str
    page: SendQueue
    take: str = ""
    shot: OwnShot | None = None


class Shown(NamedTuple):
    """A groom that is compared, and what asked for it."""

    asked: Comparison
    display: DisplayGroom


class Comparer:
    """Makes the grooms on the sides b, c and d of the viewport. Public methods run on the session's thread.

    call:    runs a function on the session's thread
    changed: called there after other grooms are shown
    shown:   the grooms by their sides
    """

    def __init__(
        self, project: Project, publisher: Publisher, call: Callable[..., None], changed: Callable[[], None]
    ) -> None:
        self._project, self._publisher, self._call, self._changed = project, publisher, call, changed
        self._workers: dict[Side, LatestTaskWorker[Comparison]] = {}
        self._evaluators: dict[Side, GroomEvaluator] = {}
        self.shown: dict[Side, Shown] = {}

    def open(self, files: Files, viewport: Viewport, review: Reviewing) -> None:
        """Compares with other files from now on."""
        self._files, self._viewport, self._review = files, viewport, review
        self.shown = {}

    def compare(self, message: protocol.Compare, page: SendQueue) -> None:
        """Shows a groom on a side as soon as it is made; raises UserError for a recipe that cannot be read."""
        side = message.side
        self._clear(side)
        if message.to == "none":
            self._announce(protocol.Compared(side=side, name=""))
            return
        asked = self._asked(message, page)
        if side not in self._workers:
            self._evaluators[side] = GroomEvaluator(self._project)
            self._workers[side] = LatestTaskWorker[Comparison](self._groom, f"compare {side}")
        self._workers[side].submit(asked)

    def _asked(self, message: protocol.Compare, page: SendQueue) -> Comparison:
        """The recipe that a message asks for; raises UserError when it cannot be read."""
        files, document = self._files, self._files.recipe
        none = frozenset[str]()
        if message.to == "saved":
            recipe = files.parse(document.saved, document.path, document.saved_edits)
            when, shot = _written(document.path), self._own_shot(saved=True)
            return Comparison(message.side, recipe, none, "as saved", when, page, shot=shot)
        if message.to == "snapshot":
            recipe, muted, name, detail = self._review.snapshot_to_compare(message.name)
            take = message.name if self._review.snapshots[message.name].seconds else ""
            return Comparison(message.side, recipe, muted, name, detail, page, take)
        if message.to == "file":
            path = self._project.inside(message.name, "compare")
            recipe = files.parse(read_text(path, "choose a recipe of the project"), path)
            return Comparison(message.side, recipe, none, path.name, "", page)
        shot = self._own_shot(saved=False)
        return Comparison(message.side, document.model, files.without_effect, "as it was", "", page, shot=shot)

    def _own_shot(self, *, saved: bool) -> OwnShot | None:
        """The open shot as it is now, or as it is saved, which the look keeps; None without a shot."""
        files = self._files
        if files.mode != "shot":
            return None
        document = files.document("shot")
        return (
            OwnShot(document.saved, files.parse_shot(document.saved)) if saved else OwnShot(document.text, files.shot)
        )

    def recompute(self) -> None:
        """Publishes the settings of the open recipe and shot again, after an edit."""
        if not self.shown:
            return
        document = self._files.recipe
        settings = self._settings(document.model, None)
        self._announce(protocol.Compared(side="a", name="now", detail=document.path.name, settings=settings))
        for asked, _ in self.shown.values():
            if asked.shot is None and self._files.mode == "shot":
                self._announce_asked(asked)

    def _settings(self, recipe: Recipe, shot: OwnShot | None) -> dict[str, str]:
        """Settings of a recipe, and of the shot that it moves in, None for the open one."""
        if self._files.mode != "shot":
            return settings_text(recipe)
        text = shot.text if shot else self._files.document("shot").text
        return {**settings_of_text(text), **settings_text(recipe)}

    def cancel(self) -> None:
        """Cancels the grooms that are being made."""
        for worker in self._workers.values():
            worker.cancel()

    def stop(self, patience: float) -> None:
        """Stops the threads; waits for each up to ``patience`` [s]."""
        for worker in self._workers.values():
            worker.stop(patience)

    def _groom(self, asked: Comparison) -> None:
        """Grooms on the worker thread."""
        worker = self._workers[asked.side]
        try:
            display = self._evaluators[asked.side].groom(
                asked.recipe, asked.muted, draft=False, check_abort=worker.raise_if_stale
            )
            worker.raise_if_stale()
            self._call(self._show, asked, display)
        except Stale:
            raise
        except Exception as error:
            asked.page.put("trouble", trouble(failure("a groom to compare with could not be made", error)))

    def _show(self, asked: Comparison, display: DisplayGroom) -> None:
        self.shown[asked.side] = Shown(asked, display)
        self.recompute()
        self._announce_asked(asked)
        self._viewport.show(display, asked.side)
        if asked.take:
            self._play(asked)
        self._changed()

    def _announce_asked(self, asked: Comparison) -> None:
        settings = self._settings(asked.recipe, asked.shot)
        named = {"side": asked.side, "name": asked.name, "detail": asked.detail, "take": asked.take}
        self._announce(protocol.Compared.model_validate({**named, "settings": settings}))

    def _play(self, asked: Comparison) -> None:
        """Lets pages play a take on the side of its groom."""
        snapshots = self._review.snapshots
        try:
            motion, first = snapshots.motion(asked.take), snapshots[asked.take].first
        except UserError as error:
            asked.page.put("trouble", trouble(str(error)))
            return
        if motion is not None:
            self._publisher.publish(f"{asked.side}/take", motion.message(asked.side, asked.take, first))

    def _clear(self, side: Side) -> None:
        """Removes the groom on a side."""
        self._viewport.clear_compared(side)
        if side in self._workers:
            self._workers[side].cancel()
        if self.shown.pop(side, None):
            self._changed()

    def _announce(self, message: protocol.Compared) -> None:
        self._publisher.publish(f"{message.side}/none", pack(message))


def _written(path: Path) -> str:
    """When a file was written; empty for none."""
    try:
        return datetime.fromtimestamp(path.stat().st_mtime).isoformat(" ", "minutes")
    except OSError:
        return ""
