"""Writing without leaving half a file: write aside, then rename."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ringlet.errors import UserError


@contextmanager
def replacing(path: Path | str) -> Iterator[Path]:
    """Yields a path beside ``path`` to write to; it takes the place of ``path`` only when the block succeeds.

    The suffix is kept, since writers choose their format by it. Raises UserError where the place cannot be written.
    """
    path = Path(path)
    aside = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.is_dir():
            raise UserError(f"{path}: is a folder; give a file name")
        aside.touch()
        yield aside
        aside.replace(path)
    except OSError as error:
        raise UserError(f"{path}: cannot be written ({error.strerror or error}); choose another place") from error
    finally:
        with suppress(OSError):  # where the folder is no folder there is nothing to take away
            aside.unlink()
