"""Images of Blender as maps: their files, and digests of what is painted in them."""

from __future__ import annotations

import time
from dataclasses import dataclass
from hashlib import blake2b
from pathlib import Path

import bpy
import numpy as np

from .refused import Refused, need_blender

REST = 10.0  # the pixels of an image are read again after so many times as long as it took


@dataclass
class _Painted:
    """Pixels of an image as they were read last: a digest, and the time after which they are read again [s]."""

    digest: str
    until: float


_painted: dict[int, _Painted] = {}


def file_of(image: bpy.types.Image, folder: Path, name: str) -> str:
    """The file of an image. What is painted, generated or packed is written to the folder, under a name of its own.

    Raises Refused for an image without pixels, or with tiles.
    """
    if (path := _on_disk(image)) is not None:
        return str(path)
    need_blender((4, 4), f"{image.name}: is painted, and cannot be written as a copy")
    place = folder / f"{name}.png"
    place.parent.mkdir(parents=True, exist_ok=True)
    own = image.file_format
    try:
        image.file_format = "PNG"
        image.save(filepath=str(place), save_copy=True)
    except RuntimeError:
        raise Refused(f"{image.name}: cannot be written to {place}; choose a folder that can be") from None
    finally:
        image.file_format = own
    return place.name


def stamp(image: bpy.types.Image) -> str:
    """Changes when an image changes: its file on the disk, or what is painted. Raises Refused as ``file_of`` does."""
    if (path := _on_disk(image)) is not None:
        return f"{path} {path.stat().st_mtime_ns}"
    found, now = _painted.get(image.session_uid), time.monotonic()
    if found is None or now >= found.until:
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        digest = blake2b(pixels.data, digest_size=16).hexdigest()
        end = time.monotonic()
        found = _painted[image.session_uid] = _Painted(digest, end + REST * (end - now))
    return found.digest


def forget() -> None:
    """Forgets what was read."""
    _painted.clear()


def _on_disk(image: bpy.types.Image) -> Path | None:
    """The file of an image whose pixels are those of the file."""
    if image.source == "TILED":
        raise Refused(f"{image.name}: has tiles; choose an image without")
    path = Path(bpy.path.abspath(image.filepath)) if image.filepath else None
    if path is not None and path.is_file() and not image.is_dirty and image.packed_file is None:
        return path
    if not image.has_data and image.packed_file is None:
        raise Refused(f"{image.name}: has no pixels; load or paint it, or take it out of the panel")
    return None
