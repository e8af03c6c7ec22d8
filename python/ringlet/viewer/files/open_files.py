"""The open files of a session: a recipe with its file of edits, or a shot and its recipe."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ringlet.data.errors import UserError
from ringlet.data.regular import read_text
from ringlet.data.settings import check_name, read_toml
from ringlet.groom import Recipe
from ringlet.groom.edits_file import edits_text
from ringlet.groom.load import APPEND, EMPTY, inherited, parse_edits
from ringlet.groom.named import GROOMS
from ringlet.shot import Shot
from ringlet.viewer.files.document import Document, History
from ringlet.viewer.files.parsing import bases, edits_file, recipe_inside, shot_inside, text_of_edits
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import File, Place


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
        project, path = self.project, self.file
        _, data = read_toml(path, "recipe or shot")
        self.mode, recipe = "recipe", path
        if "groom" in data and "frames" in data:
            self.mode = "shot"
            self.documents["shot"] = Document(self.file, lambda text, _: self.parse_shot(text), history=self._history)
            recipe = project.inside(self.shot.groom, f"{path.name}: groom")
        if recipe.suffix == ".toml":
            edits = text_of_edits(self.parse(read_text(recipe, "give a recipe file"), recipe).edits_file)
            self.documents["recipe"] = Document(
                recipe, lambda text, edits: self.parse(text, recipe, edits), edits, self._history
            )

    def parse(self, text: str, path: Path, edits: str = "") -> Recipe:
        """Parses a recipe of the project, with the text of its file of edits; raises UserError as ``recipe_inside``."""
        return recipe_inside(self.project, text, path, edits)

    def parse_shot(self, text: str) -> Shot:
        """Parses the open shot with another text; raises UserError as ``shot_inside``."""
        return shot_inside(self.project, text, self.file)

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

    def set(
        self,
        file: File,
        changes: list[tuple[Place, Any]],
        gesture: int | None = None,
        maps: Mapping[str, bytes] | None = None,
    ) -> None:
        """Sets values of settings, and painted maps; None removes a setting."""
        document = self.document(file)
        before = document.model
        names = self.inherited() if file == "recipe" else None
        if names is not None:
            changes = [(_by_name(place, names), value) for place, value in changes]
        if file == "recipe" and self.groom:
            changes = [([GROOMS, self.groom, *place], value) for place, value in changes]
        document.set(changes, gesture, maps)
        if file == "recipe" and document.model.edits_file != before.edits_file:
            document.apply(document.text, edits=text_of_edits(document.model.edits_file), gesture=gesture)

    def write_edits(self, kind: str, tables: list[dict[str, Any]], gesture: int | None = None) -> None:
        """Replaces the tables of a kind in the recipe's file of edits; names a new file when there is none.

        Raises UserError for a recipe with several grooms.
        """
        self.refuse_several()
        document = self.recipe
        edits = parse_edits(document.state.edits or EMPTY, document.path)
        text = edits_text({**edits, kind: tables})
        if not document.contents().get("edits"):
            document.set([(["edits"], self.unused_name(document.path, ".edits.toml"))], gesture)
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
        extended = [base for table in tables for base in bases(table, document.path)]
        models = [document.model, *document.model.grooms.values()]
        return [*extended, *(file for model in models for file in model.named_files().values())]

    def own(self, file: File) -> set[Path]:
        """The file of a document, and its file of edits."""
        document = self.document(file)
        edits = document.model.edits_file if file == "recipe" else None
        maps = {document.path.with_name(name) for name in document.maps}
        return {document.path, *maps} | ({edits} if edits is not None else set())

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
                edits = text_of_edits(edits_file(self.project, text, document.path))
            except UserError:
                if text == document.saved:
                    raise
        return document.meet(text, edits)

    def recover(
        self,
        file: File,
        text: str,
        edits: str,
        saved: str,
        saved_edits: str,
        maps: Mapping[str, bytes] | None = None,
    ) -> None:
        """Restores unsaved texts and painted maps of an earlier session; raises UserError when they are invalid."""
        document = self.document(file)
        base = (saved, saved_edits) if saved else (document.saved, document.saved_edits)
        document.recover(text, edits or document.saved_edits, *base, maps)

    def step(self, kind: str) -> list[File]:
        """Undoes, redoes or reverts to the saved state; returns the kinds of the changed files."""
        if kind == "revert":
            before = {name: document.state for name, document in self.documents.items()}
            for document in self.documents.values():
                document.apply(document.saved, edits=document.saved_edits, maps=document.saved_maps)
            return [name for name, document in self.documents.items() if document.state != before[name]]
        changed = self._history.undo() if kind == "undo" else self._history.redo()
        return [name for name, document in self.documents.items() if document is changed]

    def inherited(self) -> list[str] | None:
        """Names of the shape operators that the chosen groom has of its base; None where its shape is its own."""
        return inherited(self.own_tables(), self.recipe.path)

    def own_tables(self) -> dict[str, Any]:
        """The tables of the recipe's file, or of the chosen groom in it."""
        contents = self.recipe.contents()
        return contents.get(GROOMS, {}).get(self.groom, {}) if self.groom else contents

    def unused_name(self, path: Path, suffix: str) -> str:
        """File name after a recipe's name that does not exist yet."""
        stem = path.name.removesuffix(".toml").removesuffix(".recipe")
        names = [f"{stem}{suffix}", *(f"{stem}-{k}{suffix}" for k in range(2, 100))]
        return next(name for name in names if not path.with_name(name).exists())


def _by_name(place: Place, names: list[str]) -> Place:
    """Converts an index of a shape operator to the name that a variant uses, or to its place among those it appends."""
    if len(place) > 1 and place[0] == "shape" and isinstance(place[1], int):
        at = place[1]
        return ["shape", names[at], *place[2:]] if at < len(names) else ["shape", APPEND, at - len(names), *place[2:]]
    return place
