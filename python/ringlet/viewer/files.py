"""The open files of a session: a recipe with its file of edits, or a shot and its recipe."""

from __future__ import annotations

from pathlib import Path
from typing import Any, get_args

from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.regular import read_text
from ringlet.data.settings import parse_toml, read_toml
from ringlet.groom import Recipe, parse_recipe
from ringlet.groom.edits_file import edits_text
from ringlet.groom.load import APPEND, inherited, parse_edits
from ringlet.groom.operators import Operator, ShapeOperator
from ringlet.shot import Shot, parse_shot
from ringlet.viewer import protocol
from ringlet.viewer.document import Document, History, set_value
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import Place
from ringlet.viewer.variant import variant
from ringlet.viewer.wire import pack


class Files:
    """The open files, with one undo history. Reads and writes inside the project only.

    mode: kind of the opened file: ``recipe``, ``shot``, or ``stage`` for a USD file without editing
    """

    def __init__(self, file: Path, project: Project) -> None:
        self.project, self.file = project, project.inside(file, "view")
        self.documents: dict[str, Document] = {}
        self.mode = "stage"
        self._history = History()
        if self.file.suffix == ".toml":
            self._open()

    def _open(self) -> None:
        """Opens the recipe, or the shot and its recipe."""
        _, data = read_toml(self.file, "recipe or shot")
        self.mode, recipe = "recipe", self.file
        if "groom" in data and "frames" in data:
            self.mode = "shot"
            self.documents["shot"] = Document(self.file, lambda text, _: self.parse_shot(text), history=self._history)
            recipe = self.project.inside(self.shot.groom, f"{self.file.name}: groom")
        if recipe.suffix == ".toml":
            edits = _text_of(self.parse(read_text(recipe, "give a recipe file"), recipe).edits_file)
            self.documents["recipe"] = Document(
                recipe, lambda text, edits: self.parse(text, recipe, edits), edits, self._history
            )

    # Parsing

    def parse(self, text: str, path: Path, edits: str = "") -> Recipe:
        """Parses a recipe whose files are all inside the project.

        edits: text of its file of edits

        Raises UserError for a file outside the project.
        """
        self._confine(parse_toml(text, path.name, "recipe"), path)
        recipe = parse_recipe(text, path, edits or None)
        for what, file in recipe.named_files().items():
            self.project.inside(file, f"{path.name}: {what}")
        return recipe

    def _confine(self, data: dict[str, Any], path: Path) -> None:
        """Raises UserError when a base or a file of edits is outside the project."""
        for setting in ("extends", "edits"):
            if not isinstance(name := data.get(setting), str):
                continue
            file = self.project.inside(path.parent / name, f"{path.name}: {setting}")
            if setting == "extends" and file.is_file() and file != path.resolve():
                self._confine(read_toml(file, "recipe")[1], file)

    def parse_shot(self, text: str) -> Shot:
        """Parses a shot whose files are all inside the project; raises UserError for others."""
        shot = parse_shot(text, self.file)
        for what, file in shot.named_files().items():
            self.project.inside(file, f"{self.file.name}: {what}")
        return shot

    def document(self, file: str) -> Document:
        """The open file of a kind, ``recipe`` or ``shot``; raises UserError when none is open."""
        if file not in self.documents:
            raise UserError(f"{self.file.name}: no {file} is open; open one with: ringlet view")
        return self.documents[file]

    @property
    def recipe(self) -> Document:
        """The open recipe; raises UserError when none is open."""
        if "recipe" not in self.documents:
            raise UserError(f"{self.file.name}: holds no recipe to edit; open a recipe or a shot that names one")
        return self.documents["recipe"]

    @property
    def shot(self) -> Shot:
        """The shot in its current state."""
        return self.document("shot").model

    # Changes

    def set(self, file: str, changes: list[tuple[Place, Any]], gesture: int) -> None:
        """Sets values of settings; None removes a setting."""
        document = self.document(file)
        before = document.model
        names = self._inherited(document) if file == "recipe" else None
        if names is not None:
            changes = [(_by_name(place, names), value) for place, value in changes]
        document.set(changes, gesture)
        if file == "recipe" and document.model.edits_file != before.edits_file:
            document.apply(document.text, edits=_text_of(document.model.edits_file), gesture=gesture)

    def edit_operators(self, action: str, at: int, to: int, op: str) -> None:
        """Adds, removes or moves a shape operator of the recipe; muted operators stay muted.

        Raises UserError when a variant would move or add an operator of its base.
        """
        document = self.recipe
        names = self._inherited(document)
        order = [f"shape/{k}" for k in range(len(document.model.shape))]
        if names is None:
            if action == "add":
                document.add_tables("shape", at, [{"op": op, **_starter(op)} if op else {}])
            elif action == "remove":
                document.remove_tables("shape", [at])
            else:
                document.move_table("shape", at, to)
        elif action == "remove" and at < len(names):
            document.set([(["shape", names[at]], None), (["shape", names[at]], False)])
        else:
            base = document.contents()["extends"]
            raise UserError(
                f"{document.path.name}: changes and removes operators of {base}, and does neither move nor add any; "
                f"do that in {base}, or give it [[shape]] tables of its own"
            )
        muted = document.state.muted
        if muted & set(order):
            if action == "add":
                order.insert(at, "")
            else:
                moved = order.pop(at)
                order[to:to] = [moved] if action == "move" else []
            muted_shapes = {f"shape/{k}" for k, old in enumerate(order) if old in muted}
            document.apply(document.text, muted=frozenset(muted_shapes | {one for one in muted if "/" not in one}))

    def write_edits(self, kind: str, tables: list[dict[str, Any]], gesture: int | None = None) -> None:
        """Replaces the tables of a kind in the recipe's file of edits; names a new file when there is none."""
        document = self.recipe
        edits = parse_edits(document.state.edits or "ringlet = 1", document.path)
        text = edits_text({**edits, kind: tables})
        if not document.contents().get("edits"):
            document.set([(["edits"], self._unused_name(document.path, ".edits.toml"))], gesture)
        document.apply(document.text, edits=text, gesture=gesture)

    def step(self, kind: str) -> list[str]:
        """Undoes, redoes or reverts to the saved state; returns the kinds of the changed files."""
        if kind == "revert":
            before = {name: document.state for name, document in self.documents.items()}
            for document in self.documents.values():
                document.apply(document.saved, edits=document.saved_edits)
            return [name for name, document in self.documents.items() if document.state != before[name]]
        changed = self._history.undo() if kind == "undo" else self._history.redo()
        return [name for name, document in self.documents.items() if document is changed]

    def _inherited(self, document: Document) -> list[str] | None:
        return inherited(document.contents(), document.path)

    # Saving

    def save(self, file: str, name: str = "", as_variant: bool = False) -> Path:
        """Writes a file and its manual edits.

        name:       file name of a copy beside it; empty for the file itself
        as_variant: whether the copy extends the file

        Raises UserError when the copy exists already.
        """
        document = self.document(file)
        if not name:
            if document.state.edits != document.saved_edits:
                _write(document.model.edits_file, document.state.edits)
            return document.save()
        path = self.project.beside(name, f".{file}.toml")
        if path.exists():
            raise UserError(f"save: {path.name} is there already; give another name")
        text = document.text
        if file == "recipe":
            edits = None
            if document.state.edits != document.saved_edits:
                edits = path.with_name(self._unused_name(path, ".edits.toml"))
            text = variant(document, self.parse, path, edits) if as_variant else copied(document, edits)
            self.parse(text, path, document.state.edits)
            if edits is not None:
                _write(edits, document.state.edits)
        return document.save(path, text)

    def _unused_name(self, path: Path, suffix: str) -> str:
        """File name after a recipe's name that does not exist yet."""
        stem = path.name.removesuffix(".toml").removesuffix(".recipe")
        names = [f"{stem}{suffix}", *(f"{stem}-{k}{suffix}" for k in range(2, 100))]
        return next(name for name in names if not path.with_name(name).exists())

    # Messages

    def message(self, file: str) -> bytes:
        """Message with the state of a file."""
        document = self.documents[file]
        contents, model = document.contents(), document.model
        if file == "recipe" and (names := self._inherited(document)) is not None:
            shape = contents.get("shape", {})
            contents = {**contents, "shape": [shape.get(name, {}) for name in names] + shape.get(APPEND, [])}
        return pack(
            protocol.Document.model_validate(
                {
                    "file": file,
                    "name": document.path.name,
                    "revision": document.revision,
                    "text": document.text,
                    "edits": document.state.edits if document.state.edits != document.saved_edits else "",
                    "said": contents,
                    "values": model.model_dump(mode="json", exclude={"sculpt"}),
                    "stages": stages(model, document.state.muted) if file == "recipe" else [],
                    "dirty": document.dirty,
                    "undo": document.can_undo,
                    "redo": document.can_redo,
                    "changes": document.diff(),
                }
            )
        )


