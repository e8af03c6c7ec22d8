"""A hand that sculpts guides: strokes of a brush become what the file of edits says of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.groom import Groom, Recipe
from ringlet.groom.load import parse_edits
from ringlet.groom.scalp import Scalp
from ringlet.groom.sculpt import Sculpt, sculpted, sculpts_to
from ringlet.viewer import brush, protocol
from ringlet.viewer.brush import Ball
from ringlet.viewer.files import Files
from ringlet.viewer.wire import pack


@dataclass
class Stroke:
    """What a hand does from putting the brush down to lifting it.

    before:  the guides as the recipe makes them
    guides:  as they are now
    weights: how much of the way the points of each side go along with a grab
    """

    gesture: int
    scalp: Scalp
    before: Curves
    guides: Curves
    weights: list[NDArray[np.floating]]


class Sculptor:
    """Keeps the stroke that is being made."""

    def __init__(self, files: Files) -> None:
        self._files = files
        self._stroke: Stroke | None = None
        self._scalp: Scalp | None = None

    @property
    def busy(self) -> bool:
        """Whether the brush is down: then guides are where the hand has them, not where the last groom had them."""
        return self._stroke is not None

    def move(self, message: protocol.Sculpt, groom: Groom) -> Curves:
        """The guides after the brush has moved; what it has done is written when it is lifted."""
        stroke = self._stroke
        if stroke is None or stroke.gesture != message.gesture:
            stroke = self._stroke = self._put_down(message.gesture, groom)
        ball = Ball(np.array(message.at), np.array(message.by), message.radius)
        balls = [ball, ball.mirrored(stroke.scalp.middle[0])] if message.mirrored else [ball]
        if message.tool == "grab" and not stroke.weights:
            starts = [Ball(one.at - one.by, one.by, one.radius) for one in balls]
            stroke.weights = [brush.held(stroke.guides, start) for start in starts]
        for k, one in enumerate(balls):
            if message.tool == "grab":
                stroke.guides = brush.grab(stroke.guides, one, stroke.weights[min(k, len(stroke.weights) - 1)])
            elif message.tool == "return":
                stroke.guides = brush.given_back(stroke.guides, one, stroke.before)
            else:
                stroke.guides = brush.TOOLS[message.tool](stroke.guides, one)
        if message.resting:
            self._lift(stroke)
        return stroke.guides

    def preview(self, recipe: Recipe) -> Recipe:
        """The recipe with the stroke as far as it has come."""
        if self._stroke is None:
            return recipe
        stroke = self._stroke
        told = sculpts_to(stroke.before, stroke.guides, stroke.scalp)
        made = [Sculpt.model_validate(one, context={"unit": 1.0}) for one in told]
        return recipe.model_copy(update={"sculpt": made})

    def give_all_back(self) -> None:
        """Lets all guides be what the recipe makes of them."""
        self._stroke = None
        self._files.write_edits("sculpt", [])

    def _put_down(self, gesture: int, groom: Groom) -> Stroke:
        if groom.unsculpted is None:
            raise UserError("sculpt: there is no recipe whose guides could be sculpted; open one with: ringlet view")
        document = self._files.recipe
        if document.said().get("sculpt"):
            raise UserError(
                f"{document.path.name}: has [[sculpt]] tables of its own; move them to the file that 'edits' names"
            )
        scalp = self.scalp(groom)
        guides = sculpted(groom.unsculpted, document.model.sculpt, scalp)
        return Stroke(gesture, scalp, groom.unsculpted, guides, [])

    def _lift(self, stroke: Stroke) -> None:
        """Writes what is now different from the recipe; guides that are not there now keep what was done to them."""
        self._stroke = None
        there = set(stroke.before.ids.tolist())
        known = parse_edits(self._files.recipe.state.edits or "ringlet = 1", self._files.recipe.path)["sculpt"]
        gone = [one for one in known if one.get("guide") not in there]
        made = [*gone, *sculpts_to(stroke.before, stroke.guides, stroke.scalp)]
        self._files.write_edits("sculpt", made, stroke.gesture)

    def scalp(self, groom: Groom) -> Scalp:
        """The surface that the guides grow on."""
        if self._scalp is None or self._scalp.mesh is not groom.scalp:
            self._scalp = Scalp(groom.scalp, groom.region)
        return self._scalp

    def told(self, guides: Curves, groom: Groom) -> bytes:
        """The message with guides, and which of them are not as the recipe makes them."""
        before = guides if groom.unsculpted is None else groom.unsculpted
        off = np.abs(guides.points - before.points).max(axis=1) > 1e-6
        x, y, z = self.scalp(groom).middle.tolist()
        return pack(
            protocol.Guides(middle=(x, y, z)),
            points=guides.points,
            offsets=guides.offsets,
            changed=np.logical_or.reduceat(off, guides.offsets[:-1]),
        )
