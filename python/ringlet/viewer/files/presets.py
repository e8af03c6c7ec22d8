"""Presets: the looks that come with Ringlet, and tables of settings that users keep as files in the project."""

from __future__ import annotations

import base64
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.quantities import explain
from ringlet.data.settings import FORMAT, check_name, parse_toml
from ringlet.data.share import share
from ringlet.data.toml import to_toml
from ringlet.groom import Recipe
from ringlet.groom.load import load, load_text
from ringlet.groom.named import GROOMS
from ringlet.viewer import protocol
from ringlet.viewer.files import blocks
from ringlet.viewer.files.document import Document, toml_value
from ringlet.viewer.files.mixing import mix, stated
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.wire import pack

Tables = dict[str, Any]

LOOK = ("guides", "locks", "shape", "curl", "pin", "collide", "hairs", "color", "fiber")  # tables of a whole look
HELPERS = ("curves", "meshes")  # that the tables of a look name
FOLDERS = ("looks", "types")  # of the examples
SUFFIX = ".preset.toml"
MOST_PICTURE = 400_000  # bytes of the picture of a preset


@dataclass(frozen=True)
class Preset:
    """Tables of settings under a name.

    whole: whether it is a look, in which a table that it lacks has its defaults
    """

    name: str
    title: str
    about: str
    file: Path
    whole: bool

    @property
    def picture(self) -> Path:
        """Path of its picture, which may be missing."""
        if self.whole:
            return self.file.parent / "pictures" / f"{self.file.name.removesuffix('.recipe.toml')}.jpg"
        return self.file.with_name(self.file.name.removesuffix(".toml") + ".jpg")

    def tables(self) -> Tables:
        """Its tables with the base resolved; raises UserError for a file that is no preset."""
        if self.whole:
            return load(self.file)[1]
        tables = parse_toml(self.file.read_text(encoding="utf-8"), self.file.name, "preset")
        for name in tables.keys() - {"ringlet", "unit"}:
            check_name(name, (*LOOK, *HELPERS), self.file.name, "table of a preset")
        return tables

    def message(self) -> protocol.Preset:
        """What a page knows of it."""
        return protocol.Preset(
            name=self.name, title=self.title, about=self.about, whole=self.whole, picture=_data_url(self.picture)
        )


@dataclass(frozen=True)
class Taken:
    """What a preset was taken of: the state before, and the text that it gave."""

    gesture: int
    text: str
    model: Recipe
    given: str


class Presets:
    """The presets of a session, and the one that is tried or taken."""

    def __init__(self, files: Files) -> None:
        self._files = files
        self._taken: Taken | None = None

    def all(self) -> dict[str, Preset]:
        """Presets by name: those of the project, then the looks that come with Ringlet."""
        own = [_own(file) for file in sorted(self._files.project.folder.glob(f"*{SUFFIX}"))[:200]]
        return {preset.name: preset for preset in [*own, *looks()]}

    def message(self) -> bytes:
        """Message with all presets."""
        return pack(protocol.Presets(presets=[preset.message() for preset in self.all().values()]))

    def tried(self, name: str, part: float) -> Recipe:
        """The recipe with a preset, which is not stored anywhere; raises UserError for one that does not fit.

        part: 0 for the recipe as it is, 1 for the preset
        """
        document = self._files.recipe
        return self._mixed(document.model, document.text, name, part)[0]

    def take(self, message: protocol.Take) -> None:
        """Takes a preset, or a part of it, as one undo step with all messages of its gesture."""
        document, taken = self._files.recipe, self._taken
        again = taken is not None and (taken.gesture, taken.given) == (message.gesture, document.text)
        text, model = (taken.text, taken.model) if taken and again else (document.text, document.model)
        _, given = self._mixed(model, text, message.name, message.part)
        document.apply(given, gesture=message.gesture)
        self._taken = Taken(message.gesture, text, model, document.text)

    def _mixed(self, model: Recipe, text: str, name: str, part: float) -> tuple[Recipe, str]:
        """A recipe with a part of a preset, and its text."""
        self._files.refuse_several()
        document, presets = self._files.recipe, self.all()
        check_name(name, presets, "presets", "preset")
        preset = presets[name]
        given = _given(preset, model)
        whole_text = with_tables(document, text, given)
        whole = self._files.parse(whole_text, document.path, document.state.edits)
        if part >= 1.0:
            return whole, whole_text
        if part <= 0.0:
            return model, text
        names = [one for one in given if one in LOOK]
        try:
            mixed = mix(model, whole, part, names)
        except ValidationError as error:
            raise explain(error, f"{document.path.name} and {preset.title}", {}) from None
        tables = {one: _stated_table(mixed, one, model.unit) for one in names}
        return mixed, with_tables(document, text, {**given, **tables})

    def keep(self, message: protocol.Keep) -> Path:
        """Writes tables of the recipe to a preset of the project; raises UserError where one of the name exists."""
        self._files.refuse_several()
        document = self._files.recipe
        path = self._files.project.new_file(message.name, SUFFIX)
        if not path.name.endswith(SUFFIX):
            path = path.with_name(path.name.removesuffix(".toml") + SUFFIX)
        if path.exists():
            raise UserError(f"preset: {path.name} is there already; give another name")
        tables = load_text(document.text, document.path, document.state.edits)[1]
        kept = {name: tables[name] for name in (*LOOK, *HELPERS) if name in message.tables and name in tables}
        if not kept:
            raise UserError(f"preset: {document.path.name} sets none of these tables; choose others")
        picture = _jpeg(message.picture) if message.picture else None
        unit = {} if document.model.unit == "cm" else {"unit": document.model.unit}
        with replacing(path) as aside:
            aside.write_text(to_toml({"ringlet": FORMAT, **unit, **kept}), encoding="utf-8")
        if picture is not None:
            with replacing(_own(path).picture) as aside:
                aside.write_bytes(picture)
        return path


