"""Messages as bytes.

``u4`` length of the header · header, a JSON object, filled with spaces to a multiple of 8 · the arrays, in the order of
the header's ``arrays`` (name, type, length), each filled with zeros to a multiple of 8. All little-endian.
"""

from __future__ import annotations

import json
import math
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from ringlet.data.errors import UserError
from ringlet.viewer.protocol import FROM_PAGE, FromPage, Message, Trouble

MOST = 1_000_000  # bytes of a message from a page


def pack(message: Message, **arrays: NDArray) -> bytes:
    """A message with the arrays that its class names."""
    if set(arrays) != set(message.arrays):
        raise ValueError(f"{message.__class__.__name__}: arrays {sorted(arrays)}; must be {sorted(message.arrays)}")
    header = message.model_dump(mode="json")
    told: list[tuple[str, str, int]] = []
    blocks: list[bytes] = []
    for name, kind in message.arrays.items():
        block = np.ascontiguousarray(arrays[name], np.dtype(kind).newbyteorder("<"))
        told.append((name, kind, block.size))
        blocks += [block.tobytes(), b"\0" * (-block.nbytes % 8)]
    text = json.dumps(
        {**_plain(header), "arrays": told}, separators=(",", ":"), ensure_ascii=False, allow_nan=False
    ).encode()
    text += b" " * ((-len(text) - 4) % 8)
    return b"".join([struct.pack("<I", len(text)), text, *blocks])


def unpack(data: bytes) -> FromPage:
    """What a page said: a header without arrays. Raises UserError for anything else."""
    if len(data) > MOST:
        raise UserError(f"message: has {len(data)} bytes; must be at most {MOST}")
    if len(data) < 4 or len(data) != 4 + struct.unpack_from("<I", data)[0]:
        raise UserError("message: its length is not what it says; send it again")
    try:
        return FROM_PAGE.validate_json(data[4:])
    except ValidationError as error:
        first = error.errors(include_url=False, include_context=False, include_input=False)[0]
        where = ".".join(str(part) for part in first["loc"]) or "message"
        raise UserError(f"message: {where}: {first['msg'].lower()}"[:400]) from None


def trouble(message: str) -> bytes:
    """What a page is sent of something that cannot be."""
    return pack(Trouble(message=" ".join(message.split())))


def _plain(value: Any) -> Any:
    """The same with null for numbers that JSON does not have."""
    if isinstance(value, dict):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
