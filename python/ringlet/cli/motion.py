"""``ringlet motion``: how locks bounce, settle, sag and swing."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import AllowStale, GroomOfShot, Json, ShotFile, Threads, Variant, ending_in
from ringlet.cli.output import print_json, print_table
from ringlet.cli.progress import shown_progress


def motion(
    shot: ShotFile,
    cache: Annotated[
        Path | None,
        typer.Argument(metavar="[CACHE]", help="A simulation of the shot, to find there too.", show_default=False),
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            "--plot",
            callback=ending_in(".png", ".svg", ".pdf"),
            metavar="FILE",
            help="Draw the distribution of each word over the locks.",
            show_default=False,
        ),
    ] = None,
    groom: GroomOfShot = None,
    variant: Variant = None,
    allow_stale: AllowStale = False,
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Says how the locks of a SHOT will bounce, settle, sag and swing, before a frame is simulated.

    bounce: frequency along the lock; settle: time until a bounce has gone to a twentieth; sag: how much longer a lock
    hangs than it is groomed; swing: frequency sideways. Each is what the steps of the shot show of a lock that touches
    nothing; the column after it has the lock by itself. With a CACHE it says what came out, and how far coils open and
    close.

    Examples: ringlet motion nod.shot.toml --plot motion.png · ringlet motion nod.shot.toml cache.usdc
    """
    with shown_progress() as progress:
        settings = ringlet.read_shot(shot)
        source = groom or settings.groom
        if plot is not None:
            ringlet.check_place(plot, settings.named_files() | {"groom": source, "cache": cache})
        locks = ringlet.load_groom(source, variant=variant, progress=progress)
        words = ringlet.motion_words(settings, locks, cache=cache, allow_stale=allow_stale, progress=progress)
    if plot is not None:
        ringlet.plot_motion(words, plot, shot.name)
    if as_json:
        print_json(ringlet.motion_json(words) | {"plot": plot and str(plot)})
        return
    columns, rows = ringlet.motion_table(words)
    print_table(columns, rows, right=tuple(range(2, len(columns))))
    for sentence in words.notes:
        print(sentence)
    if plot is not None:
        print(plot)
