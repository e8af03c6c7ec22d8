"""Benchmark of swing: how far tips go over a shot of the example without contact, converged, and as shipped."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ringlet import Clock, build_groom, lock_motion, read_recipe, read_shot, simulate, tip_distance

EXAMPLE = Path(__file__).parents[1] / "examples" / "child"


def run(
    shot: str = "nod",
    frames: int = 40,
    settings: str = "3/0.2,5/0.2,8/0.1",
    converged: str = "60/0.02",
) -> dict[str, Any]:
    """Simulates the first frames of an example shot without contact and with it at each setting of the solver.

    shot:      ``nod`` or another shot of the example without a garment
    frames:    last frame of the clip
    settings:  ``solver.newton`` / ``solver.linear_tolerance`` of each run, separated by commas
    converged: the same, of the run that the others are compared with
    """
    clock = Clock()
    played = read_shot(EXAMPLE / f"{shot}.shot.toml")
    played = played.model_copy(update={"frames": (played.frames[0], frames)})
    groom = build_groom(read_recipe(played.groom))
    contact = played.contact
    assert contact is not None  # set in the example
    offsets = groom.locks.offsets
    runs: dict[str, np.ndarray] = {}
    results: dict[str, dict[str, Any]] = {}
    for name in ("free", converged, *settings.split(",")):
        changes: dict[str, Any] = {"contact": contact.model_copy(update={"on": False})}
        if name != "free":
            newton, tolerance = name.split("/")
            update = {"newton": int(newton), "linear_tolerance": float(tolerance)}
            changes = {"solver": played.solver.model_copy(update=update)}
        with clock(name):
            cache = simulate(played.model_copy(update=changes), groom, allow_stale=True)
        runs[name] = cache.points.astype(np.float64)
        results[name] = {
            "tips_mm": [round(1e3 * distance, 3) for distance in tip_distance(runs[name], offsets)],
            "motion_mm": [round(1e3 * distance, 3) for distance in lock_motion(runs[name], offsets)],
            "cpu_ms": float(np.median([frame["cpu_ms"] for frame in cache.statistics[1:]])),
            "max_stretch": max(frame["max_stretch"] for frame in cache.statistics[1:]),
        }
    for name in settings.split(","):
        whole = sum(results[converged]["motion_mm"])
        results[name]["kept"] = sum(results[name]["motion_mm"]) / whole
        results[name]["off_mm"] = 1e3 * float(np.linalg.norm(runs[name] - runs[converged], axis=-1).mean())
    return clock.result(
        "tips",
        {"shot": shot, "frames": frames, "settings": settings, "converged": converged},
        per="free",
        warm_up=0,
        runs=results,
    )
