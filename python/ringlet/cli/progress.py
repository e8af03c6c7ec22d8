"""Progress on the error stream: bars with rate and time left on a terminal, a plain line now and then elsewhere.

With ``RINGLET_PROGRESS=openjd`` in the environment each line is followed by the percentage of its stage, as farms of
Open Job Description read it.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections import deque
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
LONG_STEP = 10.0  # seconds, after which a step is reported while it lasts


class Pace:
    """The time that a stage takes, from when its steps ended.

    Steps that were done at the first report belong to an earlier run, and those of the first half of the time may be of
    another kind, such as a pre-roll, so neither counts.
    """

    def __init__(self, began: float) -> None:
        self.began = began
        self._ended: deque[tuple[float, int]] = deque()  # when a step ended [s], and how many were done then

    def report(self, now: float, done: int) -> None:
        """Takes note of the number of steps that are done."""
        self._ended.append((now, done))
        while len(self._ended) > 2 and self._ended[1][0] <= 0.5 * (self.began + now):
            self._ended.popleft()

    @property
    def each(self) -> float | None:
        """Seconds of a step; None while they are unknown."""
        (first, before), (last, done) = self._ended[0], self._ended[-1]
        return (last - first) / (done - before) if done > before else None

    def left(self, now: float, total: int) -> str:
        """The remaining time in words, empty while it is unknown."""
        last, done = self._ended[-1]
        if self.each is None or done >= total:
            return ""
        seconds = max(self.each * (total - done) - (now - last), 0.0)
        return f"about {seconds:.0f} s left" if seconds < 100.0 else f"about {seconds / 60.0:.0f} min left"


class Rate(ProgressColumn):
    """Steps per second, or seconds per step."""

    def render(self, task: Task) -> Text:
        """The speed of a task, empty while it is unknown."""
        each = task.fields["pace"].each
        if not each or task.total is None or task.total < 2:
            return Text("")
        return Text(
            f"{1 / each:,.0f}/s" if each <= 0.1 else f"{1 / each:.1f}/s" if each <= 1 else f"{each:.1f} s each", "dim"
        )


class Clock(ProgressColumn):
    """Remaining time of a stage, and its duration once it ends."""

    def render(self, task: Task) -> Text:
        """Seconds left, or the seconds that it took."""
        if task.finished:
            return Text(f"{task.finished_time:.1f} s", "cyan")
        return Text(task.fields["pace"].left(time.monotonic(), int(task.total or 0)), "cyan")


class LongStep(ProgressColumn):
    """Time since the last step ended, where that is long."""

    def render(self, task: Task) -> Text:
        """Seconds of the step in progress, empty for a short one."""
        since = time.monotonic() - task.fields["since"]
        return Text("" if task.finished or since < LONG_STEP else f"{since:.0f} s on this one so far", "dim")


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
        LongStep(),
    )
    with Progress(*columns, console=Console(stderr=True)) as bars:
        tasks = {}
        paces: dict[str, Pace] = {}

        def report(stage: str, done: int, total: int) -> None:
            pace = paces.setdefault(stage, Pace(time.monotonic()))
            pace.report(time.monotonic(), done)
            if stage not in tasks:
                tasks[stage] = bars.add_task(stage, total=total, since=time.monotonic(), pace=pace)
            bars.update(tasks[stage], completed=done, total=total, since=time.monotonic())

        yield report


@contextmanager
def in_lines() -> Iterator[Callable[[str, int, int], None]]:
    """A line when a stage ends, and every few seconds while it or one of its steps lasts."""
    lines = Lines()
    ended = threading.Event()

    def watch() -> None:
        while not ended.wait(0.1 * LONG_STEP):
            lines.report_long_step()

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield lines.report
    finally:
        ended.set()
        watcher.join()


class Lines:
    """Progress in lines on the error stream."""

    def __init__(self) -> None:
        self._paces: dict[str, Pace] = {}
        self._printed: dict[str, float] = {}
        self._ended: set[str] = set()
        self._step: tuple[str, int, int, float] | None = None  # stage, steps done, their number, when the last ended
        self._lock = threading.Lock()

    def report(self, stage: str, done: int, total: int) -> None:
        """Prints a line if the stage ends, or if the last line is some seconds old."""
        with self._lock:
            now = time.monotonic()
            pace = self._paces.setdefault(stage, Pace(now))
            pace.report(now, done)
            since = now - self._printed.setdefault(stage, now)
            self._step = (stage, done, total, now) if done < total else None
            if stage in self._ended or (done < total and since < SECONDS_BETWEEN_LINES):
                return
            self._printed[stage] = now
            if done >= total:
                self._ended.add(stage)
            left = f", {words}" if (words := pace.left(now, total)) else ""
            print(f"{stage}: {done}/{total}, {now - pace.began:.1f} s{left}", file=sys.stderr, flush=True)
            if os.environ.get("RINGLET_PROGRESS") == "openjd":
                print(f"openjd_progress: {100.0 * done / max(total, 1):.1f}", file=sys.stderr, flush=True)

    def report_long_step(self) -> None:
        """Prints a line if the step in progress takes long, and the last line is as old."""
        with self._lock:
            if self._step is None:
                return
            (stage, done, total, ended), now = self._step, time.monotonic()
            if now - max(ended, self._printed[stage]) >= LONG_STEP:
                self._printed[stage] = now
                print(f"{stage}: {done}/{total}, {now - ended:.0f} s on the next so far", file=sys.stderr, flush=True)
