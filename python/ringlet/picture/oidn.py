"""Denoising by Intel Open Image Denoise (``pyoidn``), which has no wheel for Linux on ARM64."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
from numpy.typing import NDArray


def available() -> bool:
    """Whether ``pyoidn`` is installed."""
    try:
        return find_spec("pyoidn") is not None
    except ValueError:  # a module that was kept from being imported has no specification
        return False


def denoise(image: NDArray[np.floating]) -> NDArray[np.floating]:
    """Denoises light and coverage, shape (height, width, 4); keeps where a pixel is covered all over, or not at all."""
    import pyoidn  # pyright: ignore[reportMissingImports]

    light = np.ascontiguousarray(image[:, :, :3], np.float32)
    coverage = np.ascontiguousarray(image[:, :, 3:].repeat(3, axis=2), np.float32)
    covered = pyoidn.denoise(coverage, hdr=False)[:, :, :1]
    certain = (image[:, :, 3:] == 0.0) | (image[:, :, 3:] == 1.0)
    return np.concatenate([pyoidn.denoise(light, hdr=True), np.where(certain, image[:, :, 3:], covered)], axis=2)
