"""Path tracing of scenes, in passes, to linear light."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from ringlet.data.camera import Camera
from ringlet.data.pigment import HairColor
from ringlet.picture import oidn
from ringlet.picture.engine import mitsuba
from ringlet.picture.fiber import hair_reflectances
from ringlet.picture.hair_field import hair_field
from ringlet.picture.layers import HairGroup, Later, Layers, trace_layers
from ringlet.picture.motion import Pose, fraction_of_pass
from ringlet.picture.passes import Passes
from ringlet.picture.scene import Scene, image_sensor, scene_scale
from ringlet.picture.studio import backdrop

# Arguments: name of the stage, steps done, total steps.
Progress = Callable[[str, int, int], None]


# Samples per pixel of one pass: enough to stratify a pixel and the lights, few enough for several passes to compare.
# A time limit makes passes smaller, since denoising needs a few of them.
MAX_PASS_SAMPLES, MAX_TIMED_PASS_SAMPLES, MIN_PASSES = 8, 2, 4
MIN_DENOISED_PASSES = 3

# Most pixels along a side of the first picture of one that grows.
COARSE = 240

# Passes of a picture with motion blur: each sees the scene at one time.
MIN_MOVED_PASSES = 16


def trace(
    scene: Scene,
    *,
    samples: int,
    seconds: float | None = None,
    progress: Progress | None = None,
    denoise: bool = True,
    moved: Callable[[float], Scene] | None = None,
) -> NDArray[np.float32]:
    """Renders light and coverage (r, g, b, a), shape (height, width, 4): the mean of independent passes, denoised.

    samples:  light paths per pixel
    seconds:  time limit; a pass that would exceed it is not started, but for those that denoising needs
    progress: called with "picture", the passes done and their number
    denoise:  whether noise is removed; it takes ``MIN_DENOISED_PASSES``
    moved:    builds the scene at a fraction of the shutter time, for motion blur
    """
    mi = mitsuba()
    most = MAX_PASS_SAMPLES if seconds is None else MAX_TIMED_PASS_SAMPLES
    per_pass = min(max(samples // (MIN_PASSES if moved is None else MIN_MOVED_PASSES), 1), most)
    passes = -(-samples // per_pass)
    enough = MIN_DENOISED_PASSES if denoise else 1
    began = time.monotonic()
    accumulated, done = Passes(), 0
    if progress:
        progress("picture", 0, passes)
    while done < passes:
        at = scene if moved is None else moved(fraction_of_pass(done))
        accumulated.add(np.nan_to_num(np.array(mi.render(at.loaded, spp=per_pass, seed=done), np.float64)))
        done = accumulated.count
        if progress:
            progress("picture", done, passes)
        elapsed = time.monotonic() - began
        if seconds is not None and done >= enough and elapsed * (done + 1) / done > seconds:
            break
    if progress and done < passes:
        progress("picture", passes, passes)
    if done < MIN_DENOISED_PASSES or not denoise:
        return accumulated.mean().astype(np.float32)
    return _denoised(scene, accumulated)


def trace_coarse(scene: Scene, camera: Camera, size: tuple[int, int]) -> NDArray[np.floating]:
    """Light and coverage of a picture of one sample, of ``COARSE`` pixels along a side at most."""
    mi, scale = mitsuba(), min(1.0, COARSE / max(size))
    small = max(1, round(scale * size[0])), max(1, round(scale * size[1]))
    sensor = mi.load_dict(image_sensor(mi, camera, small, scene_scale(camera)))
    return np.nan_to_num(np.array(mi.render(scene.loaded, sensor=sensor, spp=1), np.float64))


def trace_growing(scene: Scene, samples: int, *, denoise: bool = True) -> Iterator[tuple[NDArray[np.floating], int]]:
    """Renders as ``trace``, and yields the picture as it grows: light and coverage, and the samples that it has.

    One of each sample per pixel so far; the last is denoised as in ``trace``.
    """
    mi, accumulated, denoised = mitsuba(), Passes(), denoise and samples >= MIN_DENOISED_PASSES
    for done in range(samples):
        accumulated.add(np.nan_to_num(np.array(mi.render(scene.loaded, spp=1, seed=done), np.float64)))
        if done + 1 < samples or not denoised:
            yield accumulated.mean(), done + 1
    if denoised:
        yield _denoised(scene, accumulated), samples


def _denoised(scene: Scene, accumulated: Passes) -> NDArray[np.float32]:
    """The mean of at least three passes without noise, with the edges of its hairs."""
    return np.asarray(accumulated.relief(oidn.denoise(accumulated.mean()), hair_field(mitsuba(), scene)), np.float32)


def layers_of(scene: Scene, camera: Camera, color: HairColor | None, pose: Pose, later: Later | None = None) -> Layers:
    """Layers of a scene other than its light; ``later`` is what is seen in the next frame."""
    groups = [HairGroup(some, hair_reflectances(some, color)) for some in scene.hairs]
    return trace_layers(mitsuba(), scene, camera, groups, pose.bodies, pose.grooms, later)


def over_backdrop(image: NDArray[np.float32]) -> NDArray[np.floating]:
    """Composites light with coverage, shape (h, w, 4), over the studio's backdrop; shape (h, w, 3)."""
    wall = backdrop(image.shape[1], image.shape[0])
    return image[:, :, :3] + (1.0 - np.clip(image[:, :, 3:], 0.0, 1.0)) * wall
