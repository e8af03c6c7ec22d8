"""Benchmark of a shot with contact: locks on the example head, which nods, turns and hops."""

from __future__ import annotations

import statistics
import tempfile
from pathlib import Path
from typing import Any

from ringlet import Cache, Clock, Groom, build_groom, read_recipe, read_shot, simulate

EXAMPLE = Path(__file__).parents[1] / "examples" / "child"

MEANS = ("candidates", "contacts", "violations", "zone_vertices", "linear_iterations")
PHASES = ("pairs", "assemble", "solve", "search", "filter")

SHOT = """
ringlet = 2
groom = "{groom}"
frames = [1, {frames}]
preroll = {preroll}
[strands]
damping = 0.004
bend_scale = 6
[solver]
newton = {newton}
[contact]
radius = {radius}
"""


def run(
    locks: int = 500, points: int = 60, newton: int = 5, frames: int = 36, preroll: int = 4, radius: float = 4e-4
) -> dict[str, Any]:
    """Simulates the example with contact; each frame is one step.

    locks:   groom guides of the example's recipe, with 12 points a curl
    points:  points of a guide
    newton:  iteration limit of every step
    frames:  number of frames, of the clip's 48; the head turns quickly from 19 to 33
    preroll: untimed steps with the head at rest
    radius:  contact radius of a lock [m]
    """
    groom, cache = simulated(locks, points, newton, frames, preroll, radius)
    steps = cache.statistics[1:]  # the first frame is the start
    clock = Clock()
    clock.cpu["step"] = [step["cpu_ms"] for step in steps]
    clock.wall["step"] = [step["wall_ms"] for step in steps]
    contacts = [step["contact"] for step in steps]
    return clock.result(
        "head",
        {"locks": locks, "points": points, "newton": newton, "frames": frames, "preroll": preroll, "radius": radius},
        per="step",
        warm_up=0,
        strands=len(groom.locks),
        vertices=len(groom.locks.points),
        newton=statistics.mean(step["newton"] for step in steps),
        line_search_cuts=sum(step["line_search_cuts"] for step in steps),
        max_stretch=max(step["max_stretch"] for step in steps),
        nan=sum(step["nan"] for step in steps),
        closest=min((step["closest"] for step in contacts if step["closest"] is not None), default=None),
        **{name: statistics.mean(step[name] for step in contacts) for name in MEANS},
        phases_wall_ms={name: statistics.mean(step[f"{name}_ms"] for step in contacts) for name in PHASES},
    )


def simulated(locks: int, points: int, newton: int, frames: int, preroll: int, radius: float) -> tuple[Groom, Cache]:
    """The groom of the benchmark, and its simulated cache."""
    text = (EXAMPLE / "curls.recipe.toml").read_text()
    text = text.replace("count = 1050", f"count = {locks}").replace("points = 96", f"points = {points}")
    text = text.replace("pitch = { value = 1.2, vary = 0.2 }", f"curls = {{ value = {points / 12}, vary = 0.1 }}")
    text = text.replace('"head.usdc"', f'"{(EXAMPLE / "head.usdc").as_posix()}"')
    with tempfile.TemporaryDirectory() as folder:
        recipe, shot = Path(folder) / "head.recipe.toml", Path(folder) / "head.shot.toml"
        recipe.write_text(text)
        shot.write_text(
            SHOT.format(groom=recipe.as_posix(), frames=frames, preroll=preroll, newton=newton, radius=radius)
        )
        groom = build_groom(read_recipe(recipe))
        return groom, simulate(read_shot(shot), groom)
