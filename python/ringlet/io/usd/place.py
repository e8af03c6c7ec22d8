"""Points far from the origin of coordinates: a translation on their prim keeps them exact in single precision.

Points within 8 m of the origin have none. It is an ``xformOp:translate`` of its own name, in double precision.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Usd, UsdGeom, Vt

from ringlet.data.bounds import check_curves, check_positions
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.precision import origin_of
from ringlet.data.stage import StageSpace
from ringlet.io.space import from_metres, to_file, to_metres
from ringlet.io.usd.values import float3

SUFFIX = "ringlet"
DEFAULT = Usd.TimeCode.Default()

Array = NDArray[np.float64]

REMEDY = "check the file or the settings that they come from"


def local_points(points: NDArray[np.floating], origin: Array, space: StageSpace) -> Vt.Vec3fArray:
    """Points [m] relative to an origin [m], as a value in the unit and axes of a file."""
    if not origin.any():
        return float3(from_metres(points, space))
    relative = np.asarray(points, np.float64) - origin
    return float3(from_metres(relative, space))


def rounded(points: NDArray[np.floating], space: StageSpace) -> Array:
    """Points [m] after a round trip through a file."""
    origin = origin_of(points)
    local = np.array(local_points(points, origin, space), np.float64)
    return to_metres(local + _in_file(origin, space), space)


def placed(points: NDArray[np.floating], prim: Usd.Prim, time: Usd.TimeCode) -> NDArray[np.floating]:
    """Points of a prim in the space of its parent, in double precision; the same where it has no transform."""
    matrix = np.array(UsdGeom.Xformable(prim).GetLocalTransformation(time))
    if (matrix == np.eye(4)).all():
        return points
    return points.astype(np.float64) @ matrix[:3, :3] + matrix[3, :3]


class Place:
    """The origin of a prim whose points are written, at rest or frame by frame. It changes only where it has to.

    Between frames points and translation are interpolated linearly, and so is their sum. All points that are written
    pass here, and are checked.

    file:   the file that is written, for messages
    curves: the curves of the prim; None for other points
    """

    def __init__(self, prim: Usd.Prim, space: StageSpace, file: Path | str, curves: Curves | None = None) -> None:
        self._xform, self._space, self._curves = UsdGeom.Xformable(prim), space, curves
        self._where = f"{file} {prim.GetPath()}"
        translation = np.array(self._xform.GetLocalTransformation(DEFAULT))[3, :3]
        self.origin: Array = to_metres(translation[None], space)[0]
        self._before: Usd.TimeCode | None = None
        self._animated = False

    def local(
        self, points: NDArray[np.floating], time: Usd.TimeCode, around: NDArray[np.floating] | None = None
    ) -> Vt.Vec3fArray:
        """The value of points [m] at a time; moves the origin near them.

        around: points of the head [m], shape (k, 3); by default the roots of the curves

        Raises UserError for points that are not finite, far from the head, or not as many as the curves have.
        """
        self._check(points, time, around)
        origin = origin_of(points, self.origin)
        if self._animated or (origin != self.origin).any():
            self._move(origin, time)
        self._before = time
        return local_points(points, self.origin, self._space)

    def _check(self, points: NDArray[np.floating], time: Usd.TimeCode, around: NDArray[np.floating] | None) -> None:
        where = self._where if time.IsDefault() else f"{self._where} at frame {time.GetValue():g}"
        if self._curves is None:
            check_positions(points, points if around is None else around, where, lambda row: f"point {row}", REMEDY)
            return
        if points.shape != self._curves.points.shape:
            raise UserError(f"{where}: has {len(points)} points for curves of {len(self._curves.points)}; not written")
        check_curves(
            self._curves, points, points[self._curves.offsets[:-1]] if around is None else around, where, REMEDY
        )

    def _move(self, origin: Array, time: Usd.TimeCode) -> None:
        operation = self._operation()
        if not self._animated and self._before is not None:
            operation.Set(self._value(), self._before)
        self._animated = not time.IsDefault()
        self.origin = origin
        operation.Set(self._value(), time)

    def _operation(self) -> UsdGeom.XformOp:
        own = [op for op in self._xform.GetOrderedXformOps() if op.GetOpName().endswith(f":{SUFFIX}")]
        return own[0] if own else self._xform.AddTranslateOp(UsdGeom.XformOp.PrecisionDouble, SUFFIX)

    def _value(self) -> Gf.Vec3d:
        return Gf.Vec3d(*_in_file(self.origin, self._space).tolist())


def _in_file(origin: Array, space: StageSpace) -> Array:
    return to_file(origin[None], space)[0]
