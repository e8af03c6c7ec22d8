"""Makes the gallery: styles on their heads in one light, each with a close-up, and the page that shows them.

    .venv/bin/python docs/gallery.py            all pictures that are missing or out of date, one at a time
    .venv/bin/python docs/gallery.py bob 4C     those of these styles
    .venv/bin/python docs/gallery.py --page     only docs/gallery.md

Styles and their cameras stand in docs/gallery.toml. A picture holds a digest of its resolved recipe, its head and its
camera: it is rendered again when one of them changes, so that an interrupted run goes on. ``--again`` renders all.
"""

from __future__ import annotations

import argparse
import hashlib
import tempfile
import tomllib
from collections.abc import Iterator
from dataclasses import astuple, dataclass
from math import cos, radians, sin
from pathlib import Path

import numpy as np
from PIL import Image
from pxr import Gf, Usd, UsdGeom
from ringlet.groom.load import load

import ringlet

DOCS = Path(__file__).parent
ROOT, FOLDER = DOCS.parent, DOCS / "images" / "gallery"
HEADS = ("child", "adult")  # of a style that names none
COLUMNS = 6  # of small pictures
FOCAL_LENGTH, AWAY = 0.085, 1.9  # of the lens; from the camera to what it looks at [m]


PAGE_HEAD = """# Gallery

Styles on three heads in one light, which are made by the code in `examples/child`, `examples/adult` and
`examples/torso`.
Grooms have about 120 hairs per cm² of scalp or more, also in braids, twists, locs. Pictures are path-traced, with all
hairs.
Pictures that are not rendered yet are left out.
`python docs/gallery.py` makes the pictures, and this page from `docs/gallery.toml`.

A recipe fits the other head with two lines, as the middle of the skull and the names of regions are the same:

```toml
ringlet = 2
extends = "../looks/bob.recipe.toml"

[scalp]
file = "../adult/head.usdc"
mesh = "/adult/skin"
```
"""

PAGE_FOOT = """
## Faults, before and after

Each row is a fault in two places, with the picture of 28 November to the left and the present one to the right. Both
are drawn smaller than they are. `python docs/gallery_faults.py` takes the former from the history.

![Six rows of two pairs: soft and single hairs, roots, parts, types, locs, and the demo's still](images/faults.jpg)

| row | fault | what changed |
|---|---|---|
| 1 | hair looked painted: 3A, low bun | the denoiser keeps [single hairs](picture_bench.md#detail-of-hair) |
| 2 | pointed tufts at roots: box braids, Bantu knots | each strand takes hair from the whole of its section |
| 3 | wedge at a part, islands at a temple: wash-and-go, fade | hair grows up to a part, and hairlines fade |
| 4 | columns of one pitch, felt: 3C, 4B | families of several pitches, Z-shaped hairs, neutral black |
| 5 | beads along locs, skin through a shirt: locs, flat twists | hair is matted, and the bust dressed |
| 6 | a still of another time | `make demo` makes the still that is shown |

## What a groomer would still refuse

- Wash-and-go: coils are of one size near the part.
- Box braids: two braids hang off the cheek; on the child, one hangs over an eye.
- Two-strand twists: on the adult, one hangs over an eye.
- Hair down, two puffs, 3B: on the other head, the part is a wide bare wedge.
- Locs: at part lines, hair gathers in tufts; ridges along a loc are too even.
- Locs with new growth: hair leaves part lines in teeth, and baby hair is hardly seen.
- Finger waves: the last row breaks over the top of the ears, and the part runs on thinly from the crown to the nape.
- Wolf cut: clumps look matted, and the fringe is torn.
- Long box braids: some with their roots at the temples hang off the chest.
- Bantu knots: at the temple, hair of a section lies in a dark tuft next to its knot.
- Long braids, and looks with a part or sections on their second head, are shown with the distribution of
  hair that parts and sections had before.
- Cornrows: at the temple, the first hairs of a row begin on a straight line across it, not on the hairline.
- Flat twists: the rows over the ears are wide.
- Cornrows and flat twists: tails of neighbouring rows overlap at the nape.
- On the adult, rows turn aside at their last centimetre, at the nape. Strands of the cornrow over its right ear overlap
  one another.
"""


@dataclass(frozen=True)
class Shot:
    """A camera of the gallery.

    at:     point in the middle of the picture [cm]
    height: of what is seen at that distance [cm]
    view:   azimuth from the front to the left of the head, and elevation [degrees]
    size:   of the picture [pixels]
    """

    at: tuple[float, float, float]
    height: float
    view: tuple[float, float]
    size: tuple[int, int]
    samples: int


