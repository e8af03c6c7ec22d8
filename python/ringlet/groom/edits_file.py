"""Reads and writes the file of manual edits."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError
from ringlet.data.files import replacing, within
from ringlet.data.groom import Groom
from ringlet.data.regular import read_bytes
from ringlet.data.settings import FORMAT, did_you_mean
from ringlet.data.toml import to_toml
from ringlet.groom.edits import offsets_to
from ringlet.groom.load import EDITS, read_edits
from ringlet.groom.recipe import Recipe
from ringlet.groom.scalp import Scalp


def edits_path(recipe: Recipe) -> Path:
    """Path of a recipe's file of edits, in the recipe's folder or below.

    Raises UserError when the recipe names no such file, or one elsewhere.
    """
    if recipe.edits_file is None:
        stem = (recipe.path.name if recipe.path else "recipe").removesuffix(".toml").removesuffix(".recipe")
        raise UserError(
            f'{recipe.path or "recipe"}: names no file for edits; add a line edits = "{stem}.edits.toml" to it'
        )
    return within(recipe.edits_file, recipe.path.parent if recipe.path else Path(), f"{recipe.path or 'recipe'}: edits")


def write_edits(edits: list[dict[str, Any]], path: Path) -> None:
    """Writes edits of locks as ``[[edit]]`` tables; keeps the file's edits of guides."""
    with replacing(path, update=True) as aside:
        aside.write_text(edits_text({**read_edits(path), "edit": edits}), encoding="utf-8")


def edits_text(edits: dict[str, list[dict[str, Any]]]) -> str:
    """The text of a file of edits."""
    return to_toml({"ringlet": FORMAT, **{kind: edits[kind] for kind in EDITS if edits[kind]}})


@contextmanager
def restored_on_error(recipe: Recipe) -> Iterator[None]:
    """Restores the file of edits when the block raises UserError."""
    path = edits_path(recipe)
    before = read_bytes(path) if path.exists() else None
    try:
        yield
    except UserError:
        if before is None:
            path.unlink(missing_ok=True)
        else:
            with replacing(path, update=True) as aside:
                aside.write_bytes(before)
        raise


def add_settings(recipe: Recipe, lock: int, settings: dict[str, Any]) -> None:
    """Overrides settings of one lock, such as ``{"curl.width": "8 mm"}``."""
    path = edits_path(recipe)
    edits = read_edits(path)["edit"]
    for edit in edits:
        if edit.get("lock") == lock and edit.get("set"):
            edit["set"] = {**edit["set"], **settings}
            break
    else:
        edits.append({"lock": lock, "set": settings})
    write_edits(edits, path)


def add_points(recipe: Recipe, groom: Groom, lock: int, points: NDArray, stage: str, relative: bool) -> None:
    """Moves one lock to given points.

    groom:    the recipe's groom without this edit
    points:   new positions [m], shape (k, 3), in the rest pose
    stage:    ``shape`` before the lock is curled, ``groom`` after
    relative: stores offsets that follow later changes of the recipe, instead of a fixed curve

    Raises UserError for an unknown lock and for points that are not finite or not of shape (k, 3), k ≥ 2.
    """
    path, points = edits_path(recipe), np.asarray(points, np.float64)
    current = groom.shapes if stage == "shape" else groom.locks
    row = row_of(groom, lock)
    assert current is not None and groom.shapes is not None
    if points.ndim != 2 or points.shape[1:] != (3,) or len(points) < 2 or not np.isfinite(points).all():
        raise UserError(f"edit of lock {lock}: points have shape {points.shape}; must be finite, of shape (k, 3)")
    root = Scalp(groom.scalp, groom.region).frames(groom.locks)[row]
    edit: dict[str, Any] = {"lock": lock, "stage": stage}
    if relative:
        edit["offsets"] = _with_unit(offsets_to(current, groom.shapes, row, root, points))
    else:
        edit["curve"] = _with_unit(np.round((points - points[0]) @ root, 9).tolist())
    edits = read_edits(path)["edit"]
    kept = [e for e in edits if e.get("lock") != lock or e.get("stage", "groom") != stage or e.get("set")]
    write_edits([*kept, edit], path)


def release(recipe: Recipe, locks: Collection[int] | None) -> list[int]:
    """Removes the edits of the named locks, or of all; returns the ids of the locks that were edited.

    Raises UserError for a named lock that has no edit.
    """
    path = edits_path(recipe)
    edits = read_edits(path)["edit"]
    removed = [edit for edit in edits if locks is None or edit.get("lock") in locks]
    for lock in locks or ():
        if not any(edit.get("lock") == lock for edit in removed):
            edited = [str(edit.get("lock")) for edit in edits]
            hint = did_you_mean(str(lock), edited) if edited else "; nothing is edited there"
            raise UserError(f"{path}: lock {lock} is not edited{hint}")
    if removed:
        write_edits([edit for edit in edits if edit not in removed], path)
    return sorted({int(edit["lock"]) for edit in removed})


def row_of(groom: Groom, lock: int) -> int:
    """Row of the lock with an id; raises UserError when there is none."""
    return groom.locks.row_of(lock, "edit")


def _with_unit(points: list[list[float]]) -> list[list[str]]:
    """Lengths [m] as text with their unit, which holds in a recipe of any unit."""
    return [[f"{x:.9g} m" for x in point] for point in points]
