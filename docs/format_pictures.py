"""Makes the pictures of hair in files: docs/adopt.md, convert.md, from_blender.md, into_unreal.md and hair_files.md.

python docs/format_pictures.py [adopted | curled | archive | formats | levels]
curled and archive need `make blender`.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from ringlet.data.camera import Camera
from ringlet.data.curves import Curves
from ringlet.data.detail import HAIR_PIXELS, LEVELS
from ringlet.data.pigment import DYE, DYE_AMOUNT, MELANIN
from ringlet.io import open_scene, read_stage
from ringlet.io.usd.curves import curve_widths
from ringlet.picture import PosedBody
from ringlet.picture.sheet import arrange_tiles, draw_tile, frame_all
from ringlet.picture.strands import hair_widths

import ringlet

ROOT = Path(__file__).parents[1]
IMAGES = ROOT / "docs/images"
VIEW = (28.0, 6.0)  # degrees
SAMPLES, FRAME = 16, 10
LARGE = 300  # of a tile [pixels]
Seen = tuple[Sequence[PosedBody], Curves]


def adopted(folder: Path) -> None:
    """Hair of a file without names of clumps: as given, its locks, with wider curls, and in motion."""
    known = folder / "known.recipe.toml"
    known.write_text(
        f'ringlet = 2\nextends = "{ROOT}/examples/types/3C.recipe.toml"\n[locks]\ncount = 240\n'
        '[hairs]\ndensity = false\nper_lock = 24\nwidth = "0.3 mm"\n'
    )
    recipe = ringlet.read_recipe(known)
    ringlet.write_groom(ringlet.build_groom(recipe), folder / "groom.usdc")
    ringlet.write_hairs(folder / "groom.usdc", folder / "all.usdc")
    ringlet.convert(folder / "all.usdc", folder / "hair.hair", only="hairs", unit=1.0)
    ringlet.adopt(folder / "hair.hair", folder / "adopted.recipe.toml", head=recipe.scalp_file, locks=240)
    tiles = {"the given hairs": (head(), _with(folder / "hair.hair")[1]), **_adopted(folder)}
    _save("adopted", tiles, (300, 330), VIEW)


def curled(folder: Path) -> None:
    """Curves that Blender's own nodes curl, exported as USD: as given, and as they are adopted."""
    head_file, curves = ROOT / "examples/child/head.usdc", folder / "curves.usdc"
    _in_blender("blender_curves.py", head_file, curves)
    ringlet.adopt(curves, folder / "adopted.recipe.toml", head=head_file, mesh="/child/skin")
    tiles = {"exported by Blender": (head(), _with(curves)[1]), **_adopted(folder)}
    _save("from_blender", tiles, (300, 330), VIEW)


def archive(folder: Path) -> None:
    """Guides and hairs of an Alembic archive, as Blender opens it."""
    _thinned(folder)
    ringlet.convert(folder / "hair.usdc", folder / "hair.abc")
    _in_blender("blender_archive.py", folder / "hair.abc", folder)
    names = ("guides", "hairs")
    pictures = [np.asarray(Image.open(folder / f"{name}.jpg").convert("RGB")) for name in names]
    tiles = [(f"{name} of hair.abc", "", picture) for name, picture in zip(names, pictures, strict=True)]
    arrange_tiles(tiles, 2, pictures[0].shape[1::-1], "", "").save(IMAGES / "archive.jpg", quality=84)


def _in_blender(script: str, *words: Path) -> None:
    """Runs a script of this folder in Blender's Python."""
    clean = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    subprocess.run([ROOT / ".venv-blender/bin/python", ROOT / "docs" / script, *words], check=True, env=clean)


def _adopted(folder: Path) -> dict[str, Seen]:
    """Hairs of an adopted recipe: in a color for each lock, with curls twice as wide, and at a frame of the nod."""
    path, bodies = folder / "adopted.recipe.toml", head()
    groom, recipe = ringlet.build_groom(path), ringlet.read_recipe(path)
    hairs = ringlet.build_hairs(groom).curves
    curl = recipe.curl
    assert curl is not None and curl.width is not None
    twice = curl.width.model_copy(update={"value": 2.0 * curl.width.value})
    wider = ringlet.build_groom(recipe.model_copy(update={"curl": curl.model_copy(update={"width": twice})}))
    shot = folder / "nod.shot.toml"
    text = (ROOT / "examples/child/nod.shot.toml").read_text()
    for was, now in (("curls", "adopted"), ("[1, 48]", f"[1, {FRAME}]"), ("preroll = 12", "preroll = 0")):
        text = text.replace(was, now)
    shot.write_text(text)
    ringlet.write_groom(groom, folder / "adopted.usdc")
    cache = folder / "cache.usdc"
    ringlet.write_simulation(
        ringlet.read_shot(shot), groom, folder / "adopted.usdc", cache, checkpoints=folder / "cache.part"
    )
    ringlet.write_hairs(cache, folder / "moving.usdc", frames=(FRAME, FRAME))
    return {
        f"{len(groom.locks):,} locks": (bodies, colored(hairs, hairs.curve["lock"])),
        "curls twice as wide": (bodies, ringlet.build_hairs(wider).curves),
        f"simulated, frame {FRAME}": _with(folder / "moving.usdc", frame=FRAME),
    }


