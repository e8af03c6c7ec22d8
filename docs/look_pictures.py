"""Makes the small pictures of looks that the review offers, next to their recipes: `python docs/look_pictures.py`.

Each is the picture of the gallery in small. A look that the gallery does not show yet is rendered on its own head, with
a part of its hairs. Missing ones are made; ``--again`` makes all.
"""

from __future__ import annotations

import sys
from pathlib import Path

from gallery import FOLDER, ROOT, Shot, Style, photograph, read_styles, variant
from PIL import Image

CAMERA = Shot(at=(0, 40.5, -1), height=37, view=(34, 7), size=(160, 178), samples=14)
HAIRS = 0.15  # part of the hairs, each wider


def picture_of(style: Style) -> Path:
    """Path of the picture of a look."""
    name = style.recipe.name.removesuffix(".recipe.toml")
    return style.recipe.parent / "pictures" / f"{name}.jpg"


def make(style: Style) -> None:
    """Makes the picture of a look."""
    head = next(iter(style.shots.values()))[0]
    large = FOLDER / f"{style.name}_{head}.jpg"
    if large.exists():
        picture = Image.open(large).resize(CAMERA.size, Image.Resampling.LANCZOS)
    else:
        picture = photograph(variant(style.recipe, head), CAMERA, "scalar", HAIRS)
    picture_of(style).parent.mkdir(exist_ok=True)
    picture.save(picture_of(style), quality=82)
    print(picture_of(style).relative_to(ROOT), flush=True)


def main() -> None:
    for style in read_styles():
        if "--again" in sys.argv or not picture_of(style).exists():
            make(style)


if __name__ == "__main__":
    main()
