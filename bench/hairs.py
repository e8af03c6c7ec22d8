"""Sizes of files of hairs in motion, by what is written, the time to write them, and the error of fewer points."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline

import ringlet

EXAMPLE = Path(__file__).parents[1] / "examples" / "child"
OPTIONS: dict[str, dict[str, Any]] = {
    "all points": {},
    "on demand": {"on_demand": True},
    "64 points": {"points": 64},
    "48 points": {"points": 48},
    "levels of detail": {"lod": True},
}
PLACES = 480  # of a hair that are compared


def run(frames: int = 8) -> dict[str, Any]:
    """Writes the hairs of the example, with the ribbon, in frames of the nod, and in one frame.

    ``options`` has for each the size of the file and of each further frame [MB], and the processor time [s]; for fewer
    points, the distances at rest from the curve through all of them [mm].
    """
    found: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as name:
        groom, cache, hair = (Path(name, f"{each}.usdc") for each in ("groom", "cache", "hair"))
        made = ringlet.build_groom(EXAMPLE / "ribbon.recipe.toml")
        ringlet.write_groom(made, groom)
        shot = ringlet.read_shot(EXAMPLE / "nod.shot.toml")
        ringlet.write_cache(ringlet.simulate(shot, groom, frames=(1, frames)), groom, cache)
        for option, chosen in OPTIONS.items():
            sizes = []
            for last in (1, frames):
                began = time.process_time()
                counts = ringlet.write_hairs(groom, hair, cache=cache, frames=(1, last), measures={}, **chosen)
                took = time.process_time() - began
                sizes.append(hair.stat().st_size / 1e6)
            found[option] = {"mb": sizes[1], "frame_mb": (sizes[1] - sizes[0]) / (frames - 1), "cpu_s": took}
            if "points" in chosen:
                found[option]["off_mm"] = off(made, chosen["points"])
    return {"params": {"frames": frames}, "hairs": counts["hairs"], "options": found}


def off(groom: ringlet.Groom, points: int) -> dict[str, float]:
    """Distances of hairs with fewer points from those with all of them at the same parts of their length [mm]."""
    places = [at(ringlet.build_hairs(groom, points=number).curves) for number in (None, points)]
    distances = 1e3 * np.linalg.norm(places[1] - places[0], axis=2)
    return {f"{part}": float(np.percentile(distances, part)) for part in (50, 95)}


def at(curves: ringlet.Curves) -> np.ndarray:
    """Points of hairs at equal parts of their length, (hairs, PLACES, 3) [m], of every eighth hair, by Catmull-Rom."""
    each = curves.points.reshape(len(curves), -1, 3)[::8]
    u = np.linspace(0.0, 1.0, each.shape[1])
    return CubicHermiteSpline(u, each, np.gradient(each, u, axis=1), axis=1)(np.linspace(0.0, 1.0, PLACES))
