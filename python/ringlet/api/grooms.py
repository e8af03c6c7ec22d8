"""Recipes and grooms: read, made, edited, checked and written."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from ringlet.api.progress import Progress
from ringlet.data.errors import UserError
from ringlet.data.groom import shows
from ringlet.data.reads import recorded

if TYPE_CHECKING:
    from ringlet.data.groom import Groom
    from ringlet.data.mesh import Mesh
    from ringlet.groom import Memory, Recipe

__all__ = [
    "build_groom",
    "check_groom",
    "edit_lock",
    "list_edits",
    "load_groom",
    "read_groom",
    "read_recipe",
    "rebind_groom",
    "release_locks",
    "write_groom",
]


def read_recipe(path: Path | str) -> Recipe:
    """Reads a recipe from a TOML file, with every setting checked."""
    from ringlet import groom

    return groom.read_recipe(Path(path))


def build_groom(
    recipe: Recipe | Path | str, *, progress: Progress | None = None, memory: Memory | None = None
) -> Groom:
    """Makes the groom of a recipe: guides grown on the scalp or read from USD, then locks, shape and curl.

    memory: keeps results between calls, so that an edit recomputes only what follows it
    """
    from ringlet import groom

    if not isinstance(recipe, groom.Recipe):
        recipe = read_recipe(recipe)
    if recipe.grooms:
        return _joined_groom(recipe, progress, memory)
    notes: list[str] = []
    made = groom.make_groom(recipe, progress=progress, memory=memory, **groom_inputs(recipe, memory, notes))
    made.conflicts += notes
    return made


def _joined_groom(recipe: Recipe, progress: Progress | None, memory: Memory | None) -> Groom:
    """The grooms of a recipe with several, joined."""
    from ringlet import groom

    memory, made = memory or groom.Memory(), {}
    for name, one in recipe.grooms.items():
        own = memory.grooms.setdefault(name, groom.Memory())
        own.files = memory.files
        try:
            made[name] = build_groom(one, progress=progress and _of_stage(name, progress), memory=own)
        except UserError as error:
            raise _of_groom(error, recipe, name) from error
    joined = groom.join_grooms(made)
    joined.recipe = recipe.text
    return joined


def _of_stage(name: str, progress: Progress) -> Progress:
    """Progress of one groom of several, whose name comes before each stage."""
    return lambda stage, done, total: progress(f"{name}: {stage}", done, total)


def _of_groom(error: UserError, recipe: Recipe, name: str) -> UserError:
    """An error of a recipe with the name of the groom that it is in."""
    where = f"{recipe.path.name if recipe.path else 'recipe'}: "
    return UserError(str(error).replace(where, f"{where}grooms.{name}: ", 1))


def groom_inputs(recipe: Recipe, memory: Memory | None = None, notes: list[str] | None = None) -> dict[str, Any]:
    """Contents of the files of a recipe: the arguments of ``make_groom`` besides the recipe.

    notes: receives a sentence for each thing in the files that is not used
    """
    from ringlet import io
    from ringlet.groom.operators import Drawn

    if recipe.scalp_file is None:
        raise UserError(f"{recipe.path or 'recipe'}: scalp.file is missing; name the file of the head")
    if not recipe.scalp_file.exists():
        where = recipe.path or "recipe"
        raise UserError(f"{where}: scalp.file is {recipe.scalp_file}, but there is no such file; check the name")
    chosen = recipe.scalp
    cage = chosen.surface == "cage"
    scalp, others, space = _cached(
        memory,
        recipe.scalp_file,
        f"{chosen.mesh} {chosen.surface} {chosen.space}",
        partial(io.read_head, prim=chosen.mesh, space=chosen.space, cage=cage, notes=notes),
    )
    hidden = _hidden(recipe)
    textures = {name: _cached(memory, file, "texture", io.read_texture) for name, file in recipe.map_files().items()}
    scalp = replace(scalp, textures=textures)
    drawn = None
    if isinstance(recipe.guides, Drawn) and recipe.guides_file is not None:
        drawn = io.read_curves(recipe.guides_file, recipe.guides.prim, space=recipe.guides.space, notes=notes)
    helpers = {
        name: io.read_curves(file, recipe.curves[name].prim, space=recipe.curves[name].space, notes=notes)
        for name, file in recipe.helper_files().items()
    }
    meshes = {
        name: _cached(
            memory,
            file,
            f"{recipe.meshes[name].mesh} {recipe.meshes[name].space}",
            partial(io.read_mesh, prim=recipe.meshes[name].mesh, space=recipe.meshes[name].space, notes=notes),
        )
        for name, file in recipe.mesh_files().items()
    }
    offsets = None if recipe.offsets_file is None else _cached(memory, recipe.offsets_file, "hairs", io.read_offsets)
    return {
        "scalp": scalp,
        "drawn_guides": drawn,
        "offsets": offsets,
        "helpers": helpers,
        "hidden": hidden,
        "meshes": meshes,
        "colliders": [mesh for mesh in others if shows(mesh.name, hidden)],
        "scalp_file": recipe.scalp_file,
        "scalp_prim": recipe.scalp.mesh,
        "space": space,
    }


def _hidden(recipe: Recipe) -> list[str]:
    """Paths of the meshes of the head's file that the hair replaces."""
    from ringlet import io

    file, names = recipe.scalp_file, recipe.scalp.hide
    if not names or file is None:
        return []
    if file.suffix == ".obj":
        where = recipe.path or "recipe"
        raise UserError(f"{where}: scalp.hide names prims of a USD file, which {file.name} is not; remove it")
    return io.surface_paths(file, names, "scalp.hide")


