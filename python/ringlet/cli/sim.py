"""``ringlet sim``: groom guides in motion."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import (
    AllowStale,
    Frames,
    GroomOfShot,
    Json,
    Report,
    ShotFile,
    Threads,
    Variant,
    locks_option,
    usd_file,
    usd_output,
)
from ringlet.cli.output import wrote
from ringlet.cli.progress import shown_progress


def sim(
    shot: ShotFile,
    output: Annotated[Path, usd_output("CACHE")] = Path("cache.usdc"),
    groom: GroomOfShot = None,
    variant: Variant = None,
    frames: Frames = None,
    allow_stale: AllowStale = False,
    rebind: Annotated[
        bool,
        typer.Option(
            "--rebind",
            help="Rebind the groom to the current head; writes CACHE.groom.usdc next to the cache.",
        ),
    ] = False,
    locks: Annotated[
        int | None,
        locks_option("Of finished hair without a recipe, strands to simulate, which others follow; all by default."),
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Continue a run that was interrupted; the result is the same to the bit.")
    ] = False,
    contacts: Annotated[
        Path | None,
        typer.Option(
            "--contacts",
            callback=usd_file,
            metavar="FILE",
            help="Write contacts to this USD file, as coloured points over the cache.",
            show_default=False,
        ),
    ] = None,
    report: Report = None,
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Simulates the groom of a SHOT while the scalp moves.

    The cache is a layer over the groom. Where the shot names a recipe, or finished hair of another program, the groom
    is made first, and written next to the cache with it: cache.groom.usdc under cache.usdc. What is done is kept in
    CACHE.part while it runs; after a run that was killed, or met a full disk, --resume goes on from there.

    Examples: ringlet sim nod.shot.toml -o cache.usdc --frames 1:24 · ringlet sim nod.shot.toml --groom groom.usdc
    """
    said: list[str] = []  # warnings that were printed already
    with ringlet.Run("sim", report) as run, shown_progress() as progress:
        settings = ringlet.read_shot(shot)
        if contacts is not None and not settings.touching:
            raise ringlet.UserError(f"{shot}: nothing touches, --contacts has nothing to write; add [contact]")
        source = groom or settings.groom
        finished = ringlet.is_finished_hair(source)
        if locks is not None and not finished:
            raise ringlet.UserError(f"--locks {locks}: {source} has locks already; leave it out")
        made = rebind or finished or source.suffix == ".toml"
        layer = output.with_suffix(f".groom{output.suffix}") if made else source
        _check_places(settings.named_files() | {"groom": source}, layer if made else None, output, contacts)
        with _checkpoint_folder(output, resume) as folder:  # from here on everything beside the cache is this run's
            with run.stage("groom", layer if made else None):
                if finished:
                    made_groom = ringlet.adopt_groom(
                        source, head_file=output.with_suffix(f".head{output.suffix}"), locks=locks
                    )
                else:
                    made_groom = ringlet.load_groom(source, variant=variant, rebind=rebind, progress=progress)
                for path in filter(None, (output, contacts)):
                    ringlet.check_place(path, {"head": made_groom.scalp_file})
                for conflict in made_groom.conflicts:
                    _warn(run, said, conflict)
                if finished:
                    ringlet.write_groom(made_groom, layer)
                    made_groom = ringlet.read_groom(layer)  # which holds the scalp
            with run.stage("simulate", output):
                record = ringlet.write_simulation(
                    settings,
                    made_groom,
                    layer,
                    output,
                    frames=frames,
                    allow_stale=allow_stale,
                    checkpoints=folder,
                    write_under=made and not finished,
                    resume=resume,
                    touches=contacts is not None,
                    progress=progress,
                    on_warning=lambda sentence: _warn(run, said, sentence),
                )
            if contacts is not None:
                with run.stage("contacts", contacts, "what touches, frame by frame"):
                    ringlet.write_touches(record, output, contacts)
        verdict = run.simulated(record)
        run.count(locks=len(made_groom.locks), points=len(made_groom.locks.points), frames=len(record.frames))
        if record.cloths:
            run.count(cloths=len(record.cloths), cloth_points=sum(record.cloths.values()))
    unsaid = [sentence for sentence in run.warnings if sentence not in said]
    for sentence in [] if as_json else [*verdict.lines(), *unsaid]:
        print(sentence)
    start = {name: found for name, found in record.start.items() if name != "marks"}  # these are for pictures
    more = {name: value for name, value in (("start", start), ("notes", record.notes)) if value}
    wrote(output, run.counts, as_json, verdict=verdict.json(), slowest=run.slowest, **more)


def _warn(run: ringlet.Run, said: list[str], sentence: str) -> None:
    """Prints a warning before the work that it is about, and keeps it for the report."""
    run.warn(sentence)
    said.append(sentence)
    print(f"warning: {sentence}", file=sys.stderr, flush=True)


def _check_places(read: dict[str, Path], layer: Path | None, output: Path, contacts: Path | None) -> None:
    """Refuses files to be written that are one another, or what the run reads, before its first stage.

    read:  what the shot names, by its setting; "groom" is the one that is simulated
    layer: the groom under the cache, where that is written too
    """
    if read["groom"].suffix == ".toml":
        read = ringlet.read_recipe(read["groom"]).named_files() | read
    taken: dict[str, Path | None] = {**read}
    for path, what in ((layer, "groom under the cache"), (output, "cache"), (contacts, "contacts")):
        if path is not None:
            ringlet.check_place(path, taken)
            taken[what] = path


@contextmanager
def _checkpoint_folder(output: Path, resume: bool) -> Iterator[Path]:
    """The folder that keeps what is done, until all is; says so where a run is broken off, or was and is forgotten."""
    folder = output.with_name(f"{output.name}.part")
    with ringlet.hold_checkpoints(folder) as left:
        if left and not resume:
            print(
                f"{folder} keeps {left} frames, preroll included, of a run that was broken off, and --resume goes on "
                "from there; without it they are thrown away, and all begins anew",
                file=sys.stderr,
            )
        try:
            yield folder
        except BaseException:
            if any(folder.glob("memory.*")):
                print(
                    f"{folder} keeps what is done: the same command with --resume goes on from there", file=sys.stderr
                )
            raise
        ringlet.discard_checkpoints(folder)
