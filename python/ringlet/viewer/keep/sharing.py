"""Share pages of a session, made on a worker thread."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ringlet.data.errors import failure
from ringlet.viewer import protocol
from ringlet.viewer.keep.share_page import make_page
from ringlet.viewer.keep.share_review import review_of
from ringlet.viewer.project import Project
from ringlet.viewer.publisher import SendQueue
from ringlet.viewer.show.lights import live_rigs_of
from ringlet.viewer.wire import pack, trouble
from ringlet.viewer.worker import LatestTaskWorker


@dataclass(frozen=True)
class Sharing:
    """A request for a share page.

    retained: messages of the review, by subject
    file:     the file of the look
    view:     how it is first seen
    page:     the page that asks
    """

    retained: dict[str, bytes]
    file: Path
    view: dict[str, Any]
    page: SendQueue


class Sharer:
    """Makes share pages. Public methods run on the session's thread."""

    def __init__(self, project: Project) -> None:
        self._project = project
        self._worker = LatestTaskWorker[Sharing](self._make, "share")

    def share(self, retained: dict[str, bytes], file: Path, message: protocol.Share, page: SendQueue) -> None:
        """Sends the page of a look as soon as it is made.

        retained: messages of the review, by subject
        file:     the file of the look
        """
        self._worker.submit(Sharing(retained, file, message.model_dump(exclude={"kind"}), page))

    def stop(self, patience: float) -> None:
        """Stops the thread; waits for it up to ``patience`` [s]."""
        self._worker.stop(patience)

    def _make(self, asked: Sharing) -> None:
        try:
            review, rigs = review_of(asked.file, self._project), live_rigs_of(self._project)[0]
            page = make_page(asked.retained, asked.file.name, asked.view, review, rigs)
            name = f"{asked.file.name.split('.')[0]}.html"
            made = protocol.SharePage(name=name, hairs=page.hairs, of=page.of)
            asked.page.put("share", pack(made, text=np.frombuffer(page.text.encode(), np.uint8)))
        except Exception as error:
            asked.page.put("trouble", trouble(failure("a share page could not be made", error)))