@dataclass(frozen=True)
class Style:
    """A style of the gallery: its recipe, the head of its large picture, and its cameras by the name of the picture."""

    name: str
    title: str
    text: str
    recipe: Path
    shots: dict[str, tuple[str, Shot]]


def read_styles() -> list[Style]:
    """The styles of docs/gallery.toml."""
    table = tomllib.loads((DOCS / "gallery.toml").read_text())
    common = table["camera"]
    return [read_style(entry, common) for entry in table["style"]]


def read_style(entry: dict, common: dict) -> Style:
    """A style with its cameras: one of each head that it fits, the large one first, and one close-up."""
    shots = {}
    order = sorted(entry.get("heads", HEADS), key=lambda head: head != entry["head"])
    for head, kind in zip(order, ("large", "other"), strict=False):
        camera = common["head"] | common[kind] | entry.get("camera", {}) | entry.get(f"camera_{head}", {})
        shots[head] = (head, shot(camera))
    shots["close"] = (order[0], shot(common["close"] | entry["close"]))
    return Style(entry["name"], entry["title"], entry["text"], ROOT / entry["recipe"], shots)


def shot(table: dict) -> Shot:
    return Shot(tuple(table["at"]), table["height"], tuple(table["view"]), tuple(table["size"]), table["samples"])


def variant(recipe: Path, head: str) -> str:
    """Text of a recipe for a head: the recipe with another scalp."""
    file = ROOT / "examples" / head / "head.usdc"
    return f'ringlet = 2\nextends = "{recipe}"\n[scalp]\nfile = "{file}"\nmesh = "/{head}/skin"\n'


def digest(recipe: Path, head: str, camera: Shot) -> str:
    """Digest of all that a picture is made of, but for the program and the folder that it is in."""
    parts = [
        load(recipe)[0].replace(f"{ROOT}/", ""),
        (ROOT / "examples" / head / "head.usdc").read_bytes(),
        repr(astuple(camera)),
    ]
    made = hashlib.sha256()
    for part in parts:
        made.update(part if isinstance(part, bytes) else part.encode())
    return made.hexdigest()


def stored_digest(path: Path) -> str:
    """Digest in a picture; empty without one."""
    if not path.exists():
        return ""
    with Image.open(path) as picture:
        return bytes(picture.info.get("comment", b"")).decode(errors="replace")


def due(styles: list[Style], again: bool, first_only: bool = False) -> Iterator[tuple[Style, list[str]]]:
    """Styles with the names of their pictures that are missing or out of date: first those of the style's own head."""
    for second in (False,) if first_only else (False, True):
        for style in styles:
            own = next(iter(style.shots.values()))[0]
            names = [
                name
                for name, (head, camera) in style.shots.items()
                if (head != own) == second
                and (again or stored_digest(picture_path(style, name)) != digest(style.recipe, head, camera))
            ]
            if names:
                yield style, names


def picture_path(style: Style, name: str) -> Path:
    return FOLDER / f"{style.name}_{name}.jpg"


def render(style: Style, names: list[str], engine: str) -> None:
    """Renders pictures of a style."""
    for name in names:
        head, camera = style.shots[name]
        mark = digest(style.recipe, head, camera)  # before a recipe is edited while this runs
        picture = photograph(variant(style.recipe, head), camera, engine)
        picture.save(picture_path(style, name), quality=84, comment=mark.encode())
        print(picture_path(style, name).relative_to(ROOT), flush=True)


def photograph(recipe: str, camera: Shot, engine: str, fraction: float = 1.0) -> Image.Image:
    """Picture of the hair of a recipe's text; ``fraction`` of the hairs, each wider."""
    with tempfile.TemporaryDirectory() as folder:
        text, groom, hair, still = (Path(folder) / name for name in ("a.recipe.toml", "a.usdc", "a.hair.usdc", "a.png"))
        text.write_text(recipe)
        ringlet.write_groom(ringlet.build_groom(text), groom)
        ringlet.write_hairs(groom, hair, fraction=fraction, wider=fraction < 1.0)
        add_camera(hair, "camera", camera)
        width, height = camera.size
        ringlet.write_still(
            hair, still, width=width, height=height, samples=camera.samples, camera="/camera", engine=engine
        )
        return Image.open(still).convert("RGB")


