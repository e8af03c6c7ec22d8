"""How much of its motion a shot keeps at several settings of its solver, compared with a run that converges."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.convergence import ENOUGH, Convergence, Trial
from ringlet.sim.garment import moved_rigidly
from ringlet.sim.motion import Motion

SETTINGS = ((3, 0.4), (5, 0.4), (8, 0.1), (12, 0.05))  # iterations and linear tolerances that are tried
CONVERGED = (60, 0.02)


@dataclass
class _Played:
    """A trial: the points of all locks as they are written at each frame [m], and the statistics of its frames."""

    points: list[NDArray[np.float64]] = field(default_factory=list)
    statistics: list[dict[str, Any]] = field(default_factory=list)


def converge(
    motion: Motion,
    frames: tuple[int, int],
    settings: Sequence[tuple[int, float]] = SETTINGS,
    enough: float = ENOUGH,
    progress: Callable[[str, int, int], None] | None = None,
) -> Convergence:
    """Plays frames of a motion, which is at its start, at several settings from the same state.

    frames: first and last; up to the first the motion goes with its own setting
    """
    shot, (first, last) = motion.shot, frames
    for k in range(-shot.preroll, first - motion.first + 1):
        motion.reach(k)
    state = {name: np.array(values) for name, values in motion.memory.items()}
    own = (shot.solver.newton, shot.solver.linear_tolerance)
    chosen = [*sorted({own, *settings}), CONVERGED]
    done, total = 0, (last - first) * len(chosen)
    runs: dict[tuple[int, float], _Played] = {}
    for newton, tolerance in chosen:
        motion.recall(state)
        solver = shot.solver.model_copy(update={"newton": newton, "linear_tolerance": tolerance})
        motion.shot = shot.model_copy(update={"solver": solver})
        played = runs.setdefault((newton, tolerance), _Played([motion.points(first).copy()]))
        for frame in range(first, last):
            played.statistics.append(motion.advance(frame, frame + 1))
            played.points.append(motion.points(frame + 1).copy())
            done += 1
            if progress:
                progress("converge", done, total)
    motion.shot = shot
    trials = _compared(runs, motion.cores.whole.locks.offsets)
    return Convergence(frames, trials[own], [trials[setting] for setting in chosen[:-1]], trials[CONVERGED], enough)


def _compared(
    runs: Mapping[tuple[int, float], _Played], offsets: NDArray[np.integer]
) -> dict[tuple[int, float], Trial]:
    trials = {}
    for (newton, tolerance), played in runs.items():
        points = np.array(played.points)
        trials[newton, tolerance] = Trial(
            newton,
            tolerance,
            motion=lock_motion(points, offsets),
            tips=tip_distance(points, offsets),
            stretch=max(frame["max_stretch"] for frame in played.statistics),
            cpu_ms=float(np.median([frame["cpu_ms"] for frame in played.statistics])),
            off=float(np.linalg.norm(points - np.array(runs[CONVERGED].points), axis=2)[1:].mean()),
        )
    whole = sum(trials[CONVERGED].motion)
    for trial in trials.values():
        trial.kept = sum(trial.motion) / whole if whole > 0.0 else 1.0
    return trials


def lock_motion(points: NDArray[np.float64], offsets: NDArray[np.integer]) -> list[float]:
    """Largest motion of a lock's vertices relative to the rigid motion of all roots, by frame, median over locks [m].

    points:  positions [m], shape (frames, n, 3)
    offsets: offsets of the locks, shape (locks + 1,)
    """
    roots = offsets[:-1]
    return [
        float(np.median(np.maximum.reduceat(_moved(before, after, roots), roots)))
        for before, after in itertools.pairwise(points)
    ]


def tip_distance(points: NDArray[np.float64], offsets: NDArray[np.integer]) -> list[float]:
    """Distance of the tips from where they are in the first frame, relative to the rigid motion of all roots [m].

    The median over locks, by frame. Takes what `lock_motion` takes.
    """
    roots, ends = offsets[:-1], offsets[1:] - 1
    return [float(np.median(_moved(points[0], now, roots)[ends])) for now in points]


def _moved(before: NDArray[np.float64], after: NDArray[np.float64], roots: NDArray[np.integer]) -> NDArray[np.float64]:
    """How far each vertex has moved relative to the rigid motion of all roots [m], shape (n,)."""
    return np.linalg.norm(moved_rigidly(before, before[roots], after[roots]) - after, axis=1)
