"""Benchmark of live hair on all looks and types of the examples: how many steps a second one thread does."""

from __future__ import annotations

import statistics
from pathlib import Path
from typing import Any

import numpy as np

from ringlet import Clock, Groom, build_groom, live_shot, read_recipe, read_shot

EXAMPLES = Path(__file__).parents[1] / "examples"
DENSE = "4A", 5000  # a type with many locks
TURN, PERIOD = 0.5, 24  # of the head to and fro [rad], and its time [steps]


def run(steps: int = 12, warm_up: int = 3) -> dict[str, Any]:
    """Turns the head of each look and type to and fro, live.

    steps: that are measured
    warm_up: those before
    """
    clock, looks = Clock(), {}
    for file in sorted((EXAMPLES / "looks").glob("*.toml")) + sorted((EXAMPLES / "types").glob("*.toml")):
        name = file.name.removesuffix(".recipe.toml")
        looks[name.replace("_", " ")] = moved(build_groom(file), steps, warm_up, clock)
        if name == DENSE[0]:
            made = read_recipe(file)
            dense = made.model_copy(update={"locks": made.locks.model_copy(update={"count": DENSE[1]})})
            looks[f"{name}, {DENSE[1]} locks"] = moved(build_groom(dense), steps, warm_up, clock)
    return clock.result("looks", {"steps": steps, "warm_up": warm_up}, per="step", warm_up=0, looks=looks)


def moved(groom: Groom, steps: int, warm_up: int, clock: Clock) -> dict[str, float]:
    """Sizes of a look, and times of its processor [ms]; none of its locks may be lost."""
    own = Clock()
    with own("begin"):
        live = live_shot(read_shot(EXAMPLES / "child" / "nod.shot.toml"), groom)
    for k in range(warm_up + steps):
        angle = TURN * np.sin(2.0 * np.pi * (k + 1) / PERIOD)
        head = np.eye(4)
        head[0, 0] = head[2, 2] = np.cos(angle)
        head[0, 2], head[2, 0] = np.sin(angle), -np.sin(angle)
        live.head = head
        with own("step"), clock("step"):
            note = live.step()
        assert not note, note
        with own("carry"):
            assert np.isfinite(live.positions).all()
    times = {stage: statistics.median(all_of_them[warm_up:] or all_of_them) for stage, all_of_them in own.cpu.items()}
    sizes = {"locks": len(groom.locks), "points": len(groom.locks.points)}
    return {**sizes, **{f"{stage}_ms": of for stage, of in times.items()}, "steps_a_second": 1e3 / times["step"]}
