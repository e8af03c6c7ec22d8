"""Makes movies of the demo's clip, also side by side at several values of bounce.

    python docs/bounce_movie.py demo       docs/images/bounce.webp
    python docs/bounce_movie.py bounce     docs/images/bounces.webp: the demo's ringlets at three values of bounce

A head is rendered at low quality with a part of its hairs, each wider.
"""

from __future__ import annotations

import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from PIL import Image, ImageDraw, ImageFont
from ringlet.api.demo import with_rest_shape
from ringlet.shot import Shot

import ringlet

EXAMPLES, IMAGES = (Path(__file__).parents[1] / name for name in ("examples", "docs/images"))
SIZE = (240, 290)  # of a panel [pixels]
SAMPLES, SHARE = 3, 0.06  # light paths per pixel, and the part of the hairs
LINE = 26  # of the title [pixels]


@dataclass(frozen=True)
class Panel:
    """The demo's ringlets with other words of motion."""

    title: str
    motion: dict[str, Any]


def bounce(value: float) -> Panel:
    """The demo's ringlets at a bounce [Hz]."""
    return Panel(f"bounce {value:g} Hz", {"bounce": value, "settle": 0.8})


MOVIES = {
    "demo": ("bounce.webp", 1, [bounce(5.5)]),
    "bounce": ("bounces.webp", 3, [bounce(2.0), bounce(3.5), bounce(7.0)]),
}


def shot_of(panel: Panel, folder: Path) -> Shot:
    """The demo's shot with the panel's words and a rest shape for them."""
    shot = ringlet.read_shot(EXAMPLES / "child/ringlets.shot.toml")
    return with_rest_shape(shot.model_copy(update={"motion": type(shot.motion)(**panel.motion)}), folder / "rest.usdc")


def frames_of(panel: Panel, folder: Path) -> list[Path]:
    """Grooms, simulates and renders a panel; says what came out."""
    shot = shot_of(panel, folder)
    groom = ringlet.build_groom(ringlet.read_recipe(shot.groom))
    groom_file, cache_file, hair_file = (folder / f"{name}.usdc" for name in ("groom", "cache", "hair"))
    ringlet.write_groom(groom, groom_file)
    ringlet.write_loft(ringlet.loft(shot, groom), shot, shot.rest.file)
    ringlet.write_simulation(shot, groom, groom_file, cache_file, checkpoints=folder / "checkpoints")
    words = ringlet.motion_words(shot, groom, cache=cache_file)
    print(panel.title, *(" | ".join(row) for row in ringlet.motion_table(words)[1]), sep="\n  ", flush=True)
    ringlet.write_hairs(groom_file, hair_file, cache=cache_file, fraction=SHARE, wider=True)
    width, height = SIZE
    pictures = folder / "frames"
    ringlet.write_movie(hair_file, pictures, width=width, height=height, samples=SAMPLES)
    return sorted(pictures.glob("*.png"))


def write_movie(path: Path, columns: int, panels: list[Panel]) -> None:
    """Writes panels in rows as an animated picture, their titles above."""
    with tempfile.TemporaryDirectory() as aside:
        folders = [Path(aside) / panel.title.replace(" ", "_") for panel in panels]
        for folder in folders:
            folder.mkdir()
        played = [frames_of(panel, folder) for panel, folder in zip(panels, folders, strict=True)]
        rows = -(-len(panels) // columns)
        pages = []
        for moment in zip(*played, strict=True):
            page = Image.new("RGB", (columns * SIZE[0], rows * (SIZE[1] + LINE)), "#15191d")
            for k, (panel, picture) in enumerate(zip(panels, moment, strict=True)):
                x, y = k % columns * SIZE[0], k // columns * (SIZE[1] + LINE)
                ImageDraw.Draw(page).text((x + 8, y + 4), panel.title, fill="white", font=ImageFont.load_default(16))
                page.paste(Image.open(picture).convert("RGB"), (x, y + LINE))
            pages.append(page)
        pages[0].save(path, save_all=True, append_images=pages[1:], duration=42, loop=0, quality=55)


if __name__ == "__main__":
    for name in sys.argv[1:] or list(MOVIES):
        file, columns, panels = MOVIES[name]
        write_movie(IMAGES / file, columns, panels)
