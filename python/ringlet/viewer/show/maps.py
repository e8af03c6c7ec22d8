"""Painted maps as pictures."""

from __future__ import annotations

import io
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ringlet.data.errors import UserError
from ringlet.data.texture import Texture

Values = NDArray[np.floating]


def picture_of(values: Values) -> bytes:
    """A map as a PNG picture of 8 bits: black 0, white 1; directions in colours, as ``Texture.directions_at`` reads."""
    data = io.BytesIO()
    levels = 128.0 + 127.0 * np.clip(values, -1.0, 1.0) if values.ndim == 3 else 255.0 * np.clip(values, 0.0, 1.0)
    Image.fromarray(np.rint(levels).astype(np.uint8)).save(data, "PNG")
    return data.getvalue()


def values_of(picture: bytes, *, directions: bool = False) -> Values:
    """Values of a picture, shape (rows, columns), or directions, shape (rows, columns, 3).

    Raises UserError for directions in a picture without colors.
    """
    texture = texture_of(picture)
    if directions and not texture.colored:
        raise UserError("paint: the map of directions has no colours; name another one, or none for a new one")
    return (texture.directions_at if directions else texture.at)(*np.indices(texture.shape)).astype(np.float32)


@lru_cache(maxsize=16)
def texture_of(picture: bytes) -> Texture:
    """A picture as a texture."""
    return Texture(Image.open(io.BytesIO(picture)))
