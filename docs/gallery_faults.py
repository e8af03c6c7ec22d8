"""Makes docs/images/faults.jpg: crops of pictures of the gallery and the demo, before and after faults were mended.

    .venv/bin/python docs/gallery_faults.py                        commit f87cbf1e and the present pictures
    .venv/bin/python docs/gallery_faults.py --before A --after B   those of two commits

A row for each fault, with two places: left the picture of before, right that of after. All are drawn smaller than the
smaller one of the two, so that neither is blurred by being enlarged.
"""

from __future__ import annotations

import argparse
import subprocess
from io import BytesIO
from pathlib import Path

from PIL import Image, ImageOps

IMAGES = Path(__file__).parent / "images"
TILE, GAP, PAIR_GAP = 290, 4, 20  # [pixels]

# Of each fault: pictures, with left, upper, right and lower edge as parts of their size.
FAULTS = (
    (("gallery/3A_close", (0, 0.1, 1, 1)), ("gallery/low_bun_close", (0, 0.1, 1, 1))),
    (("gallery/box_braids_close", (0, 0.1, 1, 1)), ("gallery/bantu_knots_close", (0, 0.1, 1, 1))),
    (("gallery/wash_and_go_adult", (0.1, 0.15, 0.9, 0.85)), ("gallery/fade_adult", (0.1, 0.15, 0.9, 0.85))),
    (("gallery/3C_close", (0, 0, 1, 0.9)), ("gallery/4B_close", (0, 0, 1, 0.9))),
    (("gallery/locs_close", (0, 0, 1, 0.9)), ("gallery/flat_twists_adult", (0.12, 0.46, 0.72, 1))),
    (("still", (0.1, 0, 0.9, 0.75)), ("still", (0.45, 0.25, 0.85, 0.6))),
)


def picture(name: str, commit: str | None) -> Image.Image:
    """A picture of a commit, or the one that is here now."""
    file = IMAGES / f"{name}.jpg"
    if commit is None:
        return Image.open(file).convert("RGB")
    shown = subprocess.run(
        ["git", "show", f"{commit}:./{file.name}"], cwd=file.parent, check=True, stdout=subprocess.PIPE
    )
    return Image.open(BytesIO(shown.stdout)).convert("RGB")


def cropped(image: Image.Image, edges: tuple[float, float, float, float]) -> Image.Image:
    """A square tile from the middle of a part of a picture."""
    width, height = image.size
    left, upper, right, lower = edges
    box = (round(left * width), round(upper * height), round(right * width), round(lower * height))
    return ImageOps.fit(image.crop(box), (TILE, TILE), Image.Resampling.LANCZOS)


def sheet(before: str, after: str | None) -> Image.Image:
    """A row of pairs for each fault."""
    places = len(FAULTS[0])
    pair = 2 * TILE + GAP
    made = Image.new("RGB", (places * pair + (places - 1) * PAIR_GAP, len(FAULTS) * (TILE + GAP) - GAP), "white")
    for row, fault in enumerate(FAULTS):
        for column, (name, edges) in enumerate(fault):
            for side, commit in enumerate((before, after)):
                tile = cropped(picture(name, commit), edges)
                made.paste(tile, (column * (pair + PAIR_GAP) + side * (TILE + GAP), row * (TILE + GAP)))
    return made


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--before", default="f87cbf1e", help="commit")
    parser.add_argument("--after", help="commit; what is here now by default")
    chosen = parser.parse_args()
    sheet(chosen.before, chosen.after).save(IMAGES / "faults.jpg", quality=84)


if __name__ == "__main__":
    main()
