"""Benchmark of scaling: what of a step is serial, and a model of its speed-up on more workers than this machine has.

The core records how long each chunk of each parallel loop takes on one thread, and what runs between the loops. The
model replays them: chunks go to workers as OpenMP gives them out, and all wait for the last at the end of a loop. It
knows nothing of memory bandwidth, of clocks that fall with more cores, nor of the cost of chunks that change worker.
"""

from __future__ import annotations

import heapq
import math
import os
import statistics
from collections import defaultdict
from collections.abc import Iterable
from typing import Any

import numpy as np
from head import simulated
from numpy.typing import NDArray

from ringlet import Clock, Loop, UserError, empty_loop_time, recorded_loops, threads

SCENES = {"light": (2000, 80), "dense": (3000, 100)}  # locks, points
WORKERS = (2, 4, 8, 16, 32, 64)
SHOWN = 16  # serial parts that are listed


def run(
    scenes: str = "light,dense",
    newton: int = 5,
    frames: int = 3,
    preroll: int = 2,
    radius: float = 3e-4,
    turns: int = 1,
) -> dict[str, Any]:
    """Records the moving steps of ``ringlet bench head`` with 2 000 locks of 80 points, and 3 000 of 100.

    scenes:  ``light``, ``dense`` or both
    newton:  iteration limit of every step
    frames:  last frame
    preroll: steps with the head at rest, which do not count
    radius:  contact radius of a lock [m]
    turns:   runs on one and on two threads, by turns, to compare the model with; the quickest count. 0: none
    """
    clock, results = Clock(), {}
    barriers = {count: barrier(count) for count in (2, os.cpu_count() or 2)}
    for name in scenes.split(","):
        if name not in SCENES:
            raise UserError(f"bench serial: scenes has {name}; must be light or dense")
        scene = (*SCENES[name], newton, frames, preroll, radius)
        with clock("all"), recorded_loops() as steps:
            simulated(*scene)
        results[name] = {**summary(steps[preroll:], barriers), "measured_2": measured(scene, turns)}
    return clock.result(
        "serial",
        {"scenes": scenes, "newton": newton, "frames": frames, "preroll": preroll, "radius": radius, "turns": turns},
        per="all",
        warm_up=0,
        barrier_us={str(count): 1e6 * cost for count, cost in barriers.items()},
        scenes=results,
    )


def summary(steps: list[list[Loop]], barriers: dict[int, float]) -> dict[str, Any]:
    """Times of a step, its serial share with the largest parts, and the speed-up of the model by workers.

    A part is what runs from one loop to the next, or a loop of one chunk.
    """
    loops = [loop for step in steps for loop in step]
    whole = sum(loop.serial + loop.inside for loop in loops)
    parts: defaultdict[str, float] = defaultdict(float)
    for before, loop in zip([loops[-1], *loops[:-1]], loops, strict=True):
        parts[f"{before.place} … {loop.place}"] += loop.serial
        if len(loop.chunks) == 1:
            parts[loop.place] += loop.inside
    largest = sorted(parts.items(), key=lambda part: -part[1])[:SHOWN]
    return {
        "step_ms": 1e3 * whole / len(steps),
        "loops": len(loops) / len(steps),
        "serial": sum(parts.values()) / whole,
        "serial_parts": {place: part / whole for place, part in largest},
        "speed_up": {count: whole / replay(loops, count, barrier_of(count, barriers)) for count in WORKERS},
    }


def replay(loops: Iterable[Loop], workers: int, barrier: float) -> float:
    """How long the loops and what is between them take on so many workers [s]; a shared loop costs a barrier."""
    time = 0.0
    for loop in loops:
        time += loop.serial
        if len(loop.chunks) < 2:
            time += float(loop.chunks.sum())
        else:
            time += barrier + (last_free if loop.dynamic else longest_part)(loop.chunks, workers)
    return time


def last_free(chunks: NDArray[np.float32], workers: int) -> float:
    """When the last of the workers is done, each of whom takes the next chunk as soon as it is free."""
    free = [0.0] * workers
    for chunk in chunks.tolist():
        heapq.heapreplace(free, free[0] + chunk)
    return max(free)


def longest_part(chunks: NDArray[np.float32], workers: int) -> float:
    """The longest of equal numbers of chunks, one after the other."""
    begins = np.unique(np.linspace(0, len(chunks), workers, endpoint=False).astype(int))
    return float(np.add.reduceat(chunks, begins).max())


def barrier(count: int) -> float:
    """How long an empty loop takes on so many threads [s]."""
    with threads(count):
        return empty_loop_time()


def barrier_of(count: int, measured: dict[int, float]) -> float:
    """Of more threads than were measured, as much more as their logarithm: threads arrive at a barrier as in a tree."""
    most = max(measured)
    return measured[count] if count in measured else measured[most] * math.log2(count) / math.log2(most)


def measured(scene: tuple[int, int, int, int, int, float], turns: int) -> float | None:
    """The speed-up of two threads, by the wall time of the quickest run of each."""
    best: dict[int, float] = {}
    for _ in range(turns):
        for count in (1, 2):
            with threads(count):
                moving = simulated(*scene)[1].statistics[1:]
            wall = statistics.mean(step["wall_ms"] for step in moving)
            best[count] = min(wall, best.get(count, math.inf))
    return best[1] / best[2] if turns else None
