"""Velocities of points in units per second, from the positions of neighbouring frames."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from ringlet.io.usd.values import float3


class Velocities:
    """Writes ``velocities`` of a prim, whose points are given frame by frame.

    Central differences; one-sided ones at both ends, and where frames do not follow one another evenly. A velocity is
    written once the frame after it is known, so that two frames are kept.

    fps: time codes per second
    """

    def __init__(self, prim: UsdGeom.PointBased, fps: float) -> None:
        self._prim, self._fps = prim, fps
        self._frames: list[tuple[float, NDArray[np.float32]]] = []
        self._adjacent: set[float] = set()

    def add(self, frame: float, points: NDArray[np.float32], *, adjacent: bool = False) -> None:
        """Adds the points of a frame in the space of the prim, shape (n, 3).

        adjacent: a frame adjacent to the range of the file, which has no velocities there itself
        """
        if adjacent:
            self._adjacent.add(frame)
        self._frames = [*self._frames, (frame, points)][-3:]
        if len(self._frames) > 1:
            self._write(self._frames[-2][0], self._frames[0], self._frames[-1])

    def finish(self) -> None:
        """Writes the velocities of the last frame."""
        if len(self._frames) > 1:
            self._write(self._frames[-1][0], self._frames[-2], self._frames[-1])

    def _write(self, frame: float, one: tuple[float, NDArray], other: tuple[float, NDArray]) -> None:
        if frame in self._adjacent:
            return
        seconds = (other[0] - one[0]) / self._fps
        rate = (np.asarray(other[1], np.float64) - one[1]) / seconds
        self._prim.CreateVelocitiesAttr().Set(float3(rate), Usd.TimeCode(frame))
