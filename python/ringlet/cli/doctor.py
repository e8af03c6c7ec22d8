"""``ringlet doctor``: what is installed, and whether it works."""

from __future__ import annotations

from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import Json, Threads
from ringlet.cli.output import print_json, print_table
from ringlet.cli.progress import shown_progress


def doctor(
    self_test: Annotated[
        bool, typer.Option("--self-test/--no-self-test", help="Groom, simulate, write, read and render a small scene.")
    ] = True,
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Reports the installation, the processor, threads and optional parts, and runs a self-test.

    It takes about ten seconds; exits with 1 where something does not work.

    Examples: ringlet doctor · ringlet doctor --no-self-test --json
    """
    with shown_progress() as progress:
        findings = ringlet.diagnose(self_test=self_test, progress=progress)
    failed = [finding for finding in findings if finding.state == "fails"]
    if as_json:
        print_json([finding.json() for finding in findings])
    else:
        print_table(["", "", "found", "remedy"], [[f.name, f.state, f.found, f.remedy] for f in findings])
    if failed:
        raise typer.Exit(1)
