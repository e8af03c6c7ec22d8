"""Recipes and shots of a host: their changes, their files and their settings."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from pydantic import BaseModel

from ringlet.data.files import replacing
from ringlet.data.settings import check_name
from ringlet.data.share import share
from ringlet.groom import parse_recipe, read_recipe
from ringlet.groom.named import GROOMS
from ringlet.host.requests import AddTable, Change, MoveTable, SetValue, Text
from ringlet.shot import parse_shot
from ringlet.viewer.files.document import Document
from ringlet.viewer.protocol import Place

LOOKS = ("examples/types", "examples/looks")
EXTENSION = ".recipe.toml"


class Applied(NamedTuple):
    """A recipe or a shot: its text with the changes, and the model of its file, which has the overlay too."""

    text: str
    model: Any


def apply(kind: str, text: Text, folder: Path) -> Applied:
    """Makes the changes of a text and writes its file in the folder.

    Raises UserError for a change that cannot be made and for a text that is invalid; the file then stays as it was.
    """
    path = folder / text.name
    parse = parse_recipe if kind == "recipe" else parse_shot
    document = Document(path, lambda now, _: parse(now, path), text=text.text)
    for change in text.changes:
        _make(document, change)
    kept = document.text
    for change in text.overlay:
        _make(document, change)
    with replacing(path) as aside:
        aside.write_text(document.text, encoding="utf-8")
    return Applied(kept, document.model)


def _make(document: Document, change: Change) -> None:
    if isinstance(change, SetValue):
        document.set([(_place(document, change), change.value)])
    elif isinstance(change, AddTable):
        document.add_tables(change.add, change.at, [change.entry])
    elif isinstance(change, MoveTable):
        document.move_table(change.move, change.at, change.to)
    else:
        document.remove_tables(change.remove, [change.at])


def _place(document: Document, change: SetValue) -> Place:
    """The place that a change sets: that of a plain number itself, where the change names its ``value``."""
    place: Place = change.set
    if len(place) < 2 or place[-1] != "value":
        return place
    found: Any = document.contents()
    for key in place[:-1]:
        rows: Any = dict(enumerate(found)) if isinstance(found, list) else found
        found = rows.get(key) if isinstance(rows, dict) else None
    return place if isinstance(found, dict) else place[:-1]


def settings(model: BaseModel) -> dict[str, Any]:
    """All settings of a recipe or a shot with their defaults, in SI units."""
    return model.model_dump(mode="json", exclude={GROOMS, "edit", "sculpt"})


def looks() -> list[dict[str, str]]:
    """The recipes of one groom that come with Ringlet: ``name`` and ``group``."""
    return [
        {"name": path.name.removesuffix(EXTENSION), "group": folder.rpartition("/")[2]}
        for folder in LOOKS
        for path in sorted(share(folder).glob(f"*{EXTENSION}"))
        if f"[{GROOMS}." not in path.read_text(encoding="utf-8")
    ]


def look(name: str) -> str:
    """The text of one of ``looks``, with what it extends in it. Raises UserError for another name."""
    files = {path.name.removesuffix(EXTENSION): path for at in LOOKS for path in share(at).glob(f"*{EXTENSION}")}
    check_name(name, files, "look", "recipe")
    return read_recipe(files[name]).text or ""
