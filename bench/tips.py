"""Benchmark of swing: how far tips go over a shot of the example without contact, and at several settings with it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ringlet import Clock, build_groom, converge, read_recipe, read_shot, simulate, tip_distance

EXAMPLE = Path(__file__).parents[1] / "examples" / "child"


def run(shot: str = "nod", frames: int = 40) -> dict[str, Any]:
    """Plays the first frames of an example shot as ``ringlet converge`` does, and without contact.

    shot:   ``nod`` or another shot of the example without a garment
    frames: last frame of the clip
    """
    clock = Clock()
    played = read_shot(EXAMPLE / f"{shot}.shot.toml")
    played = played.model_copy(update={"frames": (played.frames[0], frames)})
    groom = build_groom(read_recipe(played.groom))
    contact = played.contact
    assert contact is not None  # set in the example
    with clock("without contact"):
        alone = played.model_copy(update={"contact": contact.model_copy(update={"on": False})})
        free = simulate(alone, groom, allow_stale=True).points.astype(np.float64)
    with clock("with contact"):
        found = converge(played, groom, frames=played.frames, allow_stale=True)
    return clock.result(
        "tips",
        {"shot": shot, "frames": frames},
        per="without contact",
        warm_up=0,
        free_mm=_millimetres(tip_distance(free, groom.locks.offsets)),
        converged_mm=_millimetres(found.converged.tips),
        trials=[
            {
                "setting": trial.name,
                "iterations": trial.newton,
                "tips_mm": _millimetres(trial.tips),
                "kept": trial.kept,
                "off_mm": 1e3 * trial.off,
                "max_stretch": trial.stretch,
                "frame_cpu_ms": trial.cpu_ms,
            }
            for trial in found.trials
        ],
    )


def _millimetres(lengths: list[float]) -> list[float]:
    return [round(1e3 * length, 3) for length in lengths]
