"""``ringlet schema``: what recipes and shots may hold, for editors and other programs."""

from __future__ import annotations

from typing import Annotated, Literal

import typer

import ringlet
from ringlet.cli.output import print_json


def schema(
    kind: Annotated[
        Literal["recipe", "shot"] | None,
        typer.Argument(metavar="[KIND]", help="recipe or shot; both by default.", show_default=False),
    ] = None,
) -> None:
    """Prints the JSON schema of recipes and shots.

    Example: ringlet schema recipe > recipe.schema.json
    """
    schemas = ringlet.schema()
    print_json(schemas[kind] if kind else schemas)
