"""Makes the picture of the two warps: .venv/bin/python docs/warp_picture.py"""

from __future__ import annotations

import importlib.util
import tempfile
from pathlib import Path

from PIL import Image

import ringlet
from ringlet import picture

HERE = Path(__file__).parent
spec = importlib.util.spec_from_file_location("warp", HERE.parent / "bench" / "warp.py")
assert spec is not None and spec.loader is not None
warp = importlib.util.module_from_spec(spec)
spec.loader.exec_module(warp)

groom, rest, ours, theirs = warp.warped(locks=300, points=72, frames=30, nearest=3, bend_scale=0.5)
hairs = ringlet.build_hairs(groom).curves
shapes = {"at rest": rest, "carried by simulated curls": ours, "displaced by straight guides": theirs}
with tempfile.TemporaryDirectory() as folder:
    page = picture.compare(
        {name: hairs.with_points(points.astype("float32")) for name, points in shapes.items()},
        [picture.PosedBody(groom.scalp, groom.scalp.points)],
        Path(folder) / "warp.png",
        tile=(300, 340),
        view="side",
        samples=8,
    )
    Image.open(page).convert("RGB").save(HERE / "images" / "warp.jpg", quality=82)
