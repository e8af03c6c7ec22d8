"""The message with the state of an open file."""

from __future__ import annotations

from ringlet.groom import Recipe
from ringlet.groom.load import APPEND
from ringlet.viewer import protocol
from ringlet.viewer.files.document import State
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.protocol import File, Place
from ringlet.viewer.wire import pack


def document_message(files: Files, file: File) -> bytes:
    """Message with the state of a file; of several grooms, with the settings of the chosen one."""
    document = files.documents[file]
    contents, model = document.contents(), document.model
    grooms: list[str] = []
    groom = ""
    if file == "recipe":
        grooms, groom = [*model.grooms], files.groom
        contents, model = files.own_tables(), files.chosen_recipe
        if (names := files.inherited()) is not None:
            shape = contents.get("shape", {})
            contents = {**contents, "shape": [shape.get(name, {}) for name in names] + shape.get(APPEND, [])}
    edited = document.state.edits != document.saved_edits
    return pack(
        protocol.Document.model_validate(
            {
                "file": file,
                "name": document.path.name,
                "revision": document.revision,
                "text": document.text,
                "edits": document.state.edits if edited else "",
                "saved": document.saved if document.dirty else "",
                "saved_edits": document.saved_edits if edited else "",
                "said": contents,
                "values": model.model_dump(mode="json", exclude={"sculpt"}),
                "grooms": grooms,
                "groom": groom,
                "stages": stages(model, document.state) if file == "recipe" else [],
                "dirty": document.dirty,
                "undo": document.can_undo,
                "redo": document.can_redo,
                "changes": document.diff(),
            }
        )
    )


def stages(recipe: Recipe, state: State) -> list[protocol.Stage]:
    """Stages of a recipe in their order."""
    operators: list[tuple[str, Place]] = [(operator.op, ["shape", k]) for k, operator in enumerate(recipe.shape)]
    before: list[tuple[str, Place]] = [(name, [name]) for name in ("guides", "locks")]
    after: list[tuple[str, Place]] = [(name, [name]) for name in ("curl", "collide", "hairs", "color", "fiber")]
    return [
        protocol.Stage(
            name=op,
            op=op,
            place=place,
            muted=(key := "/".join(map(str, place))) in state.muted,
            solo=key == state.solo,
        )
        for op, place in [*before, *operators, *after]
    ]
