"""OpenEXR files: linear light with coverage, and further layers."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.files import replacing
from ringlet.picture.layers import Layers
from ringlet.picture.ocio import scene_linear


def write_exr(
    mi: Any,
    path: Path | str,
    image: NDArray[np.float32],
    layers: Layers,
    lights: Mapping[str, NDArray[np.float32]] | None = None,
) -> None:
    """Writes light multiplied by coverage, coverage, and the layers, as 32-bit floats.

    image:  light and coverage, shape (height, width, 4)
    lights: light of each lamp by its name, shape (height, width, 3)
    """
    light = np.concatenate([scene_linear(image[:, :, :3]), image[:, :, 3:]], axis=2)
    channels = dict(zip("RGBA", np.moveaxis(light, 2, 0), strict=True)) | {"Z": layers.depth}
    channels |= _named("N", "XYZ", layers.normal) | _named("albedo", "RGB", scene_linear(layers.albedo))
    channels["lock"] = layers.lock
    if layers.motion is not None:
        channels |= _named("forward", "uv", layers.motion)
    for name, of_one in (lights or {}).items():
        channels |= _named(name, "RGB", scene_linear(of_one))
    for matte in layers.mattes:
        channels |= matte.channels()
    pixels = np.stack([np.asarray(values, np.float32) for values in channels.values()], axis=2)
    bitmap = mi.Bitmap(pixels, mi.Bitmap.PixelFormat.MultiChannel, list(channels))
    header = bitmap.metadata()
    for matte in layers.mattes:
        for name, text in matte.metadata().items():
            header[name] = text
    with replacing(path) as aside:
        bitmap.write(str(aside))


def _named(layer: str, parts: str, values: NDArray) -> dict[str, NDArray]:
    """Channels ``layer.part`` of an array, shape (height, width, parts)."""
    return {f"{layer}.{part}": values[:, :, k] for k, part in enumerate(parts)}
