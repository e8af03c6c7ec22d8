"""Edits of the open files by the page that leads."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Any

from ringlet.data.errors import UserError
from ringlet.viewer import protocol
from ringlet.viewer.disk_changes import DiskChanges
from ringlet.viewer.edit import eyedropper
from ringlet.viewer.edit.drawing import draw
from ringlet.viewer.edit.manipulator import LockManipulator
from ringlet.viewer.edit.operator_list import arrange
from ringlet.viewer.edit.strokes import Strokes
from ringlet.viewer.files import conflicts
from ringlet.viewer.files.document_message import document_message
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.files.presets import Presets
from ringlet.viewer.keep.comparer import Comparer
from ringlet.viewer.keep.reviewing import Reviewing
from ringlet.viewer.pages import Page, Pages
from ringlet.viewer.play.playback import Playback
from ringlet.viewer.protocol import File
from ringlet.viewer.publisher import Publisher
from ringlet.viewer.show.grooming import Grooming
from ringlet.viewer.show.viewport import Viewport
from ringlet.viewer.worker import Timer

REST_AFTER = 1.0  # time without a message of a gesture after which its whole groom is made [s]


class Editing:
    """Makes the edits that pages ask for, publishes the documents and requests their grooms.

    A gesture gets drafts until its hand rests, or no more is heard of it. Methods run on the session's thread.

    submit:  runs a call on that thread
    changed: called there after the shot has changed
    """

    def __init__(
        self, publisher: Publisher, pages: Pages, submit: Callable[..., Any], changed: Callable[[], None]
    ) -> None:
        self._publisher, self._pages, self._changed = publisher, pages, changed
        self._rest = Timer(REST_AFTER, submit)

    def open(
        self,
        files: Files,
        viewport: Viewport,
        grooming: Grooming,
        comparer: Comparer,
        playback: Playback,
        review: Reviewing,
        disk: DiskChanges,
    ) -> None:
        """Edits other files from now on."""
        self._files, self._viewport, self._review, self._disk = files, viewport, review, disk
        self._grooming, self._comparer, self._playback = grooming, comparer, playback
        self.strokes = Strokes(files, viewport, grooming)
        self._manipulator, self._presets, self._trying = LockManipulator(files, viewport), Presets(files), False

    def stop(self) -> None:
        """Forgets the gesture in progress."""
        self._rest.cancel()

    def handle(self, page: Page, message: protocol.FromPage) -> None:
        """Makes an edit; raises UserError for one that fails, and for a message that is no edit."""
        files = self._files
        match message:
            case protocol.Set():
                files.set(message.file, message.changes, message.gesture)
                self.edited(message.file, resting=message.resting)
            case protocol.Arrange():
                arrange(files, message)
                self.edited("recipe")
            case protocol.Choose():
                files.choose(message.groom)
                self.edited("recipe")
            case protocol.Mute():
                files.recipe.apply(files.recipe.text, muted=frozenset(message.stages), solo=message.solo)
                self.edited("recipe")
            case protocol.Step():
                for file in files.step(message.kind):
                    self.edited(file)
            case protocol.UseRun():
                files.document("shot").apply(self._playback.text_of_run(message.run))
                self.edited("shot")
            case protocol.Resolve():
                conflicts.resolve(files.document(message.file), message)
                self.edited(message.file)
            case protocol.Restore():
                files.recover(message.file, message.text, message.edits, message.saved, message.saved_edits)
                self.edited(message.file)
            case protocol.LoadSnapshot():
                self._review.load_snapshot(message.id)
                self.edited("recipe")
            case protocol.PickColor():
                self._pages.notice(eyedropper.pick(files, message.color))
                self.edited("recipe")
            case protocol.Isolate():
                self._manipulator.isolate(message)
                self.edited("recipe")
            case protocol.Drag():
                self._manipulator.drag(message)
                self.edited("recipe", resting=message.resting)
            case protocol.Sculpt():
                self._publisher.publish("guides", self.strokes.sculpt(message))
                self._stroked(resting=message.resting and message.tool not in ("freeze", "thaw"))
            case protocol.Unsculpt():
                self.strokes.remove_sculpts()
                self.edited("recipe")
            case protocol.ShowMap():
                page.queue.put("painted", self.strokes.show_map(message))
            case protocol.Paint():
                self._pages.send("painted", self.strokes.paint(message))
                self._stroked(resting=message.resting)
            case protocol.Draw():
                draw(files, message, self._viewport.made("draw").groom)
                self.edited("recipe")
            case protocol.ListPresets():
                page.queue.put("presets", self._presets.message())
            case protocol.Try():
                self._try(message)
            case protocol.Take():
                self._presets.take(message)
                self.edited("recipe", resting=message.resting)
            case protocol.Keep():
                path = self._presets.keep(message)
                self._pages.notice(f"{path.name} is kept")
                page.queue.put("presets", self._presets.message())
            case _:
                raise UserError(f"message: {message.kind} must be the first of a page")

    def edited(self, file: File, *, resting: bool = True) -> None:
        """Publishes a document that has changed, and requests its groom: a draft of one that is not ``resting``."""
        self._trying = False
        document = self._files.document(file)
        if document.theirs is not None and not document.dirty:
            with suppress(UserError):  # theirs is invalid, and the conflict stays
                document.meet(*document.theirs)
        self._disk.show_conflict(file)
        self._publisher.publish(f"document/{file}", document_message(self._files, file))
        if file == "recipe":
            self._grooming.request(draft=not resting)
        else:
            self._playback.publish_timeline()
            self._changed()
        if resting:
            self._comparer.recompute()
            self._rest.cancel()
        else:  # the hand may never be heard to rest
            self._rest.restart(self.settle)

    def _stroked(self, *, resting: bool) -> None:
        """A brush has moved: requests a draft; the end of the stroke is an edit."""
        if resting:
            self.edited("recipe")
        elif self.strokes.busy:
            self.strokes.request(draft=True)
            self._rest.restart(self.settle)

    def _try(self, message: protocol.Try) -> None:
        """Shows the groom with a preset, or as it was; the newest one counts."""
        recipe = self._presets.tried(message.name, message.part) if message.name else None
        self._grooming.cancel()
        self._trying = recipe is not None
        if recipe is None:
            self._grooming.request()
        else:
            self._grooming.request_of(recipe, draft=True)

    def settle(self) -> None:
        """Makes the whole groom of a gesture whose hand was not heard to rest."""
        if not self._rest.cancel() or "recipe" not in self._files.documents:
            return
        if self.strokes.busy:
            self.strokes.request(draft=False)
        else:
            self._grooming.request()

    def end_gesture(self) -> None:
        """Ends the gesture of a page that is gone: its stroke is kept, and the whole groom is made."""
        if self.strokes.busy:
            self.strokes.finish()
            self.edited("recipe")
        if self._trying:
            self._try(protocol.Try())
        self.settle()
