"""``ringlet hair``: every hair, at rest or carried by the simulated guides."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import Fraction, Frames, Json, Report, Threads, Variant, Wider, points_option, usd_output
from ringlet.cli.output import density, wrote
from ringlet.cli.progress import shown_progress

MOST_CHANGE = 0.05  # of the length of a hair that nobody sees


def hair(
    groom: Annotated[
        Path, typer.Argument(metavar="GROOM", help="The groom, a USD file; or a cache, which lies over its groom.")
    ],
    output: Annotated[Path, usd_output("HAIR")] = Path("hair.usdc"),
    cache: Annotated[
        Path | None,
        typer.Option(
            "--cache",
            metavar="CACHE",
            help="Cache of simulated groom guides; without one the hairs are at rest.",
            show_default=False,
        ),
    ] = None,
    variant: Variant = None,
    frames: Frames = None,
    fraction: Fraction = 1.0,
    wider: Wider = False,
    points: Annotated[int | None, points_option("Points of each hair; those of the groom by default.")] = None,
    camera: Annotated[
        str | None,
        typer.Option(
            "--camera",
            metavar="PRIM",
            help="Make fewer, wider hairs, as far as this camera cannot see the difference.",
            show_default=False,
        ),
    ] = None,
    camera_file: Annotated[
        Path | None,
        typer.Option(
            "--camera-file",
            metavar="STAGE",
            help="A USD file that has the camera; that of the hairs by default.",
            show_default=False,
        ),
    ] = None,
    pixels: Annotated[
        int, typer.Option("--pixels", min=1, max=ringlet.limits.PIXELS, help="Width of the picture of --camera.")
    ] = 1920,
    lod: Annotated[
        bool, typer.Option("--lod", help="Write levels of detail, as the variants LOD0 to LOD3 of /groom/hairs.")
    ] = False,
    on_demand: Annotated[
        bool,
        typer.Option(
            "--on-demand", help="Write hairs that readers and renderers generate on demand, without their points."
        ),
    ] = False,
    velocities: Annotated[
        bool, typer.Option("--velocities", help="Write the velocities of points, which doubles the size of the file.")
    ] = False,
    report: Report = None,
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Makes the dense hairs of a GROOM, in each frame of its cache if it has one.

    A GROOM with hairs on demand is expanded to hairs with points.

    Examples: ringlet hair groom.usdc --cache cache.usdc -o hair.usdc · ringlet hair cache.usdc --on-demand ·
    ringlet hair cache.usdc --lod · ringlet hair cache.usdc --camera /cam --camera-file shot.usd
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
                points=points,
                camera=camera,
                camera_file=camera_file,
                pixels=pixels,
                lod=lod,
                on_demand=on_demand,
                velocities=velocities,
                variant=variant,
                measures=measures,
                progress=progress,
            )
        run.count(**counts)
    wrote(output, run.counts, as_json, **measures)
    if not as_json:
        if "fraction" in measures:
            print(f"{measures['fraction']:.1%} of the hairs, as {camera} sees them on {pixels} pixels")
        if "hairs_per_cm2" in measures or "hairs_per_cm" in measures or "grooms" in measures:
            print(density(measures))
        if (change := measures.get("length_change", 0.0)) > MOST_CHANGE:
            print(
                f"Hairs get up to {change:.0%} longer or shorter than in the groom, most in frame "
                f"{measures['length_change_frame']:g}: look at them there before you use this result."
            )
