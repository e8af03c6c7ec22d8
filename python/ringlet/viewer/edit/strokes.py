"""The strokes of brushes: shown at once, with drafts of the groom until they end."""

from __future__ import annotations

from ringlet.viewer import protocol
from ringlet.viewer.edit.painting import Painter
from ringlet.viewer.edit.sculpting import Sculptor
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.show.grooming import Grooming
from ringlet.viewer.show.viewport import Viewport


class Strokes:
    """The brushes that sculpt guides and paint maps, and the stroke in progress."""

    def __init__(self, files: Files, viewport: Viewport, grooming: Grooming) -> None:
        self._files, self._viewport, self._grooming = files, viewport, grooming
        self._sculptor, self._painter = Sculptor(files), Painter(files)

    @property
    def busy(self) -> bool:
        """Whether a stroke is in progress."""
        return self._sculptor.busy or self._painter.busy

    def sculpt(self, message: protocol.Sculpt) -> bytes:
        """Moves a brush over the guides; returns the message with them.

        Raises UserError before the groom is made.
        """
        self._files.refuse_several()
        groom = self._viewport.made("sculpt").groom
        if message.tool in ("freeze", "thaw"):
            return self._sculptor.message(self._sculptor.freeze(message, groom), groom)
        return self._sculptor.message(self._sculptor.move(message, groom), groom)

    def remove_sculpts(self) -> None:
        """Removes the sculpts of all guides."""
        self._sculptor.remove_all()

    def guides(self) -> bytes | None:
        """Message with the guides of the displayed groom; None where it has none, or a stroke has newer ones."""
        groom = self._viewport.made("guides").groom
        if groom.unsculpted is None or self._sculptor.busy:
            return None
        return self._sculptor.message(groom.guides, groom)

    def paint(self, message: protocol.Paint) -> bytes:
        """Moves a brush over the scalp; returns the message with the map. Raises UserError before the groom is made."""
        return self._painter.paint(message, self._viewport.made("paint").groom)

    def show_map(self, message: protocol.ShowMap) -> bytes:
        """Message with the map that a setting names; raises UserError before the groom is made."""
        return self._painter.show(message.place, self._viewport.made("paint").groom)

    def request(self, *, draft: bool) -> None:
        """Requests the groom with the stroke in progress."""
        recipe = self._files.recipe.model
        if self._sculptor.busy:
            self._grooming.request_of(self._sculptor.preview(recipe), draft=draft)
        else:
            self._grooming.request_of(recipe, draft=draft, painted=self._painter.painted)

    def finish(self) -> None:
        """Ends the stroke in progress and keeps it."""
        self._sculptor.finish()
        self._painter.finish()
