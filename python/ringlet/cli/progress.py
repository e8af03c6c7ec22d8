"""Progress on the error stream: bars with rate and time left on a terminal, a plain line now and then elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TextColumn,
)
from rich.text import Text

SECONDS_BETWEEN_LINES = 5.0


class Rate(ProgressColumn):
    """Steps per second, or seconds per step."""

    def render(self, task: Task) -> Text:
        """The speed of a task, empty while it is unknown."""
        speed = task.finished_speed or task.speed
        if not speed or task.total is None or task.total < 2:
            return Text("")
        return Text(
            f"{speed:,.0f}/s" if speed >= 10 else f"{speed:.1f}/s" if speed >= 1 else f"{1 / speed:.1f} s each", "dim"
        )


class Clock(ProgressColumn):
    """Remaining time of a stage, and its duration once it ends."""

    def render(self, task: Task) -> Text:
        """Seconds left, or the seconds that it took."""
        if task.finished:
            return Text(f"{task.finished_time:.1f} s", "cyan")
        left = task.time_remaining
        return Text("" if left is None else f"{left:.0f} s left", "cyan")


@contextmanager
def shown_progress() -> Iterator[Callable[[str, int, int], None]]:
    """Yields ``progress(stage, done, total)``, which draws a bar for every stage that it hears of."""
    with on_terminal() if sys.stderr.isatty() else in_lines() as report:
        yield report


@contextmanager
def on_terminal() -> Iterator[Callable[[str, int, int], None]]:
    """One bar below the other."""
    columns = (
        TextColumn("{task.description:<22}"),
        BarColumn(bar_width=32),
        MofNCompleteColumn(),
        Rate(),
        Clock(),
    )
    with Progress(*columns, console=Console(stderr=True)) as bars:
        tasks = {}

        def report(stage: str, done: int, total: int) -> None:
            if stage not in tasks:
                tasks[stage] = bars.add_task(stage, total=total)
            bars.update(tasks[stage], completed=done, total=total)

        yield report


@contextmanager
def in_lines() -> Iterator[Callable[[str, int, int], None]]:
    """A line when a stage ends, and every few seconds while it runs."""
    began: dict[str, float] = {}
    printed: dict[str, float] = {}
    ended: set[str] = set()

    def report(stage: str, done: int, total: int) -> None:
        now = time.monotonic()
        start = began.setdefault(stage, now)
        since = now - printed.setdefault(stage, now)
        if stage in ended or (done < total and since < SECONDS_BETWEEN_LINES):
            return
        printed[stage] = now
        if done >= total:
            ended.add(stage)
        left = f", {(now - start) / done * (total - done):.0f} s left" if 0 < done < total else ""
        print(f"{stage}: {done}/{total}, {now - start:.1f} s{left}", file=sys.stderr, flush=True)

    yield report
