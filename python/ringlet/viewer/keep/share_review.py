"""What a share page shows of a review: the newest snapshots with their pictures, and the open notes."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any

from ringlet.data.errors import UserError
from ringlet.viewer.keep.notes import NoteStore
from ringlet.viewer.keep.review_folder import ReviewFolder
from ringlet.viewer.keep.snapshots import SnapshotStore
from ringlet.viewer.project import Project

MOST_SNAPSHOTS, MOST_NOTES = 12, 60
MOST_PICTURES = 3_000_000  # bytes of all pictures together


def review_of(file: Path, project: Project) -> dict[str, list[dict[str, Any]]]:
    """Snapshots and notes of a file, the newest first; none where its review keeps none."""
    folder = ReviewFolder(file, project)
    return {"snapshots": _snapshots(SnapshotStore(folder)), "notes": _notes(NoteStore(folder))}


def _snapshots(store: SnapshotStore) -> list[dict[str, Any]]:
    shown: list[dict[str, Any]] = []
    left = MOST_PICTURES
    for one in reversed(store.snapshots[-MOST_SNAPSHOTS:]):
        try:
            picture = store.picture(one.id)
        except UserError:  # its thumbnail is gone
            continue
        left -= len(picture)
        if left < 0:
            break
        data = f"data:image/png;base64,{base64.b64encode(picture).decode()}"
        shown.append({"author": one.author, "text": one.note, "time": one.time, "picture": data})
    return shown


def _notes(store: NoteStore) -> list[dict[str, Any]]:
    said = [note for note in store.notes if note.text.strip() and not note.resolved]
    return [
        {"author": note.author, "text": note.text, "time": note.time, "camera": note.look.camera}
        for note in reversed(said[-MOST_NOTES:])
    ]
