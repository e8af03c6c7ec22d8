"""Rows of the tests of advice: what takes of live hair refuse."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import patch

from pxr import Usd
from remedies import RECIPE, SAVE, WIDER, Act, Advice, asked, in_order
from ringlet.viewer import protocol
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.files.writing import write
from ringlet.viewer.keep.review_folder import ReviewFolder
from ringlet.viewer.keep.snapshots import SnapshotStore, Stored
from ringlet.viewer.play.take_shot import write_take_shot
from ringlet.viewer.play.takes import TakeRing
from ringlet.viewer.project import Project
from ringlet.viewer.session import Session
from test_viewer_snapshots import LOOK
from test_viewer_takes import recorded

import ringlet
from ringlet import io


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


def kept(session: Session, *, moving: bool = True, muted: bool = False) -> None:
    """Keeps a snapshot of the open recipe, with a take."""
    groom = ringlet.build_groom(RECIPE)
    motion = recorded(groom, 20, "nod")[0].take(groom) if moving else None
    store, look = session._review.snapshots, protocol.Shared.model_validate(LOOK)
    id = store.take(session.files.recipe, look, b"", "", "", motion)
    store.entries["a"] = store.entries.pop(id).model_copy(update={"muted": ["curl"] if muted else []})
    for suffix in (".recipe.toml", ".take.npz"):
        if (file := store.folder.file(store.file(id, suffix))).exists():
            file.rename(file.with_name(f"a{suffix}"))


def made(name: str = "", *steps: Callable[[Session], object] | protocol.FromPage, **keeps: bool) -> Act:
    """Makes a shot of a take in a review, after other steps."""
    return asked(lambda session: kept(session, **keeps), *steps, protocol.MakeShot(id="a", name=name))


def instanced(*, mesh: bool) -> None:
    """Writes a clip of a head that is an instance, or a mesh."""
    stage = Usd.Stage.Open("head.usda")
    copy = stage.DefinePrim("/ball/copy")
    copy.GetReferences().AddReference("./head.usda", "/ball")
    copy.SetInstanceable(not mesh)
    stage.Export("copied.usda")
    io.write_head_clip("copied.usda", Path("clip.usdc"), (1, 2), lambda _, rest, frame: rest)


def on_head(name: str) -> Act:
    """Makes a shot of a take on the head of a file."""

    def act() -> None:
        files, groom = Files(Path(RECIPE).resolve(), Project(Path.cwd())), ringlet.build_groom(RECIPE)
        take = recorded(groom, 20, "nod")[0].take(groom)
        with patch.object(Files, "chosen_recipe", SimpleNamespace(scalp_file=Path(name))):
            write_take_shot(files, take, "", "")

    return act


def load(session: Session) -> None:
    """Loads the settings of the take, and saves them."""
    session._review.load_snapshot("a")
    write(session.files, "recipe")


ROWS = [
    Advice("take: nothing has moved in the last {} s; move the head", lambda: ring()(), lambda: ring("nod")()),
    Advice("take: hair does not move live; press L", lambda: TakeRing().take(None), lambda: ring("nod")()),
    Advice("take: the groom has changed; keep the take once", of_other_groom, lambda: ring("nod")()),
    Advice(
        "snapshot: {}{} holds no take ({}); delete the snapshot",
        lambda: damaged(delete=False),
        lambda: damaged(delete=True),
    ),
    Advice("take: {} is there already; give another name", in_order(made("nod"), made("nod")), made("nod_2")),
    Advice("take: snapshot {} holds no motion; keep a take", made("a", moving=False), made("b")),
    Advice("take: stages were muted in it; take them out", made("c", muted=True), made("d")),
    Advice("take: {} has unsaved changes; save them", made("e", WIDER), made("f", WIDER, SAVE, load)),
    Advice("{} has changed since it was kept; load its settings", made("g", WIDER, SAVE), made("h", WIDER, SAVE, load)),
    Advice("take: {} cannot be animated; make the head a USD file", on_head("head.obj"), on_head("head.usda")),
    Advice(
        "is an instance and cannot follow a take; export it as a mesh",
        lambda: instanced(mesh=False),
        lambda: instanced(mesh=True),
    ),
]
