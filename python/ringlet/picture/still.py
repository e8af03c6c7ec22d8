"""A path-traced still of a head of hair."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.pigment import hair_color
from ringlet.picture.bodies import PosedBody
from ringlet.picture.camera import frame
from ringlet.picture.render import MAX_DEPTH, Progress, build_scene, over_backdrop, trace
from ringlet.picture.tone import develop


def still(
    bodies: Sequence[PosedBody],
    hairs: Curves,
    path: Path | str,
    *,
    width: int = 900,
    height: int = 1000,
    samples: int = 40,
    view: str | tuple[float, float] = "three_quarter",
    color: str | None = None,
    max_depth: int = MAX_DEPTH,
    seconds: float | None = None,
    progress: Progress | None = None,
) -> Path:
    """Writes a PNG of the hairs and bodies in a small photo studio, framed on the hair and the head.

    bodies:    posed meshes
    hairs:     curves [m]; the point attribute ``width`` is the diameter [m]
    samples:   light paths per pixel
    view:      a name of ``VIEWS``, or azimuth and elevation of the camera [degrees]
    color:     a name of ``HAIR_COLORS``; by default the hairs' own, or dark brown where they have none
    max_depth: largest number of bounces of a light path
    seconds:   time limit of the rendering
    progress:  called with "picture", the passes done and their number

    Raises UserError for sizes below 1, an unknown view or colour, and without hairs and bodies.
    """
    if width < 1 or height < 1 or samples < 1:
        raise UserError(f"picture: size {width} × {height} with {samples} samples; each must be at least 1")
    if len(hairs):
        hairs.check("hairs")
    pigments = hair_color(color)
    camera = frame(subject(bodies, hairs), view=view, aspect=width / height)
    scene = build_scene(bodies, hairs, camera, size=(width, height), color=pigments, max_depth=max_depth)
    light = trace(scene, samples=samples, seconds=seconds, progress=progress)
    with replacing(path) as aside:
        Image.fromarray(develop(over_backdrop(light))).save(aside)
    return Path(path)


def subject(bodies: Sequence[PosedBody], hairs: Curves) -> list[NDArray[np.floating]]:
    """Points that a portrait frames: all hair, and the points of bodies near it, the head without the shoulders."""
    if not len(hairs):
        if not bodies:
            raise UserError("picture: there are neither hairs nor bodies; give at least one of them")
        return [body.points for body in bodies]
    low, high = hairs.points.min(axis=0), hairs.points.max(axis=0)
    extent = high - low
    low = low - (0.05, 0.1, 0.05) * extent
    high = high + 0.05 * extent
    head = [body.points[((body.points >= low) & (body.points <= high)).all(axis=1)] for body in bodies]
    return [hairs.points, *(points for points in head if len(points))]