def formats(folder: Path) -> None:
    """One groom in each format, as it is read back."""
    _thinned(folder)
    tiles = {"hair.usdc": _with(folder / "hair.usdc")}
    for suffix in ("abc", "hair", "tfx", "obj"):
        path = folder / f"hair.{suffix}"
        done = ringlet.convert(folder / "hair.usdc", path, unit=None if suffix == "abc" else 1.0)
        print(path.name, f"{path.stat().st_size / 1e6:.1f} MB", *done["lost"], sep="\n  ")
        tiles[path.name] = _with(path)
    _save("formats", tiles, (230, 270), VIEW)


def _thinned(folder: Path) -> None:
    """Writes ``hair.usdc``: a groom of type 3B with few, wide hairs."""
    ringlet.write_groom(ringlet.build_groom(ROOT / "examples/types/3B.recipe.toml"), folder / "groom.usdc")
    ringlet.write_hairs(folder / "groom.usdc", folder / "hair.usdc", fraction=0.15, wider=True)


def levels(_folder: Path) -> None:
    """All hairs against each level of detail, at the size on the screen for which it is meant."""
    groom = ringlet.build_groom(ROOT / "examples/child/ribbon.recipe.toml")
    every, bodies = ringlet.build_hairs(groom).curves, head()
    camera = frame_all([(bodies[:1], every)], (1, 1), VIEW)
    tiles: list[tuple[str, str, NDArray[np.uint8]]] = []
    for number, level in enumerate(LEVELS[1:], 1):
        hairs = ringlet.build_hairs(groom, fraction=level.share, wider=True, point_share=level.points).curves
        pixel = float(hair_widths(hairs).max()) / HAIR_PIXELS
        size = round(across(camera, every) / pixel)
        samples = min(512, round(16 * (500 / size) ** 2))  # of larger pictures less, since the eye smooths them
        pictures = [draw_tile(bodies, one, camera, (size, size), None, samples) for one in (every, hairs)]
        difference = np.abs(pictures[0].astype(int) - pictures[1])
        print(f"LOD{number}: mean difference {difference.mean():.1f} of 255")
        about = f"{1e3 * pixel:.1f} mm a pixel"
        tiles += [
            (f"all {len(every):,} hairs", about, enlarged(pictures[0])),
            (f"LOD{number}: {len(hairs):,} hairs", about, enlarged(pictures[1])),
            ("four times the difference", "", enlarged((255 - 4 * difference).clip(0, 255).astype(np.uint8))),
        ]
    page = arrange_tiles(tiles, 3, (LARGE, LARGE), "", "")
    page.save(IMAGES / "levels.webp", quality=80, method=6)


def enlarged(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The middle of a picture, of a small one in larger pixels, shape (LARGE, LARGE, 3)."""
    times = -(-LARGE // len(picture))
    whole = picture.repeat(times, axis=0).repeat(times, axis=1)
    begin = (len(whole) - LARGE) // 2
    return whole[begin : begin + LARGE, begin : begin + LARGE]


def across(camera: Camera, hairs: Curves) -> float:
    """Width that the camera sees at the distance of the hairs [m]."""
    distance = np.linalg.norm(hairs.points.mean(axis=0) - camera.origin)
    return float(2.0 * camera.slopes[0] * distance)


def head() -> list[PosedBody]:
    """Skin of the example's head, then eyes and what else is on it."""
    return [PosedBody(body.mesh, body.mesh.points) for body in read_stage(ROOT / "examples/child/head.usdc")[0]]


def colored(hairs: Curves, groups: NDArray[np.integer]) -> Curves:
    """Hairs in a colour for each group."""
    made = hairs.take(np.arange(len(hairs)))
    hues = np.random.default_rng(2).random((int(groups.max()) + 1, 3))
    made.curve[MELANIN] = np.full(len(made), 0.5, np.float32)
    made.curve[DYE] = (0.01 + 0.3 * hues[groups] ** 3).astype(np.float32)
    made.curve[DYE_AMOUNT] = np.ones(len(made), np.float32)
    return made


def _with(path: Path, frame: float | None = None) -> Seen:
    """Hairs of a file, with its surfaces."""
    with open_scene(path) as scene:
        posed = scene.posed(frame)
        hairs, bodies = posed.sets[0].curves, posed.bodies
        at = [(mesh, mesh.points if clip is None or frame is None else clip.at(frame)) for mesh, clip in bodies]
    hairs.point["width"] = curve_widths(hairs)
    return [PosedBody(mesh, points) for mesh, points in at], hairs


def _save(name: str, tiles: dict[str, Seen], size: tuple[int, int], view: tuple[float, float]) -> None:
    """Writes pictures side by side, in one camera."""
    camera = frame_all(list(tiles.values()), size, view)
    drawn = [(label, "", draw_tile(*seen, camera, size, None, SAMPLES)) for label, seen in tiles.items()]
    page = arrange_tiles(drawn, len(drawn), size, "", "")
    page.save(IMAGES / f"{name}.jpg", quality=84)


def main() -> None:
    """Makes the picture that is asked for by name, or all."""
    made = {"adopted": adopted, "curled": curled, "archive": archive, "formats": formats, "levels": levels}
    for name in sys.argv[1:] or made:
        with tempfile.TemporaryDirectory() as folder:
            made[name](Path(folder))


if __name__ == "__main__":
    main()
