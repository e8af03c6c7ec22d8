"""Makes docs/images/braids.webp: the shots of tools/proof/braids.py from the side, each strand in its own colour.

python docs/braid_movie.py
"""

from __future__ import annotations

import io
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image
from ringlet.data.groom import STRAND_RADIUS
from ringlet.groom.sections import STRAND

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tools" / "proof"))

from braids import SHAPES, start  # noqa: E402

MOVIE = ROOT / "docs" / "images" / "braids.webp"
FRAMES, STEPS_SHOWN = 48, 2  # of the nod; every so many frames are drawn
AZIMUTH = np.radians(118.0)  # of the view, from the front to the left of the head
INK = ("#4a2c1b", "#6f4529", "#94633e")  # of the strands of a braid
OUTLINE, SKIN = "#1d100a", np.array([0.80, 0.58, 0.44])
WIDE, LOW, HIGH = 0.155, 0.22, 0.605  # half the width of a panel and its heights [m]
PANEL, DPI = 2.9, 90  # width of a panel [inches]


@dataclass(frozen=True)
class Played:
    """A played style.

    strands: positions at each frame that is drawn [m], shape (frames, strands, points, 3)
    heads:   positions of the head's mesh [m], shape (frames, n, 3); triangles: of that mesh
    radius:  of each strand [m]; number: of each in its braid
    """

    strands: NDArray[np.float64]
    heads: NDArray[np.float64]
    triangles: NDArray[np.int32]
    radius: NDArray[np.float64]
    number: NDArray[np.int64]


def play(style: str) -> Played:
    """Simulates the nod with a style."""
    motion, groom = start(style)
    first, last = motion.shot.frames
    strands, heads = [], []
    for k in range(FRAMES):
        begin = first + k % (last - first)
        motion.advance(begin, begin + 1)
        if k % STEPS_SHOWN == 0:
            strands.append(motion.strands.positions.reshape(len(groom.locks), -1, 3).copy())
            heads.append(np.array(motion.clip.at(begin + 1)))
    number = groom.locks.curve[STRAND].astype(np.int64)
    return Played(np.array(strands), np.array(heads), groom.scalp.triangles, groom.locks.curve[STRAND_RADIUS], number)


def seen(points: NDArray) -> NDArray[np.float64]:
    """Points (…, 3) [m] as the picture's right, up and towards the camera."""
    right = np.array([np.cos(AZIMUTH), 0.0, -np.sin(AZIMUTH)])
    near = np.array([np.sin(AZIMUTH), 0.0, np.cos(AZIMUTH)])
    return points @ np.stack([right, np.array([0.0, 1.0, 0.0]), near], axis=1)


def draw_head(panel: Axes, head: NDArray, triangles: NDArray) -> None:
    """Draws the triangles that face the camera, far ones first."""
    corners = seen(head)[triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    order = np.argsort(corners[:, :, 2].mean(axis=1))
    order = order[normal[order, 2] > 0.0]
    light = 0.45 + 0.55 * np.clip(normal[order] @ np.array([-0.3, 0.5, 0.81]), 0.0, 1.0)
    colors = np.clip(light[:, None] * SKIN, 0.0, 1.0)
    panel.add_collection(
        PolyCollection(corners[order, :, :2], facecolors=colors, edgecolors=colors, linewidths=0.3, zorder=1)
    )


def draw_strands(panel: Axes, strands: NDArray, played: Played, middle: float) -> None:
    """Draws strands before and behind the head as outlined lines as thick as they are, far ones first."""
    places = seen(strands)
    ends = np.stack([places[:, :-1], places[:, 1:]], axis=2)
    segments, depth = ends.reshape(-1, 2, 3), ends[..., 2].mean(axis=2).ravel()
    steps = places.shape[1] - 1
    width = np.repeat(2.0 * played.radius, steps) * 72.0 * PANEL / (2.0 * WIDE)
    ink = np.repeat(np.array(INK)[played.number % len(INK)], steps)
    order = np.argsort(depth)
    for layer, shown in ((0.5, depth[order] < middle), (1.5, depth[order] >= middle)):
        side = order[shown]
        twice = np.repeat(segments[side, :, :2], 2, axis=0)  # outline, then fill
        widths = np.stack([width[side], 0.72 * width[side]], axis=1).ravel()
        colors = np.stack([np.full(len(side), OUTLINE), ink[side]], axis=1).ravel()
        panel.add_collection(LineCollection(twice, colors=colors, linewidths=widths, capstyle="round", zorder=layer))


def picture(styles: dict[str, Played], frame: int) -> Image.Image:
    """A frame of the movie, one panel for each style."""
    figure = Figure(figsize=(PANEL * len(styles), PANEL * (HIGH - LOW) / (2.0 * WIDE) + 0.3), dpi=DPI)
    panels = figure.subplots(1, len(styles))
    for panel, (title, played) in zip(panels, styles.items(), strict=True):
        head = played.heads[frame]
        draw_head(panel, head, played.triangles)
        draw_strands(panel, played.strands[frame], played, float(seen(head)[:, 2].mean()))
        panel.set(xlim=(-WIDE, WIDE), ylim=(LOW, HIGH), aspect="equal")
        panel.set_title(title, fontsize=10)
        panel.axis("off")
    figure.subplots_adjust(0, 0, 1, 0.92, 0.0)
    with io.BytesIO() as png:
        figure.savefig(png, format="png")
        return Image.open(png).convert("RGB")


def main() -> None:
    styles = {style: play(style) for style in SHAPES}
    pictures = [picture(styles, frame) for frame in range(FRAMES // STEPS_SHOWN)]
    pictures[0].save(MOVIE, save_all=True, append_images=pictures[1:], duration=42 * STEPS_SHOWN, loop=0, quality=40)


if __name__ == "__main__":
    main()
