"""Shots of a host: simulated in its folder, frame by frame, and baked to hairs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ringlet.api import hairs
from ringlet.api.grooms import build_groom
from ringlet.api.progress import Progress
from ringlet.api.shots import discard_checkpoints, hold_checkpoints, write_simulation
from ringlet.data.files import check_place
from ringlet.host import requests, texts
from ringlet.report import judge, start_warnings

Warn = Callable[[str], None]


def simulate(request: requests.Simulate, progress: Progress, warn: Warn) -> dict[str, Any]:
    """Simulates a shot to a cache. A run that ends early keeps its checkpoints next to it, to be resumed."""
    folder = request.folder
    recipe = texts.apply("recipe", request.recipe, folder).model
    shot = texts.apply("shot", request.shot, folder).model
    cache = folder / request.cache
    layer = cache.with_suffix(f".groom{cache.suffix}")
    check_place(cache, shot.named_files())
    part = cache.with_name(f"{cache.name}.part")
    with hold_checkpoints(part):
        groom = build_groom(recipe, progress=progress)
        record = write_simulation(
            shot,
            groom,
            layer,
            cache,
            checkpoints=part,
            write_under=True,
            resume=request.resume,
            progress=progress,
            on_warning=warn,
        )
        discard_checkpoints(part)
    verdict = judge(record.statistics)
    notes = [*start_warnings(record.start), *record.notes, *(verdict.lines() if verdict.findings else [])]
    return {"path": str(cache), "frames": record.frames, "notes": notes, "locks": len(groom.locks)}


def left_steps(folder: Path, cache: str) -> int:
    """Steps of a run that ended early and can be resumed; 0 where there is none."""
    part = folder / f"{cache}.part"
    if not part.is_dir():
        return 0
    with hold_checkpoints(part) as left:
        return left


def write_hairs(request: requests.Hairs, progress: Progress) -> dict[str, Any]:
    """Writes the hairs of a cache."""
    cache, path = request.folder / request.cache, request.folder / request.file
    check_place(path, {"cache": cache})
    counts = hairs.write_hairs(
        cache, path, fraction=request.fraction, wider=True, velocities=request.velocities, progress=progress
    )
    return {"path": str(path), "counts": counts}
