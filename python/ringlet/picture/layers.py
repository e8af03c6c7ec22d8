"""Layers of a picture beside its light (AOVs): depth, normal, albedo, and which lock is seen."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.camera import Camera
from ringlet.data.curves import Curves

SAMPLES = 16  # rays per pixel: the edges of the layers are then as smooth as those of the picture
NOTHING = -1


@dataclass(frozen=True)
class Layers:
    """What is seen in each pixel: means over what is covered, 0 where nothing is.

    depth:  along the optical axis [m], shape (height, width)
    normal: of the surface, in world axes, shape (height, width, 3)
    albedo: linear r, g, b, shape (height, width, 3)
    lock:   row of the lock of the hair that one ray through the pixel hits; -1 elsewhere. Shape (height, width), int32
    """

    depth: NDArray[np.float32]
    normal: NDArray[np.float32]
    albedo: NDArray[np.float32]
    lock: NDArray[np.int32]


def trace_layers(
    mi: Any,
    scene: Any,
    camera: Camera,
    hairs: Curves,
    *,
    hair_shape: str,
    hair_albedo: NDArray[np.floating],
    scale: float,
) -> Layers:
    """Casts rays of one sample per pixel, so that each hits one surface, and takes the means.

    The second sensor of the scene has no pixel filter.

    hair_shape:  name of the hairs in the scene
    hair_albedo: of a hair, as a mass of hairs shows it (linear r, g, b)
    scale:       scene units per metre; the origin of the scene is the camera's target
    """
    names = [shape.id() for shape in scene.shapes()]
    shown = np.array([False] + [not shape.is_emitter() for shape in scene.shapes()])  # 0 is the background
    hair_index = names.index(hair_shape) + 1 if hair_shape in names else -1
    hair_of_segment = np.repeat(np.arange(len(hairs)), hairs.counts - 1)
    lock_of_hair = hairs.curve.get("lock", np.arange(len(hairs)))
    aovs = "position:position,normal:sh_normal,albedo:albedo,shape:shape_index,segment:prim_index"
    integrator = mi.load_dict({"type": "aov", "aovs": aovs})
    sums: Any = 0.0
    lock: Any = None
    for number in range(SAMPLES):
        rays = np.array(mi.render(scene, sensor=1, integrator=integrator, spp=1, seed=number), np.float64)
        position, normal, albedo, shape, segment = np.split(rays, [3, 6, 9, 10], axis=2)
        is_hair, seen = shape == hair_index, shown[shape.astype(np.int64)]
        depth = camera.distance - position @ camera.axes[2][:, None] / scale
        albedo = np.where(is_hair, hair_albedo, albedo)
        sums = sums + np.concatenate([seen, seen * depth, seen * normal, seen * albedo], axis=2)
        if lock is None:
            at = np.clip(segment, 0, max(len(hair_of_segment) - 1, 0)).astype(np.int64)
            rows = lock_of_hair[hair_of_segment[at]] if len(hair_of_segment) else at
            lock = np.where(is_hair, rows, NOTHING)[:, :, 0].astype(np.int32)
    means = (sums[:, :, 1:] / np.maximum(sums[:, :, :1], 1.0)).astype(np.float32)
    return Layers(means[:, :, 0], means[:, :, 1:4], means[:, :, 4:7], lock)
