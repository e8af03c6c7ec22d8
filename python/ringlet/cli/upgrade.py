"""``ringlet upgrade``: files of earlier versions in the present format."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import Json
from ringlet.cli.output import print_json


def upgrade(
    files: Annotated[
        list[Path], typer.Argument(metavar="FILE…", help="Recipes, shots, presets and files of edits (TOML).")
    ],
    check: Annotated[
        bool, typer.Option("--check", help="Write nothing; exit with 1 where a file would change.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Rewrites each FILE in the present format: settings get their present names, comments and order stay.

    Example: ringlet upgrade curls.recipe.toml nod.shot.toml
    """
    upgrades = {file: ringlet.upgrade(file, check=True) for file in files}  # refuses any file before one is written
    for file in files if not check else ():
        ringlet.upgrade(file)
    if as_json:
        print_json([{"path": str(file), **made._asdict()} for file, made in upgrades.items()])
    else:
        for file, made in upgrades.items():
            for former, name in made.renamed:
                print(f"{file}: {former} is now {name}")
            if not made.renamed:
                print(f"{file}: {'only the number of the format changes' if made.changed else 'nothing to change'}")
    if check and any(made.changed for made in upgrades.values()):
        raise typer.Exit(1)
