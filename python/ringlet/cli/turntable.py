"""``ringlet turntable``: a head of hair from all sides, and a video of it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

import ringlet
from ringlet.cli.movie import Output, wrote_movie
from ringlet.cli.options import Json, Report, frame_option
from ringlet.cli.progress import shown_progress
from ringlet.cli.settings import with_settings


@with_settings(width=640, samples=16)
def turntable(
    stage: Annotated[Path, typer.Argument(metavar="STAGE", help="A USD file with hairs.")],
    settings: dict[str, Any],
    output: Output = Path("turntable.mp4"),
    frame: Annotated[float | None, frame_option("Frame of the clip; the first by default.")] = None,
    views: Annotated[
        int, typer.Option("--views", min=1, max=ringlet.limits.FRAMES, help="Views around the head; 24 a second.")
    ] = 72,
    report: Report = None,
    as_json: Json = False,
) -> None:
    """Path-traces a STAGE from all sides, and encodes the views as a video.

    The camera goes around the head, and the studio with it; other lights stay. The same command again goes on where it
    was interrupted: views of the same hairs and settings are kept.

    Example: ringlet turntable hair.usdc -o curls.mp4 --frame 24 --views 48 --light window
    """
    with ringlet.Run("turntable", report) as run, shown_progress() as progress:
        with run.stage("turntable"):
            made = ringlet.write_turntable(stage, output, frame=frame, views=views, progress=progress, **settings)
        run.count(frames=len(made.frames), rendered=made.rendered)
        run.pictured(made.frames[0], stage.name)
    wrote_movie(made, run.counts, as_json)
