"""``ringlet converge``: which iterations a shot needs."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import AllowStale, Frames, GroomOfShot, Json, ShotFile, Threads, Variant, ending_in
from ringlet.cli.output import print_json, print_table
from ringlet.cli.progress import shown_progress


def converge(
    shot: ShotFile,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            callback=ending_in(".html"),
            metavar="PAGE",
            help="Write the numbers and the paths of the tips to this HTML page.",
            show_default=False,
        ),
    ] = None,
    groom: GroomOfShot = None,
    variant: Variant = None,
    frames: Frames = None,
    enough: Annotated[
        float,
        typer.Option("--enough", min=0.5, max=1.0, help="Fraction of the converged motion that counts as enough."),
    ] = 0.95,
    allow_stale: AllowStale = False,
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Simulates a few frames of a SHOT at several settings of its solver, and recommends one.

    It compares how much of its motion the hair keeps, and its distance from a converged run: 60 iterations to 0.02.
    Frames before the first of them have the shot's own settings; choose frames in the middle of the motion.

    Examples: ringlet converge nod.shot.toml --frames 19:27 · ringlet converge nod.shot.toml -o converge.html
    """
    with shown_progress() as progress:
        settings = ringlet.read_shot(shot)
        locks = ringlet.load_groom(groom or settings.groom, variant=variant, progress=progress)
        if output is not None:
            ringlet.check_place(output, settings.named_files() | {"groom": groom or settings.groom})
        found = ringlet.converge(
            settings, locks, frames=frames, enough=enough, allow_stale=allow_stale, progress=progress
        )
    if output is not None:
        ringlet.write_convergence(found, output, f"{shot.name}, frames {found.frames[0]} to {found.frames[1]}")
    if as_json:
        advised = found.advised and {"newton": found.advised.newton, "linear_tolerance": found.advised.linear_tolerance}
        print_json({**asdict(found), "advised": advised, "path": output and str(output)})
        return
    columns, rows, advice = ringlet.convergence_table(found)
    print_table(columns, rows, right=(1, 2, 3, 4))
    print(advice)
    if output is not None:
        print(output)
