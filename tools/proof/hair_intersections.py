"""Counts hair edges that intersect the surfaces around their locks, before and after the hairs are moved out.

python tools/proof/hair_intersections.py hat 20
"""

from __future__ import annotations

import argparse
import json
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from ringlet.api.caches import scalp_clip
from ringlet.io import read_meshes
from ringlet.sim.penetration import edge_triangle_intersections

import ringlet

EXAMPLE = Path(__file__).parents[2] / "examples/child"


def run(shot: str = "hat", frame: int = 20, repeats: int = 9) -> dict[str, Any]:
    """Simulates a shot of the example up to a frame and measures its hairs there.

    ``surfaces`` has the meshes that hairs intersect, with the number of edges away from the roots that do: ``before``
    and ``after`` the correction.
    ``jump_mm`` is the 99th percentile, over corrected points, of the change of the correction since the last frame.
    The stage ``carry`` moves hairs with their locks; ``keep`` also corrects intersections.

    shot: ``hat``, ``tie``, ``ribbon``, ``scarf`` or ``nod``
    """
    file = EXAMPLE / f"{shot}.shot.toml"
    if not file.is_file():
        raise ringlet.UserError(f"hair intersections: shot is {shot}; must be hat, tie, ribbon, scarf or nod")
    if repeats < 2:
        raise ringlet.UserError(f"hair intersections: repeats is {repeats}; must be at least 2")
    settings = ringlet.read_shot(file)
    groom = ringlet.load_groom(settings.groom)
    first = settings.frames[0]
    if frame <= first:
        raise ringlet.UserError(f"hair intersections: frame is {frame}; must be after {first}, the first of {shot}")
    clock = ringlet.Clock()
    with tempfile.TemporaryDirectory() as folder:
        under, cache = Path(folder) / "groom.usdc", Path(folder) / "cache.usdc"
        ringlet.write_groom(groom, under)
        ringlet.write_cache(ringlet.simulate(settings, groom, frames=(first, frame)), under, cache)
        groom = ringlet.read_groom(under)
        hairs, clip = ringlet.build_hairs(groom), scalp_clip(groom)
        corrections: list[NDArray] = []
        names = [mesh.name for mesh in read_meshes(cache)]
        with ringlet.open_cache(cache) as moved:
            for number in (frame - 1, frame):
                points, scalp, beside = moved.points(number), clip.at(number), moved.surfaces(number)
                corrections.append(hairs.deformed(points, scalp, surfaces=beside) - hairs.deformed(points, scalp))
    out = hairs.new_buffer()
    for _ in range(repeats):
        with clock("carry"):
            hairs.deformed(points, scalp, out=out)
        with clock("keep"):
            hairs.deformed(points, scalp, surfaces=beside, out=out)
    hold = hairs.deformation(scalp)["hold"]
    corrected = np.linalg.norm(corrections[1], axis=1) > 1e-5
    jumps = 1e3 * np.linalg.norm(corrections[1] - corrections[0], axis=1)[corrected]
    both = zip(*(intersections(hold, moved, beside) for moved in (hairs.deformed(points, scalp), out)), strict=True)
    counts = {
        "hairs": len(hairs.curves),
        "corrected": int(corrected.sum()),
        "surfaces": {
            name.rpartition("/")[2]: {"before": before, "after": after}
            for name, (before, after) in zip(names, both, strict=True)
            if before or after
        },
        "jump_mm": float(np.quantile(jumps, 0.99)) if len(jumps) else 0.0,
    }
    return clock.result("beside", {"shot": shot, "frame": frame, "repeats": repeats}, per="keep", warm_up=1, **counts)


def intersections(hold: NDArray, points: NDArray[np.float32], surfaces: list[tuple[NDArray, NDArray]]) -> list[int]:
    """Counts the edges that intersect each surface. hold: weights along a hair; edges with a weight are left out."""
    number = len(hold)
    free = np.flatnonzero(hold[:-1] == 0.0)
    each = points.reshape(-1, number, 3).astype(np.float64)
    ends = np.stack([each[:, free], each[:, free + 1]], axis=2).reshape(-1, 2, 3)
    return [
        len(np.unique(edge_triangle_intersections(ends, corners[triangles])[:, 0])) for corners, triangles in surfaces
    ]


def main() -> None:
    """Measures a frame of a shot on one thread and prints the result as JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("shot", help="hat, tie, ribbon, scarf or nod")
    parser.add_argument("frame", type=int, help="after the first of the shot")
    parser.add_argument("--repeats", type=int, default=9, help="number of repetitions, the first of which is not timed")
    options = parser.parse_args()
    ringlet.use_threads(1)
    print(json.dumps(run(options.shot, options.frame, options.repeats), indent=1))


if __name__ == "__main__":
    main()
