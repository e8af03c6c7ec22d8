"""Snapshots of a look: the text of the recipe, how it was looked at, and a thumbnail, in readable files.

``ID.toml`` has author, note, time and look, ``ID.png`` the thumbnail, and ``ID.recipe.toml`` the recipe as it was
written. Files that the recipe reads (meshes, curves, maps) count from the recipe's folder and are not copied. What a
recipe extends may change later, so that a snapshot also has ``ID.resolved.toml``, the recipe that refers to no other.
One of live hair has its motion, ``ID.take.npz``, and ``ID.shot.toml``, the shot whose material and forces moved it.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from typing import Annotated

from pydantic import AfterValidator, BaseModel

from ringlet.data.errors import UserError
from ringlet.data.former_names import present
from ringlet.data.upgrade import in_present_names
from ringlet.groom import Recipe
from ringlet.viewer.files.document import Document
from ringlet.viewer.files.merge import Versions
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.files.variant import settings_of
from ringlet.viewer.keep.review_entries import Entries
from ringlet.viewer.keep.review_folder import ReviewFolder, now
from ringlet.viewer.protocol import Shared, Snapshot
from ringlet.viewer.show.live_take import LiveTake

RECIPE, RESOLVED, EDITS, SHOT, TAKE = ".recipe.toml", ".resolved.toml", ".edits.toml", ".shot.toml", ".take.npz"
SUFFIXES = (".png", RECIPE, RESOLVED, EDITS, SHOT, TAKE)  # of the files of a snapshot besides its own
MOST_TAKE = 200_000_000  # bytes of the file of a take


class Stored(BaseModel):
    """Contents of the file of a snapshot.

    muted, solo: stages, as in the state of the recipe
    seconds:     of the take of live hair; 0 for none
    first:       frame at which the take begins in the shot that was made of it; None for no shot
    """

    author: str = ""
    note: str = ""
    time: str = ""
    muted: Annotated[list[str], AfterValidator(lambda stages: [*present(dict.fromkeys(stages), "muted")[0]])] = []
    solo: str = ""
    seconds: float = 0.0
    first: int | None = None
    look: Shared


@dataclass(frozen=True)
class Texts:
    """The recipe of a snapshot: as it was written, as one that refers to no other, and its file of edits."""

    written: str
    resolved: str
    edits: str


class SnapshotStore(Entries[Stored]):
    """The snapshots of a recipe, by id, the oldest first."""

    def __init__(self, folder: ReviewFolder) -> None:
        super().__init__(folder, "snapshot", Stored, most=500, suffixes=SUFFIXES)

    @property
    def snapshots(self) -> list[Snapshot]:
        """All snapshots, the oldest first."""
        return [
            Snapshot(id=id, author=one.author, note=one.note, time=one.time, look=one.look, seconds=one.seconds)
            for id, one in self.entries.items()
        ]

    def picture(self, id: str) -> bytes:
        """PNG file of the thumbnail of a snapshot; raises UserError when there is none."""
        return self.folder.bytes(self.file(id, ".png"))

    def take(
        self,
        document: Document,
        look: Shared,
        picture: bytes,
        author: str,
        note: str,
        motion: LiveTake | None = None,
        shot: str = "",
    ) -> str:
        """Writes a snapshot of a recipe; returns its id. A file that cannot be written leaves none of them.

        motion: of live hair, that plays
        shot:   text of the shot that moved it
        """
        id, state = self.new_id(), document.state
        stored = Stored(author=author, note=note, time=now(), muted=sorted(state.muted), solo=state.solo, look=look)
        try:
            self.folder.write_bytes(self.file(id, ".png"), picture)
            self.folder.write_text(self.file(id, RECIPE), state.text)
            if (resolved := document.model.text or state.text) != state.text:
                self.folder.write_text(self.file(id, RESOLVED), resolved)
            if state.edits:
                self.folder.write_text(self.file(id, EDITS), state.edits)
            if shot:
                self.folder.write_text(self.file(id, SHOT), shot)
            if motion is not None:
                self.folder.write_bytes(self.file(id, TAKE), motion.to_bytes())
                stored.seconds = round(motion.seconds, 3)
            return self.add(stored, id)  # the last file: those that belong to it are there
        except UserError:
            self.folder.remove(*(self.file(id, suffix) for suffix in SUFFIXES))
            raise

    def motion(self, id: str) -> LiveTake | None:
        """The take of live hair of a snapshot, None for one without; raises UserError when it cannot be read."""
        if not self[id].seconds:
            return None
        try:
            return LiveTake.from_bytes(self.folder.bytes(self.file(id, TAKE), MOST_TAKE))
        except ValueError as error:
            raise UserError(f"snapshot: {id}{TAKE} holds no take ({error}); delete the snapshot") from error

    def shot(self, id: str) -> str:
        """Text of the shot that moved the take of a snapshot; empty for none."""
        self.__getitem__(id)
        return self.folder.text(self.file(id, SHOT))

    def texts(self, id: str) -> Texts:
        """The recipe of a snapshot; raises UserError when its file is gone."""
        self.__getitem__(id)
        written = in_present_names(self.folder.text(self.file(id, RECIPE)))[0]
        if not written:
            raise UserError(f"snapshot: {id}{RECIPE} is gone; delete the snapshot")
        resolved, edits = (in_present_names(self.folder.text(self.file(id, suffix)))[0] for suffix in (RESOLVED, EDITS))
        return Texts(written, resolved or written, edits)


def keep_with_shot(store: SnapshotStore, id: str, folder: ReviewFolder, texts: Texts, first: int) -> None:
    """Keeps a take in the review folder of the shot that was made of it, whose recipe is another.

    first: frame of the shot at which it begins
    """
    copy = SnapshotStore(folder)
    try:
        for suffix in (".png", SHOT, TAKE):
            if store.folder.file(store.file(id, suffix)).exists():
                copy.folder.write_bytes(copy.file(id, suffix), store.folder.bytes(store.file(id, suffix), MOST_TAKE))
        copy.folder.write_text(copy.file(id, RECIPE), texts.written)
        copy.folder.write_text(copy.file(id, RESOLVED), texts.resolved)
        copy.add(store[id].model_copy(update={"first": first, "muted": [], "solo": ""}), id)
    except UserError:
        copy.folder.remove(*(copy.file(id, suffix) for suffix in SUFFIXES))
        raise


def recipe_of(texts: Texts, files: Files) -> Recipe:
    """The recipe of a snapshot, whatever has become of what it extends."""
    document = files.recipe
    return files.parse(texts.resolved, document.path, texts.edits if texts.resolved == texts.written else "")


def load(store: SnapshotStore, id: str, files: Files) -> bool:
    """Sets the recipe to a snapshot as one undo step; returns whether it still refers to what it extended.

    Raises UserError when the snapshot can no longer be parsed, such as after a mesh was removed.
    """
    document, texts, stored = files.recipe, store.texts(id), store[id]
    wanted = settings_of(recipe_of(texts, files))
    *nearer, (text, edits) = _candidates(document, texts)
    for some in nearer:
        with suppress(UserError):
            if settings_of(files.parse(some[0], document.path, some[1])) == wanted:
                text, edits = some
                break
    document.apply(text, edits=edits, muted=frozenset(stored.muted), solo=stored.solo)
    return "extends" not in texts.written or "extends" in text


def _candidates(document: Document, texts: Texts) -> list[tuple[str, str]]:
    """Texts of a recipe and of its file of edits that may have the settings of a snapshot, the best first.

    The first keeps the comments and the order of the present text; the last is the snapshot itself.
    """
    merged: list[tuple[str, str]] = []
    try:
        versions = Versions(document.text, texts.written, document.text)
        merged = [(versions.merged([place for place, _ in versions.differences()]), texts.edits)]
    except (ValueError, KeyError, IndexError, TypeError):
        pass  # the notation differs too much
    written = texts.written, texts.edits
    return [*merged, written, *([(texts.resolved, "")] if texts.resolved != texts.written else [])]
