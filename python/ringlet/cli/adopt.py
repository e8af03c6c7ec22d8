"""``ringlet adopt``: a recipe of finished hair."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

import ringlet
from ringlet.cli.options import UNITS, FromUnit, FromUp, Json, Report, Threads, locks_option
from ringlet.cli.output import print_json
from ringlet.cli.progress import shown_progress


def adopt(
    hair: Annotated[Path, typer.Argument(metavar="HAIR", help="USD, .abc, .hair, .tfx, or .obj with polylines.")],
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="RECIPE", help="The recipe to write, with files next to it.")
    ] = Path("adopted.recipe.toml"),
    head: Annotated[
        Path | None,
        typer.Option(
            "--head",
            metavar="FILE",
            help="USD or OBJ of the head; by default the mesh of HAIR, or else a surface through the roots.",
            show_default=False,
        ),
    ] = None,
    mesh: Annotated[
        str | None, typer.Option("--mesh", metavar="PRIM", help="Prim of the head.", show_default=False)
    ] = None,
    locks: Annotated[int | None, locks_option("Number of locks; by default one for each clump.")] = None,
    from_unit: FromUnit = None,
    from_up: FromUp = None,
    report: Report = None,
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Turns finished HAIR of any program into a recipe that can be simulated as it is, and edited.

    Clumps become locks, their curls become settings, and what these do not fit is kept.

    Example: ringlet adopt mohawk.tfx -o mohawk.recipe.toml --from-unit cm
    """
    with ringlet.Run("adopt", report) as run, shown_progress() as progress:
        with run.stage("adopt", output):
            done: dict[str, Any] = ringlet.adopt(
                hair,
                output,
                head=head,
                mesh=mesh,
                locks=locks,
                source_unit=UNITS[from_unit] if from_unit else None,
                source_up=from_up,
                progress=progress,
            )
        run.count(hairs=done["hairs"], locks=done["locks"])
    if as_json:
        print_json({"path": str(output), **done})
        return
    how = {"shape": "found by their shapes", "each": "one a hair", "count": "as many as asked for"}
    print(f"{output}: {done['hairs']:,} hairs in {done['locks']:,} locks ({how.get(done['clumps'], done['clumps'])})")
    if done["coiled"]:
        print(
            f"{done['coiled']:,} coiled: width {1e3 * done['width']:.3g} mm, pitch {1e3 * done['pitch']:.3g} mm, "
            f"{100 * done['right_handed']:.0f} % right-handed"
        )
    print(f"distance to the hair as it was: median {_mm(done, 'median')}, 95 % below {_mm(done, '95')}")


def _mm(done: dict[str, Any], name: str) -> str:
    return f"{1e3 * done['error'][name]:.3g} mm"
