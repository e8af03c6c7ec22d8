"""Path-traced stills of a head of hair."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ringlet.data.camera import Camera
from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.picture import PictureSettings
from ringlet.data.pigment import hair_color
from ringlet.picture import oidn
from ringlet.picture.camera import angles_towards, frame, picture_size, take_position
from ringlet.picture.engine import mitsuba, using
from ringlet.picture.exr import write_exr
from ringlet.picture.layers import Later, Layers
from ringlet.picture.motion import Pose
from ringlet.picture.render import (
    Progress,
    layers_of,
    over_backdrop,
    trace,
    trace_coarse,
    trace_growing,
)
from ringlet.picture.rigs import Rig, check_rig
from ringlet.picture.scene import Scene, build_scene
from ringlet.picture.strands import split
from ringlet.picture.tone import develop


@dataclass(frozen=True)
class Standpoint:
    """A camera, and the light around what it looks at."""

    camera: Camera
    rig: Rig


@dataclass(frozen=True)
class Taken:
    """A picture before it is developed: light and coverage, shape (height, width, 4), and its layers if there are.

    lights: that of each light, shape (height, width, 3); they add up to the picture
    """

    image: NDArray[np.float32]
    layers: Layers | None = None
    lights: dict[str, NDArray[np.float32]] = field(default_factory=dict)


def still(
    pose: Pose,
    path: Path | str,
    settings: PictureSettings | None = None,
    *,
    lock: NDArray[np.floating] | None = None,
    closing: Pose | None = None,
    later: Pose | None = None,
    progress: Progress | None = None,
) -> Path:
    """Writes a picture of hairs and bodies, framed on the hair and the head: a PNG, a JPEG, or an EXR with layers.

    lock:     points of the lock to look at in place of the head [m], shape (n, 3)
    closing:  the pose when the shutter closes, for motion blur
    later:    that of the next frame, for the layer of motion
    progress: called with "picture", the passes done and their number

    Raises UserError for an unknown view, colour or light, and without hairs and bodies.
    """
    settings = settings or PictureSettings()
    refuse_transparent(settings, path)
    is_exr = Path(path).suffix.lower() == ".exr"
    if not is_exr:
        settings.refuse_lights(str(path))
    taken = take(pose, settings, lock=lock, closing=closing, layers=is_exr, later=later, progress=progress)
    if taken.layers is not None and is_exr:
        write_exr(mitsuba(), path, taken.image, taken.layers, taken.lights)
    else:
        with replacing(path) as aside:
            developed(taken.image, settings.background).save(aside)
    return Path(path)


def take(
    pose: Pose,
    settings: PictureSettings,
    *,
    lock: NDArray[np.floating] | None = None,
    closing: Pose | None = None,
    standpoint: Standpoint | None = None,
    layers: bool = False,
    later: Pose | None = None,
    progress: Progress | None = None,
) -> Taken:
    """Takes a picture as in ``still``.

    standpoint: camera and light, in place of those that the settings give
    layers:     asks for depth, normal, albedo, motion and mattes, at the opening shutter
    """
    check_rig(settings.light)
    check_denoiser(settings.denoiser)
    with using(settings.engine):
        return _taken(pose, settings, lock, closing, standpoint, layers, later, progress)


def _taken(
    pose: Pose,
    settings: PictureSettings,
    lock: NDArray[np.floating] | None,
    closing: Pose | None,
    standpoint: Standpoint | None,
    layers: bool,
    later: Pose | None,
    progress: Progress | None,
) -> Taken:
    """``take`` with settings that are checked."""
    if len(pose.hairs):
        pose.hairs.check("hairs")
    if standpoint is None:
        standpoint = place(settings, subject(pose), lock, pose.camera)
    camera, pigments = standpoint.camera, hair_color(settings.color)
    look: dict[str, Any] = {
        "size": picture_size(settings, pose.camera),
        "color": pigments,
        "max_depth": settings.bounces + 1,
    }

    def camera_of(now: Pose) -> Camera:
        return camera if now.camera is None else place(settings, subject(now), lock, now.camera).camera

    def traced(rig: Rig) -> tuple[Scene, NDArray[np.float32]]:
        def scene_at(fraction: float) -> Scene:
            now = pose if closing is None else pose.towards(closing, fraction)
            return build_scene(now.bodies, now.hairs, camera_of(now), rig=rig, **look)

        scene = scene_at(0.0)
        return scene, trace(
            scene,
            samples=settings.samples,
            seconds=settings.seconds,
            progress=progress,
            denoise=settings.denoiser == "oidn",
            moved=None if closing is None else scene_at,
        )

    rig = standpoint.rig
    if settings.light_layers:
        each = {name: traced(replace(rig, only=name)) for name in rig.lights}
        (scene, image), *_ = each.values()
        lights = {name: light[:, :, :3] for name, (_, light) in each.items()}
        image = np.concatenate([sum(lights.values()), image[:, :, 3:]], axis=2, dtype=np.float32)
    else:
        (scene, image), lights = traced(rig), {}
    if not layers:
        return Taken(image, None, lights)
    then = None if later is None else Later(split(later.hairs), later.bodies, camera_of(later))
    return Taken(image, layers_of(scene, camera, pigments, pose, then), lights)


def place(
    settings: PictureSettings,
    seen: Sequence[NDArray[np.floating]],
    lock: NDArray[np.floating] | None = None,
    given: Camera | None = None,
) -> Standpoint:
    """Camera and light of settings; the arguments are those of ``take_position``."""
    camera = take_position(settings, seen, lock, given)
    return Standpoint(camera, rig_around(settings, seen, camera))


def rig_around(settings: PictureSettings, seen: Sequence[NDArray[np.floating]], camera: Camera) -> Rig:
    """The light of settings around a subject, as far from it as a portrait camera is."""
    portrait = frame(seen, view=angles_towards(camera.axes[2]))
    return Rig(settings.light, settings.light_turn, camera.axes, portrait.target, portrait.distance)


def growing(poses: Iterator[Pose], camera: Camera, settings: PictureSettings) -> Iterator[tuple[Image.Image, int]]:
    """Pictures from a camera as they grow, developed, and the samples that each has; the last is that of ``still``.

    poses: what is seen; first with few hairs that stand for all, for a coarse picture that comes soon, then with all
    Takes width, height, samples, colour, light, bounces and denoiser of the settings.

    Raises UserError for an unknown colour or light, and without hairs and bodies.
    """
    check_rig(settings.light)
    size, color = picture_size(settings, camera), hair_color(settings.color)

    def scene_of(pose: Pose) -> Scene:
        rig = rig_around(settings, subject(pose), camera)
        return build_scene(
            pose.bodies, pose.hairs, camera, size=size, color=color, max_depth=settings.bounces + 1, rig=rig
        )

    def picture(light: NDArray[np.floating]) -> Image.Image:
        return developed(np.asarray(light, np.float32), settings.background)

    with using(settings.engine):
        yield picture(trace_coarse(scene_of(next(poses)), camera, size)), 1
        for light, samples in trace_growing(
            scene_of(next(poses)), settings.samples, denoise=settings.denoiser == "oidn"
        ):
            yield picture(light), samples


def check_denoiser(name: str) -> None:
    """Raises UserError for a denoiser that is not installed."""
    if name == "oidn" and not oidn.available():
        raise UserError("picture: the denoiser oidn needs pyoidn; install it with: pip install 'ringlet[pictures]'")


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


def subject(pose: Pose) -> list[NDArray[np.floating]]:
    """Points that a portrait frames: all hair, and the points of bodies near it, the head without the shoulders."""
    bodies, hairs = pose.bodies, pose.hairs
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