def add_camera(stage_file: Path, name: str, camera: Shot) -> None:
    """Adds a camera to a stage: its prim is ``/name``."""
    stage = Usd.Stage.Open(str(stage_file))
    unit = UsdGeom.GetStageMetersPerUnit(stage)
    azimuth, elevation = map(radians, camera.view)
    backward = np.array([sin(azimuth) * cos(elevation), sin(elevation), cos(azimuth) * cos(elevation)])
    right = np.array([cos(azimuth), 0.0, -sin(azimuth)])
    matrix = np.eye(4)
    matrix[:3, :3] = right, np.cross(backward, right), backward
    matrix[3, :3] = (0.01 * np.array(camera.at) + AWAY * backward) / unit
    prim = UsdGeom.Camera.Define(stage, f"/{name}")
    prim.MakeMatrixXform().Set(Gf.Matrix4d(*matrix.ravel().tolist()))
    tenth = 0.1 * unit
    aperture = 0.01 * camera.height * FOCAL_LENGTH / AWAY / tenth
    prim.CreateFocalLengthAttr(FOCAL_LENGTH / tenth)
    prim.CreateVerticalApertureAttr(aperture)
    prim.CreateHorizontalApertureAttr(aperture * camera.size[0] / camera.size[1])
    prim.CreateFocusDistanceAttr(AWAY / unit)
    stage.GetRootLayer().Save()


def write_page(styles: list[Style]) -> None:
    """Writes docs/gallery.md: small pictures of all styles, then every style with its pictures and its recipe."""
    cells = [
        f"{linked(style, next(iter(style.shots)))} [{style.title}](#{slug(style.title)})".strip() for style in styles
    ]
    rows = [cells[first : first + COLUMNS] for first in range(0, len(cells), COLUMNS)]
    overview = table([row + [""] * (COLUMNS - len(row)) for row in rows])
    foot = [PAGE_FOOT, *outdated(styles)]
    (DOCS / "gallery.md").write_text("\n".join([PAGE_HEAD, overview, *map(section, styles), *foot]))


def outdated(styles: list[Style]) -> list[str]:
    """A list for the page of the pictures that are there but show an earlier recipe, if there are any."""
    of_styles = [
        (style.title, [name for name in due_names if picture_path(style, name).exists()])
        for style, due_names in due(styles, again=False)
    ]
    lines = [f"- {title}: {', '.join(names)}" for title, names in of_styles if names]
    return ["Pictures that show an earlier recipe or operator:\n", *lines, ""] if lines else []


def section(style: Style) -> str:
    """Heading, pictures and recipe of a style; its first picture is the large one."""
    first, *others = (name for name in style.shots if name != "close")
    recipe = style.recipe.relative_to(ROOT)
    return f"""
## {style.title}

{style.text} [`{recipe}`](../{recipe})

{table([[linked(style, name) for name in (first, "close", *others)]])}

<details><summary>Recipe</summary>

```{{literalinclude}} ../{recipe}
:language: toml
```

</details>
"""


def linked(style: Style, name: str) -> str:
    """A picture that opens itself; empty where it is not there yet."""
    if not picture_path(style, name).exists():
        return ""
    file = f"images/gallery/{style.name}_{name}.jpg"
    what = "close-up" if name == "close" else f"on the {name}"
    return f"[![{style.title}, {what}]({file})]({file})"


def table(rows: list[list[str]]) -> str:
    """A table of Markdown with an empty head."""
    columns = len(rows[0])
    lines = [[""] * columns, ["---"] * columns, *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def slug(title: str) -> str:
    """The anchor of a heading."""
    kept = "".join(letter for letter in title.lower() if letter.isalnum() or letter in " -_")
    return kept.replace(" ", "-")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("styles", nargs="*", help="names of styles; all by default")
    parser.add_argument("--again", action="store_true", help="render pictures that are up to date, too")
    parser.add_argument("--first", action="store_true", help="only pictures on the head that a style is shown on first")
    parser.add_argument("--engine", default="scalar", help="of the renderer: scalar, or llvm, which is faster")
    parser.add_argument("--page", action="store_true", help="write docs/gallery.md, and render nothing")
    chosen = parser.parse_args()
    styles = read_styles()
    FOLDER.mkdir(exist_ok=True)
    wanted = [] if chosen.page else [style for style in styles if not chosen.styles or style.name in chosen.styles]
    for style, names in due(wanted, chosen.again, chosen.first):
        render(style, names, chosen.engine)
    write_page(styles)  # with the pictures that are there now


if __name__ == "__main__":
    main()
