"""A second groom for comparison, made on a worker thread."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ringlet.data.errors import UserError
from ringlet.data.regular import read_text
from ringlet.groom import Recipe
from ringlet.viewer import protocol
from ringlet.viewer.display_groom import GroomEvaluator
from ringlet.viewer.files import Files
from ringlet.viewer.project import Project
from ringlet.viewer.publisher import Publisher, SendQueue
from ringlet.viewer.viewport import Viewport
from ringlet.viewer.wire import pack, trouble
from ringlet.viewer.worker import LatestTaskWorker, Stale, report_mistake


@dataclass(frozen=True)
class Comparison:
    """A request for a groom to compare with: a recipe, its muted stages, its name, and the page that asks."""

    recipe: Recipe
    muted: frozenset[str]
    name: str
    page: SendQueue


class Comparer:
    """Makes the groom on side b of the viewport. Public methods run on the session's thread.

    call: runs a function on the session's thread
    """

    def __init__(self, project: Project, publisher: Publisher, call: Callable[..., None]) -> None:
        self._project, self._publisher, self._call = project, publisher, call
        self._evaluator = GroomEvaluator(project)
        self._worker = LatestTaskWorker[Comparison](self._groom, "compare")

    def open(self, files: Files, viewport: Viewport) -> None:
        """Compares with other files from now on."""
        self._files, self._viewport = files, viewport

    def compare(self, message: protocol.Compare, page: SendQueue) -> None:
        """Shows a groom for comparison as soon as it is made; raises UserError for a recipe that cannot be read."""
        self._viewport.clear_beside()
        self._worker.cancel()
        if message.to == "none":
            self._name("")
            return
        files, document = self._files, self._files.recipe
        recipe, muted, name = document.model, files.without_effect, "as it was"
        if message.to == "saved":
            recipe = files.parse(document.saved, document.path, document.saved_edits)
            muted, name = frozenset[str](), "as saved"
        elif message.to == "file":
            path = self._project.inside(message.name, "compare")
            recipe = files.parse(read_text(path, "choose a recipe of the project"), path)
            muted, name = frozenset[str](), path.name
        self._worker.submit(Comparison(recipe, muted, name, page))

    def cancel(self) -> None:
        """Cancels the groom that is being made."""
        self._worker.cancel()

    def stop(self, patience: float) -> None:
        """Stops the thread; waits for it up to ``patience`` [s]."""
        self._worker.stop(patience)

    def _groom(self, asked: Comparison) -> None:
        """Grooms on the worker thread."""
        try:
            display = self._evaluator.groom(
                asked.recipe, asked.muted, draft=False, check_abort=self._worker.raise_if_stale
            )
            self._worker.raise_if_stale()
            self._call(self._name, asked.name)
            self._call(self._viewport.show, display, "b")
        except UserError as error:
            asked.page.put("trouble", trouble(str(error)))
        except Stale:
            raise
        except Exception as error:
            asked.page.put("trouble", trouble(report_mistake("a groom to compare with could not be made", error)))

    def _name(self, name: str) -> None:
        self._publisher.publish("b/none", pack(protocol.Compared(name=name)))
