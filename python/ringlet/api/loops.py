"""The parallel loops of a simulation's steps, for benchmarks that ask what more threads would bring."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.api.threads import threads


class Loop(NamedTuple):
    """A parallel loop of a step, recorded on one thread. Times in seconds of the processor."""

    place: str  # in the sources of the core
    serial: float  # before it, since the last loop or the begin of the step
    inside: float
    dynamic: bool  # chunks go to threads as they become free; otherwise each has its equal part of them
    chunks: NDArray[np.float32]  # none: what follows the last loop of a step


@contextmanager
def recorded_loops() -> Iterator[list[list[Loop]]]:
    """Gives a list that has the loops of each step when the block ends. In the block the core uses one thread."""
    steps: list[list[Loop]] = []
    with threads(1):
        recorder = _core.LoopRecorder()
        try:
            yield steps
        finally:
            loops, chunks = recorder.recorded()
            del recorder
    step: list[Loop] = []
    begin = 0
    for file, function, line, serial, inside, dynamic, end in loops:
        place = f"{Path(file).name}:{line} {function.partition('<')[0]}"
        step.append(Loop(place, serial, inside, dynamic, chunks[begin:end]))
        if begin == end and function == "take_step":
            steps.append(step)
            step = []
        begin = end


def empty_loop_time(turns: int = 2000) -> float:
    """How long a parallel loop of nothing takes on the present threads [s]: nine tenths of ``turns`` take longer."""
    return _core.empty_loop_time(turns)
