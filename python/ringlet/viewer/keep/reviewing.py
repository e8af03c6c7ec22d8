"""What a session keeps next to its recipe: dispatches the messages about it, and publishes it to all pages."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from ringlet.data.errors import UserError
from ringlet.groom import Recipe
from ringlet.viewer import protocol
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.files.variant import settings_of
from ringlet.viewer.keep.notes import NoteStore
from ringlet.viewer.keep.references import ReferenceStore
from ringlet.viewer.keep.review_folder import ReviewFolder, decode_picture
from ringlet.viewer.keep.snapshots import SnapshotStore, Texts, keep_with_shot, load, recipe_of
from ringlet.viewer.keep.views import ViewStore
from ringlet.viewer.project import Project
from ringlet.viewer.publisher import Publisher
from ringlet.viewer.show.live_take import LiveTake
from ringlet.viewer.wire import pack


class Reviewing:
    """The review folder of the open file. Runs on the session's thread.

    notice: reports to all pages
    """

    def __init__(self, project: Project, publisher: Publisher, notice: Callable[[str], None]) -> None:
        self._project, self._publisher, self._notice = project, publisher, notice

    def open(self, files: Files) -> None:
        """Reads the folder of the open recipe, or of another file without one."""
        self._files = files
        file = files.recipe.path if "recipe" in files.documents else files.file
        self._folder = ReviewFolder(file, self._project)
        self.snapshots, self.notes = SnapshotStore(self._folder), NoteStore(self._folder)
        self.references, self.views = ReferenceStore(self._folder), ViewStore(self._folder)
        self._state = self._folder.state()

    def publish(self) -> None:
        """Publishes everything that the folder holds."""
        self._publish_snapshots()
        self._publish_notes()
        self._publish_references()
        self._publish_views()
        self._publisher.clear("notice/review")
        stores = (self.snapshots, self.notes, self.references, self.views)
        if errors := [error for store in stores for error in store.unreadable]:  # pages that join later see it too
            self._publisher.publish("notice/review", pack(protocol.Notice(message=errors[0])))

    def watch(self) -> bool:
        """Whether another program has changed the folder; runs on any thread."""
        return self._folder.state() != self._state

    def reload(self) -> None:
        """Takes in what other programs changed.

        The folder is compared again, on the thread of the session: a watch in the midst of its change sees that too.
        """
        if not self.watch():
            return
        self._state = self._folder.state()
        for store in (self.snapshots, self.notes, self.references, self.views):
            store.reload()
        self.publish()

    def handle(self, message: protocol.AnyReview) -> None:
        """Handles a message of any page; raises UserError for a request that fails."""
        self._do(lambda: self._change(message))

    def keep_take(self, message: protocol.KeepTake, motion: LiveTake) -> None:
        """Keeps a take of live hair as a snapshot; raises UserError when it cannot be written."""

        def keep() -> Callable[[], None]:
            picture, _ = decode_picture(message.picture, "take: picture")
            files = self._files
            shot = files.document("shot").text if files.mode == "shot" else ""
            self.snapshots.take(files.recipe, message.look, picture, message.author, message.note, motion, shot)
            return self._publish_snapshots

        self._do(keep)

    def _do(self, change: Callable[[], Callable[[], None]]) -> None:
        """Makes a change of the folder, which returns what publishes it."""
        try:
            publish = change()
        finally:
            self._state = self._folder.state()  # before pages hear of it: what is written then is of others
        publish()

    def _change(self, message: protocol.AnyReview) -> Callable[[], None]:
        """Changes the folder; returns what publishes the change."""
        snapshots, notes, references = self.snapshots, self.notes, self.references
        if isinstance(message, protocol.TakeSnapshot):
            picture, _ = decode_picture(message.picture, "snapshot: picture")
            snapshots.take(self._files.recipe, message.look, picture, message.author, message.note)
        elif isinstance(message, protocol.EditSnapshot):
            snapshots.change(message.id, {"note": message.note})
        elif isinstance(message, protocol.DeleteSnapshot):
            snapshots.delete(message.id)
        elif isinstance(message, protocol.WriteNote):
            notes.write(message)
            return self._publish_notes
        elif isinstance(message, protocol.EditNote):
            notes.edit(message)
            return self._publish_notes
        elif isinstance(message, protocol.DeleteNote):
            notes.delete(message.id)
            return self._publish_notes
        elif isinstance(message, protocol.AddReference):
            references.keep(message)
            return self._publish_references
        elif isinstance(message, protocol.PlaceReference):
            references.place(message)
            return self._publish_references
        elif isinstance(message, protocol.DeleteReference):
            references.delete(message.id)
            return self._publish_references
        else:
            self.views.keep(message.slot, message.look)
            return self._publish_views
        return self._publish_snapshots

    def load_snapshot(self, id: str) -> None:
        """Sets the recipe to a snapshot."""
        if not load(self.snapshots, id, self._files):
            self._notice(
                "What the recipe extends has changed since the snapshot; it is loaded as a recipe that extends no other"
            )

    def take_of_shot(self, id: str) -> LiveTake:
        """The take of a snapshot, for a shot with the open recipe; raises UserError where it is of another one."""
        document, stored = self._files.recipe, self.snapshots[id]
        motion = self.snapshots.motion(id)
        if motion is None:
            raise UserError(f"take: snapshot {id} holds no motion; keep a take of live hair")
        if stored.muted or stored.solo:
            raise UserError("take: stages were muted in it; take them out of the recipe, and keep a take again")
        if not self._files.clean:
            raise UserError(f"take: {self._files.file.name} has unsaved changes; save them, and make the shot then")
        if settings_of(recipe_of(self.snapshots.texts(id), self._files)) != settings_of(document.model):
            raise UserError(
                f"take: {document.path.name} has changed since it was kept; load its settings and save them, and make "
                "the shot then"
            )
        return motion

    def keep_with_shot(self, id: str, recipe: Path, text: str, first: int) -> None:
        """Keeps a take in the review folder of the shot that was made of it. text: of the recipe of the shot"""
        resolved = self._files.parse(text, recipe).text or text
        folder = ReviewFolder(recipe, self._project)
        keep_with_shot(self.snapshots, id, folder, Texts(text, resolved, ""), first)

    def snapshot_to_compare(self, id: str) -> tuple[Recipe, frozenset[str], str, str]:
        """Recipe, muted stages, name, and author and time of a snapshot; raises UserError when there is none."""
        stored = self.snapshots[id]
        recipe = recipe_of(self.snapshots.texts(id), self._files)
        name = stored.note.strip().splitlines()[0] if stored.note.strip() else "snapshot"
        when = stored.time.replace("T", " ")[:16]
        return recipe, frozenset(stored.muted), name, ", ".join(filter(None, (stored.author, when)))

    def _publish_snapshots(self) -> None:
        self._publisher.publish("snapshots", pack(protocol.Snapshots(snapshots=self.snapshots.snapshots)))
        self._publish_pictures("snapshots", self.snapshots.entries, self.snapshots.picture)

    def _publish_notes(self) -> None:
        self._publisher.publish("notes", pack(protocol.Notes(notes=self.notes.notes)))

    def _publish_references(self) -> None:
        self._publisher.publish("references", pack(protocol.References(references=self.references.references)))
        self._publish_pictures("references", self.references.entries, self.references.picture)

    def _publish_views(self) -> None:
        self._publisher.publish("views", pack(protocol.Views(views=self.views.views)))

    def _publish_pictures(self, kind: str, ids: Iterable[str], read: Callable[[str], bytes]) -> None:
        """Publishes the pictures of new entries, and removes those of deleted ones."""
        prefix = f"picture/{kind}/"
        known = {subject.removeprefix(prefix).removesuffix("/") for subject in self._publisher.subjects(prefix)}
        for id in known - set(ids):
            self._publisher.clear(f"{prefix}{id}/")
        for id in ids:
            if id in known:
                continue
            try:
                data = np.frombuffer(read(id), np.uint8)
            except UserError:
                continue  # an entry without its picture
            self._publisher.publish(f"{prefix}{id}/", pack(protocol.Picture(name=f"{kind}/{id}"), data=data))
