"""The callbacks of long work."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Progress = Callable[[str, int, int], None]
OnFrame = Callable[[float, dict[str, Any]], None]