def looks() -> list[Preset]:
    """Looks of the examples: recipes with one groom and no file but the scalp's."""
    found = []
    for folder in FOLDERS:
        for file in sorted(share(f"examples/{folder}").glob("*.recipe.toml")):
            data = tomllib.loads(file.read_text(encoding="utf-8"))
            if GROOMS not in data and (folder == "looks" or len(file.name.split(".")[0]) <= 2):
                title = str(data.get("name") or file.name.split(".")[0]).replace("_", " ")
                found.append(Preset(f"{folder}/{file.name.split('.')[0]}", title, _about(file), file, whole=True))
    return found


def _own(file: Path) -> Preset:
    name = file.name.removesuffix(SUFFIX)
    return Preset(file.name, name.replace("_", " "), _about(file), file, whole=False)


def _about(file: Path) -> str:
    """First sentence of the comment at the top of a file; empty without one."""
    with file.open(encoding="utf-8", errors="replace") as lines:
        first = lines.readline()
    return re.split(r"(?<=[.:])\s", first.lstrip("# ").strip())[0].rstrip(":") if first.startswith("#") else ""


def _given(preset: Preset, model: Recipe) -> Tables:
    """Tables that a preset gives; None for those of a look that it leaves at their defaults.

    Raises UserError for a preset in another unit, and for one that names files.
    """
    tables = preset.tables()
    if (unit := tables.get("unit", "cm")) != model.unit:
        raise UserError(f"{preset.file.name}: its unit is {unit}, that of the recipe is {model.unit}; must be the same")
    names = [name for name in (*LOOK, *HELPERS) if name in tables]
    for name in names:
        one = tables[name]
        if isinstance(one, dict) and any("file" in inner for inner in (one, *one.values()) if isinstance(inner, dict)):
            raise UserError(f"{preset.file.name}: {name} names a file; a preset has settings alone")
    return {**({name: None for name in LOOK} if preset.whole else {}), **{name: tables[name] for name in names}}


def _stated_table(recipe: Recipe, name: str, unit: str) -> Any:
    value = getattr(recipe, name)
    if value is None:
        return None
    return [stated(one, unit) for one in value] if isinstance(value, list) else stated(value, unit)


def with_tables(document: Document, text: str, tables: Tables) -> str:
    """A text of a recipe with other tables, whose others keep their comments and notation; None removes a table.

    Raises UserError for a table in a notation that cannot be replaced.
    """
    data = tomllib.loads(text)
    own = {name: value for name, value in tables.items() if value not in (None, {}, [])}
    if "extends" in data:
        base = load_text(_without(text, data.keys() - {"ringlet", "extends"}), document.path)[1]
        own = _changes({name: base[name] for name in tables if name in base}, own)
    changed = {name for name in tables if own.get(name) != data.get(name)}
    rest = _without(text, changed)
    if stuck := changed & tomllib.loads(rest).keys():
        name = min(stuck)
        raise UserError(f"{document.path.name}: {name} is not written as a table [{name}]; edit it in the file")
    parts = blocks.split(rest)
    added = {name: own[name] for name in LOOK + HELPERS if name in own and name in changed}
    for name in [name for name, value in added.items() if value is False]:
        blocks.insert_line(parts[0], f"{name} = {toml_value(added.pop(name))}")
    return blocks.join(parts).rstrip("\n") + "\n" + ("\n" + to_toml(added) if added else "")


def _changes(base: Tables, now: Tables) -> Tables:
    """Tables that turn ``base`` into ``now`` in a recipe that extends it: false takes a setting away."""
    changes: Tables = {name: False for name in base.keys() - now.keys()}
    for name, value in now.items():
        old = base.get(name)
        if isinstance(value, dict) and isinstance(old, dict):
            if more := _changes(old, value):
                changes[name] = more
        elif value != old:
            changes[name] = value
    return changes


def _without(text: str, names: set[str]) -> str:
    """A text without some tables and the comments above them."""
    parts = [block for block in blocks.split(text) if block.name.split(".")[0] not in names or not block.name]
    return blocks.join(parts)


def _data_url(picture: Path) -> str:
    """A JPEG picture as a data URL; empty where there is none, or a large one."""
    if not picture.is_file() or picture.stat().st_size > MOST_PICTURE:
        return ""
    return "data:image/jpeg;base64," + base64.b64encode(picture.read_bytes()).decode()


def _jpeg(url: str) -> bytes:
    """A JPEG picture from its data URL; raises UserError for other data."""
    head, _, data = url.partition(",")
    try:
        picture = base64.b64decode(data, validate=True)
    except ValueError:
        picture = b""
    if head != "data:image/jpeg;base64" or not picture.startswith(b"\xff\xd8"):
        raise UserError("preset: its picture is no JPEG; keep it without one")
    return picture
