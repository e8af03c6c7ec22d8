"""``ringlet farm``: a whole shot as a job for a render farm."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import Frames, GroomOfShot, Json, ShotFile
from ringlet.cli.output import print_json


def farm(
    shot: ShotFile,
    camera: Annotated[
        str, typer.Option("--camera", metavar="PRIM", help="The camera of the pictures, in the stage of the hairs.")
    ],
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            metavar="JOB",
            help="A .json file for Open Job Description, an .alf file for Tractor, or a .deadline folder for Deadline.",
        ),
    ] = Path("shot.json"),
    folder: Annotated[
        Path, typer.Option("--folder", metavar="FOLDER", help="Where groom, cache, hairs and pictures go.")
    ] = Path("out/shot"),
    groom: GroomOfShot = None,
    frames: Frames = None,
    width: Annotated[
        int, typer.Option("--width", min=1, max=ringlet.limits.PIXELS, help="Of the pictures: pixels across.")
    ] = 1280,
    samples: Annotated[
        int, typer.Option("--samples", min=1, max=ringlet.limits.SAMPLES, help="Light paths of a pixel.")
    ] = 40,
    exr: Annotated[bool, typer.Option("--exr", help="Pictures as EXR with all layers, in place of PNG.")] = False,
    as_json: Json = False,
) -> None:
    """Writes a SHOT, from its groom to its pictures, as a job for a render farm, and runs nothing.

    Frames of hairs and of pictures run in parallel. Each step names what it reads and writes.

    Examples: ringlet farm nod.shot.toml --camera /groom/body/camera -o shot.json ·
    ringlet farm nod.shot.toml --camera /groom/body/camera -o shot.alf --folder /shows/a/nod --exr
    """
    steps = ringlet.write_shot_job(
        output,
        shot,
        folder=folder,
        camera=camera,
        groom=groom,
        frames=frames,
        width=width,
        samples=samples,
        exr=exr,
    )
    submit = SUBMIT[output.suffix].format(output)
    if as_json:
        print_json({"path": str(output), "steps": steps, "submit": submit})
    else:
        print(f"{output}: {', '.join(steps)}. Submit it: {submit}")


SUBMIT = {
    ".json": "openjd run {}",  # here, one task after the other
    ".alf": "tractor-spool {}",
    ".deadline": "deadlinecommand {}/submit.txt",
}
