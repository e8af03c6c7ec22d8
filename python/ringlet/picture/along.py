"""Means along hairs in a picture: noise averages out, while single hairs keep their edges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from ringlet.picture.scene import Scene

RAYS = 16  # of one sample per pixel that show where hair is: they take a seventh of the time of 48 samples of dark hair
BLUR = 1.2  # deviation of the mean of share and direction [pixels]
REACH = 6  # pixels to each side along a hair
ALIKE = 0.7  # cosine of the double angle from which on a pixel counts as along the same hairs


@dataclass(frozen=True)
class HairField:
    """Where hair is seen in a picture, and how it runs.

    share:     coverage of visible hair, from 0 to 1, blurred at its edges; shape (height, width)
    direction: mean of (cos 2φ, sin 2φ) over the hairs in a pixel, with the angle φ of each from the picture's x axis
               towards its y axis; its length tells how parallel they are. Shape (height, width, 2)
    layers:    what single hairs show in, sharp: coverage of hair, mean and deviation of its depth, cos 2φ and sin 2φ.
               Shape (height, width, 5)
    """

    share: NDArray[np.float32]
    direction: NDArray[np.float32]
    layers: NDArray[np.float32]

    def along(self, image: NDArray[np.floating]) -> NDArray[np.float64]:
        """Means of an image (height, width, channels) along the hairs, over up to ``REACH`` pixels to each side.

        Line integral convolution (Cabral and Leedom 1993), which ends where hairs turn away or cross.
        """
        height, width = self.share.shape
        rows, columns = np.mgrid[:height, :width].astype(np.float64)
        angle = 0.5 * np.arctan2(self.direction[:, :, 1], self.direction[:, :, 0])
        step = np.stack([np.cos(angle), np.sin(angle)])
        total, weights = np.array(image, np.float64), np.ones((height, width))
        for sign in (1.0, -1.0):
            ahead, x, y, weight = sign * step, columns.copy(), rows.copy(), np.ones((height, width))
            for _ in range(REACH):
                x, y = np.clip(x + ahead[0], 0, width - 1), np.clip(y + ahead[1], 0, height - 1)
                at = np.rint(y).astype(np.int64), np.rint(x).astype(np.int64)
                alike = np.einsum("hwk,hwk->hw", self.direction, self.direction[at])
                weight = weight * np.clip(alike / ALIKE, 0.0, 1.0)
                total += weight[:, :, None] * image[at]
                weights += weight
                there = step[:, at[0], at[1]]
                ahead = np.where((there * ahead).sum(axis=0) < 0.0, -there, there)
        return total / weights[:, :, None]


def hair_field(mi: Any, scene: Scene) -> HairField:
    """Casts rays of one sample per pixel to see where hair is, how deep, and how it runs."""
    if not scene.hairs:
        empty = np.zeros((1, 1, 5), np.float32)
        return HairField(empty[:, :, 0], empty[:, :, :2], empty)
    integrator = mi.load_dict({"type": "aov", "aovs": "tangent:dp_dv,shape:shape_index,depth:depth"})
    to_camera = np.array(scene.loaded.sensors()[0].world_transform().matrix).reshape(4, 4)[:3, :3].T
    sums: Any = 0.0
    for number in range(RAYS):
        seen = np.array(mi.render(scene.loaded, integrator=integrator, spp=1, seed=number), np.float64)
        shape, depth = np.rint(seen[:, :, 3]), seen[:, :, 4]  # shape 0 is the background
        run = seen[:, :, :3] @ to_camera.T[:, :2]
        squared = np.maximum((run**2).sum(axis=2), 1e-30)
        hair = ((shape > 0) & (shape <= len(scene.hairs))).astype(np.float64)
        double = ((run[:, :, 0] ** 2 - run[:, :, 1] ** 2) / squared, 2.0 * run[:, :, 0] * run[:, :, 1] / squared)
        one = (np.ones_like(depth), depth, depth**2, *double)
        sums = sums + np.stack([hair * value for value in one], axis=2)
    count = np.maximum(sums[:, :, :1], 1.0)
    depth, squared_depth = np.moveaxis(sums[:, :, 1:3] / count, 2, 0)
    deviation = np.sqrt(np.maximum(squared_depth - depth**2, 0.0))
    layers = np.stack([sums[:, :, 0], depth, deviation, sums[:, :, 3], sums[:, :, 4]], axis=2)
    layers[:, :, (0, 3, 4)] /= RAYS
    share, *run = (scipy.ndimage.gaussian_filter(layers[:, :, k], BLUR) for k in (0, 3, 4))
    direction = np.stack(run, axis=2) / np.maximum(share[:, :, None], 1e-3)
    return HairField(share.astype(np.float32), direction.astype(np.float32), layers.astype(np.float32))
