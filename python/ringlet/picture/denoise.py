"""Less noise: pixels are averaged with pixels nearby whose surroundings look the same, given how noisy both are.

Non-local means with the variance of each pixel, after Rousselle, Knaus and Zwicker, "Adaptive rendering with non-local
means filtering" (2012). Smooth skin and cloth become clean; curls differ from each other by more than their noise and
keep their grain. What looks the same is judged by another picture of the same: by its own noise, pixels would be
averaged with those that have the same noise by chance, and that would stay as a pattern of worms.
"""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter

REACH = 6  # how far a pixel looks for others like it [pixels]
PATCH = 5  # edge of the surroundings that are compared [pixels]
STRICT = 0.5  # differences below about this many standard deviations count as noise
LEAST = 1e-5  # difference that nobody sees, squared


def denoise(
    light: NDArray[np.floating], guide: NDArray[np.floating], variance: NDArray[np.floating]
) -> NDArray[np.float32]:
    """An image without much of its noise, shape (height, width, channels).

    guide:    the same image with other noise
    variance: of each value of the guide
    """
    # A channel is a plane: sums over channels are then sums of planes, which are fast.
    light, guide, noise = (np.ascontiguousarray(np.moveaxis(v, 2, 0), np.float32) for v in (light, guide, variance))
    noise = uniform_filter(noise, 5, axes=(1, 2))  # itself known from a few passes only
    _, height, width = light.shape
    total, weights = light.copy(), np.ones((height, width), np.float32)
    for dy, dx in product(range(REACH + 1), range(-REACH, REACH + 1)):
        if (dy, dx) <= (0, 0):
            continue  # every pair once: the weight of one pixel for the other is the same both ways
        here = np.s_[..., : height - dy, max(-dx, 0) : width - max(dx, 0)]
        there = np.s_[..., dy:, max(dx, 0) : width - max(-dx, 0)]
        a, b = noise[here], noise[there]
        apart = (guide[here] - guide[there]) ** 2 - (a + np.minimum(a, b))
        apart = uniform_filter((apart / (LEAST + STRICT**2 * (a + b))).mean(axis=0), PATCH)
        weight = np.exp(-np.maximum(apart, 0.0))
        total[here] += weight * light[there]
        total[there] += weight * light[here]
        weights[here] += weight
        weights[there] += weight
    return np.moveaxis(total / weights, 0, 2)
