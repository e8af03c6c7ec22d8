"""``ringlet edit``: single locks taken out of the recipe, changed by hand, and given back."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated

import typer

import ringlet
from ringlet.cli.options import Json, lock_option
from ringlet.cli.output import print_json, print_table


def edit(
    recipe: Annotated[Path, typer.Argument(metavar="RECIPE", help="The recipe, a TOML file that names `edits`.")],
    freeze: Annotated[list[int] | None, lock_option("--freeze", "Isolate a lock in its present shape.")] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="LOCK:NAME=VALUE",
            help="Set a value for one lock alone, such as 12000003:curl.width=8mm.",
            show_default=False,
        ),
    ] = None,
    release: Annotated[list[int] | None, lock_option("--release", "Return a lock to the recipe.")] = None,
    release_all: Annotated[bool, typer.Option("--release-all", help="Return all locks to the recipe.")] = False,
    as_json: Json = False,
) -> None:
    """Isolates locks of a RECIPE for edits by hand, returns them to the recipe, and lists them.

    Example: ringlet edit curls.recipe.toml --freeze 12000003
    """
    for text in settings or ():
        lock, name, value = parse_setting(text)
        ringlet.edit_lock(recipe, lock, settings={name: value})
    for lock in freeze or ():
        ringlet.edit_lock(recipe, lock)
    if release or release_all:
        ringlet.release_locks(recipe, None if release_all else release)
    edits = ringlet.list_edits(recipe)
    if as_json:
        print_json({"edits": edits})
    elif edits:
        print_table(
            ["lock", "stage", "what", ""],
            [[str(e["lock"]), e["stage"], ", ".join(e["what"]), "" if e["there"] else "is not there"] for e in edits],
            right=(0,),
        )
    else:
        print("no lock is edited")


def parse_setting(text: str) -> tuple[int, str, str | float]:
    """``12:curl.width=8mm`` as lock, name and value."""
    lock, colon, rest = text.partition(":")
    name, equals, value = rest.partition("=")
    if not (colon and equals and name.strip() and value.strip() and re.fullmatch(r"\s*-?\d{1,15}\s*", lock)):
        raise ringlet.UserError(f"--set {text}: must be LOCK:NAME=VALUE, such as 12000003:curl.width=8mm")
    try:
        return int(lock), name.strip(), float(value)
    except ValueError:
        return int(lock), name.strip(), value.strip()
