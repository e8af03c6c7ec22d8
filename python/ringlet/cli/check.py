"""``ringlet check``: what of a groom goes through the head or through other hair, and its repair."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

import ringlet
from ringlet.cli.options import Json, Threads, Variant, picture_file, usd_file
from ringlet.cli.output import density, print_json, print_table
from ringlet.cli.progress import shown_progress


def check(
    groom: Annotated[Path, typer.Argument(metavar="GROOM", help="A groom, or a recipe to make it from.")],
    variant: Variant = None,
    fix: Annotated[bool, typer.Option("--fix", help="Repair it, with the least change of shape.")] = False,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            callback=usd_file,
            metavar="FIXED",
            help="Where the repaired groom goes.",
            show_default=False,
        ),
    ] = None,
    picture: Annotated[
        Path | None,
        typer.Option(
            "--picture",
            callback=picture_file,
            metavar="PNG",
            help="Write a picture that marks the intersections.",
            show_default=False,
        ),
    ] = None,
    root_depth: Annotated[
        float,
        typer.Option("--root-depth", metavar="MM", min=0, max=1000, help="How deep roots may be in the skin."),
    ] = 0.5,
    root_length: Annotated[
        float,
        typer.Option(
            "--root-length",
            metavar="MM",
            min=0,
            max=1000,
            help="Length along the lock, from its root, in which that depth is allowed.",
        ),
    ] = 5.0,
    thickness: Annotated[
        float,
        typer.Option(
            "--thickness",
            metavar="MM",
            min=0,
            max=1000,
            help="Distance below which locks count as intersecting.",
        ),
    ] = 0.1,
    own_radius: Annotated[
        float,
        typer.Option(
            "--own-radius",
            metavar="PART",
            min=0,
            max=1,
            help="Fraction of their own radius at which locs and strands of braids touch.",
        ),
    ] = 0.85,
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Finds where locks of a GROOM intersect the scalp, the body or other hair, and how deep, and braids that fold.

    Exits with 1 if there are any. Example: ringlet check groom.usdc --fix -o fixed.usdc --picture check.png
    """
    if fix and output is None:
        raise ringlet.UserError("--fix: needs --output FIXED for the repaired groom")
    allowed = {
        "root_depth": 1e-3 * root_depth,
        "root_length": 1e-3 * root_length,
        "thickness": 1e-3 * thickness,
        "own_radius": own_radius,
    }
    with shown_progress() as progress:
        summary = ringlet.check_groom(
            groom, fixed=output if fix else None, picture=picture, variant=variant, progress=progress, **allowed
        )
    if as_json:
        print_json(summary)
    else:
        for name in ("found", "left") if fix else ("found",):
            rows = [
                [kind, f"{of['places']:,}", f"{of['locks']:,}", f"{1e3 * of['depth']:.3g} mm"]
                for kind, of in summary[name].items()
            ]
            print_table([name, "places", "locks", "depth"], rows, right=(1, 2, 3))
        if (folds := summary["folds"])["places"]:
            first = folds["worst"][0]
            print(
                f"{folds['braids']} of {folds['of']} braids or twists fold back on themselves, first lock "
                f"{first['lock']} at its point {first['point']}."
            )
        print(_thicknesses(summary))
        print(density(summary))
    if summary["folds"]["places"] or any(of["places"] for of in summary["left" if fix else "found"].values()):
        raise typer.Exit(1)


def _thicknesses(summary: dict[str, Any]) -> str:
    """How thick the hair that was checked was taken to be."""
    thickness, wide, own = (1e3 * summary[name] for name in ("thickness", "lock_thickness", "own_thickness"))
    if own > thickness:
        return (
            f"Locks with a radius of their own are checked as up to {own:.3g} mm thick, others as lines of "
            f"{thickness:.3g} mm."
        )
    if wide > thickness:
        return (
            f"Hair is checked as lines {thickness:.3g} mm thick. With their hairs locks are {wide:.3g} mm thick: "
            f"--thickness {wide:.3g} counts where these overlap."
        )
    return f"Hair is checked as lines {thickness:.3g} mm thick."
