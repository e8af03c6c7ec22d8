"""Makes the small pictures of looks that the review offers, next to their recipes: `python docs/look_pictures.py`.

Each is a look of docs/gallery.toml on its own head, with a part of its hairs. Missing ones are made; ``--again`` makes
all.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from gallery import ROOT, Shot, Style, add_camera, read_styles, variant
from PIL import Image

import ringlet

CAMERA = Shot(at=(0, 40.5, -1), height=37, view=(34, 7), size=(160, 178), samples=14)
HAIRS = 0.15  # part of the hairs, each wider


def picture_of(style: Style) -> Path:
    """Path of the picture of a look."""
    name = style.recipe.name.removesuffix(".recipe.toml")
    return style.recipe.parent / "pictures" / f"{name}.jpg"


def render(style: Style, folder: Path) -> None:
    """Renders the picture of a look."""
    head = next(iter(style.shots.values()))[0]
    recipe, groom, hair, still = (folder / name for name in ("a.recipe.toml", "a.usdc", "a.hair.usdc", "a.png"))
    recipe.write_text(variant(style.recipe, head))
    ringlet.write_groom(ringlet.build_groom(recipe), groom)
    ringlet.write_hairs(groom, hair, fraction=HAIRS, wider=True)
    add_camera(hair, "look", CAMERA)
    width, height = CAMERA.size
    ringlet.write_still(hair, still, width=width, height=height, samples=CAMERA.samples, camera="/look")
    picture_of(style).parent.mkdir(exist_ok=True)
    Image.open(still).convert("RGB").save(picture_of(style), quality=82)
    print(picture_of(style).relative_to(ROOT), flush=True)


def main() -> None:
    for style in read_styles():
        if "--again" in sys.argv or not picture_of(style).exists():
            with tempfile.TemporaryDirectory() as folder:
                render(style, Path(folder))


if __name__ == "__main__":
    main()
