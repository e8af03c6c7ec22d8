"""What a file of hair holds, whatever its format: curves with their motion, and the surfaces around them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.stage import StageSpace


@dataclass
class CurveSet:
    """The curves of one prim.

    name:   of the prim, such as ``hairs``
    curves: in their rest pose [m]
    guide:  whether they are guides, which renderers do not show
    motion: positions at a frame [m], shape (points, 3); None for curves that stand still
    """

    name: str
    curves: Curves
    guide: bool = False
    motion: Callable[[float], NDArray[np.floating]] | None = None

    def points(self, frame: float | None) -> NDArray[np.floating]:
        """Positions at a frame [m], shape (points, 3); the rest pose for None."""
        return self.curves.points if frame is None or self.motion is None else self.motion(frame)


@dataclass
class HairScene:
    """Curves, surfaces and frames of a file.

    sets:   sets of curves, hairs before guides
    bodies: surfaces in their rest pose with their clips (None for one that stands still)
    frames: whole frames at which something moves, shape (k,); empty where nothing does
    space:  unit, up-axis and rate of the file
    """

    sets: list[CurveSet]
    bodies: list[tuple[Mesh, Clip | None]] = field(default_factory=list)
    frames: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    space: StageSpace = field(default_factory=StageSpace)

    def posed(self, frame: float | None) -> HairScene:
        """The scene as it stands at a frame, or at rest for None: its curves do not move."""
        sets = [replace(one, curves=one.curves.with_points(one.points(frame)), motion=None) for one in self.sets]
        return replace(self, sets=sets)

    @property
    def shown(self) -> list[CurveSet]:
        """The hairs, or the guides of a scene without hairs."""
        return [one for one in self.sets if not one.guide] or self.sets