def stages(recipe: Recipe, muted: frozenset[str]) -> list[protocol.Stage]:
    """Stages of a recipe in their order."""
    found: list[tuple[str, str, Place]] = [("guides", "guides", ["guides"]), ("locks", "locks", ["locks"])]
    found += [(operator.op, operator.op, ["shape", k]) for k, operator in enumerate(recipe.shape)]
    for name in ("curl", "clean", "hairs", "color", "fiber"):
        found.append((name, name, [name]))
    return [
        protocol.Stage(name=name, op=op, place=place, muted="/".join(map(str, place)) in muted)
        for name, op, place in found
    ]


def _starter(op: str) -> dict[str, Any]:
    """Settings with which a shape operator is added; none for an unknown one."""
    kinds: tuple[type[Operator], ...] = get_args(get_args(ShapeOperator)[0])
    return next((dict(kind.starter) for kind in kinds if kind.model_fields["op"].default == op), {})


def operator_names(schema: dict[str, Any]) -> list[str]:
    """Names of the shape operators."""
    return list(schema["properties"]["shape"]["items"]["discriminator"]["mapping"])


def copied(document: Document, edits: Path | None) -> str:
    """Text of a copy of a document, with the name of its own file of edits if it has one."""
    return document.text if edits is None else set_value(document.text, ["edits"], edits.name)


def _by_name(place: Place, names: list[str]) -> Place:
    """Converts an index of a shape operator to the name that a variant uses, or to its place among those it appends."""
    if len(place) > 1 and place[0] == "shape" and isinstance(place[1], int):
        at = place[1]
        return ["shape", names[at], *place[2:]] if at < len(names) else ["shape", APPEND, at - len(names), *place[2:]]
    return place


def _text_of(file: Path | None) -> str:
    return read_text(file, "give a file of edits") if file is not None and file.exists() else ""


def _write(file: Path | None, text: str) -> None:
    if file is not None:
        with replacing(file, update=True) as aside:
            aside.write_text(text or "ringlet = 1\n", encoding="utf-8")
