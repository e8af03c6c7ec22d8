"""The callbacks of long work."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Progress = Callable[[str, int, int], None]
OnFrame = Callable[[float, dict[str, Any]], None]


@contextmanager
def stage(progress: Progress | None, name: str) -> Iterator[None]:
    """Reports a stage of one step: before it, and after it."""
    if progress:
        progress(name, 0, 1)
    yield
    if progress:
        progress(name, 1, 1)
