"""Tone mapping: a filmic response curve, sRGB encoding, and dithering against banding."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.picture import ocio


def develop(light: NDArray[np.floating], *, exposure: float = 1.0) -> NDArray[np.uint8]:
    """Tone-maps linear light (height, width, 3) to 8-bit sRGB of the same shape; highlights roll off.

    Where the environment names a configuration of OpenColorIO, its view does that.
    """
    exposed = np.maximum(np.asarray(light, np.float64) * exposure, 0.0)
    encoded = ocio.displayed(exposed) if ocio.configured() else _film(exposed)
    dither = np.random.default_rng(0).uniform(-0.5, 0.5, encoded.shape[:2])[:, :, None]
    return np.clip(np.rint(255.0 * encoded + dither), 0, 255).astype(np.uint8)


def _film(exposed: NDArray[np.float64]) -> NDArray[np.float64]:
    """Linear light as sRGB from 0 to 1, by a filmic curve."""
    # Reinhard's curve x (1 + x/w²)/(1 + x), which reaches white at w = 5. The mean of luminance and per-channel mapping
    # keeps some colour in highlights that bleach towards white.
    white = 5.0
    luminance = exposed @ np.array([0.2126, 0.7152, 0.0722])
    scale = ((1.0 + luminance / white**2) / (1.0 + luminance))[:, :, None]
    per_channel = exposed * (1.0 + exposed / white**2) / (1.0 + exposed)
    film = np.clip(0.5 * (exposed * scale + per_channel), 0.0, 1.0)
    encoded = np.where(film <= 0.0031308, 12.92 * film, 1.055 * film ** (1 / 2.4) - 0.055)
    # A gentle S-curve restores the contrast that the roll-off removes.
    return encoded + 0.4 * (encoded**2 * (3.0 - 2.0 * encoded) - encoded)
