"""Grooms for comparison, up to three, each made on a worker thread of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from ringlet.data.errors import UserError, failure
from ringlet.data.regular import read_text
from ringlet.groom import Recipe
from ringlet.viewer import protocol
from ringlet.viewer.files.compared_settings import settings_text
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.keep.reviewing import Reviewing
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import Side
from ringlet.viewer.publisher import Publisher, SendQueue
from ringlet.viewer.show.display_groom import DisplayGroom, GroomEvaluator
from ringlet.viewer.show.viewport import Viewport
from ringlet.viewer.wire import pack, trouble
from ringlet.viewer.worker import LatestTaskWorker, Stale


@dataclass(frozen=True)
class Comparison:
    """A request for a groom to compare with: a recipe, its muted stages, its name, and the page that asks.

    detail: author and time of a snapshot
    take:   id of a snapshot whose take of live hair plays; empty for none
    """

    side: Side
    recipe: Recipe
    muted: frozenset[str]
    name: str
    detail: str
    page: SendQueue
    take: str = ""


class Comparer:
    """Makes the grooms on the sides b, c and d of the viewport. Public methods run on the session's thread.

    call: runs a function on the session's thread
    """

    def __init__(self, project: Project, publisher: Publisher, call: Callable[..., None]) -> None:
        self._project, self._publisher, self._call = project, publisher, call
        self._workers: dict[Side, LatestTaskWorker[Comparison]] = {}
        self._evaluators: dict[Side, GroomEvaluator] = {}
        self._shown: dict[Side, Comparison] = {}

    def open(self, files: Files, viewport: Viewport, review: Reviewing) -> None:
        """Compares with other files from now on."""
        self._files, self._viewport, self._review = files, viewport, review
        self._shown = {}

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
            return Comparison(message.side, recipe, none, "as saved", _written(document.path), page)
        if message.to == "snapshot":
            recipe, muted, name, detail = self._review.snapshot_to_compare(message.name)
            take = message.name if self._review.snapshots[message.name].seconds else ""
            return Comparison(message.side, recipe, muted, name, detail, page, take)
        if message.to == "file":
            path = self._project.inside(message.name, "compare")
            recipe = files.parse(read_text(path, "choose a recipe of the project"), path)
            return Comparison(message.side, recipe, none, path.name, "", page)
        return Comparison(message.side, document.model, files.without_effect, "as it was", "", page)

    def recompute(self) -> None:
        """Publishes the settings of the open recipe again, after an edit."""
        if self._shown:
            document = self._files.recipe
            now = protocol.Compared(
                side="a", name="now", detail=document.path.name, settings=settings_text(document.model)
            )
            self._announce(now)

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
        self._shown[asked.side] = asked
        self.recompute()
        settings = settings_text(asked.recipe)
        self._announce(
            protocol.Compared(side=asked.side, name=asked.name, detail=asked.detail, settings=settings, take=asked.take)
        )
        self._viewport.show(display, asked.side)
        if asked.take:
            self._play(asked)

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
        self._shown.pop(side, None)
        if side in self._workers:
            self._workers[side].cancel()

    def _announce(self, message: protocol.Compared) -> None:
        self._publisher.publish(f"{message.side}/none", pack(message))


def _written(path: Path) -> str:
    """When a file was written; empty for none."""
    try:
        return datetime.fromtimestamp(path.stat().st_mtime).isoformat(" ", "minutes")
    except OSError:
        return ""
