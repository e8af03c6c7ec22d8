"""Kills a process at each of its calls of the system that change files."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator

CHANGES = ("open", "os.chmod", "os.chown", "os.mkdir", "os.remove", "os.rename", "os.rmdir")


def kills(do: Callable[[], object]) -> Iterator[int]:
    """Does it in processes that are killed at their first such call, at their second, and so on.

    Yields after each, until one lives to its end.
    """
    calls = 0
    while _is_killed(calls, do):
        yield calls
        calls += 1


def _is_killed(after: int, do: Callable[[], object]) -> bool:
    """Whether a process is killed at the call after so many."""
    child = os.fork()
    if child:
        status = os.waitpid(child, 0)[1]
        assert status in (0, signal.SIGKILL), status
        return status == signal.SIGKILL
    left = after

    def count(event: str, _: object) -> None:
        nonlocal left
        if event in CHANGES:
            if left == 0:
                os.kill(os.getpid(), signal.SIGKILL)
            left -= 1

    sys.addaudithook(count)
    try:
        do()
        os._exit(0)
    finally:
        os._exit(1)
