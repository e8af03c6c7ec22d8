"""The shape operators of the open recipe: adds, removes and moves them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar, get_args

from ringlet.data.errors import UserError
from ringlet.groom.load import APPEND
from ringlet.groom.named import GROOMS
from ringlet.groom.operators import Operator, ShapeOperator
from ringlet.viewer import protocol
from ringlet.viewer.files.document import Document
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.protocol import Place

Entry = TypeVar("Entry")
Tables = dict[str, Any]


def arrange(files: Files, message: protocol.Arrange) -> None:
    """Adds, removes or moves a shape operator; muted operators stay muted.

    Raises UserError when a variant would move an operator of its base, or add one before it.
    """
    document, action, at, to = files.recipe, message.action, message.at, message.to
    stages = [f"shape/{k}" for k in range(len(files.chosen_recipe.shape))]
    new = {**({"op": message.op, **_starter(message.op)} if message.op else {}), **message.values}
    if (names := files.inherited()) is not None:
        _arrange_inherited(files, names, action, at, to, new)
    elif files.groom:
        shape = files.own_tables().get("shape", [])
        if not 0 <= at < len(shape) + (action == "add"):
            raise UserError(f"{document.path.name}: shape has {len(shape)} operators; there is none at {at}")
        document.set([([GROOMS, files.groom, "shape"], _arranged(shape, action, at, to, new))])
    else:
        _arrange_tables(document, "shape", action, at, to, new)
    places = {old: f"shape/{k}" for k, old in enumerate(_arranged(stages, action, at, to, ""))}

    def now(stage: str) -> str:
        return places.get(stage, "") if "/" in stage else stage

    muted = frozenset(filter(None, map(now, document.state.muted)))
    document.keep(muted=muted, solo=now(document.state.solo))


def _arrange_inherited(files: Files, names: list[str], action: str, at: int, to: int, new: Tables) -> None:
    """Edits the operators of a variant: it removes those of its base by name, and has tables of its own after them.

    names: names of the operators of the base
    """
    document = files.recipe
    if action == "remove" and at < len(names):
        place: Place = [GROOMS, files.groom, "shape"] if files.groom else ["shape"]
        document.set([([*place, names[at]], None), ([*place, names[at]], False)])
        return
    first = min(at, to) if action == "move" else at
    if files.groom or first < len(names):
        base = files.own_tables()["extends"]
        raise UserError(
            f"{document.path.name}: operators of {base} keep their order, and others follow them; "
            f"move them in {base}, or give {document.path.name} [[shape]] tables of its own"
        )
    _arrange_tables(document, f"shape.{APPEND}", action, at - len(names), to - len(names), new)


def _arrange_tables(document: Document, name: str, action: str, at: int, to: int, new: Tables) -> None:
    """Adds, removes or moves a table of an array of tables."""
    if action == "add":
        document.add_tables(name, at, [new])
    elif action == "remove":
        document.remove_tables(name, [at])
    else:
        document.move_table(name, at, to)


def _arranged(entries: Sequence[Entry], action: str, at: int, to: int, new: Entry) -> list[Entry]:
    """A list with ``new`` added at ``at``, or the entry there removed or moved to ``to``."""
    arranged = list(entries)
    if action == "add":
        arranged.insert(at, new)
    else:
        moved = arranged.pop(at)
        arranged[to:to] = [moved] if action == "move" else []
    return arranged


def _starter(op: str) -> Tables:
    """Settings with which a shape operator is added; none for an unknown one."""
    kinds: tuple[type[Operator], ...] = get_args(get_args(ShapeOperator)[0])
    return next((dict(kind.starter) for kind in kinds if kind.model_fields["op"].default == op), {})


def operator_names(schema: dict[str, Any]) -> list[str]:
    """Names of the shape operators, from the schema of recipes."""
    return list(schema["properties"]["shape"]["items"]["discriminator"]["mapping"])
