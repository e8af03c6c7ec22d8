"""Schemas of the files that people write."""

from __future__ import annotations

from typing import Any

from ringlet import groom as grooms
from ringlet import shot as shots


def schema() -> dict[str, Any]:
    """JSON schemas of what people write: ``recipe`` and ``shot``."""
    return {"recipe": grooms.schema(), "shot": shots.schema()}
