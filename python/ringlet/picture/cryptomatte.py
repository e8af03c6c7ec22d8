"""Cryptomatte: ids of what is seen in each pixel, with the part of the pixel that each covers, for mattes in comp.

Friedman and Jones, Cryptomatte specification 1.2.0: https://github.com/Psyop/Cryptomatte
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

RANKS = 6  # ids of a pixel, those that cover most first: three layers of two
NOTHING = -1


@dataclass(frozen=True)
class Matte:
    """The ids of one kind of thing.

    name:     of the kind, such as ``CryptoLock``
    names:    of the things
    rank:     things of each pixel, those that cover most first, rows of ``names`` or -1, shape (height, width, RANKS)
    coverage: the part of the pixel that each covers, shape (height, width, RANKS)
    """

    name: str
    names: Sequence[str]
    rank: NDArray[np.int32]
    coverage: NDArray[np.float32]

    def channels(self) -> dict[str, NDArray[np.float32]]:
        """Channels of an EXR by name: ids, whose bits are those of a hash, and coverages by turns."""
        ids = np.array([*map(float_id, self.names), 0.0], np.float32)[self.rank]  # the last one is nothing
        made = dict[str, NDArray[np.float32]]()
        for rank in range(RANKS):
            pair = "RG" if rank % 2 == 0 else "BA"
            for channel, values in zip(pair, (ids, self.coverage), strict=True):
                made[f"{self.name}{rank // 2:02d}.{channel}"] = values[:, :, rank]
        return made

    def metadata(self) -> dict[str, str]:
        """Attributes of the header of an EXR, the names of all ids among them."""
        key = f"cryptomatte/{murmur3(self.name):08x}"[: len("cryptomatte/") + 7]
        manifest = {name: f"{int(float_id(name).view(np.uint32)):08x}" for name in self.names}
        return {
            f"{key}/name": self.name,
            f"{key}/hash": "MurmurHash3_32",
            f"{key}/conversion": "uint32_to_float32",
            f"{key}/manifest": json.dumps(manifest, separators=(",", ":")),
        }


def matte(name: str, names: Sequence[str], seen: NDArray[np.int32]) -> Matte:
    """Ranks what rays see.

    seen: the thing that each ray of each pixel hits, row of ``names`` or -1, shape (rays, height, width)
    """
    rank = np.full((*seen.shape[1:], RANKS), NOTHING, np.int32)
    coverage = np.zeros(rank.shape, np.float32)
    for row in range(seen.shape[1]):  # all pairs of rays of a whole picture would need much memory
        hits = seen[:, row]
        votes = (hits[:, None] == hits[None, :]).sum(axis=1) * (hits != NOTHING)
        for k in range(RANKS):
            most = votes.argmax(axis=0)[None]
            thing, count = np.take_along_axis(hits, most, 0)[0], np.take_along_axis(votes, most, 0)[0]
            rank[row, :, k], coverage[row, :, k] = np.where(count, thing, NOTHING), count / len(seen)
            votes = votes * (hits != thing)
    return Matte(name, names, rank, coverage)


def float_id(name: str) -> np.float32:
    """The id of a name: its hash as the bits of a float that is neither infinite, subnormal nor NaN."""
    bits = murmur3(name)
    if bits >> 23 & 255 in (0, 255):
        bits ^= 1 << 23
    return np.uint32(bits).view(np.float32)


def murmur3(text: str) -> int:
    """MurmurHash3_x86_32 of a text in UTF-8, with the seed 0 (Appleby 2011)."""
    data, hashed = text.encode(), 0
    for start in range(0, len(data), 4):
        block = data[start : start + 4]
        k = int.from_bytes(block, "little") * 0xCC9E2D51 & 0xFFFFFFFF
        k = (k << 15 | k >> 17) & 0xFFFFFFFF
        hashed ^= k * 0x1B873593 & 0xFFFFFFFF
        if len(block) == 4:
            hashed = (hashed << 13 | hashed >> 19) & 0xFFFFFFFF
            hashed = (hashed * 5 + 0xE6546B64) & 0xFFFFFFFF
    hashed ^= len(data)
    hashed ^= hashed >> 16
    hashed = hashed * 0x85EBCA6B & 0xFFFFFFFF
    hashed ^= hashed >> 13
    hashed = hashed * 0xC2B2AE35 & 0xFFFFFFFF
    return hashed ^ hashed >> 16
