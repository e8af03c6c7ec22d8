"""``ringlet loft``: the shape that locks must remember to hang as they were groomed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import GroomOfShot, Json, Report, ShotFile, Threads, Variant, usd_file
from ringlet.cli.output import print_json, print_table, size
from ringlet.cli.progress import shown_progress

MEASURES = {
    "away": "away from the groom, vertices",
    "drop": "drop of the tips",
    "height": "height of the locks, change",
}
NEAR = 1e-3  # what hangs within this of where it should counts as held [m]


def loft(
    shot: ShotFile,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            callback=usd_file,
            metavar="REST",
            help="The USD file to write; by default where the shot will look for it.",
            show_default=False,
        ),
    ] = None,
    groom: GroomOfShot = None,
    variant: Variant = None,
    again: Annotated[bool, typer.Option("--again", help="Loft all locks, also those that have not changed.")] = False,
    report: Report = None,
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Computes rest shapes of a SHOT with which locks that hang under gravity have the shape of the groom.

    The locks hang still under the forces of the shot, in the rest pose of the scalp. Where REST is there already, only
    locks that have changed since are lofted. The shot uses it with [rest] mode = "lofted" or "equilibrium".

    Examples: ringlet loft nod.shot.toml · ringlet loft nod.shot.toml --report out
    """
    shown = report is not None
    with ringlet.Run("loft", report) as run, shown_progress() as progress:
        settings = ringlet.read_shot(shot)
        path = output or ringlet.rest_place(settings)
        with run.stage("groom"):
            locks = ringlet.load_groom(groom or settings.groom, variant=variant, progress=progress)
        with run.stage("loft", path, "the shape that locks remember"):
            made = ringlet.loft(settings, locks, known=None if again else path, sag=shown or as_json, progress=progress)
            ringlet.write_loft(made, settings, path)
        near = int((made.off < NEAR).sum())
        run.count(locks=len(locks.locks), points=len(locks.locks.points), held=near)
        lost = made.lost()
        rows = [
            [f"{what}, {when} loft", *(f"{1e3 * lost[name][f'{when} {k}']:.2f}" for k in ("mean", "95", "max"))]
            for name, what in MEASURES.items()
            for when in ("without", "with")
            if f"{when} mean" in lost[name]
        ]
        columns = ["mm", "mean", "95 % are below", "most"]
        run.table("What gravity takes from the groom", columns, rows)
        stiffer = made.stiffened[made.stiffened > 1.0] if made.stiffened is not None else made.off[:0]
        if len(stiffer):
            run.warn(
                f"{len(stiffer)} of {len(made.off)} locks were made up to {stiffer.max():.1f} times stiffer to stand."
            )
        fell, moving = len(made.off) - near, int((made.moving > 1e-6).sum())
        if fell:
            run.warn(f"{fell} of {len(made.off)} locks do not hang as groomed: probably too soft to stand.")
        if moving:
            run.warn(f"{moving} of {len(made.off)} locks were not quite still when they were measured.")
        if settings.rest.mode == "none":
            run.warn(f'{shot.name} does not use this shape: for that it needs [rest] with mode = "lofted".')
        if shown:
            picture = report / "loft.png"
            with run.stage("picture", picture, "the groom, and how it hangs"):
                ringlet.write_loft_picture(made, picture, title=f"{shot.name}: the loft", progress=progress)
            run.pictured(picture, "The groom; how it hangs without the loft; how it hangs with it.")
    if as_json:
        summary = {"path": str(path), "bytes": path.stat().st_size, **run.counts}
        print_json({**summary, "tolerance": NEAR, "most_moving": float(made.moving.max()), "lost": lost})
        return
    print_table(columns, rows, right=(1, 2, 3))
    for sentence in run.warnings:
        print(sentence)
    print(f"{path}: {len(locks.locks):,} locks, {near:,} within 1 mm, {size(path.stat().st_size)}")
