"""Conflicts of a document with its file on disk: the settings that differ, and the choice between both versions."""

from __future__ import annotations

from ringlet.data.errors import UserError
from ringlet.viewer import protocol
from ringlet.viewer.files.document import Document
from ringlet.viewer.files.merge import Versions
from ringlet.viewer.protocol import Difference


def differences(document: Document) -> list[Difference]:
    """Settings in which a document differs from its file on disk; none where one of both is no TOML.

    Raises UserError for a document without a conflict.
    """
    try:
        return [
            difference.model_copy(update={"name": prefix + difference.name})
            for versions, prefix in _versions(document)
            for _, difference in versions.differences()
        ]
    except ValueError:
        return []


def resolve(document: Document, message: protocol.Resolve) -> None:
    """Ends a conflict; raises UserError for a merge that leaves a setting open or gives an invalid file."""
    versions = [one for one, _ in _versions(document)]
    if message.choice == "mine":
        texts = [one.mine for one in versions]
    elif message.choice == "theirs":
        texts = [one.theirs for one in versions]
    else:
        found = differences(document)
        if open_ := [one.name for one in found if one.name not in {*message.mine, *message.theirs}]:
            raise UserError(f"{document.path.name}: {open_[0]} differs; choose one of both values")
        names = iter(found)
        texts = []
        for one in versions:
            places = [place for place, _ in one.differences()]
            texts.append(one.merged([place for place in places if next(names).name in message.mine]))
    document.resolve(*texts)


def _versions(document: Document) -> list[tuple[Versions, str]]:
    """The three versions of a document and of its file of edits, each with a prefix for names."""
    if document.theirs is None:
        raise UserError(f"{document.path.name}: has no conflict with its file; go on")
    text, edits = document.theirs
    return [
        (Versions(document.saved, document.text, text), ""),
        (Versions(document.saved_edits, document.state.edits, edits), "edits: "),
    ]
