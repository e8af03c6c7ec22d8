"""Makes the pictures of hair in files: docs/adopt.md, convert.md, from_xgen.md and hair_files.md.

python docs/format_pictures.py [adopted | game MOHAWK.tfx | formats | levels]
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from ringlet.data.camera import Camera
from ringlet.data.curves import Curves
from ringlet.data.detail import HAIR_PIXELS, LEVELS
from ringlet.data.pigment import DYE, DYE_AMOUNT, MELANIN
from ringlet.io import open_scene, read_stage
from ringlet.picture import PosedBody
from ringlet.picture.sheet import arrange_tiles, draw_tile, frame_all
from ringlet.picture.strands import hair_widths

import ringlet

ROOT = Path(__file__).parents[1]
IMAGES = ROOT / "docs/images"
VIEW = (28.0, 6.0)  # degrees
SAMPLES = 24
LARGE = 300  # of a tile [pixels]
Seen = tuple[Sequence[PosedBody], Curves]


def adopted(folder: Path) -> None:
    """Hair of a file without names of clumps: as given, its locks, with wider curls, and in motion."""
    known = folder / "known.recipe.toml"
    known.write_text(
        f'ringlet = 2\nextends = "{ROOT}/examples/types/3C.recipe.toml"\n[locks]\ncount = 600\n'
        '[hairs]\ndensity = false\nper_lock = 16\nwidth = "0.2 mm"\n'
    )
    recipe = ringlet.read_recipe(known)
    ringlet.write_groom(ringlet.build_groom(recipe), folder / "groom.usdc")
    ringlet.write_hairs(folder / "groom.usdc", folder / "all.usdc")
    ringlet.convert(folder / "all.usdc", folder / "hair.hair", only="hairs", unit=1.0)
    ringlet.adopt(folder / "hair.hair", folder / "adopted.recipe.toml", head=recipe.scalp_file)
    tiles = {"the given hairs": _with(folder / "hair.hair", folder / "all.usdc")}
    tiles |= _adopted(folder, head(), wider=2.0, frame=16)
    _save("adopted", tiles, (300, 330), VIEW)


def game(folder: Path, file: Path) -> None:
    """Hair of a game: as given, straightened by a setting, and in motion."""
    ringlet.adopt(file, folder / "adopted.recipe.toml")
    tiles = {"the given hairs": _with(file)}
    tiles |= _adopted(folder, [], wider=None, frame=16)
    _save("adopted_game", tiles, (300, 330), (60.0, 10.0))


def _adopted(folder: Path, bodies: list[PosedBody], wider: float | None, frame: int) -> dict[str, Seen]:
    """Hairs of an adopted recipe: in a colour for each lock, with wider curls, and at a frame of the nod."""
    path = folder / "adopted.recipe.toml"
    groom = ringlet.build_groom(path)
    hairs = ringlet.build_hairs(groom).curves
    bodies = bodies or [PosedBody(groom.scalp, groom.scalp.points)]
    found: dict[str, Seen] = {f"{len(groom.locks):,} locks": (bodies, colored(hairs, hairs.curve["lock"]))}
    recipe = ringlet.read_recipe(path)
    if wider is not None and recipe.curl is not None and recipe.curl.width is not None:
        settings = {name: getattr(recipe.curl, name) for name in ("width", "pitch")}
        scaled = {name: one.model_copy(update={"value": wider * one.value}) for name, one in settings.items()}
        changed = recipe.model_copy(update={"curl": recipe.curl.model_copy(update=scaled)})
        found["width and pitch of the curl × 2"] = (bodies, ringlet.build_hairs(ringlet.build_groom(changed)).curves)
    shot = folder / "nod.shot.toml"
    text = (ROOT / "examples/child/nod.shot.toml").read_text()
    shot.write_text(text.replace("curls.recipe.toml", path.name).replace("[1, 48]", f"[1, {frame}]"))
    ringlet.write_groom(groom, folder / "adopted.usdc")
    ringlet.write_simulation(ringlet.read_shot(shot), groom, folder / "adopted.usdc", folder / "cache.usdc")
    ringlet.write_hairs(folder / "cache.usdc", folder / "moving.usdc", frames=(frame, frame))
    found[f"simulated, frame {frame}"] = _with(folder / "moving.usdc", frame=frame)
    return found


def formats(folder: Path) -> None:
    """One groom in each format, as it is read back."""
    known = folder / "known.recipe.toml"
    known.write_text(f'ringlet = 2\nextends = "{ROOT}/examples/types/3B.recipe.toml"\n')
    ringlet.write_groom(ringlet.build_groom(known), folder / "groom.usdc")
    ringlet.write_hairs(folder / "groom.usdc", folder / "hair.usdc", fraction=0.15, wider=True)
    tiles = {"hair.usdc": _with(folder / "hair.usdc")}
    for suffix in ("abc", "hair", "tfx", "obj"):
        path = folder / f"hair.{suffix}"
        done = ringlet.convert(folder / "hair.usdc", path, unit=None if suffix == "abc" else 1.0)
        print(path.name, f"{path.stat().st_size / 1e6:.1f} MB", *done["lost"], sep="\n  ")
        tiles[path.name] = _with(path)
    _save("formats", tiles, (230, 270), VIEW)


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
            ("difference × 4, white is none", "", enlarged((255 - 4 * difference).clip(0, 255).astype(np.uint8))),
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
    made.curve[MELANIN] = np.full(len(made), 0.1, np.float32)
    made.curve[DYE] = (0.05 + 0.75 * hues[groups]).astype(np.float32)
    made.curve[DYE_AMOUNT] = np.ones(len(made), np.float32)
    return made


def _with(path: Path, head: Path | None = None, frame: float | None = None) -> Seen:
    """Hairs of a file, with its surfaces or those of another."""
    with open_scene(path) as scene:
        posed = scene.posed(frame)
        hairs, bodies = posed.sets[0].curves, posed.bodies
        at = [(mesh, mesh.points if clip is None or frame is None else clip.at(frame)) for mesh, clip in bodies]
    if head is not None:
        return _with(head)[0], hairs
    return [PosedBody(mesh, points) for mesh, points in at], hairs


def _save(name: str, tiles: dict[str, Seen], size: tuple[int, int], view: tuple[float, float]) -> None:
    """Writes pictures side by side, in one camera."""
    camera = frame_all(list(tiles.values()), size, view)
    drawn = [(label, "", draw_tile(*seen, camera, size, None, SAMPLES)) for label, seen in tiles.items()]
    page = arrange_tiles(drawn, len(drawn), size, "", "")
    page.save(IMAGES / f"{name}.jpg", quality=84)


def main() -> None:
    """Makes the pictures that are asked for by name, or all that need no file."""
    made = {"adopted": adopted, "game": game, "formats": formats, "levels": levels}
    name, *files = sys.argv[1:] or ["all"]
    for one in ("adopted", "formats", "levels") if name == "all" else (name,):
        with tempfile.TemporaryDirectory() as folder:
            made[one](Path(folder), *map(Path, files))


if __name__ == "__main__":
    main()
