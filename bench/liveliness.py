"""Benchmark of liveliness: motion of hair relative to the head by contact stiffness, with a ribbon or without."""

from __future__ import annotations

import statistics
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from ringlet import Clock, build_groom, lock_motion, loft, read_recipe, read_shot, simulate, write_loft

EXAMPLE = Path(__file__).parents[1] / "examples" / "child"
STILL = 0.1  # motion of a frame below which hair counts as still [mm]


def run(
    shot: str = "nod",
    locks: int = 1050,
    frames: int = 14,
    newton: int = 5,
    stiffness: str = "1,0.1",
    rest: str = "none",
    linear_tolerance: float = 0.4,
    converged: int = 0,
) -> dict[str, Any]:
    """Simulates the first frames of an example shot without contact, and with contacts of each stiffness.

    shot:      ``nod`` or ``ribbon``; its cloth is omitted without contact
    locks:     groom guides of 96 points
    frames:    last frame of the clip, after 12 frames to settle
    newton:    iterations of every step
    stiffness: values of ``contact.stiffness``, separated by commas
    rest:      ``rest.mode``
    linear_tolerance: ``solver.linear_tolerance``
    converged: iterations of a run, solved to 0.02, that each run with contact is compared with; 0: of none
    """
    clock = Clock()
    played = read_shot(EXAMPLE / f"{shot}.shot.toml")
    recipe = read_recipe(played.groom)
    groom = build_groom(recipe.model_copy(update={"locks": recipe.locks.model_copy(update={"count": locks})}))
    contact, first = played.contact, played.frames[0]
    assert contact is not None  # set in the example
    results = {}
    with tempfile.TemporaryDirectory() as folder:
        rest_file = Path(folder) / "nod.rest.usdc"
        played = played.model_copy(
            update={
                "frames": (first, frames),
                "solver": played.solver.model_copy(update={"newton": newton, "linear_tolerance": linear_tolerance}),
                "rest": played.rest.model_copy(update={"mode": rest, "file": rest_file}),
            }
        )
        if rest != "none":
            with clock("rest shapes"):
                write_loft(loft(played, groom), played, rest_file)
        for name in ("without", *str(stiffness).split(",")):
            changes = {"on": False} if name == "without" else {"stiffness": float(name)}
            update = {"contact": contact.model_copy(update=changes), "cloth": () if name == "without" else played.cloth}
            shown = played.model_copy(update=update)
            with clock(f"stiffness {name}"):
                cache = simulate(shown, groom, allow_stale=True)
            points = cache.points[1 - first :].astype(np.float64)
            each = [1e3 * distance for distance in lock_motion(points, groom.locks.offsets)]
            results[name] = {
                "moves_mm": statistics.mean(each),
                "still": sum(distance < STILL for distance in each),
                "cpu_ms": statistics.median(frame["cpu_ms"] for frame in cache.statistics[1:]),
                "max_stretch": max(frame["max_stretch"] for frame in cache.statistics[1:]),
            }
            if name != "without" and frames > 2:  # the swing begins in frame 3
                estimates = [frame["contact"]["motion_kept"] for frame in cache.statistics[3 - first :]]
                results[name]["motion_kept"] = statistics.mean(estimates)
            if converged and name != "without":
                with clock("converged"):
                    solver = shown.solver.model_copy(update={"newton": converged, "linear_tolerance": 0.02})
                    exact = simulate(shown.model_copy(update={"solver": solver}), groom, allow_stale=True)
                expected = exact.points[1 - first :].astype(np.float64)
                results[name] |= {
                    "kept": 1e-3 * statistics.mean(each) / statistics.mean(lock_motion(expected, groom.locks.offsets)),
                    "off_mm": 1e3 * float(np.linalg.norm(points - expected, axis=-1).mean()),
                }
    return clock.result(
        "liveliness",
        {
            "shot": shot,
            "locks": locks,
            "frames": frames,
            "newton": newton,
            "stiffness": stiffness,
            "rest": rest,
            "linear_tolerance": linear_tolerance,
            "converged": converged,
        },
        per="stiffness without",
        warm_up=0,
        off=results,
    )
