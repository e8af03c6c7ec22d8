"""Finished hair of any program as a groom with a recipe."""

from __future__ import annotations

import os
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ringlet import _core, io
from ringlet import groom as grooms
from ringlet.adoption import Clumps, Coils, each_alone, find_clumps, fit_coils
from ringlet.adoption.coil import no_coils
from ringlet.adoption.scalp import scalp_of_roots
from ringlet.api.conversion import source_space_of
from ringlet.api.progress import Progress, stage
from ringlet.data import limits
from ringlet.data.curves import Curves, offsets_from_counts
from ringlet.data.errors import UserError
from ringlet.data.files import check_place, replacing
from ringlet.data.groom import OFFSETS, Groom
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.mesh import Mesh
from ringlet.data.random import Random
from ringlet.data.reads import recorded
from ringlet.data.resampling import Resampling
from ringlet.data.settings import FORMAT
from ringlet.data.stage import StageSpace
from ringlet.data.toml import to_toml
from ringlet.groom import adopted
from ringlet.groom.operators import Context, Drawn, Resample
from ringlet.groom.scalp import Scalp
from ringlet.io.formats import joined

MOST_POINTS = 160  # of a hair that is adopted
FEWEST_POINTS = 24
SHAPE_POINTS = 40  # of the centre line of a lock
FARTHEST_ROOT = 0.05  # [m] of a root from the head
WIDTH, PITCH, HAND, PHASE = (f"adopted_{name}" for name in ("width", "pitch", "hand", "phase"))
COILED = 0.2  # share of the locks that must be coiled for the recipe to have a curl
MOST_PITCH = 0.9  # [m] of a lock, as the recipe has it
MEASURED = 2000  # hairs whose distances are measured
TURN_POINTS = 8  # points of a turn of a lock


@dataclass
class _Hair:
    """Finished hairs, evenly resampled.

    points:  [m], shape (hairs, k, 3)
    lengths: [m], shape (hairs,)
    widths:  diameters at even steps [m], shape (hairs, k)
    """

    curves: Curves
    points: NDArray[np.float64]
    lengths: NDArray[np.float64]
    widths: NDArray[np.float64]


