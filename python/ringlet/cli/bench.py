"""``ringlet bench``: how fast it is on this machine."""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import takewhile, zip_longest
from typing import Annotated, Any

import typer

import ringlet
from ringlet.cli.options import Json, Threads
from ringlet.cli.output import print_json, print_table


def bench(
    context: typer.Context,
    name: Annotated[
        str,
        typer.Argument(
            metavar="NAME",
            help="What to measure: cloth, collide, direct, groom, growth, head, iterations, liveliness, mixed, page, "
            "rest, slider, strands, twirl, view, warp …; or compare, with a commit and names",
        ),
    ],
    as_json: Json = False,
    threads: Threads = None,
) -> None:
    """Measures a part of Ringlet. A benchmark's own parameters are given as --PARAMETER VALUE.

    Examples: ringlet bench groom · ringlet bench strands --json --threads 1 · ringlet bench twirl --strands 1024 --json
    · ringlet bench compare v0.1.0 strands "twirl --strands 1024"
    """
    words = tuple(takewhile(lambda word: not word.startswith("--"), context.args)) if name == "compare" else ()
    params = dict(parameters(context.args[len(words) :]))
    result = ringlet.run_bench(name, **params, **({"words": words} if words else {}))
    if as_json:
        print_json(result)
        return
    print_table(["", ""], [[key, json.dumps(value)] for key, value in result.items()])


def parameters(words: list[str]) -> Iterator[tuple[str, Any]]:
    """``--strands 500`` as a name and a value; what is no JSON is text. Words of a name may be joined by ``-``."""
    for option, value in zip_longest(words[::2], words[1::2]):
        if not option.startswith("--") or value is None:
            raise ringlet.UserError(
                f"bench: {option}: parameters are given as --PARAMETER VALUE, such as --strands 500"
            )
        parameter = option[2:].replace("-", "_")
        try:
            yield parameter, json.loads(value)
        except ValueError:
            yield parameter, value