def _cached(memory: Memory | None, file: Path, settings: str, read: Callable[[Path], Any]) -> Any:
    """Contents of a file, from memory while the file and the settings it is read with are unchanged."""
    version = file.stat().st_mtime_ns if file.exists() else 0, settings
    if memory is None:
        return read(file)
    if memory.files.get(str(file), (None, None))[0] != version:
        memory.files[str(file)] = (version, read(file))
    return memory.files[str(file)][1]


def write_groom(groom: Groom, path: Path | str, *, variants: Mapping[str, Groom] | None = None) -> None:
    """Writes a groom as USD, with the head it grows on by reference.

    variants: more grooms of the same head, by name: the file has a variant set ``groom``, with ``groom`` as ``base``
    """
    from ringlet import io

    io.write_groom(groom, Path(path), variants)


def read_groom(path: Path | str, *, variant: str | None = None) -> Groom:
    """Reads a groom that ``write_groom`` wrote, or one of its variants."""
    from ringlet import io

    return io.read_groom(Path(path), variant)


def rebind_groom(path: Path | str, *, variant: str | None = None) -> Groom:
    """The groom of a USD file, bound to its head as that is now.

    Each lock keeps its shape, begins on its root, and is turned as the roots are together. Raises UserError for another
    mesh whose surface is farther than 1 cm from a root.
    """
    from ringlet import groom, io

    return groom.rebind(io.read_groom(Path(path), variant, bound=False))


def load_groom(
    path: Path | str, *, variant: str | None = None, rebind: bool = False, progress: Progress | None = None
) -> Groom:
    """The groom of a recipe (``.toml``) or of a USD file, or a variant of the latter.

    rebind: bind the groom of a file to its head as that is now (see ``rebind_groom``)
    """
    if Path(path).suffix != ".toml":
        return rebind_groom(path, variant=variant) if rebind else read_groom(path, variant=variant)
    if variant is not None:
        raise UserError(f"variant '{variant}': {path} is a recipe; name the recipe of the variant instead")
    if rebind:
        raise UserError(f"rebind: {path} is a recipe, which grooms the head as it is now; leave it out")
    return build_groom(path, progress=progress)


def edit_lock(
    recipe: Path | str,
    lock: int,
    *,
    points: NDArray | None = None,
    stage: Literal["groom", "shape"] = "groom",
    relative: bool | None = None,
    settings: dict[str, Any] | None = None,
) -> None:
    """Takes a lock out of a recipe, whose line ``edits`` names the file that keeps the change.

    points:   where its points go [m], shape (k, 3), in the rest pose; where they are now when absent
    stage:    ``shape``: the points are those of the lock before it is curled
    relative: keep the difference from what the recipe makes, so that the edit goes with all changes of the recipe (so
              it is for given points); else the curve as it is
    settings: in place of points: settings of this lock alone, such as ``{"curl.width": "8 mm"}``
    """
    from ringlet import groom

    before, lock = groom.recipe_of_lock(read_recipe(recipe), lock)
    with groom.restored_on_error(before):
        if settings is not None:
            groom.add_settings(before, lock, settings)
        else:
            made = build_groom(before)
            now = (made.shapes if stage == "shape" and made.shapes else made.locks)[groom.row_of(made, lock)]
            others = [edit for edit in before.edit if edit.lock != lock or edit.stage != stage]
            plain = build_groom(before.model_copy(update={"edit": others}))
            relative = points is not None if relative is None else relative
            groom.add_points(before, plain, lock, now if points is None else points, stage, relative)
        read_recipe(recipe)


