"""Layers of a picture other than its light (AOVs): depth, normal, albedo, and which lock is seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.camera import Camera
from ringlet.data.curves import Curves
from ringlet.picture.scene import Scene, scene_scale

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


@dataclass(frozen=True)
class HairGroup:
    """Hairs of one shape of the scene, and their reflectance, of each hair or of each point, shape (k, 3)."""

    hairs: Curves
    reflectance: NDArray[np.float64]

    def locks(self) -> NDArray[np.integer]:
        """Row of the lock of each segment; without locks each hair is one."""
        lock = self.hairs.curve.get("lock", np.arange(len(self.hairs)))
        return np.repeat(lock, self.hairs.counts - 1)

    def albedo(self) -> NDArray[np.float64]:
        """Albedo of each segment (linear r, g, b), that of its first point where it varies along hairs."""
        if len(self.reflectance) == len(self.hairs):
            return np.repeat(self.reflectance, self.hairs.counts - 1, axis=0)
        return np.delete(self.reflectance, self.hairs.offsets[1:] - 1, axis=0)


def trace_layers(mi: Any, scene: Scene, camera: Camera, groups: Sequence[HairGroup]) -> Layers:
    """Casts rays of one sample per pixel, so that each hits one surface, and takes the means.

    groups: hairs of the first shapes of the scene
    """
    hair = [(number, group.locks(), group.albedo()) for number, group in enumerate(groups, 1)]
    aovs = "position:position,normal:sh_normal,albedo:albedo,shape:shape_index,segment:prim_index"
    integrator = mi.load_dict({"type": "aov", "aovs": aovs})
    sums: Any = 0.0
    lock: Any = None
    for number in range(SAMPLES):
        rays = np.array(mi.render(scene.loaded, integrator=integrator, spp=1, seed=number), np.float64)
        position, normal, albedo = np.split(rays[:, :, :9], 3, axis=2)
        shape, segment = (np.rint(rays[:, :, k]).astype(np.int64) for k in (9, 10))
        shown = (shape > 0) & (shape <= len(groups) + scene.bodies)  # neither the background nor a light
        seen, hit = shown[:, :, None], np.full(shape.shape, NOTHING, np.int32)
        for index, locks, colors in hair:
            of_group = shape == index
            at = np.minimum(segment[of_group], len(locks) - 1)  # the last one is the guard
            albedo[of_group], hit[of_group] = colors[at], locks[at]
        depth = camera.distance - position @ camera.axes[2][:, None] / scene_scale(camera)
        sums = sums + np.concatenate([seen, seen * depth, seen * normal, seen * albedo], axis=2)
        lock = hit if lock is None else lock
    means = (sums[:, :, 1:] / np.maximum(sums[:, :, :1], 1.0)).astype(np.float32)
    return Layers(means[:, :, 0], means[:, :, 1:4], means[:, :, 4:7], lock)
