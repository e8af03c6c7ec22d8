"""One run of a command: how long its stages took and what it wrote, for people and for the report."""

from __future__ import annotations

import shlex
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Self

from ringlet import _core, report
from ringlet.data.cache import Cache, SimulationRecord
from ringlet.data.files import check_place
from ringlet.report import Verdict, explain_slowest, judge, start_table, start_warnings

FREE = "Contact was off: locks may pass through the head and one another. A table [contact] in the shot turns it on."
CARRIED = "Locks touch, single hairs do not: they go with their lock, and may dip into what it touches."


@dataclass
class Stage:
    """A stage of a run.

    name: what was done
    wall: time on the clock [s]
    cpu:  time of all threads together [s]
    file: what it wrote, or None
    what: what is in that file
    """

    name: str
    wall: float
    cpu: float
    file: Path | None = None
    what: str = ""


class Run:
    """Collects the stages and results of a run; when the block succeeds, writes the report to ``folder``, if given.

    Example::

        with ringlet.Run("groom", "out") as run:
            with run.stage("groom", "groom.usdc"):
                ringlet.write_groom(ringlet.build_groom("curls.recipe.toml"), "groom.usdc")
    """

    def __init__(self, name: str, folder: Path | str | None = None) -> None:
        self.name = name
        self.folder = None if folder is None else Path(folder)
        self.stages: list[Stage] = []
        self.counts: dict[str, int] = {}
        self.pictures: dict[Path, str] = {}
        self.tables: list[tuple[str, list[str], list[list[str]]]] = []
        self.warnings: list[str] = []
        self.cache: Cache | SimulationRecord | None = None
        self.slowest: str | None = None
        if self.folder is not None:
            check_place(self.folder / "report.html")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is None and self.folder is not None:
            self._write_report(self.folder)

    @contextmanager
    def stage(self, name: str, file: Path | str | None = None, what: str = "") -> Iterator[None]:
        """Times a stage of the run. A ``file`` that cannot be written is refused before the work for it."""
        if file is not None:
            check_place(file)
        wall, cpu = time.perf_counter(), time.process_time()
        yield
        self.stages.append(
            Stage(
                name, time.perf_counter() - wall, time.process_time() - cpu, None if file is None else Path(file), what
            )
        )

    def count(self, **counts: int) -> None:
        """Notes counts of the result: ``run.count(locks=1200)``."""
        self.counts |= counts

    def simulated(self, cache: Cache | SimulationRecord) -> Verdict:
        """Notes a simulation: its statistics for the charts, and its report of initial penetration.

        Returns whether it can be used, and what to look at.
        """
        self.cache = cache
        self.slowest = explain_slowest(cache.statistics)
        self.warnings += [*start_warnings(cache.start), *cache.notes]
        if cache.start:
            self.table("How it started", *start_table(cache.start))
        return judge(cache.statistics)

    def pictured(self, path: Path | str, caption: str) -> None:
        """Notes a picture to show in the report."""
        self.pictures[Path(path)] = caption

    def table(self, title: str, columns: list[str], rows: list[list[str]]) -> None:
        """Notes a table of numbers to show in the report."""
        self.tables.append((title, columns, rows))

    def warn(self, sentence: str) -> None:
        """Notes a warning for the reader of the report."""
        self.warnings.append(sentence)

    def _write_report(self, folder: Path) -> None:
        report.write_report(
            report.RunReport(
                name=self.name,
                version=version("ringlet"),
                command=shlex.join([Path(sys.argv[0]).name, *sys.argv[1:]]),
                machine=report.Machine(threads=_core.thread_count(), simd=_core.simd()),
                counts=self.counts,
                stages=[report.Stage(name=s.name, wall_ms=1e3 * s.wall, cpu_ms=1e3 * s.cpu) for s in self.stages],
                statistics=self.cache.statistics if self.cache else [],
                files=[report.MadeFile.of(s.file, s.what) for s in self.stages if s.file],
                pictures=[report.Picture(path=str(path), caption=caption) for path, caption in self.pictures.items()],
                tables=[report.Table(title=title, columns=columns, rows=rows) for title, columns, rows in self.tables],
                warnings=self.warnings,
                limits=[CARRIED if self.cache.start else FREE] if self.cache else [],
            ),
            folder,
        )
