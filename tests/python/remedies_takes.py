"""Rows of the tests of advice: what takes of live hair refuse."""

from __future__ import annotations

from pathlib import Path

from remedies import RECIPE, Act, Advice
from ringlet.viewer import protocol
from ringlet.viewer.keep.review_folder import ReviewFolder
from ringlet.viewer.keep.snapshots import SnapshotStore, Stored
from ringlet.viewer.play.takes import TakeRing
from ringlet.viewer.project import Project
from test_viewer_snapshots import LOOK
from test_viewer_takes import recorded

import ringlet


def ring(*motions: str) -> Act:
    groom = ringlet.build_groom(RECIPE)
    return lambda: recorded(groom, 20, *motions)[0].take(groom)


def of_other_groom() -> None:
    groom = ringlet.build_groom(RECIPE)
    recorded(groom, 20, "nod")[0].take(None)


def damaged(*, delete: bool) -> None:
    """Reads the takes of all snapshots, of which one is damaged."""
    store = SnapshotStore(ReviewFolder(Path(RECIPE).resolve(), Project(Path.cwd())))
    store.add(Stored(look=protocol.Shared.model_validate(LOOK), seconds=1.0), "a")
    store.folder.write_bytes("snapshots/a.take.npz", b"damaged")
    if delete:
        store.delete("a")
    for id in store.entries:
        store.motion(id)


ROWS = [
    Advice("take: nothing has moved in the last {} s; move the head", lambda: ring()(), lambda: ring("nod")()),
    Advice("take: hair does not move live; press L", lambda: TakeRing().take(None), lambda: ring("nod")()),
    Advice("take: the groom has changed; keep the take once", of_other_groom, lambda: ring("nod")()),
    Advice(
        "snapshot: {}{} holds no take ({}); delete the snapshot",
        lambda: damaged(delete=False),
        lambda: damaged(delete=True),
    ),
]
