"""Accumulation of independent render passes; what their halves share is no noise."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from ringlet.picture.along import HairField
from ringlet.picture.regression import regressed

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
DARKEST = 1e-4  # luminance below which detail has no color of its surroundings
BRIGHTEST = 2.0  # deviations of detail beyond which it is a speck
DARKEST_RELIEF, BRIGHTEST_RELIEF = 1e-3, 4.0  # luminance, and its ratio to the denoised mean: beyond it is noise
RELIEF = 0.25, 3.0  # least and largest ratio that the edges of hairs make
DETAIL_WINDOW = 6.0  # deviation of the window that separates detail from noise [pixels]


class Passes:
    """Sums of passes in two halves, the even and the odd passes. A pass has light and coverage, (height, width, 4).

    count: number of passes
    """

    def __init__(self) -> None:
        self.count = 0
        self._sums: list[Any] = [0.0, 0.0]
        self._brightest: Any = 0.0
        self._half_of_brightest: Any = 0

    def add(self, image: NDArray[np.float64]) -> None:
        """Adds a pass."""
        half = self.count % 2
        self._sums[half] = self._sums[half] + image
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
        before, after = (scipy.ndimage.gaussian_filter(light, (2.5, 2.5, 0.0)) for light in (total, total - firefly))
        spread = np.clip(before / np.maximum(after, 1e-9), 1.0, 2.0)
        return [spread * (self._sums[half] - firefly * (self._half_of_brightest == half)) for half in (0, 1)]

    def relief(self, denoised: NDArray[np.floating], hair: HairField) -> NDArray[np.floating]:
        """The denoised mean with the edges of single hairs: what depth and run of the hair explain of the passes.

        Light is scaled, and its color kept. Needs at least two passes.
        """
        even, odd = self.without_specks()
        light, clean = (image[:, :, :3] @ LUMINANCE for image in (denoised, (even + odd) / self.count))
        relative = np.clip(clean / np.maximum(light, DARKEST_RELIEF), 0.0, BRIGHTEST_RELIEF)
        scale = 1.0 + hair.share * regressed(relative, hair.layers, hair.share)
        scaled = denoised[:, :, :3] * np.clip(scale, *RELIEF)[:, :, None]
        return np.concatenate([scaled, denoised[:, :, 3:]], axis=2)

    def detail(self, denoised: NDArray[np.floating], hair: HairField) -> NDArray[np.float64]:
        """What both halves have in common beyond the denoised mean, such as single hairs; needs two passes.

        A Wiener filter of the residual along the hairs, less its mean around a pixel: detail adds no light. Noise of
        the halves is independent, so their covariance is that of the detail, which bounds it: what stands out further
        is a speck. Detail has the color of its surroundings.
        """
        light = denoised[:, :, :3] @ LUMINANCE
        residuals = (
            _brightness(total / count - denoised)
            for total, count in zip(self.without_specks(), self.counts, strict=True)
        )
        a, b = (hair.along(residual - _around(residual)) for residual in residuals)
        mean = (a * self.counts[0] + b * self.counts[1]) / self.count
        common, power = _around(a * b), _around(mean**2)
        brightest = BRIGHTEST * np.sqrt(np.maximum(common, 0.0))
        kept = np.clip(mean, -brightest, brightest) * np.clip(common / np.maximum(power, 1e-12), 0.0, 1.0)
        colored = denoised[:, :, :3] * (kept[:, :, 0] / np.maximum(light, DARKEST))[:, :, None]
        return np.concatenate([colored, kept[:, :, 1:]], axis=2)


def _around(image: NDArray[np.floating]) -> NDArray[np.floating]:
    """Means of an image (height, width, channels) around its pixels."""
    return scipy.ndimage.gaussian_filter(image, (DETAIL_WINDOW, DETAIL_WINDOW, 0.0))


def _brightness(image: NDArray[np.float64]) -> NDArray[np.float64]:
    """Luminance and coverage of an image (r, g, b, a), shape (height, width, 2)."""
    return np.stack([image[:, :, :3] @ LUMINANCE, image[:, :, 3]], axis=2)
