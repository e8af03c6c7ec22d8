"""``ringlet picture``: a path-traced still, or a contact sheet of the clip."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import Frames, Json, Report, frame_option, picture_file
from ringlet.cli.output import wrote
from ringlet.cli.progress import shown_progress


def picture(
    stage: Annotated[
        Path, typer.Argument(metavar="STAGE", help="A USD file with hairs, and with the head if it is to be seen.")
    ],
    output: Annotated[
        Path, typer.Option("--output", "-o", callback=picture_file, metavar="PICTURE", help="The PNG file to write.")
    ] = Path("still.png"),
    frame: Annotated[float | None, frame_option("Frame of the still; the first by default.")] = None,
    view: Annotated[str, typer.Option("--view", help="three_quarter, front, side or back.")] = "three_quarter",
    color: Annotated[
        str | None,
        typer.Option(
            "--color",
            help="black, dark_brown, brown, auburn, ginger, blond, gray or white; by default the hair's own.",
            show_default=False,
        ),
    ] = None,
    width: Annotated[int, typer.Option("--width", min=16, max=8192, help="Pixels across.")] = 900,
    height: Annotated[int, typer.Option("--height", min=16, max=8192, help="Pixels down.")] = 1000,
    samples: Annotated[
        int,
        typer.Option(
            "--samples", min=1, max=ringlet.limits.SAMPLES, help="Paths per pixel: more is cleaner and slower."
        ),
    ] = 40,
    seconds: Annotated[
        float | None,
        typer.Option(
            "--seconds",
            min=1,
            max=ringlet.limits.SECONDS,
            help="Stop adding samples after that long.",
            show_default=False,
        ),
    ] = None,
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
    """Pictures a STAGE: one frame, path-traced, or with --sheet a page of small ones.

    With --contacts, beads show contacts. By force: blue to red, over three decades up to the strongest in a hundred.
    By gap: red where hardly any gap is left. By start: all places that overlapped at the start, red where worst.

    Examples: ringlet picture hair.usdc -o still.png --frame 24 --view side · ringlet picture hair.usdc --sheet
    """
    with ringlet.Run("picture", report) as run, shown_progress() as progress:
        with run.stage("sheet" if sheet else "still", output):
            if contacts is not None:
                ringlet.write_touches_picture(
                    stage,
                    output,
                    show=contacts,
                    frame=frame,
                    view=view,
                    width=width,
                    height=height,
                    samples=samples,
                    seconds=seconds,
                    progress=progress,
                )
            elif sheet:
                ringlet.write_sheet(stage, output, frames=frames, color=color, progress=progress)
            else:
                ringlet.write_still(
                    stage,
                    output,
                    frame=frame,
                    view=view,
                    color=color,
                    width=width,
                    height=height,
                    samples=samples,
                    seconds=seconds,
                    progress=progress,
                )
        run.pictured(output, f"{stage.name}: the clip" if sheet else f"{stage.name}, {view.replace('_', ' ')}")
    wrote(output, run.counts, as_json)
