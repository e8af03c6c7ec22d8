"""``ringlet groom``: from a recipe to groom guides."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import Json, Report, Threads, usd_output
from ringlet.cli.output import wrote
from ringlet.cli.progress import shown_progress


def groom(
    recipe: Annotated[Path, typer.Argument(metavar="RECIPE", help="The recipe, a TOML file.")],
    output: Annotated[Path, usd_output("GROOM")] = Path("groom.usdc"),
    variant: Annotated[
        list[Path] | None,
        typer.Option(
            "--variant",
            metavar="RECIPE",
            help="Another recipe for the same head, as a USD variant with the name of its file; may be repeated.",
            show_default=False,
        ),
    ] = None,
    report: Report = None,
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Grows, shapes and curls the locks of a RECIPE.

    Example: ringlet groom curls.recipe.toml -o groom.usdc
    """
    with ringlet.Run("groom", report) as run, shown_progress() as progress:
        for path in (recipe, *(variant or ())):
            ringlet.check_place(output, ringlet.read_recipe(path).named_files())
        files = dict[str, Path]()
        for path in variant or ():
            name = path.name.removesuffix(".toml").removesuffix(".recipe")
            if (other := files.setdefault(name, path)) != path:
                raise ringlet.UserError(f"--variant: {path} and {other} are both called '{name}'; rename one of them")
        with run.stage("groom", output):
            groom = ringlet.build_groom(recipe, progress=progress)
            variants = {name: ringlet.build_groom(path, progress=progress) for name, path in files.items()}
            ringlet.write_groom(groom, output, variants=variants)
        for conflict in [line for made in (groom, *variants.values()) for line in made.conflicts]:
            run.warn(conflict)
            print(f"warning: {conflict}", file=sys.stderr)
        run.count(guides=len(groom.guides), locks=len(groom.locks), points=len(groom.locks.points))
    wrote(output, run.counts, as_json, conflicts=groom.conflicts)
