"""Reads maps from image files."""

from __future__ import annotations

from pathlib import Path

from PIL import Image, UnidentifiedImageError

from ringlet.data.errors import UserError
from ringlet.data.reads import record
from ringlet.data.regular import open_regular
from ringlet.data.texture import Texture

MOST_PIXELS = 16_384**2
FORMATS = ("PNG", "TIFF", "JPEG", "WEBP", "BMP", "TGA", "PPM")

Image.MAX_IMAGE_PIXELS = None  # the bound here is stated in the message, Pillow's warns on the screen


def read_texture(path: Path | str) -> Texture:
    """Reads an image as one channel; see ``Texture``.

    Raises UserError for a file that is not a readable image, or has more pixels than ``MOST_PIXELS``.
    """
    record(path)
    with open_regular(path) as file:
        try:
            with Image.open(file, formats=FORMATS) as picture:
                columns, rows = picture.size
                if columns * rows > MOST_PIXELS:
                    raise UserError(
                        f"{path}: has {columns} × {rows} pixels; must be at most {MOST_PIXELS:,}, which are 16 384 × "
                        "16 384: save it smaller"
                    )
                picture.load()
                return Texture(picture)
        except UserError:
            raise
        except UnidentifiedImageError:
            raise UserError(f"{path}: is not a picture that can be read; save it as PNG or TIFF") from None
        except Exception as error:  # a decoder of a damaged file raises what it likes
            reason = " ".join(str(error).split())[:120] or type(error).__name__
            raise UserError(f"{path}: cannot be read as a picture ({reason}); save it again") from None
