"""The groom of a session, made on a worker thread and then measured on another."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ringlet.data.errors import UserError, failure
from ringlet.groom import Recipe
from ringlet.viewer import protocol
from ringlet.viewer.files.document import Document
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.files.problems import GROOM, SAVE, UNDO, WORK, ProblemList, fixes_of
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import Fix
from ringlet.viewer.publisher import Publisher
from ringlet.viewer.show import overlays
from ringlet.viewer.show.display_groom import DisplayGroom, GroomEvaluator
from ringlet.viewer.show.progress_report import ProgressReport
from ringlet.viewer.show.scene import read_meshes
from ringlet.viewer.show.viewport import Viewport, measured
from ringlet.viewer.show.work import too_large
from ringlet.viewer.wire import pack
from ringlet.viewer.worker import LatestTaskWorker, Stale

PROGRESS_AFTER = 0.6  # time from which the progress of a groom is shown [s]

MAKE = Fix(label="Make it", message={"kind": "proceed"})


@dataclass(frozen=True)
class Work:
    """A request for a groom.

    document: the recipe's document
    without:  stages without effect
    chosen:   the one of several grooms that ``without`` is about
    draft:    whether a draft suffices
    painted:  pictures of maps in place of those on disk
    """

    document: Document
    recipe: Recipe
    revision: int
    without: frozenset[str]
    chosen: str
    draft: bool
    painted: Mapping[str, bytes]


class Grooming:
    """Makes the groom of the open recipe. Public methods run on the session's thread.

    call:   runs a function on the session's thread
    show:   called there with each groom of the open recipe, and the revision of its document
    failed: reports an error message
    """

    def __init__(
        self,
        project: Project,
        publisher: Publisher,
        problems: ProblemList,
        call: Callable[..., None],
        show: Callable[[DisplayGroom, int], None],
        failed: Callable[[str], None],
    ) -> None:
        self._publisher, self._problems = publisher, problems
        self._call, self._show, self._failed = call, show, failed
        self._evaluator = GroomEvaluator(project)
        self._worker = LatestTaskWorker[Work](self._groom, "groom")
        self._measurer = LatestTaskWorker[DisplayGroom](self._measure, "measure")

    def open(self, files: Files, viewport: Viewport) -> None:
        """Makes the groom of other files from now on."""
        self._files, self._viewport = files, viewport
        self._shown: Recipe | None = None  # recipe of the displayed groom

    def request(self, *, draft: bool = False, large: bool = False) -> None:
        """Requests the groom of the current recipe; a draft while a gesture is in progress.

        large: makes it however long it takes; otherwise one that takes much longer than the displayed one is held
        """
        recipe, display = self._files.recipe.model, self._viewport.display
        ratio = 0.0
        if not large and display is not None and self._shown is not None:
            ratio = too_large(recipe, self._shown, display)
        if ratio:
            self._hold(f"This groom has about {ratio:.0f} times as many points as the one that is seen")
            return
        self._problems.clear(WORK)
        self.request_of(recipe, draft=draft)

    def request_of(self, recipe: Recipe, *, draft: bool, painted: Mapping[str, bytes] | None = None) -> None:
        """Requests the groom of a recipe that is the current one but for a stroke that has not ended.

        painted: maps with a stroke that has not ended
        """
        files = self._files
        document = files.recipe
        maps = document.painted if painted is None else painted
        self._worker.submit(Work(document, recipe, document.revision, files.without_effect, files.groom, draft, maps))

    def cancel(self) -> None:
        """Cancels the groom that is being made."""
        self._worker.cancel()

    def cancel_by_hand(self) -> None:
        """Cancels the groom that is being made, and offers to make it after all."""
        self._hold("The groom was canceled; the last one is seen")

    def stop(self, patience: float) -> None:
        """Stops the threads; waits for each up to ``patience`` [s]."""
        self._worker.stop(patience)
        self._measurer.stop(patience)

    def _hold(self, why: str) -> None:
        self._worker.cancel()
        self._problems.show(WORK, why, [MAKE, UNDO])

    def _groom(self, work: Work) -> None:
        """Grooms on the worker thread. Newer work does not abort a draft, so that the page updates during a gesture."""
        check_abort = self._worker.raise_if_cancelled if work.draft else self._worker.raise_if_stale
        self._measurer.cancel()
        progress = ProgressReport(lambda *now: self._call(self._report, *now), PROGRESS_AFTER)
        try:
            display = self._evaluator.groom(
                work.recipe,
                work.without,
                chosen=work.chosen,
                draft=work.draft,
                check_abort=check_abort,
                progress=progress,
                painted=work.painted,
                found=self._found,
            )
            self._call(self._succeed, display, work)
            if not work.draft:
                self._measurer.submit(display)
        except UserError as error:
            self._call(self._fail, error, work)
        except Stale:
            raise
        except Exception as error:
            self._call(self._failed, failure("a groom could not be made", error))
        finally:
            progress.close()

    def _found(self, recipe: Recipe, inputs: dict[str, Any]) -> None:
        """Shows the head of the first groom before that is made."""
        if self._viewport.display is not None:
            return
        scalp, file, hidden = inputs["scalp"], inputs["scalp_file"], inputs["hidden"]
        bodies = read_meshes(scalp, file, cage=recipe.scalp.surface == "cage", hidden=hidden)
        self._call(self._viewport.show_head, scalp, recipe.scalp.region, lambda: bodies)

    def _report(self, stage: str, done: float) -> None:
        self._publisher.publish("progress", pack(protocol.Progress(stage=stage, done=done)))

    def _measure(self, display: DisplayGroom) -> None:
        """Measures a groom on a worker thread; a new groom cancels it."""
        groom, chunks = display.groom, []
        for chunk in overlays.depths(groom.scalp, groom.scalp.points, groom.locks, groom.locks.points):
            self._measurer.raise_if_stale()
            chunks.append(chunk)
        self._call(self._publisher.publish, "measured", measured(groom, np.concatenate([np.empty(0), *chunks])))

    def _succeed(self, display: DisplayGroom, work: Work) -> None:
        if self._is_open(work.document):
            self._problems.clear(GROOM, SAVE)
            self._shown = work.recipe
            self._show(display, work.revision)

    def _fail(self, error: UserError, work: Work) -> None:
        """Shows why a groom cannot be made, with the remedies; it stays until one can."""
        if self._is_open(work.document):
            undo = [UNDO] if work.document.can_undo else []
            setting = ".".join(str(part) for part in error.fixes[0].place) if error.fixes else ""
            self._problems.show(GROOM, str(error), [*fixes_of(error, "recipe"), *undo], place=("recipe", setting))

    def _is_open(self, document: Document) -> bool:
        """Whether no other file was opened since a request."""
        return document is self._files.documents.get("recipe")
