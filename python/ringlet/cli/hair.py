"""``ringlet hair``: every hair, at rest or carried by the simulated guides."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import Fraction, Frames, Json, Report, Threads, Variant, usd_file
from ringlet.cli.output import density, wrote
from ringlet.cli.progress import shown_progress


def hair(
    groom: Annotated[
        Path, typer.Argument(metavar="GROOM", help="The groom, a USD file; or a cache, which lies over its groom.")
    ],
    output: Annotated[
        Path, typer.Option("--output", "-o", callback=usd_file, metavar="HAIR", help="The USD file to write.")
    ] = Path("hair.usdc"),
    cache: Annotated[
        Path | None,
        typer.Option(
            "--cache",
            metavar="CACHE",
            help="Simulated guides, of another file; without any the hairs are at rest.",
            show_default=False,
        ),
    ] = None,
    variant: Variant = None,
    frames: Frames = None,
    fraction: Fraction = 1.0,
    wider: Annotated[
        bool, typer.Option("--wider", help="With --fraction: wider hairs, which cover as much as all of them.")
    ] = False,
    velocities: Annotated[
        bool, typer.Option("--velocities", help="Write the velocities of points, which doubles the size of the file.")
    ] = False,
    report: Report = None,
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Makes the hairs of a GROOM, frame by frame where there is a cache.

    Example: ringlet hair groom.usdc --cache cache.usdc -o hair.usdc
    """
    measures: dict[str, float] = {}
    with ringlet.Run("hair", report) as run, shown_progress() as progress:
        with run.stage("hairs", output):
            counts = ringlet.write_hairs(
                groom,
                output,
                cache=cache,
                frames=frames,
                fraction=fraction,
                wider=wider,
                velocities=velocities,
                variant=variant,
                measures=measures,
                progress=progress,
            )
        run.count(**counts)
    wrote(output, run.counts, as_json, **measures)
    if not as_json:
        print(density(measures))
