"""Comparison of several shapes of the same hair: side by side, one camera, outline of the first over the others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageChops, ImageDraw, ImageFilter

from ringlet.data.camera import Camera
from ringlet.data.curves import Curves
from ringlet.data.files import replacing
from ringlet.data.pigment import hair_color
from ringlet.picture.bodies import PosedBody
from ringlet.picture.render import Progress
from ringlet.picture.sheet import arrange_tiles, draw_tile, frame_all, subsample

OUTLINE = (255, 176, 59)
CLOSE = 7  # largest gap between curls that an outline ignores [pixels]


def compare(
    shapes: Mapping[str, Curves],
    bodies: Sequence[PosedBody],
    path: Path | str,
    *,
    tile: tuple[int, int] = (420, 480),
    title: str = "",
    hairs: int = 6000,
    samples: int = 12,
    view: str | tuple[float, float] = "three_quarter",
    color: str | None = None,
    progress: Progress | None = None,
) -> Path:
    """Writes a PNG with one tile per shape, under its name.

    shapes: hairs [m] by name; the outline of the first is drawn over all others
    bodies, tile, title, hairs, samples, view, color, progress: as in ``sheet``
    """
    thinned = {name: subsample(curves, hairs) for name, curves in shapes.items()}
    camera, pigments = frame_all([(bodies, curves) for curves in thinned.values()], tile, view), hair_color(color)
    tiles: list[tuple[str, str, NDArray[np.uint8]]] = []
    outline = None
    for name, curves in thinned.items():
        pixels = draw_tile(bodies, curves, camera, tile, pigments, samples)
        if outline is None:
            outline = _outline(curves, bodies, camera, tile)
        else:
            pixels = pixels.copy()
            pixels[outline] = OUTLINE
        tiles.append((name, "outline: " + next(iter(thinned)) if len(tiles) else "", pixels))
        if progress:
            progress("picture", len(tiles), len(shapes))
    page = arrange_tiles(tiles, len(tiles), tile, title, "")
    with replacing(path) as aside:
        page.save(aside)
    return Path(path)


def _outline(hairs: Curves, bodies: Sequence[PosedBody], camera: Camera, size: tuple[int, int]) -> NDArray[np.bool_]:
    """Pixels on the silhouette of hair and bodies together, shape (height, width)."""
    mask = Image.new("L", size, 0)
    draw = ImageDraw.Draw(mask)
    for body in bodies:
        for corners in (camera.project(body.points) * size)[body.mesh.triangles]:
            draw.polygon([(float(x), float(y)) for x, y in corners], fill=255)
    places = camera.project(hairs.points) * size
    for begin, end in zip(hairs.offsets[:-1], hairs.offsets[1:], strict=True):
        draw.line([(float(x), float(y)) for x, y in places[begin:end]], fill=255, width=2)
    closed = mask.filter(ImageFilter.MaxFilter(CLOSE)).filter(ImageFilter.MinFilter(CLOSE))
    return np.asarray(ImageChops.difference(closed, closed.filter(ImageFilter.MinFilter(3)))) > 0
