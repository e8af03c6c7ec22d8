"""Writes the open files, their manual edits and painted maps: in place, as a copy, or as a variant."""

from __future__ import annotations

from pathlib import Path

from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.settings import FORMAT
from ringlet.viewer.files.document import Document, set_value
from ringlet.viewer.files.open_files import Files
from ringlet.viewer.files.variant import variant
from ringlet.viewer.protocol import File


def write(files: Files, file: File) -> Path:
    """Writes a file to its own path; raises UserError for one in conflict with another program."""
    document = files.document(file)
    files.meet_disk(file)
    if document.theirs is not None:
        raise UserError(f"{document.path.name}: was changed by another program; choose first what is kept")
    if document.state.edits != document.saved_edits:
        _write_edits(document.model.edits_file, document.state.edits)
    for name, picture in document.painted.items():
        _write_map(files, document.path, name, picture)
    return document.save()


def write_copy(files: Files, file: File, name: str, *, as_variant: bool) -> Path:
    """Writes a copy next to a file; raises UserError when it exists already.

    as_variant: whether the copy extends the file
    """
    document = files.document(file)
    path = files.project.new_file(name, f".{file}.toml")
    if path.exists():
        raise UserError(f"save: {path.name} is there already; give another name")
    text = document.text
    if file == "recipe":
        edits = None
        if document.state.edits != document.saved_edits:
            edits = path.with_name(files.unused_name(path, ".edits.toml"))
        text = variant(document, files.parse, path, edits) if as_variant else _copied(document, edits)
        text = _with_own_maps(files, text, path)
        files.parse(text, path, document.state.edits)
        if edits is not None:
            _write_edits(edits, document.state.edits)
    return document.save(path, text)


def _copied(document: Document, edits: Path | None) -> str:
    """Text of a copy, with the name of its own file of edits if it has one."""
    return document.text if edits is None else set_value(document.text, ["edits"], edits.name)


def _with_own_maps(files: Files, text: str, path: Path) -> str:
    """Writes maps with unsaved strokes for a copy, and returns its text with their names."""
    document = files.recipe
    for name, file in document.model.maps.items():
        if file in document.painted:
            own = files.unused_name(path, f".{name}.png")
            _write_map(files, path, own, document.painted[file])
            text = set_value(text, ["maps", name], own)
    return text


def _write_map(files: Files, path: Path, name: str, picture: bytes) -> None:
    with replacing(files.project.inside(path.parent / name, "map"), update=True) as aside:
        aside.write_bytes(picture)


def _write_edits(file: Path | None, text: str) -> None:
    if file is not None:
        with replacing(file, update=True) as aside:
            aside.write_text(text or f"ringlet = {FORMAT}\n", encoding="utf-8")