@recorded()
def adopt(
    source: Path | str,
    recipe: Path | str,
    *,
    head: Path | str | None = None,
    mesh: str | None = None,
    locks: int | None = None,
    source_unit: float | None = None,
    source_up: Literal["Y", "Z"] | None = None,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Makes a recipe of finished hair, whatever program made it: USD, Alembic, ``.hair``, ``.tfx`` or OBJ.

    Clumps become locks, each with a centre line and a curl of its own width, pitch, hand and phase. What a curl does
    not fit stays with its lock, and every hair keeps its offsets from its lock, so that the groom is the hair as it
    was; settings of the recipe change it. Beside the recipe NAME.recipe.toml stand NAME.guides.usdc, NAME.hairs.usdc
    and, for hair without a head, NAME.scalp.usdc.

    head:  USD or OBJ file of the head; by default the mesh of the source on which the roots are, or else a surface
           through the roots
    mesh:  prim of the head; needed where the file has several
    locks: number of locks; by default one for each clump that is found
    source_unit, source_up: unit [m] and up-axis of a source that stores neither

    Returns the numbers of ``hairs`` and ``locks``, how ``clumps`` were found, ``coiled`` locks, the medians of
    ``width`` and ``pitch`` [m] and the share ``right_handed`` of these, and ``error``: the median and the 95th
    percentile of the distances between the hair as it was and as the recipe makes it [m].
    """
    target = Path(recipe)
    if target.suffix != ".toml":
        raise UserError(f"{target}: ends in '{target.suffix}'; must end in .toml")
    if locks is not None:
        limits.check_count("locks", locks, 1_000_000)
    stem = target.name.removesuffix(".toml").removesuffix(".recipe")
    files = {name: target.with_name(f"{stem}.{name}.usdc") for name in ("guides", "hairs", "scalp")}
    with stage(progress, "read"):
        space = source_space_of(source, source_unit, source_up)
        hair, scalp, scalp_table, prim = _read(source, head, mesh, space, files)
        for path in (target, *files.values()):
            check_place(path)
    with stage(progress, "clumps"):
        clumps = find_clumps(hair.points, hair.lengths, hair.curves.curve, locks)
    with stage(progress, "curls"):
        guides, coils = _guides(hair, clumps, scalp)
    text = to_toml(_tables(stem, files, scalp_table, coils, hair, _largest_distance(scalp, guides)))
    with stage(progress, "groom"):
        groom = _fitted(text, target, scalp, guides, hair.points[clumps.middle])
    with stage(progress, "hairs"):
        error = _add_hairs(groom, hair, clumps)
    if prim is not None:
        io.write_head(source, prim, files["scalp"])
    _write(groom, guides, text, target, files, with_scalp=head is None and prim is None)
    coiled = coils.coiled
    return {
        "hairs": len(hair.points),
        "locks": len(clumps),
        "clumps": clumps.source,
        "coiled": int(coiled.sum()),
        "width": _median(coils.width[coiled], 0.0),
        "pitch": _median(coils.pitch[coiled], 0.0),
        "right_handed": float((coils.hand[coiled] > 0.0).mean()) if coiled.any() else 0.0,
        "error": {"median": float(np.median(error)), "95": float(np.quantile(error, 0.95))},
    }


@recorded()
def adopt_groom(
    source: Path | str,
    *,
    head: Path | str | None = None,
    mesh: str | None = None,
    head_file: Path | str | None = None,
    locks: int | None = None,
    source_unit: float | None = None,
    source_up: Literal["Y", "Z"] | None = None,
) -> Groom:
    """A groom of finished hair without a recipe, to be simulated as it is: each curve is a lock.

    head_file: where to write a reference to the head of a USD source, which moves with it; without it the head is
               stored with the groom, and stands still
    locks:     a number of locks, whose middle hairs are simulated, and carry the others
    head, mesh, source_unit, source_up: as for ``adopt``
    """
    target = Path(source).absolute().with_suffix(".recipe.toml")
    files = {name: target.with_suffix(f".{name}.usdc") for name in ("guides", "hairs", "scalp")}
    hair, scalp, table, prim = _read(source, head, mesh, source_space_of(source, source_unit, source_up), files)
    clumps = each_alone(len(hair.points)) if locks is None else find_clumps(hair.points, hair.lengths, {}, locks)
    coils = no_coils(hair.points[clumps.middle])
    guides = _packed(coils.center)
    tables = _tables(target.stem, files, table, coils, hair, _largest_distance(scalp, guides))
    groom = _fitted(to_toml(tables), target, scalp, guides, hair.points[clumps.middle])
    _add_hairs(groom, hair, clumps)
    groom.recipe = None
    if prim is not None and head_file is not None:
        io.write_head(source, prim, head_file)
        groom.scalp_file, groom.scalp_prim = Path(head_file), io.head_path(prim)
    elif head is not None:
        groom.scalp_file, groom.scalp_prim = Path(head), mesh
    groom.space = io.read_space(groom.scalp_file) if groom.scalp_file else StageSpace()
    return groom


def is_finished_hair(path: Path | str) -> bool:
    """Whether a file holds curves that are no groom of Ringlet's."""
    if Path(path).suffix.lower() in (".abc", ".hair", ".tfx", ".obj"):
        return True
    return Path(path).suffix.lower() in (".usd", ".usda", ".usdc", ".usdz") and not io.is_groom(path)


def _read(
    source: Path | str, head: Path | str | None, mesh: str | None, space: StageSpace | None, files: dict[str, Path]
) -> tuple[_Hair, Mesh, dict[str, Any], str | None]:
    """The hairs, the scalp, the table of the recipe that names it, and its prim where it is one of the source."""
    with io.open_scene(source, space) as scene:
        if not scene.sets:
            raise UserError(f"{source}: has no curves; export the hair as curves or choose another file")
        curves = joined(scene.shown).distinct().check(str(source))
        bodies = [body for body, _ in scene.bodies]
    hair = _resampled(curves)
    roots = hair.points[:, 0]
    if head is not None:
        table = {"file": _relative(head, files["scalp"]), **({"mesh": mesh} if mesh else {})}
        return hair, io.read_mesh(head, mesh), table, None
    if Path(source).suffix.lower().startswith(".usd") and bodies:
        near = min(io.read_bodies(source), key=lambda body: _median_distance(body.mesh, roots))
        return hair, near.mesh, {"file": files["scalp"].name, "mesh": io.head_path(near.prim)}, near.prim

    own = min(bodies, key=lambda body: _median_distance(body, roots)) if bodies else scalp_of_roots(roots, str(source))
    return hair, replace(own, name="scalp"), {"file": files["scalp"].name}, None


def _relative(path: Path | str, neighbour: Path) -> str:
    """Name of a file for a recipe that is in the folder of another."""
    return Path(os.path.relpath(Path(path).absolute(), neighbour.absolute().parent)).as_posix()


def _root_distances(mesh: Mesh, roots: NDArray) -> NDArray[np.float64]:
    """Distances of roots from a mesh [m], shape (k,)."""
    return _core.bind_roots(mesh.points, mesh.triangles, np.ascontiguousarray(roots, np.float64))[2]


def _median_distance(mesh: Mesh, roots: NDArray) -> float:
    return float(np.median(_root_distances(mesh, roots)))


def _resampled(curves: Curves) -> _Hair:
    count = int(np.clip(curves.counts.max(), FEWEST_POINTS, MOST_POINTS))
    resampling = Resampling(curves, count)
    points = resampling.values(np.asarray(curves.points, np.float64)).reshape(len(curves), count, 3)
    if "width" in curves.point:
        widths = resampling.values(np.asarray(curves.point["width"], np.float64)).reshape(len(curves), count)
    else:
        own = np.asarray(curves.curve.get("width", np.full(len(curves), 7e-5)), np.float64)
        widths = np.repeat(own[:, None], count, axis=1)
    return _Hair(curves, points, np.asarray(curves.lengths(), np.float64), widths)


def _guides(hair: _Hair, clumps: Clumps, scalp: Mesh) -> tuple[Curves, Coils]:
    """The centre lines of the locks, with what was fitted to each as attributes."""
    target = hair.points[clumps.middle]
    coils = fit_coils(target)
    along = Resampling(_packed(coils.center), SHAPE_POINTS)
    center = along.values(coils.center.reshape(-1, 3)).reshape(len(clumps), SHAPE_POINTS, 3)
    guides = _packed(center)
    coiled = coils.coiled
    width, pitch = (_median(values[coiled], 1.0) for values in (coils.width, coils.pitch))
    straight = hair.lengths[clumps.middle]  # pitch of a lock without a coil: a turn of no width
    guides.curve = {
        WIDTH: (coils.width / width).astype(np.float32),
        PITCH: (np.minimum(np.where(coiled, coils.pitch, straight), MOST_PITCH) / pitch).astype(np.float32),
        HAND: (coils.hand > 0.0).astype(np.float32),
        PHASE: np.zeros(len(clumps), np.float32),
    }
    return guides, coils


def _largest_distance(scalp: Mesh, guides: Curves) -> float:
    """Largest distance of roots from the scalp [m]; raises UserError for hair that does not grow there."""
    distance = _root_distances(scalp, guides.roots)
    if (far := float(np.median(distance))) > FARTHEST_ROOT:
        raise UserError(
            f"{scalp.name}: half of the roots are more than {far:.3g} m away from it; see whether both files have the "
            "same unit and axis, or name the head of this hair with --head"
        )
    return float(distance.max())


def _tables(
    stem: str, files: dict[str, Path], scalp: dict[str, Any], coils: Coils, hair: _Hair, distance: float
) -> dict[str, Any]:
    """The tables of the recipe."""
    coiled = coils.coiled
    tables: dict[str, Any] = {
        "ringlet": FORMAT,
        "name": stem,
        "unit": "mm",
        "scalp": scalp,
        "guides": {"file": files["guides"].name, "tolerance": f"{1e3 * (1.1 * distance + 1e-3):.4g} mm"},
        "locks": {"points": _lock_points(hair, coils), "shape_points": SHAPE_POINTS},
    }
    if coiled.mean() >= COILED:
        width, pitch = float(np.median(coils.width[coiled])), float(np.median(coils.pitch[coiled]))
        tables["curl"] = {
            "width": {"value": f"{1e3 * width:.6g} mm", "map": WIDTH},
            "pitch": {"value": f"{1e3 * pitch:.6g} mm", "map": PITCH},
            "right_handed": {"value": 1.0, "map": HAND},
            "phase": {"value": 360.0, "map": PHASE},
            "phase_spread": 0.0,
            "irregularity": 0.0,
            "start": f"{1e3 * min(pitch, 0.5):.4g} mm",
        }
    return {**tables, "collide": {"margin": 0.0}, "hairs": {"file": files["hairs"].name}}


def _lock_points(hair: _Hair, coils: Coils) -> int:
    """Points of a lock: those of the hairs, or more where its turns need them."""
    most = int(np.ceil(TURN_POINTS * float(coils.turns.max(initial=0.0))))
    return int(np.clip(max(hair.points.shape[1], most), 4, limits.POINTS))


def _fitted(text: str, path: Path, scalp: Mesh, guides: Curves, target: NDArray[np.float64]) -> Groom:
    """The groom of the text of a recipe and its guides, which get the phases of their curls and what these do not fit.

    target: points of the locks as they were [m], evenly spaced, shape (locks, k, 3)
    """
    recipe = grooms.parse_recipe(text, path)
    assert isinstance(recipe.guides, Drawn) and recipe.locks.points is not None
    surface, points = Scalp(scalp, None), recipe.locks.points
    context = Context(recipe.seed, surface, "curl", points)
    wanted = _packed(target)
    wanted = Resampling(wanted, points).values(wanted.points).reshape(len(guides), points, 3)
    shapes = recipe.locks.apply(recipe.guides.apply(guides, context), context)
    context = replace(context, shapes=shapes)
    curl = recipe.curl or Resample(points=points)
    curled = curl.apply(shapes, context)
    if recipe.curl is not None:
        turned = adopted.phase_of(wanted, curled, shapes, context)
        shapes.curve[PHASE] = guides.curve[PHASE] = turned.astype(np.float32)
        curled = curl.apply(shapes, context)
    guides.curve[OFFSETS] = adopted.residual_of(wanted, curled, shapes, context)
    return grooms.make_groom(recipe, scalp, drawn_guides=guides)


def _add_hairs(groom: Groom, hair: _Hair, clumps: Clumps) -> NDArray[np.float64]:
    """Gives a groom its hairs; returns how far what they were is from them [m], shape (hairs, points)."""
    shuffled = Random(1, "adopt").uniform(np.arange(len(clumps.of)))
    shuffled[clumps.middle] = -1.0
    order = np.lexsort((shuffled, clumps.of))
    size = hair.widths.shape[1]
    at = np.round(np.linspace(0, size - 1, adopted.WIDTHS)).astype(int)
    groom.offsets = adopted.fit_offsets(
        groom, hair.points[order], hair.lengths[order], hair.widths[order][:, at], clumps.of[order]
    )
    made = grooms.make_hairs(groom).curves.points.reshape(len(order), -1, 3)
    measured = order[:: max(1, len(order) // MEASURED)]
    return distances(hair.points[measured], made[:: max(1, len(order) // MEASURED)].astype(np.float64))


def distances(points: NDArray[np.float64], lines: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distance of points from the polyline of their hair [m], shape (hairs, k).

    points: shape (hairs, k, 3); lines: shape (hairs, n, 3)
    """
    found = np.empty(points.shape[:2])
    for row, (hair, line) in enumerate(zip(points, lines, strict=True)):
        start, edge = line[:-1], np.diff(line, axis=0)
        from_start = hair[:, None] - start
        t = (from_start * edge).sum(axis=2) / np.maximum((edge**2).sum(axis=1), 1e-18)
        off = from_start - np.clip(t, 0.0, 1.0)[..., None] * edge
        found[row] = np.sqrt((off**2).sum(axis=2).min(axis=1))
    return found


def _write(groom: Groom, guides: Curves, text: str, recipe: Path, files: dict[str, Path], *, with_scalp: bool) -> None:
    """Writes the files of an adopted groom, the recipe last; ``with_scalp`` also its scalp."""
    assert groom.offsets is not None
    recipe.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".adopt.", dir=recipe.parent) as folder:
        made = {name: Path(folder, file.name) for name, file in files.items()}
        io.write_scene(HairScene([CurveSet("guides", guides, guide=True)]), made["guides"], StageSpace())
        io.write_offsets(groom.offsets, made["hairs"])
        if with_scalp:
            io.write_scene(HairScene([], [(groom.scalp, None)]), made["scalp"], StageSpace())
        for name, file in made.items():
            if file.exists():
                with replacing(files[name]) as aside:
                    file.replace(aside)
    with replacing(recipe) as aside:
        aside.write_text(text, encoding="utf-8")


def _median(values: NDArray, without: float) -> float:
    """Median of values; ``without`` where there are none."""
    return float(np.median(values)) if len(values) else without


def _packed(grid: NDArray[np.float64]) -> Curves:
    count, points, _ = grid.shape
    ids = np.arange(count, dtype=np.int64)
    return Curves(grid.reshape(-1, 3).copy(), offsets_from_counts(np.full(count, points)), ids)
