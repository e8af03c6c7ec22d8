"""Writes points frame by frame, without all frames in memory."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from types import TracebackType

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom, Vt

from ringlet.data.curves import Curves
from ringlet.data.reads import recorded, refuse_inputs
from ringlet.data.stage import StageSpace
from ringlet.io.usd.curves import set_points
from ringlet.io.usd.groom import GROOM, choose_variant, groom_prim
from ringlet.io.usd.model import set_extents_hint
from ringlet.io.usd.place import Place, local_points
from ringlet.io.usd.stage import check_target, new_stage, reading, writing
from ringlet.io.usd.velocities import Velocities

FLUSH = 64e6  # bytes of points in memory before they are saved


class StreamWriter:
    """Base of writers that add frames to a layer over another file; the file appears when the block succeeds.

    moving: writes ``velocities`` too, in units per second
    """

    moving = True

    def __init__(self, path: Path | str, under: Path | str, space: StageSpace, variant: str | None = None) -> None:
        check_target(path, under)
        self.path, self.under, self.space, self.variant = Path(path), Path(under), space, variant
        self._frames: list[float] = []
        self._unsaved = 0
        self._place_of_prim: dict[Usd.Prim, Place] = {}
        self._velocities_of_prim: dict[Usd.Prim, Velocities] = {}
        self._adjacent_of_prim: dict[Usd.Prim, tuple[float, NDArray]] = {}

    def begin(self) -> Usd.Stage:
        """Opens a temporary file beside ``path`` and returns its stage over the groom.

        Raises UserError when the output is a file under it, and ValueError for another space.
        """
        with recorded():  # the groom under a cache, the head, cloths
            with reading(self.under) as source:
                groom_prim(source)
                if source.space != self.space:
                    raise ValueError(f"{self.under}: has {source.space}; must be {self.space}")
            refuse_inputs(self.path)
        with ExitStack() as opened:
            self._stage = new_stage(opened.enter_context(writing(self.path)), self.space, over=self.under)
            if self.variant is not None:
                choose_variant(self._stage, self.variant)
            self._opened = opened.pop_all()
        return self._stage

    @property
    def layer(self) -> Sdf.Layer:
        """The layer in progress."""
        return self._stage.GetRootLayer()

    def put(
        self,
        prim: UsdGeom.BasisCurves,
        frame: float | None,
        points: NDArray,
        curves: Curves,
        around: NDArray | None = None,
    ) -> Vt.Vec3fArray:
        """Sets the points [m] of curves at a frame, at rest for None; returns the value.

        curves: those of the prim
        around: points of the head [m], shape (k, 3); by default the roots
        """
        place = self._place_of_prim.get(prim.GetPrim())
        if place is None:
            place = self._place_of_prim[prim.GetPrim()] = Place(prim.GetPrim(), self.space, self.path, curves)
        time = Usd.TimeCode.Default() if frame is None else Usd.TimeCode(float(frame))
        value = set_points(prim, points, place, time, around)
        if frame is not None and self.moving:
            velocities = self._velocities_of_prim.get(prim.GetPrim())
            if velocities is None:
                velocities = self._velocities_of_prim[prim.GetPrim()] = Velocities(prim, self.space.fps)
                if before := self._adjacent_of_prim.get(prim.GetPrim()):
                    velocities.add(before[0], self._adjacent(place, before[1]), adjacent=True)
            velocities.add(float(frame), np.array(value))
        self.record(frame, points.size * 4)
        return value

    def put_adjacent(self, prim: UsdGeom.BasisCurves, frame: float, points: NDArray) -> None:
        """Takes the points [m] of the frame before the first, or after the last, for the velocities there."""
        if velocities := self._velocities_of_prim.get(prim.GetPrim()):
            place = self._place_of_prim[prim.GetPrim()]
            velocities.add(frame, self._adjacent(place, points), adjacent=True)
        else:
            self._adjacent_of_prim[prim.GetPrim()] = frame, points

    def _adjacent(self, place: Place, points: NDArray) -> NDArray[np.float32]:
        """Points [m] relative to where the frame next to them has its origin, in the space of the prim."""
        return np.array(local_points(points, place.origin, self.space))

    def record(self, frame: float | None, size: int) -> None:
        """Records ``size`` bytes that were set at a frame; saves the layer when much is unsaved."""
        if frame is not None:
            self._frames.append(float(frame))
        self._unsaved += size
        # Saving a binary layer frees its memory; a text layer would be written as a whole each time.
        if self._unsaved > FLUSH and self.path.suffix != ".usda":
            self.layer.Save()
            self._unsaved = 0

    def finish(self) -> None:
        """Writes final data before the last save; for subclasses."""

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if error is not None:
            self._opened.__exit__(kind, error, trace)
            return
        with self._opened:
            if self._frames:
                self._stage.SetStartTimeCode(min(self._frames))
                self._stage.SetEndTimeCode(max(self._frames))
            for velocities in self._velocities_of_prim.values():
                velocities.finish()
            self.finish()
            set_extents_hint(self._stage.OverridePrim(GROOM), sorted(set(self._frames)))
            self.layer.Save()
