"""Measures what survives writing each format of hair, as Ringlet and another reader read it; prints the table of
docs/convert.md. It ends where the two find something else.

Usage: python tools/proof/round_trip.py
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from other_readers import READERS, Found
from ringlet.data.curves import Curves
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.mesh import Mesh
from ringlet.data.stage import StageSpace
from ringlet.io import open_scene, write_scene
from ringlet.io.space import from_metres

SUFFIXES = {".usdc": "USD", ".abc": "Alembic", ".hair": "`.hair`", ".tfx": "TressFX `.tfx`", ".obj": "OBJ"}
SPACE = StageSpace(0.01, "Z")
TOLERANCE = 1e-5  # of the file's centimetres: 0.1 µm; of values of attributes
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


def ringlets(path: Path) -> Found:
    """What Ringlet reads, in the unit and axes of the scene's file."""
    with open_scene(path) as plain:
        space = plain.space.meters_per_unit, plain.space.up_axis
    with open_scene(path, SPACE) as read:
        curves = read.sets[0].curves
        found = Found(from_metres(curves.points, SPACE), curves.counts.tolist(), space=space)
        found.curve = {**curves.curve, "id": curves.ids}
        found.point = dict(curves.point)
        for scope in (found.curve, found.point):
            if "width" in scope:
                scope["width"] = scope["width"] / SPACE.meters_per_unit
        if len(read.frames) == len(FRAMES):
            found.later = from_metres(read.sets[0].points(FRAMES[-1]), SPACE)
        found.guides = sum(len(one.curves) for one in read.sets if one.guide)
        if read.bodies:
            found.head = from_metres(read.bodies[0][0].points, SPACE)
    return found


def survives(suffix: str) -> list[str]:
    """A row of the table: what both Ringlet and another reader find again in a file of a format."""
    before = scene()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"a{suffix}")
        write_scene(before, path, SPACE)
        ours, others = cells(ringlets(path), before), cells(READERS[suffix](path), before)
    if ours != others:
        raise SystemExit(f"{suffix}: Ringlet reads {ours}, another reader {others}")
    return [SUFFIXES[suffix], *others]


def cells(found: Found, before: HairScene) -> list[str]:
    """What is found again of a scene, a cell each."""
    hairs, guides, body = before.sets[0].curves, before.sets[1].curves, before.bodies[0][0]
    width = hairs.point["width"] / SPACE.meters_per_unit
    kept = [
        same(found.points, from_metres(hairs.points, SPACE)),
        same(found.later, from_metres(before.sets[0].points(FRAMES[-1]), SPACE)),
        found.guides == len(guides),
        same(found.head, from_metres(body.points, SPACE)),
        same(found.point.get("width"), width),
        same(found.curve.get("st"), hairs.curve["st"]),
        same(found.point.get("color", found.point.get("groom_color")), hairs.point["color"]),
        same(found.curve.get("melanin"), hairs.curve["melanin"]) and same(found.point.get("wet"), hairs.point["wet"]),
        found.curve.get("id", np.empty(0)).tolist() == hairs.ids.tolist(),
        found.space == (SPACE.meters_per_unit, SPACE.up_axis),
    ]
    row = ["yes" if one else "–" for one in kept]
    if found.counts != hairs.counts.tolist():
        row[0] = "resampled to equal numbers"
    widest = np.maximum.reduceat(width, hairs.offsets[:-1])  # of the points between which curves are resampled
    if "width" in found.curve and ((0.5 * widest < (one := found.curve["width"])) & (one <= widest + TOLERANCE)).all():
        row[4] = "one a curve"
    return row


def same(found: np.ndarray | None, wanted: np.ndarray) -> bool:
    """Whether values are found again, to ``TOLERANCE`` of the unit of the file or of the attribute."""
    return found is not None and found.shape == wanted.shape and np.allclose(found, wanted, rtol=0.0, atol=TOLERANCE)


HEAD = ["format", "rest pose", "motion", "guides apart", "head", "widths", "root `st`", "color", "named attributes"]
HEAD += ["ids", "unit, axis"]


def table() -> str:
    """The table in Markdown."""
    rows = [HEAD, ["---"] * len(HEAD), *map(survives, SUFFIXES)]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


if __name__ == "__main__":
    print(table())
