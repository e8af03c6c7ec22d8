"""The open files of a session: a recipe with its file of edits, or a shot and its recipe."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeVar, get_args

from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.regular import read_text
from ringlet.data.settings import check_name, parse_toml, read_toml
from ringlet.groom import Recipe, parse_recipe
from ringlet.groom.edits_file import edits_text
from ringlet.groom.load import APPEND, inherited, parse_edits
from ringlet.groom.named import GROOMS
from ringlet.groom.operators import Operator, ShapeOperator
from ringlet.shot import Shot, parse_shot
from ringlet.viewer import protocol
from ringlet.viewer.document import Document, History, State, set_value
from ringlet.viewer.merge import Versions
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import Difference, File, Place
from ringlet.viewer.variant import variant
from ringlet.viewer.wire import pack

Entry = TypeVar("Entry")


class Files:
    """The open files, with one undo history. Reads and writes inside the project only.

    mode: kind of the opened file: ``recipe``, ``shot``, or ``stage`` for a USD file without editing
    """

    def __init__(self, file: Path, project: Project) -> None:
        self.project, self.file = project, project.inside(file, "view")
        self.documents: dict[File, Document] = {}
        self.mode = "stage"
        self._chosen = ""
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
        grooms = data.get(GROOMS, {})
        for table in grooms.values() if isinstance(grooms, dict) else ():
            if isinstance(table, dict):
                self._confine(table, path)

    def parse_shot(self, text: str) -> Shot:
        """Parses a shot whose files are all inside the project; raises UserError for others."""
        shot = parse_shot(text, self.file)
        for what, file in shot.named_files().items():
            self.project.inside(file, f"{self.file.name}: {what}")
        return shot

    def document(self, file: File) -> Document:
        """The open file of a kind, ``recipe`` or ``shot``; raises UserError when none is open."""
        if file not in self.documents:
            raise UserError(f"{self.file.name}: no {file} is open; open one with: ringlet view")
        return self.documents[file]

    @property
    def clean(self) -> bool:
        """Whether no file has unsaved changes."""
        return not any(document.dirty for document in self.documents.values())

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

    @property
    def groom(self) -> str:
        """The chosen one of several grooms of the recipe, by default the first; empty where it has one."""
        names = list(self.recipe.model.grooms)
        return self._chosen if self._chosen in names else next(iter(names), "")

    def choose(self, name: str) -> None:
        """Chooses one of several grooms; raises UserError for an unknown one."""
        check_name(name, self.recipe.model.grooms, self.recipe.path.name, "groom of the recipe")
        self._chosen = name
        self.recipe.apply(self.recipe.text, muted=frozenset())

    @property
    def chosen_recipe(self) -> Recipe:
        """The recipe, or that of the chosen one of several grooms."""
        model = self.recipe.model
        return model.grooms[self.groom] if model.grooms else model

    @property
    def without_effect(self) -> frozenset[str]:
        """Stages of the chosen groom that have no effect: the muted ones, or all but the one that is soloed."""
        state = self.recipe.state
        if not state.solo:
            return state.muted
        return frozenset({*(f"shape/{k}" for k in range(len(self.chosen_recipe.shape))), "curl"} - {state.solo})

    def refuse_several(self) -> None:
        """Raises UserError for a recipe with several grooms, whose locks and guides are not edited by hand."""
        if self.groom:
            raise UserError(
                f"{self.recipe.path.name}: has several grooms; locks and guides are edited by hand in the recipe of "
                "one: open it, and let the groom extend it"
            )

    # Changes

    def set(self, file: File, changes: list[tuple[Place, Any]], gesture: int | None = None) -> None:
        """Sets values of settings; None removes a setting."""
        document = self.document(file)
        before = document.model
        names = self._inherited(document) if file == "recipe" else None
        if names is not None:
            changes = [(_by_name(place, names), value) for place, value in changes]
        if file == "recipe" and self.groom:
            changes = [([GROOMS, self.groom, *place], value) for place, value in changes]
        document.set(changes, gesture)
        if file == "recipe" and document.model.edits_file != before.edits_file:
            document.apply(document.text, edits=_text_of(document.model.edits_file), gesture=gesture)

    def edit_operators(self, action: str, at: int, to: int, op: str, values: dict[str, str] | None = None) -> None:
        """Adds, removes or moves a shape operator of the recipe; muted operators stay muted.

        values: settings of an operator that is added

        Raises UserError when a variant would move an operator of its base, or add one before it.
        """
        document = self.recipe
        names = self._inherited(document)
        stages = [f"shape/{k}" for k in range(len(self.chosen_recipe.shape))]
        new = {**({"op": op, **_starter(op)} if op else {}), **(values or {})}
        if names is not None:
            self._edit_inherited(names, action, at, to, new)
        elif self.groom:
            document.set([([GROOMS, self.groom, "shape"], self._arranged_shape(action, at, to, new))])
        else:
            _edit_tables(document, "shape", action, at, to, new)
        places = {old: f"shape/{k}" for k, old in enumerate(_arranged(stages, action, at, to, ""))}

        def now(stage: str) -> str:
            return places.get(stage, "") if "/" in stage else stage

        muted = frozenset(filter(None, map(now, document.state.muted)))
        document.keep(muted=muted, solo=now(document.state.solo))

    def _edit_inherited(self, names: list[str], action: str, at: int, to: int, new: dict[str, Any]) -> None:
        """Edits the operators of a variant: it removes those of its base by name, and has tables of its own after them.

        names: names of the operators of the base
        """
        document = self.recipe
        if action == "remove" and at < len(names):
            place: Place = [GROOMS, self.groom, "shape"] if self.groom else ["shape"]
            document.set([([*place, names[at]], None), ([*place, names[at]], False)])
            return
        first = min(at, to) if action == "move" else at
        if self.groom or first < len(names):
            base = self._own_tables(document)["extends"]
            raise UserError(
                f"{document.path.name}: operators of {base} keep their order, and others follow them; "
                f"move them in {base}, or give {document.path.name} [[shape]] tables of its own"
            )
        _edit_tables(document, f"shape.{APPEND}", action, at - len(names), to - len(names), new)

    def _arranged_shape(self, action: str, at: int, to: int, new: dict[str, Any]) -> list[dict[str, Any]]:
        """The operators of the chosen groom, with one added, removed or moved."""
        shape = self._own_tables(self.recipe).get("shape", [])
        if not 0 <= at < len(shape) + (action == "add"):
            raise UserError(f"{self.recipe.path.name}: shape has {len(shape)} operators; there is none at {at}")
        return _arranged(shape, action, at, to, new)

    def write_edits(self, kind: str, tables: list[dict[str, Any]], gesture: int | None = None) -> None:
        """Replaces the tables of a kind in the recipe's file of edits; names a new file when there is none.

        Raises UserError for a recipe with several grooms.
        """
        self.refuse_several()
        document = self.recipe
        edits = parse_edits(document.state.edits or "ringlet = 1", document.path)
        text = edits_text({**edits, kind: tables})
        if not document.contents().get("edits"):
            document.set([(["edits"], self._unused_name(document.path, ".edits.toml"))], gesture)
        document.apply(document.text, edits=text, gesture=gesture)

    # Other programs

    def watched(self) -> dict[Path, File]:
        """Files on disk that the session depends on, and the kind of the document that each belongs to."""
        found: dict[Path, File] = {}
        for kind, document in self.documents.items():
            paths = [document.path, *(self._read_by_recipe(document) if kind == "recipe" else [])]
            for path in paths:
                found.setdefault(path, kind)
        return found

    @staticmethod
    def _read_by_recipe(document: Document) -> list[Path]:
        """Files that a recipe, its grooms and their bases name."""
        contents = document.contents()
        tables = [contents, *contents.get(GROOMS, {}).values()]
        bases = [base for table in tables for base in _bases(table, document.path)]
        models = [document.model, *document.model.grooms.values()]
        return [*bases, *(file for model in models for file in model.named_files().values())]

    def own(self, file: File) -> set[Path]:
        """The file of a document, and its file of edits."""
        edits = self.document(file).model.edits_file if file == "recipe" else None
        return {self.document(file).path} | ({edits} if edits is not None else set())

    def meet_disk(self, file: File) -> bool:
        """Takes in what another program wrote to a document and its file of edits; returns whether its state changed.

        Raises UserError when that is invalid.
        """
        document = self.document(file)
        if not document.path.exists():  # it is written again with the next save
            return False
        text = read_text(document.path, "give a file")
        edits = document.saved_edits
        if file == "recipe":
            try:
                edits = _text_of(self._edits_file(text, document.path))
            except UserError:
                if text == document.saved:
                    raise
        return document.meet(text, edits)

    def _edits_file(self, text: str, path: Path) -> Path | None:
        name = parse_toml(text, path.name, "recipe").get("edits")
        return self.project.inside(path.parent / name, f"{path.name}: edits") if isinstance(name, str) else None

    def versions(self, file: File) -> list[tuple[Versions, str]]:
        """The three versions of a document in conflict and of its file of edits, each with a prefix for names."""
        document = self.document(file)
        if document.theirs is None:
            raise UserError(f"{document.path.name}: has no conflict with its file; go on")
        text, edits = document.theirs
        return [
            (Versions(document.saved, document.text, text), ""),
            (Versions(document.saved_edits, document.state.edits, edits), "edits: "),
        ]

    def differences(self, file: File) -> list[Difference]:
        """Settings in which a document differs from its file on disk; none where one of both is no TOML."""
        try:
            return [
                difference.model_copy(update={"name": prefix + difference.name})
                for versions, prefix in self.versions(file)
                for _, difference in versions.differences()
            ]
        except ValueError:
            return []

    def resolve(self, file: File, choice: str, mine: list[str], theirs: list[str]) -> None:
        """Resolves a conflict; raises UserError for a merge that leaves a setting open or gives an invalid file.

        choice:       ``mine``, ``theirs``, or ``merge`` for a choice by setting
        mine, theirs: names of the settings that keep the value of the session, or take that on disk
        """
        document = self.document(file)
        versions = [one for one, _ in self.versions(file)]
        if choice == "mine":
            texts = [one.mine for one in versions]
        elif choice == "theirs":
            texts = [one.theirs for one in versions]
        else:
            differences = self.differences(file)
            if open_ := [one.name for one in differences if one.name not in {*mine, *theirs}]:
                raise UserError(f"{document.path.name}: {open_[0]} differs; choose one of both values")
            names = iter(differences)
            texts = []
            for one in versions:
                places = [place for place, _ in one.differences()]
                texts.append(one.merged([place for place in places if next(names).name in mine]))
        document.resolve(*texts)

    def recover(self, file: File, text: str, edits: str, saved: str, saved_edits: str) -> None:
        """Restores unsaved texts of an earlier session; raises UserError when they are invalid."""
        document = self.document(file)
        base = (saved, saved_edits) if saved else (document.saved, document.saved_edits)
        document.recover(text, edits or document.saved_edits, *base)

    def step(self, kind: str) -> list[File]:
        """Undoes, redoes or reverts to the saved state; returns the kinds of the changed files."""
        if kind == "revert":
            before = {name: document.state for name, document in self.documents.items()}
            for document in self.documents.values():
                document.apply(document.saved, edits=document.saved_edits)
            return [name for name, document in self.documents.items() if document.state != before[name]]
        changed = self._history.undo() if kind == "undo" else self._history.redo()
        return [name for name, document in self.documents.items() if document is changed]

    def _inherited(self, document: Document) -> list[str] | None:
        return inherited(self._own_tables(document), document.path)

    def _own_tables(self, document: Document) -> dict[str, Any]:
        """The tables of a recipe's file, or of the chosen groom in it."""
        contents = document.contents()
        return contents.get(GROOMS, {}).get(self.groom, {}) if document.model.grooms else contents

    # Saving

    def save(self, file: File, name: str = "", as_variant: bool = False) -> Path:
        """Writes a file and its manual edits.

        name:       file name of a copy next to it; empty for the file itself
        as_variant: whether the copy extends the file

        Raises UserError when the copy exists already.
        """
        document = self.document(file)
        if not name:
            self.meet_disk(file)
            if document.theirs is not None:
                raise UserError(f"{document.path.name}: was changed by another program; choose first what is kept")
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

    def message(self, file: File) -> bytes:
        """Message with the state of a file."""
        document = self.documents[file]
        contents, model = document.contents(), document.model
        grooms, groom = ([*model.grooms], self.groom) if file == "recipe" else ([], "")
        if groom:
            contents, model = self._own_tables(document), model.grooms[groom]
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
                    "saved": document.saved if document.dirty else "",
                    "saved_edits": document.saved_edits if document.state.edits != document.saved_edits else "",
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
    found: list[tuple[str, str, Place]] = [("guides", "guides", ["guides"]), ("locks", "locks", ["locks"])]
    found += [(operator.op, operator.op, ["shape", k]) for k, operator in enumerate(recipe.shape)]
    for name in ("curl", "clean", "hairs", "color", "fiber"):
        found.append((name, name, [name]))
    return [
        protocol.Stage(
            name=name,
            op=op,
            place=place,
            muted=(key := "/".join(map(str, place))) in state.muted,
            solo=key == state.solo,
        )
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


def _edit_tables(document: Document, name: str, action: str, at: int, to: int, new: dict[str, Any]) -> None:
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


def _by_name(place: Place, names: list[str]) -> Place:
    """Converts an index of a shape operator to the name that a variant uses, or to its place among those it appends."""
    if len(place) > 1 and place[0] == "shape" and isinstance(place[1], int):
        at = place[1]
        return ["shape", names[at], *place[2:]] if at < len(names) else ["shape", APPEND, at - len(names), *place[2:]]
    return place


def _bases(data: dict[str, Any], path: Path) -> list[Path]:
    """Files that a recipe extends, the nearest first."""
    found: list[Path] = []
    while isinstance(name := data.get("extends"), str) and (file := path.parent / name).is_file() and file not in found:
        found.append(file)
        try:
            path, data = file, read_toml(file, "recipe")[1]
        except UserError:
            break
    return found


def _text_of(file: Path | None) -> str:
    return read_text(file, "give a file of edits") if file is not None and file.exists() else ""


def _write(file: Path | None, text: str) -> None:
    if file is not None:
        with replacing(file, update=True) as aside:
            aside.write_text(text or "ringlet = 1\n", encoding="utf-8")
