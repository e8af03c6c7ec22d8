"""Makes docs/images/bounce.webp: the demo's ringlets in motion, at low quality and with a part of their hairs.

python docs/bounce_movie.py [HZ …]     by default at the bounce of the shot; several values of it stand side by side
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont
from ringlet.api.demo import with_rest_shape

import ringlet

EXAMPLE, MOVIE = (Path(__file__).parents[1] / name for name in ("examples/child", "docs/images/bounce.webp"))
WIDTH, HEIGHT = 240, 290  # of a panel [pixels]
SAMPLES, SHARE = 3, 0.06  # light paths per pixel, and the part of the hairs
LINE = 26  # of the title [pixels]


def frames_at(bounce: float | None, folder: Path) -> list[Image.Image]:
    """Simulates and renders the clip at a bounce [Hz], None for the shot's; each frame has its title above."""
    shot = ringlet.read_shot(EXAMPLE / "ringlets.shot.toml")
    if bounce is not None:
        wanted = shot.motion.bounce.model_copy(update={"value": bounce})
        shot = shot.model_copy(update={"motion": shot.motion.model_copy(update={"bounce": wanted})})
    shot = with_rest_shape(shot, folder / "rest.usdc")
    groom = ringlet.build_groom(shot.groom)
    groom_file, cache_file, hair_file = (folder / f"{name}.usdc" for name in ("groom", "cache", "hair"))
    ringlet.write_groom(groom, groom_file)
    ringlet.write_loft(ringlet.loft(shot, groom), shot, shot.rest.file)
    ringlet.write_simulation(shot, groom, groom_file, cache_file, checkpoints=folder / "checkpoints")
    ringlet.write_hairs(groom_file, hair_file, cache=cache_file, fraction=SHARE, wider=True)
    ringlet.write_movie(hair_file, folder / "frames", width=WIDTH, height=HEIGHT, samples=SAMPLES)
    pages = []
    for picture in sorted((folder / "frames").glob("*.png")):
        pages.append(page := Image.new("RGB", (WIDTH, HEIGHT + LINE), "#15191d"))
        title = f"bounce {shot.motion.bounce.value:g} Hz"
        ImageDraw.Draw(page).text((8, 4), title, fill="white", font=ImageFont.load_default(16))
        page.paste(Image.open(picture).convert("RGB"), (0, LINE))
    return pages


def main(bounces: list[float | None]) -> None:
    """Writes the movie, a column for each bounce."""
    columns = []
    for bounce in bounces:
        with tempfile.TemporaryDirectory() as aside:
            columns.append(frames_at(bounce, Path(aside)))
    pages = []
    for frames in zip(*columns, strict=True):
        pages.append(page := Image.new("RGB", (WIDTH * len(frames), HEIGHT + LINE)))
        for k, frame in enumerate(frames):
            page.paste(frame, (k * WIDTH, 0))
    pages[0].save(MOVIE, save_all=True, append_images=pages[1:], duration=42, loop=0, quality=55)


if __name__ == "__main__":
    main([float(word) for word in sys.argv[1:]] or [None])
