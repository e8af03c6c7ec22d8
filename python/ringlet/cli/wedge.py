"""``ringlet wedge``: one shot with several values of some settings, side by side."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

import ringlet
from ringlet.cli.options import Frames, Json, ShotFile, frame_option
from ringlet.cli.output import print_json, print_table
from ringlet.cli.progress import shown_progress


def wedge(
    shot: ShotFile,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="SETTING=VALUES",
            help="A setting of the shot and its values, such as strands.bend_scale=1,2,4; may be repeated.",
            show_default=False,
        ),
    ] = None,
    output: Annotated[
        Path,
        typer.Option("--output", "-o", metavar="FOLDER", help="Folder for the results, with a folder for each task."),
    ] = Path("out/wedge"),
    frames: Frames = None,
    frame: Annotated[int | None, frame_option("The frame to draw and to compare; the last by default.")] = None,
    picture: Annotated[bool, typer.Option("--picture/--no-picture", help="Render a frame of each task.")] = True,
    scheduler: Annotated[
        str | None,
        typer.Option(
            "--scheduler",
            metavar="ADDRESS",
            help="A scheduler of dask.distributed, such as tcp://farm:8786, whose workers see the same folders.",
            show_default=False,
        ),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(
            "--workers",
            min=1,
            max=ringlet.limits.WORKERS,
            help="Worker processes on this machine; one for each processor by default.",
            show_default=False,
        ),
    ] = None,
    here: Annotated[
        bool, typer.Option("--here", help="Run tasks one after the other in this process, without dask.")
    ] = False,
    threads: Annotated[
        int | None,
        typer.Option(
            "--threads",
            min=1,
            max=ringlet.limits.THREADS,
            help="Threads of each task; one by default.",
            show_default=False,
        ),
    ] = None,
    retries: Annotated[
        int,
        typer.Option(
            "--retries",
            min=0,
            max=ringlet.limits.RETRIES,
            help="How often a task is tried again after it fails or loses its worker.",
        ),
    ] = 2,
    compare: Annotated[bool, typer.Option("--compare", help="Only rebuild the page from results that exist.")] = False,
    openjd: Annotated[
        Path | None,
        typer.Option(
            "--openjd",
            metavar="FILE",
            help="Only write an Open Job Description template, for a render farm.",
            show_default=False,
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """Simulates a SHOT with every combination of settings and compares the results on a page.

    Each task has a folder with its shot, cache, log and picture; FOLDER/wedge.html shows them all. Run the same command
    again to continue: finished tasks are kept, interrupted ones resume, and new values add tasks.

    Exits with 1 if a task fails.

    Examples: ringlet wedge nod.shot.toml --set strands.bend_scale=1,2,4 --set contact.friction=0.1,0.3 ·
    ringlet wedge nod.shot.toml --set rest.mode=none,lofted --openjd wedge.template.json
    """
    if compare:
        show(ringlet.compare_wedge(shot, output), output, as_json)
        return
    choices = choices_of(settings or [])
    what: dict[str, Any] = {"frames": frames, "frame": frame, "picture": picture}
    if openjd is not None:
        count = ringlet.write_wedge_template(openjd, shot, choices, threads=threads, **what)
        summary = {"path": str(openjd), "tasks": count}
        run = f"openjd run {openjd} -p Shot={shot.absolute()} -p Folder={output.absolute()}"
        print_json(summary) if as_json else print(f"{openjd}: {count} tasks. Try it here: {run}")
        return
    with shown_progress() as progress:
        results = ringlet.wedge(
            shot,
            choices,
            output,
            scheduler=scheduler,
            workers=workers,
            here=here,
            threads=threads,
            retries=retries,
            progress=progress,
            **what,
        )
    show(results, output, as_json)


def choices_of(texts: list[str]) -> dict[str, str]:
    """``strands.bend_scale=1,2,4`` as a name and values, of each option."""
    choices: dict[str, str] = {}
    for text in texts:
        name, equals, values = text.partition("=")
        if not (name.strip() and equals and values.strip()):
            raise ringlet.UserError(f"--set {text}: must be SETTING=VALUE,VALUE…, such as strands.bend_scale=1,2,4")
        if name.strip() in choices:
            raise ringlet.UserError(f"--set {text}: {name.strip()} is given twice; name all its values in one --set")
        choices[name.strip()] = values
    return choices


def show(results: list[dict[str, Any]], folder: Path, as_json: bool) -> None:
    """Prints what the tasks gave; exits with 1 where one of them was not done."""
    if as_json:
        print_json({"page": str(folder / "wedge.html"), "tasks": results})
    else:
        rows = [
            [Path(result["folder"]).name, result["state"], f"{result['seconds']:.1f} s", result["message"]]
            for result in results
        ]
        print_table(["task", "", "took", ""], rows, right=(2,))
        print(f"{folder / 'wedge.html'}: {sum(r['state'] == 'done' for r in results)} of {len(results)} tasks are done")
    if any(result["state"] != "done" for result in results):
        raise typer.Exit(1)
