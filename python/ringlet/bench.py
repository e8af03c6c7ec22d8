"""What benchmarks measure with, and the object that they print."""

from __future__ import annotations

import statistics
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import _core


class Clock:
    """Times of named stages, evaluation by evaluation [ms].

    Example::

        clock = Clock()
        for _ in range(6):
            with clock("step"):
                strands.step(targets, 1 / 24)
        result = clock.result("strands", {"strands": 500}, per="step", warm_up=1)
    """

    def __init__(self) -> None:
        self.cpu: dict[str, list[float]] = {}
        self.wall: dict[str, list[float]] = {}

    @contextmanager
    def __call__(self, stage: str) -> Iterator[None]:
        """Adds the time that the block takes."""
        cpu, wall = time.process_time(), time.perf_counter()
        yield
        self.cpu.setdefault(stage, []).append(1e3 * (time.process_time() - cpu))
        self.wall.setdefault(stage, []).append(1e3 * (time.perf_counter() - wall))

    def result(self, name: str, params: dict[str, Any], *, per: str, warm_up: int, **counts: Any) -> dict[str, Any]:
        """The contract object of ``ringlet bench``: what was asked, times of the stage ``per`` and of all, and counts.

        The first ``warm_up`` evaluations are left out of every time.
        """
        return {
            "name": name,
            "params": params,
            "threads": _core.thread_count(),
            "simd": _core.simd(),
            "cpu_ms": spread(self.cpu[per][warm_up:]),
            "wall_ms": spread(self.wall[per][warm_up:]),
            "stages": {stage: statistics.median(times[warm_up:]) for stage, times in self.cpu.items()},
            **counts,
        }


def solver_counts(reports: list[dict[str, NDArray[np.float64]]]) -> dict[str, Any]:
    """What a benchmark of the solver counts, from the reports of all its steps (see ``Strands.step``)."""
    return {
        "contacts": 0,
        "newton": float(np.mean([report["newton"].mean() for report in reports])),
        "linear_iterations": 0,
        "line_search_cuts": int(sum(report["cuts"].sum() for report in reports)),
        "nan": int(sum(report["nan"].sum() for report in reports)),
        "max_stretch": float(max(report["max_stretch"].max() for report in reports)),
    }


def spread(times: list[float]) -> dict[str, float]:
    """Median, least and most."""
    return {"median": statistics.median(times), "min": min(times), "max": max(times)}
