"""A head: its shape, its features, and the borders of its regions, for the code that meshes any of them [cm]."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from distances import Array, Shape
from features import Ear, Eye
from numpy.typing import ArrayLike, NDArray

Profile = Callable[[Array], Array]
Box = tuple[ArrayLike, ArrayLike]


@dataclass(frozen=True)
class Head:
    """Everything that differs between heads. Y up, the face towards +Z, the left side of the head at +X.

    name:           of the root prim.
    skin, shirt:    signed distances of the two closed bodies.
    dressed:        that of the skin where the shirt presses on it.
    neckline:       signed distance of the opening of the shirt.
    lips:           signed distance of the lips.
    skin_box, shirt_box: what the bodies lie in: the lowest and the highest corner.
    cell:           of the grid that the bodies are first meshed on.
    fine:           where the skin has short edges: a distance, and the edge length within.
    glow:           where skin is reddish: centres and reaches.
    skull:          middle of the skull, where angles around the head are counted from.
    hairline, jawline: heights by the angle around the vertical axis: 0 is the front, π/2 the ear.
    brow:           points of the left brow's middle line.
    brow_width:     half its width at 0, 1/5, 1/2 and 1 of it.
    brow_height:    half its height over the skin.
    patches:        further named regions of the skin, which lie on those of ``regions.NAMES``.
    iris:           half-angle at the eyeball's centre [rad].
    colors:         linear red, green and blue of skin, lips, blush, shirt and iris.
    """

    name: str
    skin: Shape
    dressed: Shape
    shirt: Shape
    neckline: Shape
    lips: Shape
    skin_box: Box
    shirt_box: Box
    cell: float
    fine: tuple[tuple[Shape, float], ...]
    glow: tuple[tuple[ArrayLike, float], ...]
    skull: Array
    hairline: Profile
    jawline: Profile
    eye: Eye
    ear: Ear
    brow: tuple[ArrayLike, ArrayLike, ArrayLike]
    brow_width: tuple[float, float, float, float]
    brow_height: float
    patches: dict[str, Callable[[Array], NDArray[np.bool_]]]
    iris: float
    colors: dict[str, Array]

    def above_hairline(self, points: Array) -> Array:
        """Height above the hairline, positive where hair grows, shape (n,); not valid on ears."""
        p = mirrored(points) - self.skull
        return points[:, 1] - self.hairline(np.arctan2(p[:, 0], p[:, 2]))


def mirrored(p: Array) -> Array:
    """Mirrors points to the left side, smoothly at the middle, so that the face has no crease."""
    return np.column_stack([np.sqrt(p[:, 0] ** 2 + 0.03**2), p[:, 1], p[:, 2]])
