"""Parses recipes and shots whose files are all inside of a project."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ringlet.data.errors import UserError
from ringlet.data.regular import read_text
from ringlet.data.settings import parse_toml, read_toml
from ringlet.groom import Recipe, parse_recipe
from ringlet.groom.named import GROOMS
from ringlet.shot import Shot, parse_shot
from ringlet.viewer.project import Project


def recipe_inside(project: Project, text: str, path: Path, edits: str = "") -> Recipe:
    """Parses a recipe; raises UserError for a file outside the project.

    edits: text of its file of edits
    """
    _confine(project, parse_toml(text, path.name, "recipe"), path)
    recipe = parse_recipe(text, path, edits or None)
    for what, file in recipe.named_files().items():
        project.inside(file, f"{path.name}: {what}")
    return recipe


def shot_inside(project: Project, text: str, path: Path) -> Shot:
    """Parses a shot; raises UserError for a file outside the project."""
    shot = parse_shot(text, path)
    for what, file in shot.named_files().items():
        project.inside(file, f"{path.name}: {what}")
    return shot


def _confine(project: Project, data: dict[str, Any], path: Path) -> None:
    """Raises UserError when a base or a file of edits is outside the project."""
    for setting in ("extends", "edits"):
        if not isinstance(name := data.get(setting), str):
            continue
        file = project.inside(path.parent / name, f"{path.name}: {setting}")
        if setting == "extends" and file.is_file() and file != path.resolve():
            _confine(project, read_toml(file, "recipe")[1], file)
    grooms = data.get(GROOMS, {})
    for table in grooms.values() if isinstance(grooms, dict) else ():
        if isinstance(table, dict):
            _confine(project, table, path)


def edits_file(project: Project, text: str, path: Path) -> Path | None:
    """Path of the file of edits that the text of a recipe names; None without one."""
    name = parse_toml(text, path.name, "recipe").get("edits")
    return project.inside(path.parent / name, f"{path.name}: edits") if isinstance(name, str) else None


def text_of_edits(file: Path | None) -> str:
    """Text of a file of edits; empty for none."""
    return read_text(file, "give a file of edits") if file is not None and file.exists() else ""


def bases(data: dict[str, Any], path: Path) -> list[Path]:
    """Files that a recipe extends, the nearest first."""
    found: list[Path] = []
    while isinstance(name := data.get("extends"), str) and (file := path.parent / name).is_file() and file not in found:
        found.append(file)
        try:
            path, data = file, read_toml(file, "recipe")[1]
        except UserError:
            break
    return found
