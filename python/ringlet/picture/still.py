"""Path-traced stills of a head of hair."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ringlet.data.camera import Camera
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.picture import PictureSettings
from ringlet.picture.bodies import PosedBody
from ringlet.picture.camera import angles_towards, frame, picture_size, take_position
from ringlet.picture.render import Progress, build_scene, hair_color, over_backdrop, trace
from ringlet.picture.rigs import Rig, check_rig
from ringlet.picture.tone import develop


def still(
    bodies: Sequence[PosedBody],
    hairs: Curves,
    path: Path | str,
    settings: PictureSettings | None = None,
    *,
    lock: NDArray[np.floating] | None = None,
    camera: Camera | None = None,
    progress: Progress | None = None,
) -> Path:
    """Writes a PNG of the hairs and bodies, framed on the hair and the head.

    bodies:   posed meshes
    hairs:    curves [m]; the point attribute ``width`` is the diameter [m]
    lock:     points of the lock to look at in place of the head [m], shape (n, 3)
    camera:   a camera of the stage, in place of the view
    progress: called with "picture", the passes done and their number

    Raises UserError for an unknown view, colour or light, and without hairs and bodies.
    """
    settings = settings or PictureSettings()
    refuse_transparent(settings, path)
    image = take(bodies, hairs, settings, lock=lock, camera=camera, progress=progress)
    with replacing(path) as aside:
        developed(image, settings.background).save(aside)
    return Path(path)


def take(
    bodies: Sequence[PosedBody],
    hairs: Curves,
    settings: PictureSettings,
    *,
    lock: NDArray[np.floating] | None = None,
    camera: Camera | None = None,
    progress: Progress | None = None,
) -> NDArray[np.float32]:
    """Light and coverage of a picture, shape (height, width, 4), as in ``still``."""
    check_rig(settings.light)
    if len(hairs):
        hairs.check("hairs")
    pigments, size, seen = hair_color(settings.color), picture_size(settings, camera), subject(bodies, hairs)
    camera = take_position(settings, seen, lock, camera)
    portrait = frame(seen, view=angles_towards(camera.axes[2]))
    rig = Rig(settings.light, settings.light_turn, camera.axes, portrait.target, portrait.distance)
    scene = build_scene(bodies, hairs, camera, size=size, color=pigments, max_depth=settings.bounces + 1, rig=rig)
    return trace(scene, samples=settings.samples, seconds=settings.seconds, progress=progress)


def developed(image: NDArray[np.float32], background: str) -> Image.Image:
    """Tone-mapped picture of light with coverage, shape (h, w, 4), over the backdrop or with an alpha channel."""
    if background == "studio":
        return Image.fromarray(develop(over_backdrop(image)))
    coverage = np.clip(image[:, :, 3:], 0.0, 1.0)
    colors = develop(image[:, :, :3] / np.maximum(coverage, 1e-6) * (coverage > 0))
    return Image.fromarray(np.concatenate([colors, np.rint(255.0 * coverage).astype(np.uint8)], axis=2), "RGBA")


def refuse_transparent(settings: PictureSettings, path: Path | str) -> None:
    """Raises UserError for a transparent picture in a format without transparency."""
    if settings.background == "transparent" and Path(path).suffix.lower() in (".jpg", ".jpeg"):
        raise UserError(f"{path}: a JPEG cannot be transparent; choose .png or .exr")


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
