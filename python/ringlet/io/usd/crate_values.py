"""The values of a crate that have a count: OpenUSD reserves memory for as many entries as a damaged count says.

A field's value is a word of 64 bits: flags, a type, and the place in the file where the value is. Layout:
https://github.com/PixarAnimationStudios/OpenUSD, ``pxr/usd/sdf/crateFile.cpp`` and ``crateDataTypes.h``.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any

ARRAY, INLINED, COMPRESSED = 1 << 63, 1 << 62, 1 << 61
PLACE = (1 << 48) - 1
WORD, SHORT, OFFSET = struct.Struct("<Q"), struct.Struct("<I"), struct.Struct("<q")
PACKED = 1024  # entries in a byte at most: four whole numbers, which LZ4 packs 255 times
# Bytes of an entry, by type: of arrays, and of vectors, which are no arrays to USD.
SIZES = dict(enumerate((1, 1, 4, 4, 8, 8, 2, 4, 8, 4, 4, 4, 32, 72, 128, 32, 16, 8, 16, 8, 4, 8, 24, 12, 6, 12), 1))
SIZES |= {27: 32, 28: 16, 29: 8, 30: 16, 56: 8}
TIME_SAMPLES, VECTORS = 46, {40: 4, 41: 4, 48: 8, 49: 16, 50: 4}
LISTS = {32: 4, 33: 4, 34: 4, 36: 4, 37: 8, 38: 4, 39: 8}  # of tokens, strings, paths and numbers
LISTS |= {35: 1, 54: 1, 55: 1}  # of entries of any size
LISTED = 0b1111110  # bits of the header of a list, each for a count and its entries


class Values:
    """Checks values of a crate.

    read:    the numbers of a layout at a place; raises UserError outside the file
    size:    bytes of the file
    version: major, minor and patch of its format
    refuse:  raises UserError for a count of entries and the bytes there are
    """

    def __init__(
        self,
        read: Callable[[struct.Struct, int], tuple[Any, ...]],
        size: int,
        version: tuple[int, ...],
        refuse: Callable[[int, int], None],
    ) -> None:
        self._read, self._size, self._version, self._refuse = read, size, version, refuse

    def check(self, words: list[int]) -> None:
        """Raises UserError where the file cannot hold as many entries as a value says it has."""
        waiting, seen = list(words), set[int]()
        while waiting:
            word = waiting.pop()
            place, kind = word & PLACE, word >> 48 & 0xFF
            if word & INLINED or not place or word in seen:
                continue
            seen.add(word)
            if word & ARRAY:
                self._array(place, SIZES.get(kind, 1), bool(word & COMPRESSED))
            elif kind in VECTORS:
                self._entries(WORD, place, VECTORS[kind])
            elif kind in LISTS:
                self._list(place, LISTS[kind])
            elif kind == TIME_SAMPLES:
                waiting += self._time_samples(place)

    def _entries(self, layout: struct.Struct, place: int, size: int, packed: int = 1) -> int:
        """The number of entries of a value, which follow their count."""
        (count,) = self._read(layout, place)
        left = self._size - place - layout.size
        if count * size > packed * left:
            self._refuse(count, left)
        return count

    def _array(self, place: int, size: int, compressed: bool) -> None:
        place += 4 * (self._version < (0, 5, 0))  # a rank, which is always one
        layout = SHORT if self._version < (0, 7, 0) else WORD
        self._entries(layout, place, 1 if compressed else size, PACKED if compressed else 1)

    def _list(self, place: int, size: int) -> None:
        header = self._read(struct.Struct("<B"), place)[0] & LISTED
        place += 1
        for _ in range(header.bit_count() if size > 1 else min(header.bit_count(), 1)):
            place += WORD.size + size * self._entries(WORD, place, size)

    def _time_samples(self, place: int) -> list[int]:
        """The words of the times and of the value at each; both come after what they refer to, at an offset."""
        times = place + self._read(OFFSET, place)[0]
        counted = times + WORD.size + self._read(OFFSET, times + WORD.size)[0]
        count = self._entries(WORD, counted, WORD.size)
        return [*self._read(WORD, times), *self._read(struct.Struct(f"<{count}Q"), counted + WORD.size)]


def unpacked(data: bytes, size: int) -> bytes:
    """Bytes that OpenUSD packed: blocks of LZ4, each but a single one behind its length.

    size: bytes of the result at most

    Raises ValueError where the data is damaged.
    """
    if not data or not data[0]:
        return _lz4(data[1:], size)
    made, place = b"", 1
    for _ in range(data[0]):
        length = int.from_bytes(data[place : place + 4], "little")
        made += _lz4(data[place + 4 : place + 4 + length], size - len(made))
        place += 4 + length
    return made


def _lz4(data: bytes, size: int) -> bytes:
    """A block of LZ4: literals, then a match in what is there already, and so on."""
    made, place = bytearray(), 0

    def longer() -> int:
        nonlocal place
        length, more = 15, 255
        while more == 255:
            more = data[place]
            place += 1
            length += more
        return length

    try:
        while place < len(data):
            token = data[place]
            place += 1
            literals = token >> 4
            if literals == 15:
                literals = longer()
            made += data[place : place + literals]
            place += literals
            if place >= len(data):
                break
            back = data[place] | data[place + 1] << 8
            place += 2
            count, start = token & 15, len(made) - back
            count = (longer() if count == 15 else count) + 4
            if back == 0 or start < 0 or len(made) + count > size:
                raise ValueError("a match is outside the block")
            made += (made[start:] * (count // back + 1))[:count] if count > back else made[start : start + count]
    except IndexError:
        raise ValueError("a block ends early") from None
    if len(made) > size:
        raise ValueError("a block is too long")
    return bytes(made)
