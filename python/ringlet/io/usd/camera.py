"""Reads cameras of a stage: position, aperture, focal length and focus at a frame."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pxr import Gf, Usd, UsdGeom

from ringlet.data.camera import Camera
from ringlet.data.errors import UserError
from ringlet.io.space import to_metres
from ringlet.io.usd.stage import find_prim, reading


def camera_paths(path: Path | str) -> list[str]:
    """Prim paths of the cameras of a stage."""
    with reading(path) as source:
        return [str(prim.GetPath()) for prim in source.stage.Traverse() if UsdGeom.Camera(prim)]


def read_camera(path: Path | str, prim: str, frame: float | None = None) -> Camera:
    """Reads a ``UsdGeomCamera`` at a frame, by default at the first sample of each value, in metres and Y-up.

    Focal length and aperture are in tenths of the stage's unit, as the schema has them. The subject's distance is that
    of the focus, or 1 m where it has none.

    Raises UserError for another prim, for an orthographic camera, and for values of which no picture can be taken.
    """
    with reading(path) as source:
        found = find_prim(source, prim)
        where, unit = source.where(found), source.space.meters_per_unit
        if not UsdGeom.Camera(found):
            cameras = [str(p.GetPath()) for p in source.stage.Traverse() if UsdGeom.Camera(p)]
            raise UserError(
                f"{where}: is a {found.GetTypeName() or 'prim without a type'}, not a camera; "
                f"there are: {', '.join(cameras[:8]) or 'none'}"
            )
        camera = UsdGeom.Camera(found).GetCamera(Usd.TimeCode.EarliestTime() if frame is None else frame)
    if camera.projection != Gf.Camera.Perspective:
        raise UserError(f"{where}: is orthographic; choose a perspective camera")
    lens = camera.focalLength * Gf.Camera.FOCAL_LENGTH_UNIT
    size = np.array([camera.horizontalAperture, camera.verticalAperture]) * Gf.Camera.APERTURE_UNIT
    offset = np.array([camera.horizontalApertureOffset, camera.verticalApertureOffset]) * Gf.Camera.APERTURE_UNIT
    rows = np.array(camera.transform, np.float64)
    values = [lens, *size, *offset, camera.fStop, camera.focusDistance, *rows.ravel()]
    if not np.isfinite(values).all() or lens <= 0 or min(size) <= 0 or camera.fStop < 0:
        raise UserError(
            f"{where}: has focal length {camera.focalLength:g}, aperture {camera.horizontalAperture:g} × "
            f"{camera.verticalAperture:g} and fStop {camera.fStop:g}; all must be finite, and those of the lens above 0"
        )
    lengths = np.linalg.norm(rows[:3, :3], axis=1)
    if min(lengths) <= 0:
        raise UserError(f"{where}: is scaled to nothing; give its transform a scale of 1")
    axes = to_metres(rows[:3, :3] / lengths[:, None], source.space)
    focus = camera.focusDistance * unit if camera.focusDistance > 0 else None
    return Camera(
        origin=to_metres(rows[3:, :3], source.space)[0],
        axes=axes / np.linalg.norm(axes, axis=1, keepdims=True),
        distance=focus or 1.0,
        slopes=(0.5 * size[0] / lens, 0.5 * size[1] / lens),
        shift=(offset[0] / lens, offset[1] / lens),
        focal_length=lens * unit,
        f_stop=camera.fStop,
        focus=focus,
    )
