"""What other programs write: the open files, what they refer to, and the files of the project."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Collection
from pathlib import Path

from ringlet.data.errors import UserError
from ringlet.viewer import protocol
from ringlet.viewer.files.conflicts import differences
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.files.problems import GROOM, ProblemList, conflict_fixes, dismiss, gone
from ringlet.viewer.files.watcher import FileWatcher
from ringlet.viewer.keep.reviewing import Reviewing
from ringlet.viewer.play.caches import Caches
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import File, Fix
from ringlet.viewer.publisher import Publisher
from ringlet.viewer.wire import pack

WATCH_INTERVAL = 0.4  # interval at which open files are looked at [s]
FILES_INTERVAL = 2.0  # interval at which the list of files is refreshed [s]

log = logging.getLogger("ringlet.viewer")


class DiskChanges:
    """Watches the files of a session: loads those that changed, or shows the conflict with unsaved changes.

    call:   runs a function on the session's thread, on which all other methods run
    edited: called there with the kind of a document that was loaded
    notice: shows a short message
    met:    called there after all that changed was looked at
    """

    def __init__(
        self,
        project: Project,
        publisher: Publisher,
        problems: ProblemList,
        review: Reviewing,
        call: Callable[..., None],
        edited: Callable[[File], None],
        notice: Callable[[str], None],
        met: Callable[[], None],
    ) -> None:
        self._project, self._publisher, self._problems, self._review = project, publisher, problems, review
        self._call, self._edited, self._notice, self._met = call, edited, notice, met
        self._caches, self._watcher = Caches(project), FileWatcher()
        self._task: asyncio.Task[None] | None = None

    def open(self, files: Files) -> None:
        """Watches other files from now on."""
        self._files = files
        self._watcher.changed(files.watched())

    def start(self, loop: asyncio.AbstractEventLoop) -> None:
        """Begins to watch."""
        self._task = loop.create_task(self._watch())

    def stop(self) -> None:
        """Ends watching."""
        if self._task is not None:
            self._task.cancel()

    async def _watch(self) -> None:
        posted, looks = None, 0
        missing, reported = set[File](), set[File]()
        while True:
            before, missing = missing, await asyncio.to_thread(self._missing)
            if (lasting := missing & before) != reported:  # an editor removes a file before it renames another
                self._call(self.show_gone, lasting)
                reported = lasting
            if changed := await asyncio.to_thread(self._changed_files):
                self._call(self.meet, changed)
            if looks * WATCH_INTERVAL % FILES_INTERVAL < WATCH_INTERVAL:
                names = await asyncio.to_thread(self._names)
                if names != posted:
                    self._call(self._publisher.publish, "files", pack(protocol.Files(names=names)))
                posted = names
                if await asyncio.to_thread(self._review.watch):
                    self._call(self._review.reload)
            looks += 1
            await asyncio.sleep(WATCH_INTERVAL)

    def _changed_files(self) -> set[Path]:
        try:
            return self._watcher.changed(self._files.watched())
        except Exception:
            log.exception("files could not be watched")
            return set()

    def _names(self) -> list[str]:
        return [*self._project.files("*.recipe.toml", "*.shot.toml"), *self._caches.names()]

    def meet(self, changed: set[Path]) -> None:
        """Takes in files that other programs changed: loads them, or shows the conflict with unsaved changes."""
        watched = self._files.watched()
        for file, document in self._files.documents.items():
            if not any(watched.get(path) == file for path in changed):
                continue
            try:
                if self._files.meet_disk(file):
                    self._notice(f"{document.path.name} was changed by another program, and is loaded again")
                    self._edited(file)
                elif document.theirs is None and not changed <= self._files.own(file):
                    self._recheck(file)
            except UserError as error:
                self._problems.show(f"conflict/{file}", str(error), conflict_fixes(file), place=(file, ""))
                continue
            self.show_conflict(file)
        self._met()

    def _recheck(self, file: File) -> None:
        """Takes in a change of a file that a document refers to."""
        try:
            self._files.document(file).recheck()
        except UserError as error:
            self._problems.show(GROOM, str(error))
            return
        self._edited(file)

    def _missing(self) -> set[File]:
        return {file for file, document in self._files.documents.items() if not document.path.exists()}

    def show_gone(self, missing: Collection[File]) -> None:
        """Shows which documents are no longer on disk."""
        for file, document in self._files.documents.items():
            if file not in missing:
                self._problems.clear(gone(file))
                continue
            message = f"{document.path.name} is no longer on disk; what it said is kept here, and Save writes it again"
            save = Fix(label="Save", message={"kind": "save", "file": file})
            self._problems.show(gone(file), message, [save, dismiss(gone(file))])

    def show_conflict(self, file: File) -> None:
        """Shows the conflict of a document with its file on disk, or that there is none."""
        document = self._files.documents.get(file)
        if document is None or document.theirs is None:
            self._problems.clear(f"conflict/{file}")
            return
        message = f"{document.path.name} was changed by another program while it has unsaved changes here"
        self._problems.show(
            f"conflict/{file}", message, conflict_fixes(file), place=(file, ""), differences=differences(document)
        )
