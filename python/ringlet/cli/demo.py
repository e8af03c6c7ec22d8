"""``ringlet demo``: the whole way on the example."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path
from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import Json, Threads
from ringlet.cli.output import print_json, print_table, size
from ringlet.cli.progress import shown_progress


def demo(
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FOLDER", help="The folder to write to.")] = Path(
        "out/demo"
    ),
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Grooms, simulates and renders the example: a child's head full of tight curls.

    Example: ringlet demo -o out/demo
    """
    start = time.perf_counter()
    with shown_progress() as progress:
        run = ringlet.run_demo(output, progress=progress, show=None if as_json else show)
    seconds = time.perf_counter() - start
    made = {stage.file: stage for stage in run.stages if stage.file}
    if as_json:
        print_json({"folder": str(output), "seconds": round(seconds, 1), "files": list(map(str, made)), **run.counts})
        return
    rows = [[str(file), size(file.stat().st_size), f"{s.wall:.1f} s", s.what] for file, s in made.items()]
    for name, what in (("report.html", "what happened, to read"), ("report.json", "what happened, for programs")):
        rows.append([str(output / name), size((output / name).stat().st_size), "", what])
    print_table(["file", "size", "took", ""], rows, right=(1, 2))
    print(f"\nDone in {seconds:.0f} s. Look at {output / 'still.png'}, read {output / 'report.html'}.")


def show(picture: Path) -> None:
    """Opens a picture where there is a display; names it."""
    typer.echo(f"{picture} is there", err=True)
    if sys.platform in ("darwin", "win32") or {"DISPLAY", "WAYLAND_DISPLAY"} & os.environ.keys():
        typer.launch(str(picture))
