"""A contact sheet: frames of a clip in a grid, at low quality, with one camera that sees the whole motion."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from ringlet.data.camera import Camera
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.picture import PictureSettings
from ringlet.data.pigment import HairColor, hair_color
from ringlet.picture.bodies import PosedBody
from ringlet.picture.camera import frame as frame_camera
from ringlet.picture.motion import Pose
from ringlet.picture.render import Progress, over_backdrop, trace
from ringlet.picture.rigs import Rig, check_rig
from ringlet.picture.scene import build_scene
from ringlet.picture.still import subject
from ringlet.picture.strands import hair_widths
from ringlet.picture.tone import develop

Frame = tuple[float, Sequence[PosedBody], Curves]

PAPER, INK, FADED = (22, 25, 28), (236, 234, 230), (150, 154, 158)
GAP, CAPTION = 10, 34


def sheet(
    frames: Iterable[Frame],
    path: Path | str,
    *,
    columns: int = 4,
    tile: tuple[int, int] = (320, 360),
    title: str = "",
    fps: float = 24.0,
    hairs: int = 6000,
    samples: int = 8,
    settings: PictureSettings | None = None,
    progress: Progress | None = None,
) -> Path:
    """Writes a PNG with one labelled tile per frame.

    frames:   frame number, posed bodies and hairs [m] of each tile
    columns:  tiles side by side
    tile:     width and height of a tile [pixels]
    title:    printed above the tiles
    fps:      frames per second, for the times in the labels
    hairs:    largest number of hairs to draw
    samples:  light paths per pixel
    settings: its view, colour and light
    progress: called with "sheet", the frames done and their number

    Raises UserError without frames and for sizes below 1.
    """
    shots = [(number, bodies, subsample(curves, hairs)) for number, bodies, curves in frames]
    if not shots:
        raise UserError("sheet: there are no frames; give at least one")
    if columns < 1 or min(tile) < 1 or samples < 1:
        raise UserError(f"sheet: {columns} columns of {tile[0]} × {tile[1]} pixels; each must be at least 1")
    for number, _, curves in shots:
        if len(curves):
            curves.check(f"frame {number:g}: hairs")
    settings = settings or PictureSettings()
    check_rig(settings.light)
    pigments = hair_color(settings.color)
    camera = frame_all([shot[1:] for shot in shots], tile, settings.view or "three_quarter")
    rig = Rig(settings.light, settings.light_turn, camera.axes, camera.target, camera.distance)
    tiles = []
    for number, bodies, curves in shots:
        tiles.append(
            (
                number,
                draw_tile(bodies, curves, camera, tile, pigments, samples, rig, denoise=settings.denoiser == "oidn"),
            )
        )
        if progress:
            progress("sheet", len(tiles), len(shots))
    first, last = tiles[0][0], tiles[-1][0]
    labelled = [(f"frame {number:g}", f"{(number - first) / fps:.2f} s", pixels) for number, pixels in tiles]
    about = f"frames {first:g} to {last:g}, {fps:g} per second"
    page = arrange_tiles(labelled, min(columns, len(tiles)), tile, title, about)
    with replacing(path) as aside:
        page.save(aside)
    return Path(path)


def subsample(hairs: Curves, count: int) -> Curves:
    """At most ``count`` hairs, evenly chosen, the same ones in every frame; wider, to cover as much as all of them."""
    if len(hairs) <= count:
        return hairs
    chosen = hairs.take(np.linspace(0, len(hairs) - 1, count).round().astype(np.int64))
    chosen.point["width"] = hair_widths(chosen) * (len(hairs) / count)
    return chosen


def frame_all(
    scenes: Iterable[tuple[Sequence[PosedBody], Curves]], tile: tuple[int, int], view: str | tuple[float, float]
) -> Camera:
    """Camera that sees bodies and hairs of all tiles."""
    subjects = (points for bodies, curves in scenes for points in subject(Pose(bodies, curves)))
    return frame_camera(subjects, view=view, aspect=tile[0] / tile[1], margin=0.04)


def draw_tile(
    bodies: Sequence[PosedBody],
    hairs: Curves,
    camera: Camera,
    tile: tuple[int, int],
    pigments: HairColor | None,
    samples: int,
    rig: Rig | None = None,
    *,
    denoise: bool = True,
) -> NDArray[np.uint8]:
    """Renders a tile, shape (height, width, 3)."""
    scene = build_scene(
        bodies, hairs, camera, size=tile, color=pigments, max_depth=PictureSettings.bounces + 1, rig=rig
    )
    return develop(over_backdrop(trace(scene, samples=samples, denoise=denoise)))


def arrange_tiles(
    tiles: Sequence[tuple[str, str, np.ndarray]], columns: int, tile: tuple[int, int], title: str, about: str
) -> Image.Image:
    """Lays out tiles in reading order: each with a left and a right label below it, under a strip with the title.

    tiles: left label, right label and pixels of each tile
    about: text at the right of the title
    """
    rows = -(-len(tiles) // columns)
    strip = 64 if title else GAP
    cell = (tile[0] + GAP, tile[1] + CAPTION)
    page = Image.new("RGB", (columns * cell[0] + GAP, strip + rows * cell[1]), PAPER)
    draw = ImageDraw.Draw(page)

    def write(x: int, y: int, text: str, size: int, ink: tuple[int, int, int], anchor: str) -> None:
        draw.text((x, y), text, ink, ImageFont.load_default(size), anchor=anchor)

    if title:
        write(2 * GAP, strip // 2, title, 26, INK, "lm")
        write(page.width - 2 * GAP, strip // 2, about, 16, FADED, "rm")
    for index, (label, detail, pixels) in enumerate(tiles):
        left, top = GAP + (index % columns) * cell[0], strip + (index // columns) * cell[1]
        page.paste(Image.fromarray(pixels), (left, top))
        middle = top + tile[1] + CAPTION // 2 - 2
        write(left + 4, middle, label, 16, INK, "lm")
        write(left + tile[0] - 4, middle, detail, 15, FADED, "rm")
    return page
