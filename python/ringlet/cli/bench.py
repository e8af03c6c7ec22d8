"""``ringlet bench``: how fast it is on this machine."""

from __future__ import annotations

import json
from typing import Annotated, Any

import typer

import ringlet
from ringlet.cli.options import Json, Threads
from ringlet.cli.output import print_json, print_table


def bench(
    name: Annotated[str, typer.Argument(metavar="NAME", help="What to measure: groom, strands or twirl.")],
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set", metavar="KEY=VALUE", help="A parameter of the benchmark; may be given again.", show_default=False
        ),
    ] = None,
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Measures a part of Ringlet.

    Examples: ringlet bench groom · ringlet bench strands --json --set strands=500 --threads 1
    """
    result = ringlet.run_bench(name, **dict(map(parse_setting, settings or [])))
    if as_json:
        print_json(result)
        return
    print_table(["", ""], [[key, json.dumps(value)] for key, value in result.items()])


def parse_setting(text: str) -> tuple[str, Any]:
    """``strands=500`` as a name and a value; what is no JSON is text."""
    key, equals, value = text.partition("=")
    if not equals or not key.isidentifier():
        raise ringlet.UserError(f"--set {text}: must be KEY=VALUE, such as strands=500")
    try:
        return key, json.loads(value)
    except ValueError:
        return key, value
