"""Makes the small pictures of looks that the review offers, next to their recipes: `python docs/look_pictures.py`.

Each is the picture of the gallery in small. A look that the gallery does not show is rendered on its own head, with a
part of its hairs. Missing ones are made; ``--again`` makes all.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

from gallery import FOLDER, Shot, photograph, read_styles
from PIL import Image
from ringlet.viewer.files.presets import Preset, looks

CAMERA = Shot(at=(0, 40.5, -1), height=37, view=(34, 7), size=(160, 178), samples=48)
HAIRS = 0.15  # part of the hairs, each wider
HEIGHTS = {"looks/ombre": 45}  # of what is seen, where hair is wider than the head of the others [cm]


def large_pictures() -> dict[Path, Path]:
    """Large pictures of the gallery by their recipes; some are not rendered yet."""
    styles = read_styles()
    return {style.recipe: FOLDER / f"{style.name}_{next(iter(style.shots))}.jpg" for style in styles}


def make(look: Preset, large: Path | None) -> None:
    """Makes the picture of a look."""
    if large and large.exists():
        picture = Image.open(large).resize(CAMERA.size, Image.Resampling.LANCZOS)
    else:
        camera = replace(CAMERA, height=HEIGHTS.get(look.name, CAMERA.height))
        picture = photograph(f'ringlet = 2\nextends = "{look.file}"\n', camera, "scalar", HAIRS)
    look.picture.parent.mkdir(exist_ok=True)
    picture.save(look.picture, quality=82)
    print(look.name, flush=True)


def main() -> None:
    large = large_pictures()
    for look in looks():
        if "--again" in sys.argv or not look.picture.exists():
            make(look, large.get(look.file))


if __name__ == "__main__":
    main()
