"""``ringlet validate``: the simulator against answers that are known without one."""

from __future__ import annotations

from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import Json, Threads
from ringlet.cli.output import print_json, print_table
from ringlet.cli.progress import shown_progress


def validate(
    cases: Annotated[
        list[str] | None, typer.Argument(metavar="[CASE…]", help="Cases to run; all by default.", show_default=False)
    ] = None,
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Compares the simulator with known answers; exits with 1 where one does not hold.

    Examples: ringlet validate · ringlet validate cantilever --json
    """
    with shown_progress() as progress:
        rows = ringlet.run_validation(cases or None, progress=progress)
    if as_json:
        print_json([row.json() for row in rows])
    else:
        cells = [
            [
                row.case,
                f"{row.expected:.6g}",
                f"{row.got:.6g}",
                f"{row.error:.2g}",
                f"{row.tolerance:.2g}",
                "ok" if row.passed else "FAILS",
            ]
            for row in rows
        ]
        print_table(["case", "expected", "got", "error", "tolerance", ""], cells, right=(1, 2, 3, 4))
    if not all(row.passed for row in rows):
        raise typer.Exit(1)
