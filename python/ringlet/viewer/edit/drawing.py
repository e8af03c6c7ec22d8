"""Drawing on the scalp: strokes as helper curves of the recipe, such as part lines."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.data.lengths import UNITS
from ringlet.groom import Groom
from ringlet.groom.operators.grown import DRAWN_TOLERANCE
from ringlet.groom.scalp import Scalp
from ringlet.viewer import protocol
from ringlet.viewer.edit.naming import new_name, value_at
from ringlet.viewer.files.open_files import Files

GUIDES = ["guides", "drawn"]  # the list of drawn guides
DEVIATION = 5e-4  # [m] by which a curve may leave its stroke
DIGITS = 5e-5  # [m] to which coordinates are rounded


def draw(files: Files, message: protocol.Draw, groom: Groom) -> None:
    """Makes a stroke the curve that a setting names, as one undo step; a setting without one gets a new curve.

    groom: the displayed one

    Raises UserError for a stroke without length, for a curve of a file, for a guide with its root off the scalp, and
    for a recipe with several grooms.
    """
    files.refuse_several()
    document = files.recipe
    stroke = np.array(message.points, np.float64) + groom.origin
    points = simplified(stroke[np.r_[True, np.linalg.norm(np.diff(stroke, axis=0), axis=1) > DEVIATION]])
    if len(points) < 2:
        raise UserError("draw: the stroke has no length; draw a line over the scalp")
    recipe = document.model
    if message.place == GUIDES:
        _check_root(points[0], groom)
    name = value_at(recipe, message.place)
    if isinstance(name, str) and name in recipe.curves and recipe.curves[name].points is None:
        raise UserError(f"draw: the curve '{name}' is that of a file; choose none for a new one")
    names = name if isinstance(name, list) else None  # of a list of curves
    if not isinstance(name, str) or name not in recipe.curves:
        name = new_name(message.place, files.chosen_recipe, recipe.curves)
    unit = UNITS[recipe.unit]
    rounded = (np.round(points / DIGITS) * DIGITS / unit).tolist()
    curve = [[float(f"{x:.6g}") for x in point] for point in rounded]
    files.set(
        "recipe",
        [(["curves", name, "points"], curve), (message.place, name if names is None else [*names, name])],
        message.gesture,
    )


def _check_root(root: NDArray[np.float64], groom: Groom) -> None:
    """Raises UserError for the root of a guide that is off the scalp."""
    scalp = Scalp(groom.scalp, groom.region)
    distance = float(np.linalg.norm(scalp.nearest(root[None])[0] - root))
    if distance > DRAWN_TOLERANCE:
        raise UserError(f"draw: the guide begins {1e3 * distance:.0f} mm off the scalp; begin it where the hair grows")


def simplified(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """A polyline with the fewest of its points that keep it within ``DEVIATION`` (Douglas and Peucker 1973).

    points: positions [m], shape (n, 3)
    """
    kept = np.zeros(len(points), bool)
    kept[[0, -1]] = len(points) > 0
    spans = [(0, len(points) - 1)]
    while spans:
        first, last = spans.pop()
        if last - first < 2:
            continue
        chord = points[last] - points[first]
        inner = points[first + 1 : last] - points[first]
        t = np.clip(inner @ chord / max(float(chord @ chord), 1e-18), 0.0, 1.0)
        distance = np.linalg.norm(inner - t[:, None] * chord, axis=1)
        if distance.max() > DEVIATION:
            middle = first + 1 + int(distance.argmax())
            kept[middle] = True
            spans += [(first, middle), (middle, last)]
    return points[kept]
