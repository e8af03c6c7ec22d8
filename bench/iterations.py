"""Benchmark of accuracy: deviation of a motion from the converged one by Newton iterations, for curls on a head."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import Clock, UserError, build_groom, read_shot, simulate

EXAMPLE = Path(__file__).parents[1] / "examples" / "child"
ITERATIONS = (1, 2, 3, 5, 10, 20, 60)

SHOT = """
ringlet = 2
groom = "{groom}"
frames = [1, {frames}]
preroll = 6
[strands]
damping = 0.004
bend_scale = 6
[solver]
newton = {newton}
substeps = {substeps}
linear_tolerance = {linear_tolerance}
[contact]
on = {contact}
radius = 4e-4
friction = 0.3
"""


def run(
    frames: int = 12, converged: int = 200, contacts: str = "on", substeps: int = 1, linear_tolerance: float = 0.1
) -> dict[str, Any]:
    """Simulates the shot of the tutorial with few and with many iterations.

    frames:    number of frames of the clip that are simulated after the first; it starts with a nod
    converged: iterations of the reference motion; enough for strands without contact
    contacts:  ``on`` or ``off``
    substeps:  steps of a frame, for all motions
    linear_tolerance: ``solver.linear_tolerance`` of all motions but the reference
    """
    if contacts not in ("on", "off"):
        raise UserError(f"bench iterations: contacts is '{contacts}'; must be on or off")
    clock = Clock()
    groom = build_groom(EXAMPLE / "light.recipe.toml")
    tips = groom.locks.offsets[1:] - 1

    def simulated(newton: int, **solver: float) -> tuple[NDArray[np.floating], dict[str, float]]:
        settings = {"newton": newton, "substeps": substeps, "contact": str(contacts == "on").lower(), **solver}
        with tempfile.TemporaryDirectory() as folder:
            shot = Path(folder) / "iterations.shot.toml"
            recipe = (EXAMPLE / "light.recipe.toml").as_posix()
            shot.write_text(SHOT.format(groom=recipe, frames=frames + 1, **settings))
            with clock(f"newton {newton}"):
                cache = simulate(read_shot(shot), groom)
        spent = float(np.mean([frame["newton"] for frame in cache.statistics[1:]]))
        return cache.points.astype(np.float64), {"iterations": spent}

    reference, numbers = simulated(converged, linear_tolerance=0.1)
    deviations = {f"newton {converged}": numbers}
    for newton in ITERATIONS:
        points, numbers = simulated(newton, linear_tolerance=linear_tolerance)
        distance = 1e3 * np.linalg.norm(points - reference, axis=2)
        mean_shift = 1e3 * np.linalg.norm((points - reference)[:, tips].mean(axis=1), axis=1)
        deviations[f"newton {newton}"] = numbers | {
            "mean_mm": float(distance.mean()),
            "percentile_95_mm": float(np.percentile(distance, 95)),
            "most_mm": float(distance.max()),
            "tips_together_mm": float(mean_shift.max()),  # a lag of the whole hair, which does not average out
        }
    return clock.result(
        "iterations",
        {
            "frames": frames,
            "converged": converged,
            "contacts": contacts,
            "substeps": substeps,
            "linear_tolerance": linear_tolerance,
        },
        per=f"newton {ITERATIONS[0]}",
        warm_up=0,
        off=deviations,
    )
