"""Less noise: pixels are averaged with pixels nearby whose surroundings look the same, given how noisy both are.

Non-local means with the variance of each pixel, after Rousselle, Knaus and Zwicker, "Adaptive rendering with non-local
means filtering" (2012). Smooth skin and cloth become clean; curls differ from each other by more than their noise and
keep their grain.
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


def denoise(image: NDArray[np.floating], variance: NDArray[np.floating]) -> NDArray[np.float32]:
    """An image without much of its noise, shape (height, width, channels).

    variance: of each value of the image, the same shape
    """
    image = np.asarray(image, np.float32)
    variance = uniform_filter(np.asarray(variance, np.float32), 3, axes=(0, 1))  # itself known from a few passes only
    height, width, _ = image.shape
    total, weights = image.copy(), np.ones((height, width, 1), np.float32)
    for dy, dx in product(range(REACH + 1), range(-REACH, REACH + 1)):
        if (dy, dx) <= (0, 0):
            continue  # every pair once: the weight of one pixel for the other is the same both ways
        here = np.s_[: height - dy, max(-dx, 0) : width - max(dx, 0)]
        there = np.s_[dy:, max(dx, 0) : width - max(-dx, 0)]
        a, b = variance[here], variance[there]
        apart = (image[here] - image[there]) ** 2 - (a + np.minimum(a, b))
        apart = uniform_filter((apart / (LEAST + STRICT**2 * (a + b))).mean(axis=2), PATCH)
        weight = np.exp(-np.maximum(apart, 0.0))[:, :, None]
        total[here] += weight * image[there]
        total[there] += weight * image[here]
        weights[here] += weight
        weights[there] += weight
    return np.asarray(total / weights, np.float32)
