"""Threads of the core."""

from __future__ import annotations

from ringlet import _core
from ringlet.data import limits


def use_threads(count: int) -> None:
    """Limits the core to so many threads; raises UserError for a count that no machine has."""
    limits.check_count("threads", count, limits.THREADS)
    _core.set_thread_count(count)
