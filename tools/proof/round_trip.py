"""Measures what survives writing and reading each format of hair; prints the table of docs/convert.md.

Usage: python tools/proof/round_trip.py
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from ringlet.data.curves import Curves
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.mesh import Mesh
from ringlet.data.stage import StageSpace
from ringlet.io import open_scene, write_scene

SUFFIXES = {".usdc": "USD", ".abc": "Alembic", ".hair": "`.hair`", ".tfx": "TressFX `.tfx`", ".obj": "OBJ"}
SPACE = StageSpace(0.01, "Z")
TOLERANCE = 1e-6  # [m] of points; of values of attributes
FRAMES = np.array([1.0, 2.0])


def scene() -> HairScene:
    """Hairs with attributes of every kind, guides, a body and two frames."""
    rng = np.random.default_rng(1)
    hairs = Curves.from_list([np.cumsum(rng.random((count, 3)), axis=0) * 0.01 for count in (5, 7, 6)], [30, 10, 20])
    points = len(hairs.points)
    hairs.curve = {"st": rng.random((3, 2)).astype(np.float32), "melanin": rng.random(3).astype(np.float32)}
    hairs.point = {
        "width": (rng.random(points) * 1e-4).astype(np.float32),
        "color": rng.random((points, 3)).astype(np.float32),
        "wet": rng.random(points).astype(np.float32),
    }
    guides = Curves.from_list([hairs[0] + 0.001, hairs[1] + 0.001])
    body = Mesh("head", rng.random((3, 3)), np.array([[0, 1, 2]], np.int32), rng.random((1, 3, 2)))
    sets = [
        CurveSet("hairs", hairs, False, lambda frame: hairs.points + 0.01 * frame),
        CurveSet("guides", guides, True, lambda frame: guides.points + 0.01 * frame),
    ]
    return HairScene(sets, [(body, None)], FRAMES, StageSpace())


def survives(suffix: str) -> list[str]:
    """A row of the table: what is found again in a file of a format."""
    before = scene()
    hairs = before.sets[0].curves
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"a{suffix}")
        write_scene(before, path, SPACE)
        with open_scene(path) as plain:
            knows_space = plain.space.meters_per_unit == 0.01 and plain.space.up_axis == "Z"
        with open_scene(path, SPACE) as after:
            found = after.sets[0].curves
            moves = len(after.frames) == len(FRAMES)
            even = found.counts.tolist() != hairs.counts.tolist()
            checks: list[Callable[[], bool]] = [
                lambda: same(found.points, hairs.points),
                lambda: moves and same(after.sets[0].points(2.0), hairs.points + 0.02),
                lambda: len(after.sets) == 2 and after.sets[1].guide,
                lambda: same(after.bodies[0][0].points, before.bodies[0][0].points),
                lambda: np.allclose(found.point["width"], hairs.point["width"], atol=1e-9),
                lambda: same(found.curve["st"], hairs.curve["st"]),
                lambda: same(found.point.get("color", found.point.get("groom_color")), hairs.point["color"]),
                lambda: all(same(*pair) for pair in named(found, hairs)),
                lambda: found.ids.tolist() == hairs.ids.tolist(),
            ]
            row = ["yes" if _holds(check) else "–" for check in checks]
            if even:
                row[0] = "resampled to equal numbers"
            if row[4] == "–" and "width" in found.curve:
                row[4] = "one a curve"
    return [SUFFIXES[suffix], *row, "yes" if knows_space else "–"]


def same(found: np.ndarray | None, wanted: np.ndarray) -> bool:
    """Whether values are found again."""
    return found is not None and found.shape == wanted.shape and np.allclose(found, wanted, rtol=0.0, atol=TOLERANCE)


def named(found: Curves, wanted: Curves) -> list[tuple[np.ndarray | None, np.ndarray]]:
    """Attributes of curves and of points that no program knows, as found and as wanted."""
    return [
        (found.curve.get("melanin"), wanted.curve["melanin"]),
        (found.point.get("wet"), wanted.point["wet"]),
    ]


def _holds(check: Callable[[], bool]) -> bool:
    try:
        return bool(check())
    except (KeyError, IndexError, ValueError, TypeError):
        return False


HEAD = ["format", "rest pose", "motion", "guides apart", "head", "widths", "root `st`", "color", "named attributes"]
HEAD += ["ids", "unit, axis"]


def table() -> str:
    """The table in Markdown."""
    rows = [HEAD, ["---"] * len(HEAD), *map(survives, SUFFIXES)]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


if __name__ == "__main__":
    print(table())
