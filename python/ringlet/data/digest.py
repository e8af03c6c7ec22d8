"""A digest of arrays and plain values."""

from __future__ import annotations

import hashlib
import json
from typing import Any

import numpy as np


def digest(*parts: Any) -> str:
    """A digest of arrays and of plain values."""
    found = hashlib.sha256()
    for part in parts:
        array = isinstance(part, np.ndarray)
        found.update(np.ascontiguousarray(part).tobytes() if array else json.dumps(part, sort_keys=True).encode())
    return found.hexdigest()
