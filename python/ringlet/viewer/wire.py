"""Messages as bytes, little-endian.

- ``u4``: length of the header
- header: a JSON object, padded with spaces to a multiple of 8 bytes
- arrays: in the order of the header's ``arrays`` (name, type, length), each padded with zeros to a multiple of 8 bytes
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from ringlet.data.errors import UserError
from ringlet.data.explain import explain
from ringlet.data.settings import check_texts
from ringlet.viewer.protocol import FROM_PAGE, FromPage, Message, Trouble

MOST = 8_000_000  # largest size of a message from a page [bytes]


def pack(message: Message, **arrays: NDArray) -> bytes:
    """Encodes a message with the arrays of its class; raises ValueError for other arrays."""
    if set(arrays) != set(message.arrays):
        raise ValueError(f"{message.__class__.__name__}: arrays {sorted(arrays)}; must be {sorted(message.arrays)}")
    typed = {name: np.asarray(arrays[name], np.dtype(kind).newbyteorder("<")) for name, kind in message.arrays.items()}
    return join(message.model_dump(mode="json"), typed)


def join(header: dict[str, Any], arrays: Mapping[str, NDArray]) -> bytes:
    """Encodes a message from its header and its little-endian arrays."""
    entries: list[tuple[str, str, int]] = []
    blocks: list[bytes] = []
    for name, values in arrays.items():
        block = np.ascontiguousarray(values)
        entries.append((name, f"{block.dtype.kind}{block.dtype.itemsize}", block.size))
        blocks += [block.tobytes(), b"\0" * (-block.nbytes % 8)]
    try:
        text = _json({**header, "arrays": entries})
    except ValueError:  # a value is not finite, which is rare and takes as long as the rest to look for
        text = _json({**_finite(header), "arrays": entries})
    text += b" " * ((-len(text) - 4) % 8)
    return b"".join([struct.pack("<I", len(text)), text, *blocks])


def split(data: bytes) -> tuple[dict[str, Any], dict[str, NDArray]]:
    """Header and arrays of an encoded message."""
    length = struct.unpack_from("<I", data)[0]
    header = json.loads(data[4 : 4 + length])
    at, arrays = 4 + length, dict[str, NDArray]()
    for name, kind, size in header.pop("arrays"):
        arrays[name] = np.frombuffer(data, np.dtype(kind).newbyteorder("<"), size, at)
        at += -(-arrays[name].nbytes // 8) * 8
    return header, arrays


def unpack(data: bytes) -> FromPage:
    """Decodes a message of a page, a header without arrays; raises UserError for anything else."""
    if len(data) > MOST:
        raise UserError(f"message: has {len(data)} bytes; must be at most {MOST}")
    if len(data) < 4 or len(data) != 4 + struct.unpack_from("<I", data)[0]:
        raise UserError("message: its length is not the one it states; send it again")
    try:
        message = FROM_PAGE.validate_json(data[4:], strict=True)
    except ValidationError as error:
        raise explain(error, "message", _parsed(data[4:])) from None
    check_texts(_parsed(data[4:]), "message")
    return message


def _parsed(text: bytes) -> Any:
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return {}


def trouble(message: str) -> bytes:
    """Encodes an error message."""
    return pack(Trouble(message=" ".join(message.split())))


def _json(header: dict[str, Any]) -> bytes:
    return json.dumps(header, separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode()


def _finite(value: Any) -> Any:
    """Replaces infinities and NaN, which JSON lacks, by None."""
    if isinstance(value, dict):
        return {str(key): _finite(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
