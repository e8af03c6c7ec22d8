"""Pictures of [maps]: bounded before they are decoded, held in the bytes of their file, read tile by tile."""

from __future__ import annotations

import struct
import tracemalloc
import warnings
import zlib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from ringlet.data.texture import TILE, Texture

import ringlet
from ringlet import io


def png(path: Path, columns: int, rows: int, bits: int = 1, data: bytes = b"") -> Path:
    """A PNG in grey of any size; without data it has a header alone."""

    def chunk(kind: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    header = struct.pack(">IIBBBBB", columns, rows, bits, 0, 0, 0, 0)
    body = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b"")
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + body)
    return path


@pytest.mark.parametrize("size", [(20_000, 20_000), (2**31 - 1, 1), (16_385, 16_384), (2**20, 2**20)])
def test_a_picture_of_too_many_pixels_is_refused_by_its_header(tmp_path, size):
    with pytest.raises(ringlet.UserError, match=r"a.png: has .* × .* pixels; must be at most 268,435,456"):
        io.read_texture(png(tmp_path / "a.png", *size))


def test_a_large_picture_is_read_without_a_warning_in_its_own_bytes(tmp_path):
    columns, rows = 10_000, 9_000  # more than the number of pixels that Pillow warns of
    file = png(tmp_path / "a.png", columns, rows, data=(b"\0" + b"\xff" * (columns // 8)) * rows)
    tracemalloc.start()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            texture = io.read_texture(file)
        assert texture.at(np.array([0, rows - 1, -1]), np.array([0, columns - 1, columns])).tolist() == [1.0] * 3
        assert len(texture.digest) == 16
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert texture.shape == (rows, columns)
    assert most < 16 * TILE**2  # beside the picture of Pillow, no more than a tile of values


@pytest.mark.parametrize("mode", ["1", "L", "P", "RGB", "RGBA", "CMYK", "I;16", "F"])
def test_pixels_are_those_of_the_whole_picture_whatever_its_tiles(tmp_path, mode):
    values = np.random.default_rng(1).random((7, 2 * TILE + 3))
    source = {
        "I;16": lambda: Image.fromarray(np.uint16(65535 * values)),
        "F": lambda: Image.fromarray(np.float32(values)),
    }.get(mode, lambda: Image.fromarray(np.uint8(255 * values)).convert(mode))()
    source.save(tmp_path / "a.tif")
    texture = io.read_texture(tmp_path / "a.tif")
    white = {"I;16": 65535.0, "F": 1.0, "1": 1.0}
    whole = np.asarray(source if mode in ("L", *white) else source.convert("L"), np.float64) / white.get(mode, 255.0)
    assert texture.shape == whole.shape
    np.testing.assert_allclose(texture.at(*np.indices(whole.shape)), whole)


def test_pictures_that_differ_have_different_digests():
    values = np.zeros((TILE + 2, 3))
    other = values.copy()
    other[-1, -1] = 1.0
    assert Texture.from_values(values).digest == Texture.from_values(values.copy()).digest
    assert len({Texture.from_values(v).digest for v in (values, other, values.T)}) == 3


def test_a_damaged_picture_is_refused_in_one_line(tmp_path):
    Image.fromarray(np.random.default_rng(1).integers(0, 255, (64, 64), np.uint8)).save(tmp_path / "a.png")
    data = bytearray((tmp_path / "a.png").read_bytes())
    for cut in (20, 40, 60, len(data) // 2):
        (tmp_path / "a.png").write_bytes(data[:cut])
        with pytest.raises(ringlet.UserError, match=r"^[^\n]*a.png: (is not a picture|cannot be read)[^\n]*$"):
            io.read_texture(tmp_path / "a.png")
