"""Reads maps from image files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from ringlet.data.errors import UserError

WHITE = {"1": 1.0, "L": 255.0, "I;16": 65535.0, "I;16B": 65535.0, "I": 65535.0, "F": 1.0}


def read_texture(path: Path | str) -> NDArray[np.float64]:
    """Reads an image as one channel, black 0 and white 1, shape (rows, columns); colours by their luma.

    Values are those of the file, without gamma decoding. Floating-point images keep their values.

    Raises UserError for a file that is not a readable image.
    """
    path = Path(path)
    try:
        with Image.open(path) as picture:
            if picture.mode not in WHITE:
                picture = picture.convert("L")
            return np.asarray(picture, np.float64) / WHITE[picture.mode]
    except UnidentifiedImageError:
        raise UserError(f"{path}: is not a picture that can be read; save it as PNG or TIFF") from None
    except OSError as error:
        raise UserError(f"{path}: cannot be read ({error.strerror or error}); check the name") from None
