"""The clock of benchmarks, and the object that they print."""

from __future__ import annotations

import statistics
import time
from collections.abc import Iterator, Sequence
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
        """Adds the time of the block."""
        cpu, wall = time.process_time(), time.perf_counter()
        yield
        self.cpu.setdefault(stage, []).append(1e3 * (time.process_time() - cpu))
        self.wall.setdefault(stage, []).append(1e3 * (time.perf_counter() - wall))

    def result(self, name: str, params: dict[str, Any], *, per: str, warm_up: int, **counts: Any) -> dict[str, Any]:
        """The JSON object of ``ringlet bench``: parameters, times of the stage ``per`` and of all stages, and counts.

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


def solver_counts(
    strands: list[dict[str, NDArray[np.float64]]], scenes: Sequence[dict[str, float]] = ()
) -> dict[str, Any]:
    """Counts of a benchmark of the solver, from the reports of all its steps: of ``Strands.step``, or the two of
    ``Scene.step``. Counts of contact are means over the steps."""

    def mean(name: str) -> float:
        return float(np.mean([scene[name] for scene in scenes])) if scenes else 0.0

    cuts = sum(scene["cuts"] for scene in scenes) if scenes else sum(report["cuts"].sum() for report in strands)
    counts = {
        "contacts": mean("contacts"),
        "newton": float(np.mean([report["newton"].mean() for report in strands])),
        "linear_iterations": mean("linear_iterations"),
        "line_search_cuts": int(cuts),
        "nan": int(sum(report["nan"].sum() for report in strands)),
        "max_stretch": float(max(report["max_stretch"].max() for report in strands)),
    }
    if not scenes:
        return counts
    phases = {name.removeprefix("time_"): 1e3 * mean(name) for name in scenes[0] if name.startswith("time_")}
    more = {name: mean(name) for name in ("candidates", "violations", "zone_vertices")}
    return {**counts, **more, "closest": min(scene["closest"] for scene in scenes), "phases_wall_ms": phases}


def spread(times: list[float]) -> dict[str, float]:
    """Median, least and most."""
    return {"median": statistics.median(times), "min": min(times), "max": max(times)}
