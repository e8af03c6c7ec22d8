"""Sculpting of guides: converts strokes of a brush to sculpts of the file of edits."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.groom import Groom, Recipe
from ringlet.groom.load import EMPTY, parse_edits
from ringlet.groom.scalp import Scalp
from ringlet.groom.sculpt import Sculpt, sculpted, sculpts_to
from ringlet.viewer import protocol
from ringlet.viewer.edit import brush
from ringlet.viewer.edit.brush import Ball
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.wire import pack


@dataclass
class Stroke:
    """A stroke of the brush, from press to release.

    before:  guides of the recipe without sculpts
    guides:  current guides
    weights: weights of the points in a grab, for each side of the head, shape (n,)
    """

    gesture: int
    scalp: Scalp
    before: Curves
    guides: Curves
    weights: list[NDArray[np.floating]]


class Sculptor:
    """State of the current stroke."""

    def __init__(self, files: Files) -> None:
        self._files = files
        self._stroke: Stroke | None = None
        self._scalp: Scalp | None = None
        self._frozen = frozenset[int]()

    @property
    def busy(self) -> bool:
        """Whether a stroke is in progress; its guides are newer than those of the last groom."""
        return self._stroke is not None

    def move(self, message: protocol.Sculpt, groom: Groom) -> Curves:
        """Moves the brush and returns the guides; the end of the stroke writes its sculpts."""
        stroke = self._stroke
        if stroke is None or stroke.gesture != message.gesture:
            stroke = self._stroke = self._begin(message.gesture, groom)
        balls = _balls(message, groom, stroke.scalp)
        if message.tool == "grab" and not stroke.weights:
            starts = [replace(one, at=one.at - one.by) for one in balls]
            stroke.weights = [brush.grab_weights(stroke.guides, start) for start in starts]
        before = stroke.guides
        for k, one in enumerate(balls):
            if message.tool == "grab":
                stroke.guides = brush.grab(stroke.guides, one, stroke.weights[min(k, len(stroke.weights) - 1)])
            elif message.tool == "return":
                stroke.guides = brush.restore(stroke.guides, one, stroke.before)
            else:
                stroke.guides = brush.TOOLS[message.tool](stroke.guides, one)
        held = np.repeat(self._held(before), before.counts)
        stroke.guides = stroke.guides.with_points(np.where(held[:, None], before.points, stroke.guides.points))
        if message.resting:
            self._finish(stroke)
        return stroke.guides

    def freeze(self, message: protocol.Sculpt, groom: Groom) -> Curves:
        """Freezes or thaws the guides in the brush; returns the guides. Raises UserError as ``move``."""
        stroke = self._begin(message.gesture, groom)
        for one in _balls(message, groom, stroke.scalp):
            ids = set(stroke.guides.ids[brush.in_ball(stroke.guides, one)].tolist())
            self._frozen = self._frozen | ids if message.tool == "freeze" else self._frozen - ids
        return stroke.guides

    def _held(self, guides: Curves) -> NDArray[np.bool_]:
        """Which guides are frozen, shape (count,)."""
        return np.isin(guides.ids, list(self._frozen))

    def finish(self) -> None:
        """Ends the current stroke and writes its sculpts."""
        if self._stroke is not None:
            self._finish(self._stroke)

    def preview(self, recipe: Recipe) -> Recipe:
        """The recipe with the current stroke."""
        if self._stroke is None:
            return recipe
        stroke = self._stroke
        tables = sculpts_to(stroke.before, stroke.guides, stroke.scalp)
        sculpts = [Sculpt.model_validate(table, context={"unit": 1.0}) for table in tables]
        return recipe.model_copy(update={"sculpt": sculpts})

    def remove_all(self) -> None:
        """Removes the sculpts of all guides."""
        self._stroke = None
        self._files.write_edits("sculpt", [])

    def _begin(self, gesture: int, groom: Groom) -> Stroke:
        assert groom.unsculpted is not None  # it was made from the open recipe
        document = self._files.recipe
        if document.contents().get("sculpt"):
            raise UserError(
                f"{document.path.name}: has [[sculpt]] tables of its own; move them to the file that 'edits' names"
            )
        scalp = self.scalp(groom)
        guides = sculpted(groom.unsculpted, document.model.sculpt, scalp)
        return Stroke(gesture, scalp, groom.unsculpted, guides, [])

    def _finish(self, stroke: Stroke) -> None:
        """Writes the sculpts of a stroke; keeps those of guides that do not exist now."""
        self._stroke = None
        existing = set(stroke.before.ids.tolist())
        tables = parse_edits(self._files.recipe.state.edits or EMPTY, self._files.recipe.path)["sculpt"]
        kept = [table for table in tables if table.get("guide") not in existing]
        sculpts = [*kept, *sculpts_to(stroke.before, stroke.guides, stroke.scalp)]
        self._files.write_edits("sculpt", sculpts, stroke.gesture)

    def scalp(self, groom: Groom) -> Scalp:
        """The scalp of a groom, cached."""
        if self._scalp is None or self._scalp.mesh is not groom.scalp:
            self._scalp = Scalp(groom.scalp, groom.region)
        return self._scalp

    def message(self, guides: Curves, groom: Groom) -> bytes:
        """Message with guides, and a mark on those that differ from the recipe's."""
        before = guides if groom.unsculpted is None else groom.unsculpted
        moved = np.abs(guides.points - before.points).max(axis=1) > 1e-6
        x, y, z = (self.scalp(groom).middle - groom.origin).tolist()
        return pack(
            protocol.Guides(middle=(x, y, z)),
            points=guides.points - groom.origin,
            offsets=guides.offsets,
            changed=np.logical_or.reduceat(moved, guides.offsets[:-1]),
            frozen=self._held(guides),
        )


def _balls(message: protocol.Sculpt, groom: Groom, scalp: Scalp) -> list[Ball]:
    """The brush, and its mirror image where it has one."""
    shape = message.radius, message.strength, message.falloff
    ball = Ball(np.array(message.at) + groom.origin, np.array(message.by), *shape)
    return [ball, ball.mirrored(scalp.middle[0])] if message.mirrored else [ball]
