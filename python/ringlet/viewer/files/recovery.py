"""Recovers what the last session of a file left unsaved, and keeps the journal of this one."""

from __future__ import annotations

import base64
from collections.abc import Mapping

from ringlet.data.errors import UserError
from ringlet.viewer.files.journal import Entry, Journal, Unsaved
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.files.problems import RECOVERED, ProblemList, dismiss
from ringlet.viewer.protocol import Fix


class Recovery:
    """The journal of the open files of a session."""

    def __init__(self, files: Files, problems: ProblemList) -> None:
        self._files, self._problems = files, problems
        self._journal = Journal(files.file)

    def recover(self) -> Entry | None:
        """Restores unsaved changes; returns the entry of the journal, None without one."""
        files = self._files
        try:
            entry = self._journal.read()
            for kind, document in files.documents.items():
                one = entry.documents.get(kind) if entry is not None else None
                if one is not None and document.path.name == one.name:
                    files.recover(kind, one.text, one.edits, one.saved, one.saved_edits, one.maps)
        except UserError as error:
            self._problems.show(RECOVERED, str(error), [dismiss(RECOVERED)])
            return None
        if not files.clean:
            names = " and ".join(document.path.name for document in files.documents.values() if document.dirty)
            fixes = [Fix(label="Discard them", message={"kind": "revert"}), dismiss(RECOVERED)]
            self._problems.show(RECOVERED, f"Unsaved changes of {names} were recovered", fixes)
        return entry

    def record(self, heard: Mapping[str, int], leader: str) -> None:
        """Writes the unsaved changes.

        heard:  number of handled messages of each page
        leader: name of the page that holds the edit lock
        """
        documents = {
            kind: Unsaved(
                name=document.path.name,
                text=document.text,
                edits=document.state.edits,
                saved=document.saved,
                saved_edits=document.saved_edits,
                maps={name: base64.b64encode(picture) for name, picture in document.painted.items()},
            )
            for kind, document in self._files.documents.items()
            if document.dirty
        }
        self._journal.write(Entry(documents=documents, heard=dict(heard), leader=leader))

    def close(self, *, discard: bool = False) -> None:
        """Ends the session of the files; the journal stays when they have unsaved changes that are not discarded."""
        self._journal.close(clean=discard or self._files.clean)
