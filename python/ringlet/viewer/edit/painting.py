"""Painting on the scalp: strokes of a brush on the maps that settings name, stored as pictures next to the recipe."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.groom import Groom
from ringlet.viewer import protocol
from ringlet.viewer.edit.brush import Ball
from ringlet.viewer.edit.naming import new_name, value_at
from ringlet.viewer.edit.texels import Texels
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.protocol import Place
from ringlet.viewer.show.maps import Values, picture_of, values_of
from ringlet.viewer.wire import pack

SIZE = 512  # of a new map [texels]


@dataclass
class Stroke:
    """A stroke of the brush. file: of the map; values: of its texels, shape (rows, columns)"""

    gesture: int
    file: str
    texels: Texels
    values: Values


class Painter:
    """The maps of the open recipe that are painted, and the current stroke."""

    def __init__(self, files: Files) -> None:
        self._files = files
        self._stroke: Stroke | None = None
        self._texels: Texels | None = None

    @property
    def busy(self) -> bool:
        """Whether a stroke is in progress."""
        return self._stroke is not None

    @property
    def painted(self) -> dict[str, bytes]:
        """Maps that differ from those on disk, with the current stroke: pictures by name of the file."""
        stroke = {self._stroke.file: picture_of(self._stroke.values)} if self._stroke else {}
        return {**self._files.recipe.painted, **stroke}

    def paint(self, message: protocol.Paint, groom: Groom) -> bytes:
        """Moves the brush; the end of the stroke stores the map. Returns the message with the painted values.

        Raises UserError for a scalp without texture coordinates and for a setting that names no map of the recipe.
        """
        stroke = self._stroke
        if stroke is None or stroke.gesture != message.gesture:
            stroke = self._stroke = self._begin(message, groom)
        ball = Ball(
            np.array(message.at) + groom.origin,
            np.array(message.by),
            message.radius,
            message.strength,
            message.falloff,
        )
        middle = self._middle(groom)
        pace = 1.0 if not any(message.by) else min(1.0, 2.0 * ball.relative_step)
        for one in [ball, ball.mirrored(middle)] if message.mirrored else [ball]:
            weight = pace * one.falloff(stroke.texels.position)
            if message.tool == "comb" and not any(message.by):
                continue  # a brush that rests has no direction
            stroke.values = stroke.texels.changed(stroke.values, weight, _target(message.tool, one))
        if message.resting:
            self.finish()
        return self._message(message.place, stroke.values, groom)

    def show(self, place: Place, groom: Groom) -> bytes:
        """Message with the map that a setting names; raises UserError as ``paint``."""
        values = self._values(place)
        self._texels_of(groom, values.shape)
        return self._message(place, values, groom)

    def finish(self) -> None:
        """Ends the current stroke and stores its map."""
        stroke, self._stroke = self._stroke, None
        if stroke is not None:
            document = self._files.recipe
            maps = {**document.state.maps, stroke.file: picture_of(stroke.values)}
            document.apply(document.text, maps=maps, gesture=stroke.gesture)

    def _begin(self, message: protocol.Paint, groom: Groom) -> Stroke:
        self._files.refuse_several()
        document = self._files.recipe
        values = self._values(message.place)
        texels = self._texels_of(groom, values.shape)
        name = self._name(message.place)
        if not name:
            name = new_name(message.place, self._files.chosen_recipe, document.model.maps)
            file = self._files.unused_name(document.path, f".{name}.png")
            changes = [(message.place, name), (["maps", name], file)]
            self._files.set("recipe", changes, message.gesture, maps={file: picture_of(values)})
        return Stroke(message.gesture, document.model.maps[name], texels, values)

    def _name(self, place: Place) -> str:
        """Name of the map in a setting; empty without one. Raises UserError for one that is no picture."""
        value = value_at(self._files.chosen_recipe, place)
        if isinstance(value, str) and value not in self._files.recipe.model.maps:
            raise UserError(f"paint: '{value}' is no picture of [maps]; choose one of them, or none for a new one")
        return value if isinstance(value, str) else ""

    def _values(self, place: Place) -> Values:
        """Values of the map of a setting. A new one is black for a mask, which adds to nothing, and white otherwise; a
        new map of directions has none."""
        document, name, directions = self._files.recipe, self._name(place), place[-1] == "direction"
        if not name:
            shape = (SIZE, SIZE, 3) if directions else (SIZE, SIZE)
            return np.full(shape, 0.0 if directions or "mask" in place else 1.0, np.float32)
        picture = document.map_picture(document.model.maps[name], self._files.project)
        return values_of(picture, directions=directions)

    def _texels_of(self, groom: Groom, shape: tuple[int, ...]) -> Texels:
        if self._texels is None or self._texels.mesh is not groom.scalp or self._texels.shape != shape[:2]:
            mesh = groom.scalp
            region = mesh.region(groom.region)
            self._texels = Texels(mesh, region, (shape[0], shape[1]))
        return self._texels

    @staticmethod
    def _middle(groom: Groom) -> float:
        """Position of the plane of symmetry [m]."""
        mesh = groom.scalp
        region = mesh.region(groom.region)
        x = mesh.points[np.unique(mesh.triangles[region]), 0]
        return 0.5 * float(x.min() + x.max())

    def _message(self, place: Place, values: Values, groom: Groom) -> bytes:
        mesh = groom.scalp
        region = mesh.region(groom.region)
        assert mesh.uv is not None
        kept, corners = np.unique(mesh.triangles[region], return_inverse=True)
        uv = np.zeros((len(kept), 2))
        uv[corners.ravel()] = mesh.uv[region].reshape(-1, 2)
        rows = np.clip((1.0 - uv[:, 1]) * values.shape[0], 0, values.shape[0] - 1).astype(int)
        columns = np.clip(uv[:, 0] * values.shape[1], 0, values.shape[1] - 1).astype(int)
        shown = values[rows, columns]
        lengths = np.linalg.norm(shown, axis=1) if shown.ndim == 2 else shown
        return pack(
            protocol.Painted(map=self._name(place)),
            points=mesh.points[kept] - groom.origin,
            triangles=corners.reshape(-1, 3),
            values=np.rint(255.0 * np.clip(lengths, 0.0, 1.0)),
            directions=shown if shown.ndim == 2 else np.empty(0),
        )


def _target(tool: str, ball: Ball) -> NDArray[np.float64] | float | None:
    """Value to which a brush goes: the direction in which it combs; None for the mean around."""
    if tool == "comb":
        return ball.by / np.linalg.norm(ball.by)
    return {"add": 1.0, "remove": 0.0}.get(tool)
