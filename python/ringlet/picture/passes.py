"""Accumulation of independent render passes, and what of them is no noise."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from ringlet.picture.hair_field import HairField
from ringlet.picture.regression import regressed

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
DARKEST, BRIGHTEST = 1e-3, 4.0  # luminance, and its ratio to the denoised mean: beyond it is noise
RELIEF = 0.25, 3.0  # least and largest ratio that the edges of hairs make


class Passes:
    """The sum of passes, and the brightest of them in each pixel. A pass has light and coverage, (height, width, 4).

    count: number of passes
    """

    def __init__(self) -> None:
        self.count = 0
        self._sum: Any = 0.0
        self._brightest: Any = 0.0

    def add(self, image: NDArray[np.float64]) -> None:
        """Adds a pass."""
        self._sum = self._sum + image
        self._brightest = np.maximum(self._brightest, image)
        self.count += 1

    def mean(self) -> NDArray[np.float64]:
        """Mean of all passes."""
        return self._sum / self.count

    def without_specks(self) -> NDArray[np.float64]:
        """Mean of all passes with fireflies removed and their energy spread over the neighbourhood.

        A firefly is a pixel in which one pass is much brighter than the mean of the others: a rare path reached a
        light through many hairs. The pixel is reduced to that mean. Its surplus light is distributed to the pixels
        around it, since hair is lit by many such paths and would darken. Needs at least two passes.
        """
        others = (self._sum - self._brightest) / (self.count - 1)
        firefly = np.maximum(self._brightest - (1.5 * others + 0.05), 0.0)
        firefly[:, :, 3] = 0.0  # coverage has no fireflies
        kept = self._sum - firefly
        before, after = (scipy.ndimage.gaussian_filter(light, (2.5, 2.5, 0.0)) for light in (self._sum, kept))
        return np.clip(before / np.maximum(after, 1e-9), 1.0, 2.0) * kept / self.count

    def relief(self, denoised: NDArray[np.floating], hair: HairField) -> NDArray[np.floating]:
        """The denoised mean with the edges of single hairs: what depth and run of the hair explain of the passes.

        Light is scaled, and its color kept. Needs at least two passes.
        """
        light, clean = (image[:, :, :3] @ LUMINANCE for image in (denoised, self.without_specks()))
        relative = np.clip(clean / np.maximum(light, DARKEST), 0.0, BRIGHTEST)
        scale = 1.0 + hair.share * regressed(relative, hair.layers, hair.share)
        scaled = denoised[:, :, :3] * np.clip(scale, *RELIEF)[:, :, None]
        return np.concatenate([scaled, denoised[:, :, 3:]], axis=2)
