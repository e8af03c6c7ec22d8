"""Makes docs/images/review_looks.jpg: the looks of the gallery in the review, at half of their density.

    .venv/bin/python docs/review_looks.py             all looks
    .venv/bin/python docs/review_looks.py bob 4C      a sheet of these

Each look is opened in a page of its own in headless Chromium, framed as by "Frame all hair", and drawn live.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from gallery import ROOT, Style, read_styles, variant
from PIL import Image
from playwright.sync_api import Browser, sync_playwright
from review_pictures import CHROMIUM, FLAGS, IMAGES, Review, Server, decoded
from ringlet.groom.load import load

DRAWN, TILE, COLUMNS = (300, 334), (225, 250), 8  # pixels of a picture and of its tile, tiles in a row
DRAWINGS = 3  # of a part of the hairs each


def halved(density: Any) -> Any:
    """Half of a density, as a number, a text with its unit, or a table."""
    if isinstance(density, dict):
        return density | {"value": halved(density["value"])}
    number, *unit = str(density).split()
    return " ".join([f"{0.5 * float(number):g}", *unit]) if unit else 0.5 * float(number)


def at_half_density(style: Style) -> str:
    """Recipe of a style on its own head with half of its hairs; brows and lashes keep their single hairs."""
    tables = load(style.recipe)[1]
    grooms = {"hairs": tables} | {f"grooms.{name}.hairs": groom for name, groom in tables.get("grooms", {}).items()}
    text = variant(style.recipe, next(iter(style.shots.values()))[0])
    for place, groom in grooms.items():
        if density := groom.get("hairs", {}).get("density"):
            text += f"[{place}]\ndensity = {inline(halved(density))}\n"
    return text


def inline(value: Any) -> str:
    """A value of a recipe in TOML."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {inline(each)}" for key, each in value.items()) + " }"
    return f'"{value}"' if isinstance(value, str) else str(value)


def drawn(browser: Browser, style: Style) -> Image.Image:
    """Picture of a style in the review, from the side of its large picture."""
    with tempfile.TemporaryDirectory() as folder:
        examples, file = ROOT / "examples", Path(folder, "look.recipe.toml")
        shutil.copytree(examples, Path(folder, "examples"))  # a review reads no file outside of its project
        file.write_text(at_half_density(style).replace(str(examples), f"{folder}/examples"))
        server = Server(file)
        server.start()
        try:
            page = Review(browser.new_page(), server.address, pixels=0.1)  # draws where it is asked to
            width, height = DRAWN
            azimuth, elevation = next(iter(style.shots.values()))[1].view
            rectangle = f"{{ x: 0, y: 0, width: {width}, height: {height} }}"
            page.get(f"ringlet.viewer.frame({azimuth}, {elevation}, {rectangle})")
            page.get(f"ringlet.viewer.pace.needed = () => {DRAWINGS}")
            made = decoded(page.get(f"ringlet.viewer.drawAt({width}, {height}, false).toDataURL('image/png')"))
            page.page.close()
        finally:
            server.kill()
    return Image.fromarray(made.astype(np.uint8))


def main() -> None:
    names = sys.argv[1:]
    styles = [style for style in read_styles() if not names or style.name in names]
    rows = -(-len(styles) // COLUMNS)
    sheet = Image.new("RGB", (min(COLUMNS, len(styles)) * TILE[0], rows * TILE[1]), "white")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        for number, style in enumerate(styles):
            tile = drawn(browser, style).resize(TILE, Image.Resampling.LANCZOS)
            sheet.paste(tile, (number % COLUMNS * TILE[0], number // COLUMNS * TILE[1]))
            print(style.name, flush=True)
        browser.close()
    sheet.save(IMAGES / "review_looks.jpg", quality=84)


if __name__ == "__main__":
    main()
