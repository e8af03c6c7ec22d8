"""Pictures as painted values: stored as they are in their file, converted tile by tile where they are read."""

from __future__ import annotations

from functools import cached_property
from hashlib import blake2b

import numpy as np
from numpy.typing import NDArray
from PIL import Image

TILE = 512  # pixels
WHITE = {"1": 1.0, "L": 255.0, "I": 65535.0, "F": 1.0}  # by mode of Pillow


class Texture:
    """A picture as one channel, black 0 and white 1; colours by their luma, without gamma decoding.

    Memory is that of the picture: 1 or 2 bytes a pixel and channel, 4 of floating-point pictures, which keep their
    values.
    """

    def __init__(self, picture: Image.Image) -> None:
        self._picture = picture
        self._tile(0, 0)  # raises ValueError for a mode that has no luma

    @classmethod
    def from_values(cls, values: NDArray[np.floating]) -> Texture:
        """A texture of values, shape (rows, columns), the first row at v = 1."""
        return cls(Image.fromarray(np.asarray(values, np.float32)))

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self._picture.height, self._picture.width

    @property
    def colored(self) -> bool:
        """Whether it has colors, as directions have."""
        return self._picture.mode in ("RGB", "RGBA")

    def directions_at(self, rows: NDArray[np.integer], columns: NDArray[np.integer]) -> NDArray[np.float64]:
        """Directions of pixels of a colored picture, shape (…, 3): 128 of each channel is 0, 1 and 255 are -1 and 1.

        Beyond its edges the picture repeats.
        """
        channels = self._picture.split()[:3]
        one = [Texture(channel).at(rows, columns) for channel in channels]
        return (255.0 * np.stack(one, axis=-1) - 128.0) / 127.0

    def at(self, rows: NDArray[np.integer], columns: NDArray[np.integer]) -> NDArray[np.float64]:
        """Values of pixels, of the shape of ``rows``; beyond its edges the picture repeats."""
        rows, columns = rows % self.shape[0], columns % self.shape[1]
        values = np.empty(rows.shape)
        across = -(-self.shape[1] // TILE)
        tile_of = (rows // TILE * across + columns // TILE).ravel()
        order = np.argsort(tile_of, kind="stable")
        tiles, begins = np.unique(tile_of[order], return_index=True)
        for number, chosen in zip(tiles, np.split(order, begins[1:]), strict=True):
            row, column = divmod(int(number), across)
            tile = self._tile(row, column)
            values.flat[chosen] = tile[rows.flat[chosen] - row * TILE, columns.flat[chosen] - column * TILE]
        return values

    @cached_property
    def digest(self) -> bytes:
        """A digest of mode, size and pixels."""
        found = blake2b(repr((self._picture.mode, self.shape)).encode(), digest_size=16)
        for row in range(-(-self.shape[0] // TILE)):
            for column in range(-(-self.shape[1] // TILE)):
                found.update(self._crop(row, column).tobytes())
        return found.digest()

    def _tile(self, row: int, column: int) -> NDArray[np.float64]:
        """Values of one tile."""
        part = self._crop(row, column)
        mode = "I" if part.mode.startswith("I;16") else part.mode
        if mode not in WHITE:
            part, mode = part.convert("L"), "L"
        return np.asarray(part, np.float64) / WHITE[mode]

    def _crop(self, row: int, column: int) -> Image.Image:
        left, top = column * TILE, row * TILE
        return self._picture.crop((left, top, min(left + TILE, self.shape[1]), min(top + TILE, self.shape[0])))
