"""What a file of hair holds, whatever its format: curves with their motion, and the surfaces around them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ringlet.data.attributes import fits
from ringlet.data.curves import Curves
from ringlet.data.groom import GROOM
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.stage import StageSpace


@dataclass
class CurveSet:
    """The curves of one prim.

    name:   of the prim, such as ``hairs``
    curves: in their rest pose [m]
    guide:  whether they are guides, which renderers do not show
    motion: positions at a frame [m], shape (points, 3); None for curves that stand still
    material: path of the material that is bound to them; empty for none
    """

    name: str
    curves: Curves
    guide: bool = False
    motion: Callable[[float], NDArray[np.floating]] | None = None
    material: str = ""

    @property
    def group_ids(self) -> NDArray[np.int32]:
        """Unreal's ``groom_group_id``: as read, else the row of the groom of each curve; 0 for a single groom."""
        curve = self.curves.curve
        return curve.get("groom_group_id", curve.get(GROOM, np.zeros(len(self.curves)))).astype(np.int32)

    def apart(self) -> list[CurveSet]:
        """Hairs and guides in sets of their own, where the attribute ``groom_guide`` says which curves are which."""
        marks = self.curves.curve.get("groom_guide")
        if marks is None or not fits(marks, ()):
            return [self]
        curve = {name: values for name, values in self.curves.curve.items() if name != "groom_guide"}
        plain, made = replace(self, curves=replace(self.curves, curve=curve)), list[CurveSet]()
        if self.guide or (marks > 0).all() or not (marks > 0).any():
            return [replace(plain, guide=self.guide or bool((marks > 0).all()))]
        for name, guide in (("hairs", False), ("guides", True)):
            chosen = np.flatnonzero((marks > 0) == guide)
            rows, motion = plain.curves.point_rows(chosen), self.motion
            moved = None if motion is None else (lambda frame, rows=rows, motion=motion: motion(frame)[rows])
            made.append(replace(plain, name=name, curves=plain.curves.take(chosen), guide=guide, motion=moved))
        return made

    def points(self, frame: float | None) -> NDArray[np.floating]:
        """Positions at a frame [m], shape (points, 3); the rest pose for None."""
        return self.curves.points if frame is None or self.motion is None else self.motion(frame)


@dataclass
class HairScene:
    """Curves, surfaces and frames of a file.

    sets:   sets of curves, hairs before guides
    bodies: surfaces in their rest pose with their clips (None for one that stands still)
    frames: time codes of the samples of what moves, shape (k,); empty where nothing does
    space:  unit, up-axis and rate of the file
    unread: a sentence for each thing in the file that is in none of these
    """

    sets: list[CurveSet]
    bodies: list[tuple[Mesh, Clip | None]] = field(default_factory=list)
    frames: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    space: StageSpace = field(default_factory=StageSpace)
    unread: list[str] = field(default_factory=list)

    def posed(self, frame: float | None) -> HairScene:
        """The scene as it stands at a frame, or at rest for None: its curves do not move."""
        sets = [replace(one, curves=one.curves.with_points(one.points(frame)), motion=None) for one in self.sets]
        return replace(self, sets=sets)

    @property
    def groom_ids(self) -> list[NDArray[np.int32]]:
        """Unreal's ``groom_id`` of the curves of each set, which differ over the whole file.

        They are the ids of the curves where these are different numbers from 0 to 2²⁴, else counted from 0. Unreal
        keeps the ids of guides in single precision.
        """
        every = np.concatenate([np.empty(0, np.int64), *(one.curves.ids for one in self.sets)])
        if len(np.unique(every)) < len(every) or every.min(initial=0) < 0 or every.max(initial=0) > 2**24:
            every = np.arange(len(every))
        ends = np.cumsum([len(one.curves) for one in self.sets], dtype=np.int64).tolist()
        return [every[start:end].astype(np.int32) for start, end in zip([0, *ends], ends, strict=False)]

    @property
    def shown(self) -> list[CurveSet]:
        """The hairs, or the guides of a scene without hairs."""
        return [one for one in self.sets if not one.guide] or self.sets
