"""Threads of the core."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from ringlet import _core
from ringlet.data import limits


def use_threads(count: int) -> None:
    """Limits the core to so many threads; raises UserError for a count that no machine has."""
    limits.check_count("threads", count, limits.THREADS)
    _core.set_thread_count(count)


@contextmanager
def threads(count: int) -> Iterator[None]:
    """In the block the core uses so many threads."""
    before = _core.thread_count()
    use_threads(count)
    try:
        yield
    finally:
        _core.set_thread_count(before)
