"""How many edges of hairs go through what their locks lie on, before they are kept beside it and after.

Usage: python tests/physics/hairs_beside.py hat 20
"""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from ringlet.api import scalp_clip
from ringlet.sim.penetration import edge_triangle_intersections

import ringlet

EXAMPLE = Path(__file__).parents[2] / "examples/child"


def run(shot: str = "hat", frame: int = 20, repeats: int = 9) -> dict[str, Any]:
    """Simulates a shot of the example up to a frame, and carries and keeps its hairs there ``repeats`` times.

    ``before`` and ``after`` are counts, for each mesh that is seen, of edges away from the roots that go through it;
    ``jump_mm`` tells of the points that are kept beside something how much more or less they are moved than in the
    frame before: 99 in a hundred by less than this. The stage ``carry`` moves hairs alone, ``keep`` keeps them too.

    shot: ``hat``, ``tie``, ``ribbon``, ``scarf`` or ``nod``
    """
    file = EXAMPLE / f"{shot}.shot.toml"
    if not file.is_file():
        raise ringlet.UserError(f"hairs beside: shot is {shot}; must be hat, tie, ribbon, scarf or nod")
    settings = ringlet.read_shot(file)
    groom = ringlet.load_groom(settings.groom)
    first = settings.frames[0]
    if frame <= first:
        raise ringlet.UserError(f"hairs beside: frame is {frame}; must be after {first}, the first of {shot}")
    clock = ringlet.Clock()
    with tempfile.TemporaryDirectory() as folder:
        under, cache = Path(folder) / "groom.usdc", Path(folder) / "cache.usdc"
        ringlet.write_groom(groom, under)
        ringlet.write_cache(ringlet.simulate(settings, groom, frames=(first, frame)), under, cache)
        groom = ringlet.read_groom(under)
        hairs, clip = ringlet.build_hairs(groom), scalp_clip(groom)
        drawn: list[NDArray] = []
        with ringlet.open_cache(cache) as moved:
            for number in (frame - 1, frame):
                points, scalp, beside = moved.points(number), clip.at(number), moved.surfaces(number)
                drawn.append(hairs.at(points, scalp, beside=beside) - hairs.at(points, scalp))
    out = hairs.room()
    for _ in range(repeats):
        with clock("carry"):
            hairs.at(points, scalp, out=out)
        with clock("keep"):
            hairs.at(points, scalp, beside=beside, out=out)
    hold = hairs.carriage(scalp)["hold"]
    given_way = np.linalg.norm(drawn[1], axis=1) > 1e-5
    jumps = 1e3 * np.linalg.norm(drawn[1] - drawn[0], axis=1)[given_way]
    counts = {
        "hairs": len(hairs.curves),
        "given_way": int(given_way.sum()),
        "before": through(hold, hairs.at(points, scalp), beside),
        "after": through(hold, out, beside),
        "jump_mm": float(np.quantile(jumps, 0.99)) if len(jumps) else 0.0,
    }
    return clock.result("beside", {"shot": shot, "frame": frame, "repeats": repeats}, per="keep", warm_up=1, **counts)


def through(hold: NDArray, points: NDArray[np.float32], surfaces: list[tuple[NDArray, NDArray]]) -> list[int]:
    """How many edges, away from the roots, go through each surface. hold: along a hair, above 0 near its root."""
    number = len(hold)
    free = np.flatnonzero(hold[:-1] == 0.0)
    each = points.reshape(-1, number, 3).astype(np.float64)
    ends = np.stack([each[:, free], each[:, free + 1]], axis=2).reshape(-1, 2, 3)
    return [
        len(np.unique(edge_triangle_intersections(ends, corners[triangles])[:, 0])) for corners, triangles in surfaces
    ]


if __name__ == "__main__":
    ringlet.use_threads(1)
    print(json.dumps(run(sys.argv[1], int(sys.argv[2])), indent=1))
