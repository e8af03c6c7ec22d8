"""Denoising by Intel Open Image Denoise (``pyoidn``, an optional package), guided by albedo and normals."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
from numpy.typing import NDArray

from ringlet.picture.layers import Layers


def available() -> bool:
    """Whether ``pyoidn`` is installed."""
    try:
        return find_spec("pyoidn") is not None
    except ValueError:  # a module that was kept from being imported has no specification
        return False


def denoise(image: NDArray[np.floating], layers: Layers) -> NDArray[np.float32]:
    """Denoises light of shape (height, width, 4); keeps the coverage."""
    import pyoidn  # pyright: ignore[reportMissingImports]

    light = np.ascontiguousarray(image[:, :, :3], np.float32)
    guides = [np.ascontiguousarray(guide, np.float32) for guide in (np.clip(layers.albedo, 0.0, 1.0), layers.normal)]
    return np.concatenate([pyoidn.denoise(light, *guides, hdr=True), image[:, :, 3:]], axis=2).astype(np.float32)
