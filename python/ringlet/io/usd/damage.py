"""Finds damage in USD files before OpenUSD composes them: it aborts, or takes all memory, on some damaged crates.

A crate (``.usdc``) ends in a table of contents. Each of its sections, and most values of its fields, begin with a
count, for which OpenUSD reserves memory. Layout: https://github.com/PixarAnimationStudios/OpenUSD,
``pxr/usd/sdf/crateFile.h``.
"""

from __future__ import annotations

import os
import struct
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

from pxr import Sdf, Tf

from ringlet.data.errors import UserError
from ringlet.data.regular import check_regular, open_regular
from ringlet.io.usd.crate_values import PACKED, Values, unpacked

REMEDY = "give a USD file"
MAGIC, VERSION = b"PXR-USDC", 8  # begin a crate, before the place of its table of contents; bytes of the version
NUMBERS, PLACE, COUNT = struct.Struct("<3B"), struct.Struct("<q"), struct.Struct("<Q")
SECTION = struct.Struct("<16sqq")  # name, place and size
MOST_SECTIONS = 64
COUNTS = {b"TOKENS": 1, b"STRINGS": 1, b"FIELDS": 1, b"FIELDSETS": 1, b"PATHS": 2, b"SPECS": 1}  # that begin a section

Read = Callable[[struct.Struct, int], tuple[Any, ...]]


def check_bytes(path: Path | str) -> None:
    """Raises UserError for a file that is not regular, and for a crate whose sections or counts exceed the file.

    The cost is that of a read for each array. Crates in packages are checked too; a missing file passes: its reader
    reports it.
    """
    check_regular(path, REMEDY)
    if not Path(path).is_file():
        return
    with open_regular(path, REMEDY, most=None) as file:
        _check_crate(file, path)
        if Path(path).suffix.lower() == ".usdz":
            _check_package(file, path)


def _check_package(file: IO[bytes], path: Path | str) -> None:
    try:
        package = zipfile.ZipFile(file)
        for member in package.infolist():
            with package.open(member) as inner:
                _check_crate(inner, f"{path}[{member.filename}]")
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError, zlib.error) as error:
        raise _damaged(path, str(error)) from None


def _check_crate(file: IO[bytes], where: Path | str) -> None:
    """Raises UserError for a crate with sections outside the file, or with counts of more entries than it can hold."""
    if file.read(len(MAGIC)) != MAGIC:
        return
    size = file.seek(0, os.SEEK_END)

    def read(layout: struct.Struct, place: int) -> tuple[Any, ...]:
        if not 0 <= place <= size - layout.size:
            raise _damaged(where, f"byte {place} is not among its {size}")
        file.seek(place)
        return layout.unpack(file.read(layout.size))

    def refuse(count: int, length: int) -> None:
        raise _damaged(where, f"{count} entries are not in {length} bytes")

    version = tuple(read(NUMBERS, len(MAGIC)))
    (contents,) = read(PLACE, len(MAGIC) + VERSION)
    (sections,) = read(COUNT, contents)
    if sections > MOST_SECTIONS:
        raise _damaged(where, f"it has {sections} sections")
    for row in range(sections):
        name, start, length = read(SECTION, contents + COUNT.size + row * SECTION.size)
        if not (0 <= start <= size and 0 <= length <= size - start):
            raise _damaged(where, f"a section of {length} bytes at {start} is not among its {size}")
        for k in range(COUNTS.get(name.rstrip(b"\0"), 0)):
            (count,) = read(COUNT, start + k * COUNT.size)
            if count > PACKED * length:
                refuse(count, length)
        if name.rstrip(b"\0") == b"FIELDS":
            try:
                Values(read, size, version, refuse).check(_field_values(read, start, length, version))
            except ValueError as error:
                raise _damaged(where, str(error)) from None


def _field_values(read: Read, start: int, length: int, version: tuple[int, ...]) -> list[int]:
    """The words of the values of all fields: packed behind the packed names of the fields.

    Raises ValueError where there are not as many as fields.
    """
    (count,) = read(COUNT, start)
    if version < (0, 4, 0):
        return [read(COUNT, start + COUNT.size + 16 * k + 8)[0] for k in range(count)]
    names = start + COUNT.size
    values = names + COUNT.size + read(COUNT, names)[0]
    packed = read(struct.Struct(f"{min(read(COUNT, values)[0], length)}s"), values + COUNT.size)[0]
    words = unpacked(packed, COUNT.size * count)
    if len(words) != COUNT.size * count:
        raise ValueError(f"{count} fields have {len(words)} bytes of values")
    return list(struct.unpack(f"<{count}Q", words))


def sound_prims(layer: Sdf.Layer, where: Path | str) -> list[Sdf.PrimSpec]:
    """All prims of a layer; raises UserError where a child is named without a spec of its own.

    OpenUSD aborts when it composes such a layer.
    """
    paths, found = list[Sdf.Path](), list[Sdf.PrimSpec]()
    try:
        layer.Traverse(Sdf.Path.absoluteRootPath, paths.append)  # pyright: ignore[reportArgumentType]
        for path in paths:
            if path.IsPrimPath() or path.IsPrimVariantSelectionPath() or path.isEmpty:
                spec = layer.GetObjectAtPath(path)
                if isinstance(spec, Sdf.PrimSpec):
                    found.append(spec)
                elif not spec or path.IsPrimPath():
                    raise _damaged(where, f"its prim {path} is not there")
    except Tf.ErrorException:
        raise _damaged(where, "a spec in it has no valid type") from None
    return found


def _damaged(where: Path | str, what: str) -> UserError:
    return UserError(f"{where}: cannot be read as USD (damaged: {what}); write it again or choose another")
