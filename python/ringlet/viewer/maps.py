"""Painted maps as pictures."""

from __future__ import annotations

import io
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ringlet.data.texture import Texture

Values = NDArray[np.floating]


def picture_of(values: Values) -> bytes:
    """A map as a PNG picture of 8 bits; black 0, white 1."""
    data = io.BytesIO()
    Image.fromarray(np.rint(255.0 * np.clip(values, 0.0, 1.0)).astype(np.uint8)).save(data, "PNG")
    return data.getvalue()


def values_of(picture: bytes) -> Values:
    """Values of a picture, shape (rows, columns)."""
    texture = texture_of(picture)
    return texture.at(*np.indices(texture.shape)).astype(np.float32)


@lru_cache(maxsize=16)
def texture_of(picture: bytes) -> Texture:
    """A picture as a texture."""
    return Texture(Image.open(io.BytesIO(picture)))
