"""Passes of one picture with different random numbers: from what they differ in, specks and noise are known."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from ringlet.picture.denoise import denoise


class Passes:
    """Light and coverage of passes, each of shape (height, width, 4), in two halves: passes 0, 2, 4 … and 1, 3, 5 ….

    count: how many there are
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
        """How many are in each half."""
        return (self.count + 1) // 2, self.count // 2

    def mean(self) -> NDArray[np.float64]:
        """The picture as it is."""
        return (self._sums[0] + self._sums[1]) / self.count

    def without_specks(self) -> list[NDArray[np.float64]]:
        """The sums of both halves, with specks spread over their neighbourhood; at least two passes.

        A speck is a pixel with one pass much brighter than the mean of the others: a rare path met a light through
        many hairs. It is taken down to what the others say, and the light that is lost so goes to the pixels around
        it, so that hair, which is lit by many such paths, stays as bright as it is.
        """
        total = self._sums[0] + self._sums[1]
        others = (total - self._brightest) / (self.count - 1)
        speck = np.maximum(self._brightest - (1.5 * others + 0.05), 0.0)
        speck[:, :, 3] = 0.0  # coverage has none
        before, after = (gaussian_filter(light, (2.5, 2.5, 0.0)) for light in (total, total - speck))
        spread = np.clip(before / np.maximum(after, 1e-9), 1.0, 2.0)
        return [spread * (self._sums[half] - speck * (self._half_of_brightest == half)) for half in (0, 1)]

    def without_noise(self, sums: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
        """The mean of all passes without much of its noise, from the sums of both halves; at least three passes.

        Each half is cleaned as the other one looks, specks and all: they are as noisy as they look.
        """
        variance = np.maximum(self._squares / self.count - self.mean() ** 2, 0.0) * self.count / (self.count - 1)
        (many, few), (a, b) = self.counts, sums
        calm = denoise(a / many, self._sums[1] / few, variance / few) * many
        calm += denoise(b / few, self._sums[0] / many, variance / many) * few
        return calm / self.count
