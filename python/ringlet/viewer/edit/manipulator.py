"""Manual edits of single locks: isolate, drag and return to the procedural groom."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.groom import Groom, row_of
from ringlet.groom.edits import shape_frames
from ringlet.groom.scalp import Scalp
from ringlet.viewer import protocol
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.show.viewport import Viewport


class LockManipulator:
    """State of a gesture that drags a lock."""

    def __init__(self, files: Files, viewport: Viewport) -> None:
        self._files, self._viewport = files, viewport
        self._grabbed: tuple[int, int, np.ndarray] | None = None
        self._moves: tuple[int, list[dict[str, Any]]] | None = None

    def isolate(self, message: protocol.Isolate) -> None:
        """Isolates locks from the procedural groom in their current position, or returns them.

        Raises UserError for a lock that does not exist or is edited in another file.
        """
        document = self._files.recipe
        edits = document.contents().get("edit", [])
        edited = {edit.get("lock") for edit in edits}
        if message.out:
            groom = self._viewport.made("isolate").groom
            for lock in set(message.locks) - set(groom.locks.ids.tolist()):
                row_of(groom, lock)  # raises UserError with the nearest id
            new = [lock for lock in dict.fromkeys(message.locks) if lock not in edited]
            unmoved = [{"lock": lock, "move": [{"at": 1.0, "by": [0.0, 0.0, 0.0]}]} for lock in new]
            document.add_tables("edit", len(edits), unmoved)
            return
        if elsewhere := {edit.lock for edit in document.model.edit} & set(message.locks) - edited:
            raise UserError(
                f"{document.path.name}: lock {min(elsewhere)} is edited in another file; return it there, or with: "
                f"ringlet edit {document.path.name} --release {min(elsewhere)}"
            )
        returned = set(message.locks)
        document.remove_tables("edit", [k for k, edit in enumerate(edits) if edit.get("lock") in returned])

    def drag(self, message: protocol.Drag) -> None:
        """Moves a point of an isolated lock to a position, stored in the frame of the lock's shape.

        Raises UserError for a lock that is not isolated and for a point that does not exist.
        """
        document, display = self._files.recipe, self._viewport.display
        edits = document.contents().get("edit", [])
        index = next((k for k, edit in enumerate(edits) if edit.get("lock") == message.lock), None)
        if display is None or index is None:
            raise UserError(f"lock {message.lock} is not isolated; isolate it before it is dragged")
        row = row_of(display.groom, message.lock)
        count = int(display.groom.locks.counts[row])
        if not 0 < message.point < count:
            raise UserError(
                f"lock {message.lock} has points 1 to {count - 1} to drag; there is none at {message.point}"
            )
        at = round(message.point / (count - 1), 4)
        if self._grabbed is None or self._grabbed[:2] != (message.gesture, message.point):
            self._grabbed = (message.gesture, message.point, np.array(display.groom.locks[row][message.point]))
        shift = _in_shape_frame(display.groom, row, at, np.array(message.to) + display.groom.origin - self._grabbed[2])
        moves = [move for move in self._moves_before(message.gesture, edits[index]) if any(move["by"])]
        by = [f"{1e3 * x:.2f} mm" for x in shift]
        moves = [*moves, {"at": at, "by": by, "falloff": max(round(message.falloff, 3), 0.001)}]
        document.set([(["edit", index, "move"], moves)], message.gesture)

    def _moves_before(self, gesture: int, edit: dict[str, Any]) -> list[dict[str, Any]]:
        """Moves of a lock before a gesture."""
        if self._moves is None or self._moves[0] != gesture:
            self._moves = (gesture, edit.get("move", []))
        return self._moves[1]


def _in_shape_frame(groom: Groom, row: int, at: float, by: NDArray[np.float64]) -> NDArray[np.float64]:
    """Converts a displacement in world space to the frame of a lock's shape, as in ``move.by`` of an edit [m].

    row: row of the lock
    at:  parameter on the lock, from root (0) to tip (1)
    by:  displacement in world space [m], shape (3,)
    """
    root = Scalp(groom.scalp, groom.region).frames(groom.locks)[row]
    frame = shape_frames(groom.shapes or groom.locks, row, root, np.array([at]))[0]
    return frame.T @ by