def release_locks(recipe: Path | str, locks: Collection[int] | None = None) -> list[int]:
    """Gives edited locks back to the recipe, all or those named; returns their ids."""
    from ringlet import groom

    read, released = read_recipe(recipe), list[int]()
    for one, offset in groom.recipes_of(read):
        own = None if locks is None else [lock - offset for lock in locks if groom.recipe_of_lock(read, lock)[0] is one]
        if own or (own is None and one.edits_file is not None) or not read.grooms:
            released += [lock + offset for lock in groom.release(one, own)]
    return released


def list_edits(recipe: Path | str) -> list[dict[str, Any]]:
    """The edited locks of a recipe: ``lock``, ``stage``, ``what`` was changed, and whether the lock is ``there``."""
    from ringlet import groom

    read = read_recipe(recipe)
    edits = [(offset, edit) for one, offset in groom.recipes_of(read) for edit in one.edit]
    there = set(build_groom(read).locks.ids.tolist()) if edits else set()
    return [
        {
            "lock": edit.lock + offset,
            "stage": edit.stage,
            "what": [*edit.set, *(name for name in ("curve", "offsets", "move") if getattr(edit, name))],
            "there": edit.lock + offset in there,
        }
        for offset, edit in edits
    ]


@recorded()
def check_groom(
    groom: Groom | Path | str,
    *,
    root_depth: float = 5e-4,
    root_length: float = 5e-3,
    thickness: float = 1e-4,
    own_radius: float = 0.85,
    fixed: Path | str | None = None,
    picture: Path | str | None = None,
    variant: str | None = None,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Intersections of a groom with the scalp, the body and itself: places, locks, greatest depth [m], worst places.

    Returns ``found``, and ``folds``: the braids that fold back on themselves, after the repair if there is one. Lengths
    [m] are the ``thickness``, the ``lock_thickness`` of locks with their hairs, and the largest ``own_thickness`` at
    which locks with a radius of their own count. Density and cover are those of ``measure_hairs``. With ``fixed`` also
    ``left``, the remaining intersections, and ``repair``, the displacements.

    root_depth:  how deep a lock may be in the skin up to ``root_length`` from its root [m]
    thickness:   distance below which two locks count as intersecting [m]
    own_radius:  part of the radius of their own at which locs and strands of braids touch, where that is more
    fixed:       where to write the repaired groom
    picture:     where to write a picture of the places: of those that are left, if it is repaired
    variant:     of the groom file, in place of the one that is selected in it
    """
    from ringlet import groom as grooms
    from ringlet.data.groom import Groom
    from ringlet.data.thickness import own_radii

    if not isinstance(groom, Groom):
        groom = load_groom(groom, variant=variant, progress=progress)
    allowed = grooms.Allowed(root_depth, root_length, thickness, own_radius)
    others = _other_meshes(groom)
    findings = grooms.check_groom(groom, others, allowed)
    summary: dict[str, Any] = {
        "locks": len(groom.locks),
        "points": len(groom.locks.points),
        "thickness": thickness,
        "lock_thickness": grooms.lock_thickness(groom),
        "own_thickness": 2.0 * own_radius * float(own_radii(groom.locks).max(initial=0.0)),
        "found": findings.summary(),
        "folds": grooms.folded_braids(groom.locks),
        **grooms.hair_measures(groom),
    }
    if fixed is not None:
        repair = grooms.fix_groom(groom, others, allowed, progress)
        write_groom(repair.groom, fixed)
        findings = repair.left
        folds = grooms.folded_braids(repair.groom.locks)
        summary |= {"left": findings.summary(), "repair": repair.summary(), "folds": folds}
    if picture is not None:
        from ringlet.picture import write_places

        body = np.concatenate([mesh.points for mesh in (groom.scalp, *others)])
        title = "left after the repair" if fixed is not None else "found"
        write_places(body, findings.locks.points, findings.by_kind(), picture, title)
    return summary


def _other_meshes(groom: Groom) -> list[Mesh]:
    """Visible meshes in the scalp's USD file, except the scalp; empty for an OBJ."""
    from ringlet import io

    file = groom.scalp_file
    meshes = [] if file is None or file.suffix == ".obj" else io.read_meshes(file, groom.cage)
    return [mesh for mesh in meshes if mesh.name != groom.scalp.name and groom.shows(mesh.name)]
