"""Accumulation of independent render passes; their differences reveal fireflies and noise."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from ringlet.picture.along import HairField
from ringlet.picture.denoise import denoise

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
DARKEST = 1e-4  # luminance below which detail has no color of its surroundings
BRIGHTEST = 2.0  # deviations of detail beyond which it is a speck
DETAIL_WINDOW = 6.0  # deviation of the window that separates detail from noise [pixels]


class Passes:
    """Sums of passes in two halves, the even and the odd passes. A pass has light and coverage, (height, width, 4).

    count: number of passes
    """

    def __init__(self) -> None:
        self.count = 0
        self._sums: list[Any] = [0.0, 0.0]
        self._squares: Any = 0.0
        self._brightest: Any = 0.0
        self._half_of_brightest: Any = 0

    def add(self, image: NDArray[np.float64]) -> None:
        """Adds a pass."""
        half = self.count % 2
        self._sums[half] = self._sums[half] + image
        self._squares = self._squares + image**2
        self._half_of_brightest = np.where(image > self._brightest, half, self._half_of_brightest)
        self._brightest = np.maximum(self._brightest, image)
        self.count += 1

    @property
    def counts(self) -> tuple[int, int]:
        """Number of passes in each half."""
        return (self.count + 1) // 2, self.count // 2

    def mean(self) -> NDArray[np.float64]:
        """Mean of all passes."""
        return (self._sums[0] + self._sums[1]) / self.count

    def without_specks(self) -> list[NDArray[np.float64]]:
        """Sums of both halves with fireflies removed and their energy spread over the neighbourhood.

        A firefly is a pixel in which one pass is much brighter than the mean of the others: a rare path reached a
        light through many hairs. The pixel is reduced to that mean. Its surplus light is distributed to the pixels
        around it, since hair is lit by many such paths and would darken. Needs at least two passes.
        """
        total = self._sums[0] + self._sums[1]
        others = (total - self._brightest) / (self.count - 1)
        firefly = np.maximum(self._brightest - (1.5 * others + 0.05), 0.0)
        firefly[:, :, 3] = 0.0  # coverage has no fireflies
        before, after = (gaussian_filter(light, (2.5, 2.5, 0.0)) for light in (total, total - firefly))
        spread = np.clip(before / np.maximum(after, 1e-9), 1.0, 2.0)
        return [spread * (self._sums[half] - firefly * (self._half_of_brightest == half)) for half in (0, 1)]

    def without_noise(self, sums: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
        """Denoised mean of all passes, from the sums of both halves; needs at least three passes.

        The other half, with its fireflies, is the guide of each half, since the variance includes them.
        """
        variance = np.maximum(self._squares / self.count - self.mean() ** 2, 0.0) * self.count / (self.count - 1)
        (many, few), (a, b) = self.counts, sums
        denoised = denoise(a / many, self._sums[1] / few, variance / few) * many
        denoised += denoise(b / few, self._sums[0] / many, variance / many) * few
        return denoised / self.count

    def detail(
        self, sums: Sequence[NDArray[np.float64]], denoised: NDArray[np.float64], hair: HairField
    ) -> NDArray[np.float64]:
        """What both halves have in common beyond the denoised mean, such as single hairs; needs two passes.

        A Wiener filter of the residual along the hairs. Noise of the halves is independent, so their covariance is that
        of the detail, which bounds it: what stands out further is a speck. Detail has the color of its surroundings.
        """
        light = denoised[:, :, :3] @ LUMINANCE
        a, b = (
            hair.along(_brightness(total / count - denoised)) for total, count in zip(sums, self.counts, strict=True)
        )
        mean = (a * self.counts[0] + b * self.counts[1]) / self.count
        common, power = (gaussian_filter(x, (DETAIL_WINDOW, DETAIL_WINDOW, 0.0)) for x in (a * b, mean**2))
        brightest = BRIGHTEST * np.sqrt(np.maximum(common, 0.0))
        kept = np.clip(mean, -brightest, brightest) * np.clip(common / np.maximum(power, 1e-12), 0.0, 1.0)
        colored = denoised[:, :, :3] * (kept[:, :, 0] / np.maximum(light, DARKEST))[:, :, None]
        return np.concatenate([colored, kept[:, :, 1:]], axis=2)


def _brightness(image: NDArray[np.float64]) -> NDArray[np.float64]:
    """Luminance and coverage of an image (r, g, b, a), shape (height, width, 2)."""
    return np.stack([image[:, :, :3] @ LUMINANCE, image[:, :, 3]], axis=2)
