"""OpenEXR files: linear light with coverage, and further layers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.files import replacing
from ringlet.picture.layers import Layers

CHANNELS = ("R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "albedo.R", "albedo.G", "albedo.B", "lock")


def write_exr(mi: Any, path: Path | str, image: NDArray[np.float32], layers: Layers) -> None:
    """Writes light multiplied by coverage, coverage, and the layers, as 32-bit floats.

    image: light and coverage, shape (height, width, 4)
    """
    stacked = [image, layers.depth[:, :, None], layers.normal, layers.albedo, layers.lock[:, :, None]]
    pixels = np.concatenate(stacked, axis=2).astype(np.float32)
    bitmap = mi.Bitmap(pixels, mi.Bitmap.PixelFormat.MultiChannel, list(CHANNELS))
    with replacing(path) as aside:
        bitmap.write(str(aside))
