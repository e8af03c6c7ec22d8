"""Recipes and grooms: read, made, edited, checked and written."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, Literal

from numpy.typing import NDArray

from ringlet import groom as grooms
from ringlet import io
from ringlet.api.progress import Progress
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom, shows
from ringlet.data.toml import tables_of, to_toml
from ringlet.groom import Memory, Recipe
from ringlet.groom.operators import Drawn


def read_recipe(path: Path | str, settings: Mapping[str, Any] | None = None) -> Recipe:
    """Reads a recipe from a TOML file, with every setting checked.

    settings: values in place of those of the file, by name, such as ``{"curl.width": "8 mm"}``
    """
    path = Path(path)
    if not settings:
        return grooms.read_recipe(path)
    changed = to_toml({"ringlet": 2, "extends": path.name, **tables_of(settings)})
    return grooms.parse_recipe(changed, path.with_name(f"{path.name} with settings"))


def build_groom(
    recipe: Recipe | Path | str, *, progress: Progress | None = None, memory: Memory | None = None
) -> Groom:
    """Makes the groom of a recipe: guides grown on the scalp or read from USD, then locks, shape and curl.

    memory: keeps results between calls, so that an edit recomputes only what follows it
    """
    if not isinstance(recipe, grooms.Recipe):
        recipe = read_recipe(recipe)
    if recipe.grooms:
        return _joined_groom(recipe, progress, memory)
    notes: list[str] = []
    made = grooms.make_groom(recipe, progress=progress, memory=memory, **groom_inputs(recipe, memory, notes))
    made.conflicts += notes
    return made


def _joined_groom(recipe: Recipe, progress: Progress | None, memory: Memory | None) -> Groom:
    """The grooms of a recipe with several, joined."""
    memory, made = memory or grooms.Memory(), {}
    for name, one in recipe.grooms.items():
        own = memory.grooms.setdefault(name, grooms.Memory())
        own.files = memory.files
        try:
            made[name] = build_groom(one, progress=progress and _of_stage(name, progress), memory=own)
        except UserError as error:
            raise _of_groom(error, recipe, name) from error
    joined = grooms.join_grooms(made)
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
    io.write_groom(groom, Path(path), variants)


def read_groom(path: Path | str, *, variant: str | None = None) -> Groom:
    """Reads a groom that ``write_groom`` wrote, or one of its variants."""
    return io.read_groom(Path(path), variant)


def rebind_groom(path: Path | str, *, variant: str | None = None) -> Groom:
    """The groom of a USD file, bound to its head as that is now.

    Each lock keeps its shape, begins on its root, and is turned as the roots are together. Raises UserError for another
    mesh whose surface is farther than 1 cm from a root.
    """
    return grooms.rebind(io.read_groom(Path(path), variant, bound=False))


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
    before, lock = grooms.recipe_of_lock(read_recipe(recipe), lock)
    with grooms.restored_on_error(before):
        if settings is not None:
            grooms.add_settings(before, lock, settings)
        else:
            made = build_groom(before)
            now = (made.shapes if stage == "shape" and made.shapes else made.locks)[grooms.row_of(made, lock)]
            others = [edit for edit in before.edit if edit.lock != lock or edit.stage != stage]
            plain = build_groom(before.model_copy(update={"edit": others}))
            relative = points is not None if relative is None else relative
            grooms.add_points(before, plain, lock, now if points is None else points, stage, relative)
        read_recipe(recipe)


def release_locks(recipe: Path | str, locks: Collection[int] | None = None) -> list[int]:
    """Gives edited locks back to the recipe, all or those named; returns their ids."""
    read, released = read_recipe(recipe), list[int]()
    for one, offset in grooms.recipes_of(read):
        own = (
            None if locks is None else [lock - offset for lock in locks if grooms.recipe_of_lock(read, lock)[0] is one]
        )
        if own or (own is None and one.edits_file is not None) or not read.grooms:
            released += [lock + offset for lock in grooms.release(one, own)]
    return released


def list_edits(recipe: Path | str) -> list[dict[str, Any]]:
    """The edited locks of a recipe: ``lock``, ``stage``, ``what`` was changed, and whether the lock is ``there``."""
    read = read_recipe(recipe)
    edits = [(offset, edit) for one, offset in grooms.recipes_of(read) for edit in one.edit]
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
