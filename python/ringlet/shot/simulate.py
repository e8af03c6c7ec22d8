"""Running a shot: frame by frame, the scalp moves and the strands follow."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.curves import Curves
from ringlet.errors import UserError
from ringlet.groom.groom import Groom
from ringlet.mesh import Clip
from ringlet.shot.cache import Cache
from ringlet.shot.roots import Roots
from ringlet.shot.shot import Shot
from ringlet.shot.strands import Strands

Progress = Callable[[str, int, int], None]
OnFrame = Callable[[float, NDArray[np.float32], dict[str, Any]], None]


def simulate(
    shot: Shot,
    groom: Groom,
    clip: Clip,
    *,
    rest: Curves | None = None,
    frames: tuple[int, int] | None = None,
    progress: Progress | None = None,
    on_frame: OnFrame | None = None,
) -> Cache:
    """Moves the locks of ``groom`` while its scalp plays ``clip``.

    rest:     the shape that the locks remember, in the rest pose of the scalp; the groomed one by default
    frames:   first and last frame, in place of the shot's
    progress: called as progress("sim", done, total)
    on_frame: called with each frame's number, positions [m] of shape (n, 3) and statistics, as soon as it is there
    """
    first, last = frames or shot.frames
    if last < first:
        raise UserError(f"sim: frames are {first}:{last}; the last must not come before the first")
    groom.locks.check("sim: locks")
    if (groom.locks.counts <= shot.held).any():
        raise UserError(
            f"sim: held is {shot.held}, but a lock has {groom.locks.counts.min()} points; "
            "hold fewer, or resample the locks"
        )

    roots = Roots(groom)
    strands = make_strands(shot, groom, rest)
    strands.place(roots.carry(clip.at(first), first))
    numbers = range(first, last + 1)
    total = shot.preroll + len(numbers)
    cache = Cache(np.array(numbers, np.float64), np.empty((len(numbers), len(groom.locks.points), 3), np.float32))

    for done in range(shot.preroll):
        _advance(shot, strands, roots, clip, first, first)
        if progress:
            progress("sim", done + 1, total)
    for k, frame in enumerate(numbers):
        statistics = _advance(shot, strands, roots, clip, frame - 1 if k else frame, frame)
        cache.points[k] = strands.positions
        cache.statistics.append(statistics)
        if on_frame:
            on_frame(frame, cache.points[k], statistics)
        if progress:
            progress("sim", shot.preroll + k + 1, total)
    return cache


def make_strands(shot: Shot, groom: Groom, rest: Curves | None = None) -> Strands:
    """The locks of a groom as strands of a shot's material that remember the groomed shape, or another one."""
    return Strands(rest or groom.locks, shot.strands, shot.held, shot.variation.factors(groom))


def _advance(shot: Shot, strands: Strands, roots: Roots, clip: Clip, start: float, end: float) -> dict[str, Any]:
    """One frame's time passes while the scalp goes from frame ``start`` to ``end``."""
    wall, cpu = time.perf_counter(), time.process_time()
    substeps = shot.solver.substeps
    reports = []
    for k in range(1, substeps + 1):
        frame = start + (end - start) * k / substeps
        targets = roots.carry(clip.at(frame), frame)
        reports.append(
            strands.step(
                targets,
                1.0 / (clip.fps * substeps),
                gravity=shot.forces.gravity,
                wind=shot.forces.wind,
                solver=shot.solver,
            )
        )
    statistics = _summary(reports, strands)
    return {
        "frame": float(end),
        "wall_ms": 1e3 * (time.perf_counter() - wall),
        "cpu_ms": 1e3 * (time.process_time() - cpu),
        **statistics,
    }


def _summary(reports: list[dict[str, NDArray[np.float64]]], strands: Strands) -> dict[str, Any]:
    """What happened in a frame's substeps, over all strands: sums of events, the worst values, energies at its end."""
    last = reports[-1]
    unsolved = np.any([report["unconverged"] > 0 for report in reports], axis=0)

    def total(name: str) -> int:
        return int(sum(report[name].sum() for report in reports))

    def worst(name: str) -> float:
        return float(max(report[name].max() for report in reports))

    return {
        "newton": float(np.mean([report["newton"].mean() for report in reports])),
        "newton_max": int(worst("newton")),
        "unconverged": total("unconverged"),
        "unconverged_locks": [int(lock) for lock in strands.curves.ids[unsolved]],
        "line_search_cuts": total("cuts"),
        "residual": worst("residual"),
        "energy": {name: float(last[name].sum()) for name in ("stretch", "bend", "twist", "gravity", "kinetic")},
        "max_stretch": worst("max_stretch"),
        "worst_lock": int(strands.curves.ids[int(last["max_stretch"].argmax())]),
        "flips": total("flips"),
        "winding_changes": total("winding_changes"),
        "too_straight": total("too_straight"),
        "clamped": total("clamped"),
        "nan": total("nan"),
    }
