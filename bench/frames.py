"""Benchmark of memory and disk: resident memory during a shot and during the output of its hairs."""

from __future__ import annotations

import os
import resource
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import Any

from head import EXAMPLE, SHOT

from ringlet import build_groom, read_recipe, read_shot, write_groom, write_hairs, write_simulation

SELF = Path("/proc/self/statm")


def run(
    locks: int = 60,
    points: int = 40,
    frames: int = 2000,
    newton: int = 3,
    radius: float = 4e-4,
    every: int = 50,
    folder: str = "",
) -> dict[str, Any]:
    """Runs a shot of the example with contact and wind, whose clip ends at frame 48; writes its cache and hairs.

    radius: contact radius of a lock [m]; many locks need a small one
    every:  frames between two measurements of the memory
    folder: parent of the temporary folder; by default that of the system
    """
    text = (EXAMPLE / "light.recipe.toml").read_text()
    text = text.replace("count = 300", f"count = {locks}").replace("points = 60", f"points = {points}")
    text = text.replace("curls = { value = 5,", f"curls = {{ value = {points / 12},")
    text = text.replace('"head.usdc"', f'"{(EXAMPLE / "head.usdc").as_posix()}"')
    megabytes: list[float] = []
    hairs_megabytes: list[float] = []
    wall: list[float] = []

    def measure_frame(frame: float, statistics: dict[str, Any]) -> None:
        wall.append(statistics.get("wall_ms", 0.0))  # there is no step at the first
        if len(wall) % every == 1 or every == 1:
            megabytes.append(round(resident(), 1))

    with tempfile.TemporaryDirectory(dir=folder or None) as place:
        recipe, shot, groom_file = (Path(place) / name for name in ("a.recipe.toml", "a.shot.toml", "groom.usdc"))
        recipe.write_text(text)
        settings = SHOT.format(groom=recipe.as_posix(), frames=frames, preroll=0, newton=newton, radius=radius)
        shot.write_text(settings + "[forces]\nwind = [2.0, 0.0, 1.0]\n")
        groom = build_groom(read_recipe(recipe))
        write_groom(groom, groom_file)
        begin, cache, checkpoints = time.perf_counter(), Path(place) / "cache.usdc", Path(place) / "part"
        write_simulation(read_shot(shot), groom, groom_file, cache, checkpoints=checkpoints, on_frame=measure_frame)
        after, peak, seconds = (
            resident(),
            resource.getrusage(resource.RUSAGE_SELF).ru_maxrss,
            time.perf_counter() - begin,
        )

        def measure_hairs(_: str, done: int, total: int) -> None:
            if done % every == 1 or every == 1:
                hairs_megabytes.append(round(resident(), 1))

        hairs = write_hairs(groom_file, Path(place) / "hair.usdc", cache=cache, fraction=0.1, progress=measure_hairs)[
            "hairs"
        ]
        return {
            "bench": "frames",
            "params": {
                "locks": locks,
                "points": points,
                "frames": frames,
                "newton": newton,
                "radius": radius,
                "every": every,
            },
            "megabytes": megabytes,
            "megabytes_after": round(after, 1),
            "megabytes_hairs": hairs_megabytes,
            "megabytes_most": round(1.024e-3 * peak, 1),
            "megabytes_of_cache": round(1e-6 * cache.stat().st_size, 1),
            "megabytes_of_checkpoints": round(1e-6 * sum(file.stat().st_size for file in checkpoints.iterdir()), 1),
            "hairs": hairs,
            "seconds": round(seconds, 1),
            "frame_ms": {"median": round(median(wall), 1), "max": round(max(wall), 1)},
        }


def resident() -> float:
    """Resident memory of the process [MB]."""
    return 1e-6 * int(SELF.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
