"""Atomic writes: a file is written aside, then renamed."""

from __future__ import annotations

import os
import stat
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from ringlet.data.errors import UserError
from ringlet.data.reads import record_written, refuse_inputs, same_file
from ringlet.data.regular import check_regular


@contextmanager
def replacing(path: Path | str, *, update: bool = False) -> Iterator[Path]:
    """Yields a path beside ``path`` to write to, which replaces ``path`` only when the block succeeds.

    The suffix is kept, since writers choose their format by it; so are mode and owner of a file that is replaced. A
    link at ``path`` is replaced, not followed. Raises UserError where the place cannot be written, and where a file is
    that was read (see ``recorded``).

    update: the file is written anew with changes, so that it may have been read, and a link leads to it
    """
    path = Path(path)
    place = Path(os.path.realpath(path)) if update else path
    aside = place.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        before = _replaced(place)
        aside.unlink(missing_ok=True)
        # Ours, and no link to elsewhere; nobody else reads a private file while it is written.
        os.close(os.open(aside, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666 if before is None else 0o600))
        yield aside
        if not update:
            refuse_inputs(place)
        if before is not None:
            with suppress(PermissionError):  # only root gives files away
                os.chown(aside, before.st_uid, before.st_gid)
            aside.chmod(stat.S_IMODE(before.st_mode))
        aside.replace(place)
        record_written(place)
    except OSError as error:
        raise _unwritable(path, error) from error
    finally:
        with suppress(OSError):  # where the folder is no folder there is nothing to remove
            aside.unlink()


def check_place(path: Path | str, taken: Mapping[str, Path | None] | None = None) -> None:
    """Refuses a file that cannot be written, or was read (see ``recorded``), without creating it.

    taken: other files of the same run, by their role; these are refused too
    """
    path = Path(path)
    for what, other in (taken or {}).items():
        if other is not None and same_place(path, other):
            raise UserError(f"{path}: is the {what} of the same run; choose another name")
    refuse_inputs(path)
    try:
        _replaced(path)
        there = next(folder for folder in path.absolute().parents if folder.exists())
        with tempfile.TemporaryFile(dir=there):
            pass
    except OSError as error:
        raise _unwritable(path, error) from error


def _replaced(path: Path) -> os.stat_result | None:
    """The status of the file at a path; None for a link, or nothing. Refuses a folder, a pipe and a device."""
    if path.is_dir():
        raise UserError(f"{path}: is a folder; give a file name")
    if path.is_symlink() or not path.exists():
        return None
    check_regular(path, "choose another name")
    return path.stat()


def _unwritable(path: Path, error: OSError) -> UserError:
    return UserError(f"{path}: cannot be written ({error.strerror or error}); choose another place")


def same_place(path: Path | str, other: Path | str) -> bool:
    """Whether two paths are one place, or lead to one file through links."""
    one, two = (Path(p).absolute() for p in (path, other))
    return same_file(one, two) or (one.name == two.name and one.parent.resolve() == two.parent.resolve())


def within(path: Path, folder: Path, what: str) -> Path:
    """The path, if it is in a folder or below, links followed; for outputs that an input file names.

    what: the setting that names it, for the message: ``curls.recipe.toml: edits``
    """
    if not path.resolve().is_relative_to(folder.resolve()):
        raise UserError(f"{what} is '{path}', outside of {folder.resolve()}; name a file in that folder, or below it")
    return path
