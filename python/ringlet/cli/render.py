"""``ringlet render``: a path-traced still, or a contact sheet of the clip."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

import ringlet
from ringlet.cli.options import Frames, Json, Report, frame_option, still_file
from ringlet.cli.output import wrote
from ringlet.cli.progress import shown_progress
from ringlet.cli.settings import with_settings


@with_settings()
def render(
    stage: Annotated[
        Path, typer.Argument(metavar="STAGE", help="A USD file with hairs, and with the head if it is to be seen.")
    ],
    settings: dict[str, Any],
    output: Annotated[
        Path,
        typer.Option(
            "--output", "-o", callback=still_file, metavar="PICTURE", help="The PNG, JPEG or EXR file to write."
        ),
    ] = Path("still.png"),
    frame: Annotated[float | None, frame_option("Frame of the still; the first by default.")] = None,
    sheet: Annotated[bool, typer.Option("--sheet", help="A contact sheet of the clip in place of a still.")] = False,
    contacts: Annotated[
        str | None,
        typer.Option(
            "--contacts",
            metavar="WHAT",
            help="What touches, in place of hairs: force, gap or start. STAGE is what ringlet sim --contacts wrote.",
            show_default=False,
        ),
    ] = None,
    frames: Frames = None,
    report: Report = None,
    as_json: Json = False,
) -> None:
    """Renders a STAGE: one frame, path-traced, or with --sheet a page of small ones.

    With --contacts, beads show contacts. By force: blue to red, over three decades up to the strongest in a hundred.
    By gap: red where hardly any gap is left. By start: all places that overlapped at the start, red where worst.

    Examples: ringlet render hair.usdc -o still.png --frame 24 --view side · ringlet render hair.usdc --sheet ·
    ringlet render hair.usdc --look-at 50000000 --f-stop 2.8 --light window
    """
    if sheet and frame is not None:
        raise ringlet.UserError(f"--frame {frame}: a sheet shows several frames; choose them with --frames")
    if frames is not None and not sheet:
        raise ringlet.UserError(
            f"--frames {frames[0]}:{frames[1]}: a still shows one frame; choose it with --frame, or draw a --sheet"
        )
    with ringlet.Run("render", report) as run, shown_progress() as progress:
        with run.stage("sheet" if sheet else "still", output):
            if contacts is not None:
                ringlet.write_touches_picture(stage, output, show=contacts, frame=frame, progress=progress, **settings)
            elif sheet:
                ringlet.write_sheet(stage, output, frames=frames, progress=progress, **settings)
            else:
                ringlet.write_still(stage, output, frame=frame, progress=progress, **settings)
        run.pictured(output, f"{stage.name}: the clip" if sheet else stage.name)
    wrote(output, run.counts, as_json)
