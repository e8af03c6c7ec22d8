"""Makes the pictures of operators for styles.md, outlines.md and brows.md: panels, mostly without and with an operator.

    .venv/bin/python docs/operator_pictures.py            all that are missing or out of date
    .venv/bin/python docs/operator_pictures.py tie loc    these, if they are

Panels stand in docs/operators.toml. A picture holds the digest of its recipes, heads and cameras, as in the gallery.
"""

from __future__ import annotations

import argparse
import hashlib
import tempfile
import tomllib
from dataclasses import dataclass
from pathlib import Path

from gallery import DOCS, ROOT, Shot, digest, photograph, shot, stored_digest
from PIL import Image

FOLDER = DOCS / "images" / "styles"
SPACE = 8  # between panels [pixels]


@dataclass(frozen=True)
class Panel:
    """One of the panels of a picture: the text of its recipe, its head and its camera."""

    recipe: str
    head: str
    camera: Shot


@dataclass(frozen=True)
class Picture:
    """A picture: its name, its panels row by row, and how many stand in a row."""

    name: str
    panels: list[Panel]
    columns: int


def read_pictures() -> list[Picture]:
    """The pictures of docs/operators.toml."""
    table = tomllib.loads((DOCS / "operators.toml").read_text())
    return [
        Picture(
            entry["name"],
            [read_panel(entry | panel, table["camera"] | entry.get("camera", {})) for panel in entry["panels"]],
            entry.get("columns", len(entry["panels"])),
        )
        for entry in table["picture"]
    ]


def read_panel(entry: dict, camera: dict) -> Panel:
    """A panel: a recipe with changes."""
    text = f'ringlet = 2\nextends = "{ROOT / entry["recipe"]}"\n{entry.get("changes", "")}\n'
    return Panel(text, entry["head"], shot(camera | entry.get("camera", {})))


def mark_of(picture: Picture) -> str:
    """Digest of all that a picture is made of."""
    made = hashlib.sha256()
    with tempfile.TemporaryDirectory() as folder:
        recipe = Path(folder) / "panel.recipe.toml"
        for panel in picture.panels:
            recipe.write_text(panel.recipe)
            made.update(digest(recipe, panel.head, panel.camera).encode())
    return made.hexdigest()


def render(picture: Picture, engine: str) -> Image.Image:
    """Renders the panels of a picture and places them."""
    panels = [photograph(panel.recipe, panel.camera, engine) for panel in picture.panels]
    width, height = (size + SPACE for size in panels[0].size)
    columns, rows = picture.columns, -(-len(panels) // picture.columns)
    whole = Image.new("RGB", (columns * width - SPACE, rows * height - SPACE), "white")
    for number, panel in enumerate(panels):
        row, column = divmod(number, columns)
        whole.paste(panel, (column * width, row * height))
    return whole


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pictures", nargs="*", help="names of pictures; all by default")
    parser.add_argument("--engine", default="scalar", help="of the renderer: scalar, or llvm, which is faster")
    chosen = parser.parse_args()
    FOLDER.mkdir(exist_ok=True)
    for picture in read_pictures():
        path, mark = FOLDER / f"{picture.name}.jpg", mark_of(picture)
        if (not chosen.pictures or picture.name in chosen.pictures) and stored_digest(path) != mark:
            render(picture, chosen.engine).save(path, quality=84, comment=mark.encode())
            print(path.relative_to(ROOT), flush=True)


if __name__ == "__main__":
    main()
