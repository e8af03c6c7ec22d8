"""Denoising by non-local means with per-pixel variance.

After Rousselle, Knaus and Zwicker, "Adaptive rendering with non-local means filtering" (2012). Smooth skin and cloth
become clean; curls differ by more than their noise and keep their grain. The weights come from a guide image with
independent noise. With its own noise, the filter would average pixels whose noise agrees by chance, and leave
worm-like artefacts.
"""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter

SEARCH_RADIUS = 6  # [pixels]
PATCH = 5  # edge length of compared patches [pixels]
STRENGTH = 0.5  # filter parameter k: differences below about this many standard deviations count as noise
EPSILON = 1e-5  # squared difference below the visible range


def denoise(
    light: NDArray[np.floating], guide: NDArray[np.floating], variance: NDArray[np.floating]
) -> NDArray[np.float32]:
    """Denoises an image, shape (height, width, channels).

    guide:    the same image with independent noise
    variance: variance of each value of the guide
    """
    # Channels first: sums over channels are then fast sums of planes.
    light, guide, noise = (np.ascontiguousarray(np.moveaxis(v, 2, 0), np.float32) for v in (light, guide, variance))
    noise = uniform_filter(noise, 5, axes=(1, 2))  # an estimate from few passes
    _, height, width = light.shape
    total, weights = light.copy(), np.ones((height, width), np.float32)
    for dy, dx in product(range(SEARCH_RADIUS + 1), range(-SEARCH_RADIUS, SEARCH_RADIUS + 1)):
        if (dy, dx) <= (0, 0):
            continue  # each pair once: weights are symmetric
        pixels = np.s_[..., : height - dy, max(-dx, 0) : width - max(dx, 0)]
        neighbours = np.s_[..., dy:, max(dx, 0) : width - max(-dx, 0)]
        a, b = noise[pixels], noise[neighbours]
        distance = (guide[pixels] - guide[neighbours]) ** 2 - (a + np.minimum(a, b))
        distance = uniform_filter((distance / (EPSILON + STRENGTH**2 * (a + b))).mean(axis=0), PATCH)
        weight = np.exp(-np.maximum(distance, 0.0))
        total[pixels] += weight * light[neighbours]
        total[neighbours] += weight * light[pixels]
        weights[pixels] += weight
        weights[neighbours] += weight
    return np.moveaxis(total / weights, 0, 2)
