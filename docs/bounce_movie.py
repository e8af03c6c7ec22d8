"""Makes docs/images/bounce.webp: the demo's ringlets in motion, at low quality and with a part of their hairs.

python docs/bounce_movie.py            the clip at the bounce of the shot
python docs/bounce_movie.py HZ HZ …    its hop at several, side by side in docs/images/bounces.webp
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont
from ringlet.api.demo import with_rest_shape
from ringlet.data.groom import Groom
from ringlet.shot import Shot

import ringlet

EXAMPLE, IMAGES = (Path(__file__).parents[1] / name for name in ("examples/child", "docs/images"))
WIDTH, HEIGHT = 240, 290  # of a movie alone [pixels]
SMALL = 220, 260  # of one among several [pixels]
SAMPLES, SHARE = 12, 0.06  # light paths per pixel, and the part of the hairs
LINE = 26  # of the title [pixels]
HOP, SHOWN = (30, 53), (36, 53)  # frames with the hop of the clip, and those from its take-off on


def play(
    shot: Shot,
    groom: Groom,
    title: str,
    frames: tuple[int, int] | None = SHOWN,
    size: tuple[int, int] = SMALL,
) -> list[Image.Image]:
    """Simulates a groom with a rest shape of its own and renders frames of it, each with the title above."""
    pages = []
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        groom_file, cache_file, hair_file = (folder / f"{name}.usdc" for name in ("groom", "cache", "hair"))
        shot = with_rest_shape(shot, folder / "rest.usdc")
        ringlet.write_groom(groom, groom_file)
        ringlet.write_loft(ringlet.loft(shot, groom), shot, shot.rest.file)
        ringlet.write_simulation(shot, groom, groom_file, cache_file, checkpoints=folder / "checkpoints")
        ringlet.write_hairs(groom_file, hair_file, cache=cache_file, frames=frames, fraction=SHARE, wider=True)
        ringlet.write_movie(hair_file, folder / "frames", width=size[0], height=size[1], samples=SAMPLES)
        for picture in sorted((folder / "frames").glob("*.png")):
            pages.append(page := Image.new("RGB", (size[0], size[1] + LINE), "#15191d"))
            ImageDraw.Draw(page).text((8, 4), title, fill="white", font=ImageFont.load_default(16))
            page.paste(Image.open(picture).convert("RGB"), (0, LINE))
    return pages


def side_by_side(pages: Sequence[Image.Image], columns: int) -> Image.Image:
    """Pictures of one size in rows of so many."""
    width, height = pages[0].size
    rows = -(-len(pages) // columns)
    sheet = Image.new("RGB", (columns * width, rows * height), "#15191d")
    for k, page in enumerate(pages):
        sheet.paste(page, (k % columns * width, k // columns * height))
    return sheet


def save(movies: Sequence[Sequence[Image.Image]], path: Path, columns: int) -> None:
    """Writes movies of one length side by side as one."""
    pages = [side_by_side(frames, columns) for frames in zip(*movies, strict=True)]
    pages[0].save(path, save_all=True, append_images=pages[1:], duration=42, loop=0, quality=55)


def main(bounces: Sequence[float]) -> None:
    """Writes the movie of the shot, or of its hop at some bounces [Hz]."""
    shot = ringlet.read_shot(EXAMPLE / "ringlets.shot.toml")
    groom, bounce = ringlet.build_groom(shot.groom), shot.motion.bounce
    if not bounces:
        save([play(shot, groom, f"bounce {bounce.value:g} Hz", None, (WIDTH, HEIGHT))], IMAGES / "bounce.webp", 1)
        return
    movies = []
    for value in bounces:
        wanted = shot.motion.model_copy(update={"bounce": bounce.model_copy(update={"value": value})})
        hop = shot.model_copy(update={"motion": wanted, "frames": HOP})
        movies.append(play(hop, groom, f"bounce {value:g} Hz"))
    save(movies, IMAGES / "bounces.webp", len(movies))


if __name__ == "__main__":
    main([float(word) for word in sys.argv[1:]])
