"""``ringlet movie``: the frames of a clip, path-traced, and a video of them."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

import ringlet
from ringlet.cli.options import Frames, Json, Report
from ringlet.cli.output import wrote
from ringlet.cli.progress import shown_progress
from ringlet.cli.settings import with_settings

Output = Annotated[
    Path,
    typer.Option("--output", "-o", metavar="MOVIE", help="A .mp4 or .mov, or a folder for PNG frames alone."),
]


@with_settings(width=640, samples=16)
def movie(
    stage: Annotated[Path, typer.Argument(metavar="STAGE", help="A USD file with hairs in motion.")],
    settings: dict[str, Any],
    output: Output = Path("movie.mp4"),
    frames: Frames = None,
    report: Report = None,
    as_json: Json = False,
) -> None:
    """Path-traces the frames of a STAGE, and encodes them as a video.

    One camera sees the whole motion, unless --camera names one of the stage. Frames go to the folder MOVIE.frames. The
    same command again goes on where it was interrupted: frames of the same hairs, camera and settings are kept.

    The video needs imageio-ffmpeg: pip install 'ringlet[movie]'. Without it there are only frames.

    Example: ringlet movie hair.usdc -o nod.mp4 --frames 1:48 --shutter 180
    """
    with ringlet.Run("movie", report) as run, shown_progress() as progress:
        with run.stage("movie"):
            made = ringlet.write_movie(stage, output, frames=frames, progress=progress, **settings)
        run.count(frames=len(made.frames), rendered=made.rendered)
        run.pictured(made.frames[0], stage.name)
    wrote_movie(made, run.counts, as_json)


def wrote_movie(made: Any, counts: dict[str, int], as_json: bool) -> None:
    """Reports a movie: the video, or the folder of frames and how to get a video."""
    if made.video is not None:
        wrote(made.video, counts, as_json, frames_folder=str(made.frames[0].parent))
        return
    wrote(made.frames[0].parent, counts, as_json)
    if made.wanted is not None and not as_json:
        print(
            f"{made.wanted}: is not made without an encoder: pip install 'ringlet[movie]', then the same command again"
        )
