"""``ringlet view``: the review page."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import Threads


def view(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A recipe, a shot, or a USD file with hair.")],
    port: Annotated[
        int | None,
        typer.Option("--port", min=1, max=65535, help="Port; 8642 or a free one by default.", show_default=False),
    ] = None,
    host: Annotated[
        str, typer.Option("--host", help="Address to listen on. Access from other computers needs a token.")
    ] = "127.0.0.1",
    project: Annotated[
        Path | None,
        typer.Option(
            "--project", metavar="FOLDER", help="Folder that the page may read and write; that of FILE by default."
        ),
    ] = None,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Do not open a browser.")] = False,
    threads: Threads = None,
) -> None:
    """Opens the review page in a browser: change the look, and watch it move.

    Examples: ringlet view curls.recipe.toml · ringlet view nod.shot.toml --port 9000 · ringlet view hair.usdc
    """
    ringlet.view(file, port=port, host=host, browser=not no_browser, project=project)
