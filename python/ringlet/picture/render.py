"""Path tracing of bodies and hairs in the studio, in passes, to linear light."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.camera import Camera
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.pigment import HairColor
from ringlet.picture import oidn
from ringlet.picture.along import HAIRS, hair_field
from ringlet.picture.bodies import COLORS, PosedBody, material
from ringlet.picture.engine import mitsuba
from ringlet.picture.fiber import fiber_bsdf, hair_reflectances
from ringlet.picture.layers import HairGroup, Layers, trace_layers
from ringlet.picture.motion import fraction_of_pass
from ringlet.picture.passes import Passes
from ringlet.picture.rigs import STUDIO, Rig
from ringlet.picture.strands import fibres, load_fibres, split
from ringlet.picture.studio import backdrop

# Arguments: name of the stage, steps done, total steps.
Progress = Callable[[str, int, int], None]


# Smallest drawn diameter of a hair [pixels]: a surface of no radius has no normals.
THINNEST = 1e-3

# Samples per pixel of one pass: enough to stratify a pixel and the lights, few enough for several passes to compare.
# A time limit makes passes smaller, since denoising needs three of them.
MAX_PASS_SAMPLES, MAX_TIMED_PASS_SAMPLES, MIN_PASSES = 8, 2, 4

# Most pixels along a side of the first picture of one that grows.
COARSE = 240

# Passes of a picture with motion blur: each sees the scene at one time.
MIN_MOVED_PASSES = 16


def build_scene(
    bodies: Sequence[PosedBody],
    hairs: Curves | None,
    camera: Camera,
    *,
    size: tuple[int, int],
    color: HairColor | None,
    max_depth: int,
    rig: Rig | None = None,
) -> Any:
    """Builds the Mitsuba scene, centred and scaled so that single precision resolves a hair's width.

    size:     width and height of the picture [pixels]
    color:    of all hairs; None for that of their attributes
    rig:      light; by default the studio around what the camera looks at
    """
    mi = mitsuba()
    target, scale = camera.target, scene_scale(camera)
    rig = rig or Rig(STUDIO, 0.0, camera.axes, target, camera.distance)
    scene: dict[str, Any] = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": max_depth, "rr_depth": 2, "hide_emitters": True},
        "sensor": _sensor(mi, camera, size, scale),
        **rig.emitters(mi, target, scale),
    }
    for index, body in enumerate(bodies):
        scene[f"body{index}"] = _mesh(mi, body, target, scale)
    if hairs is not None and len(hairs):
        pixel = 2.0 * camera.slopes[0] * camera.distance / size[0]
        for index, some in enumerate(split(hairs)):
            controls, offsets = fibres(some, target)
            controls[:, 3] = np.maximum(controls[:, 3], 0.5 * THINNEST * pixel)
            bsdf = fiber_bsdf(mi, some, color)
            scene[f"{HAIRS}{index}"] = load_fibres(mi, controls * np.float32(scale), offsets, bsdf)
    return mi.load_dict(scene)


def scene_scale(camera: Camera) -> float:
    """Scene units per metre: the camera is 100 units from its target, the origin of the scene."""
    return 100.0 / camera.distance


def _sensor(mi: Any, camera: Camera, size: tuple[int, int], scale: float) -> dict[str, Any]:
    """The camera in the scene, whose origin is the camera's target.

    Its pixels share no samples: a denoiser takes noise that they share for detail, and layers have one surface a ray.
    """
    place = scale * camera.distance * camera.axes[2]
    sensor: dict[str, Any] = {
        "type": "perspective",
        "fov": camera.fov,
        "fov_axis": "x",
        "near_clip": 5.0,
        "far_clip": 1e5,
        "to_world": mi.ScalarTransform4f().look_at(origin=list(place), target=[0, 0, 0], up=list(camera.axes[1])),
        "sampler": {"type": "multijitter"},
        "film": {
            "type": "hdrfilm",
            "width": size[0],
            "height": size[1],
            "pixel_format": "rgba",
            "component_format": "float32",
            "rfilter": {"type": "box"},
        },
    }
    if camera.lens_radius:
        if any(camera.shift):
            raise UserError("picture: the camera has both an aperture offset and depth of field; set --f-stop to 0")
        focus = camera.distance if camera.focus is None else camera.focus
        lens = {"type": "thinlens", "aperture_radius": scale * camera.lens_radius, "focus_distance": scale * focus}
        return sensor | lens
    right, up = (0.5 * shift / slope for shift, slope in zip(camera.shift, camera.slopes, strict=True))
    return sensor | {"principal_point_offset_x": right, "principal_point_offset_y": -up}


def trace(
    scene: Any,
    *,
    samples: int,
    seconds: float | None = None,
    progress: Progress | None = None,
    denoise: bool = True,
    moved: Callable[[float], Any] | None = None,
) -> NDArray[np.float32]:
    """Renders light and coverage (r, g, b, a), shape (height, width, 4): the mean of independent passes, denoised.

    samples:  light paths per pixel
    seconds:  time limit; a pass that would exceed it is not started
    progress: called with "picture", the passes done and their number
    denoise:  whether noise is removed; it takes three passes
    moved:    builds the scene at a fraction of the shutter time, for motion blur
    """
    mi = mitsuba()
    most = MAX_PASS_SAMPLES if seconds is None else MAX_TIMED_PASS_SAMPLES
    per_pass = min(max(samples // (MIN_PASSES if moved is None else MIN_MOVED_PASSES), 1), most)
    passes = -(-samples // per_pass)
    began = time.monotonic()
    accumulated, done = Passes(), 0
    if progress:
        progress("picture", 0, passes)
    while done < passes:
        at = scene if moved is None else moved(fraction_of_pass(done))
        accumulated.add(np.nan_to_num(np.array(mi.render(at, spp=per_pass, seed=done), np.float64)))
        done = accumulated.count
        if progress:
            progress("picture", done, passes)
        elapsed = time.monotonic() - began
        if seconds is not None and elapsed * (done + 1) / done > seconds:
            break
    if progress and done < passes:
        progress("picture", passes, passes)
    if done < 3 or not denoise:
        return accumulated.mean().astype(np.float32)
    return _denoised(scene, accumulated)


def trace_growing(
    scene: Any, camera: Camera, size: tuple[int, int], samples: int, *, denoise: bool = True, coarse: int = COARSE
) -> Iterator[tuple[NDArray[np.floating], int]]:
    """Renders as ``trace``, and yields the picture as it grows: light and coverage, and the samples that it has.

    The first is small, of one sample; then one of each sample per pixel so far; the last is denoised as in ``trace``.

    coarse: most pixels along a side of the small one
    """
    mi, accumulated, denoised = mitsuba(), Passes(), denoise and samples >= 3
    if max(size) > coarse:
        small = tuple(max(1, round(side * coarse / max(size))) for side in size)
        sensor = _sensor(mi, camera, (small[0], small[1]), scene_scale(camera))
        yield np.nan_to_num(np.array(mi.render(scene, sensor=mi.load_dict(sensor), spp=1), np.float64)), 1
    for done in range(samples):
        accumulated.add(np.nan_to_num(np.array(mi.render(scene, spp=1, seed=done), np.float64)))
        if done + 1 < samples or not denoised:
            yield accumulated.mean(), done + 1
    if denoised:
        yield _denoised(scene, accumulated), samples


def _denoised(scene: Any, accumulated: Passes) -> NDArray[np.float32]:
    """The mean of at least three passes without noise, with the detail of its hair."""
    denoised, hair = oidn.denoise(accumulated.mean()), hair_field(mitsuba(), scene)
    return np.asarray(denoised + hair.share[:, :, None] * accumulated.detail(denoised, hair), np.float32)


def layers_of(scene: Any, camera: Camera, hairs: Curves, color: HairColor | None) -> Layers:
    """Layers of a scene other than its light: depth, normal, albedo and lock."""
    groups = {}
    if len(hairs):
        lock = hairs.curve.get("lock", np.arange(len(hairs)))
        for index, some in enumerate(split(replace(hairs, curve={**hairs.curve, "lock": lock}))):
            groups[f"{HAIRS}{index}"] = HairGroup(some, hair_reflectances(some, color))
    return trace_layers(mitsuba(), scene, camera, groups, scale=scene_scale(camera))


def over_backdrop(image: NDArray[np.float32]) -> NDArray[np.floating]:
    """Composites light with coverage, shape (h, w, 4), over the studio's backdrop; shape (h, w, 3)."""
    wall = backdrop(image.shape[1], image.shape[0])
    return image[:, :, :3] + (1.0 - np.clip(image[:, :, 3:], 0.0, 1.0)) * wall


def _mesh(mi: Any, body: PosedBody, target: NDArray[np.float64], scale: float) -> Any:
    mesh = body.mesh
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(material(mesh, body.opacity))
    shape = mi.Mesh(mesh.name, len(mesh.points), len(mesh.triangles), has_vertex_normals=True, props=properties)
    if mesh.colors is not None:
        shape.add_attribute(COLORS, 3, np.clip(mesh.colors, 0.0, 1.0).astype(np.float32).ravel())
    parameters = mi.traverse(shape)
    values = {
        "vertex_positions": (body.points - target) * scale,
        "vertex_normals": mesh.normals(np.asarray(body.points, np.float64)),
        "faces": mesh.triangles,
    }
    for name, array in values.items():
        kind = type(parameters[name])
        parameters[name] = kind(np.ascontiguousarray(array, np.uint32 if name == "faces" else np.float32).ravel())
    parameters.update()
    return shape
