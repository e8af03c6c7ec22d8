"""``ringlet share``: a page with a look to turn, in one file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import Json, Threads
from ringlet.cli.output import wrote


def share(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A recipe, or a USD file with hair.")],
    output: Annotated[Path, typer.Option("--output", "-o", metavar="PAGE", help="The HTML file to write.")] = Path(
        "look.html"
    ),
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Writes one HTML file that shows a look from all sides, for people without Ringlet.

    It opens from the disk and loads nothing. A page of more than 15 MB has fewer, wider hairs.

    Example: ringlet share curls.recipe.toml -o look.html
    """
    made = ringlet.share(file, output)
    fewer = made["of"] if made["of"] > made["hairs"] else 0
    wrote(output, {"hairs": made["hairs"], "hairs in the look": fewer}, as_json)
