"""Files of earlier versions, rewritten in the present format."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from ringlet.data.explain import setting_name
from ringlet.data.files import replacing
from ringlet.data.regular import read_bytes, read_text
from ringlet.data.upgrade import upgraded


class Upgrade(NamedTuple):
    """What an upgrade changes.

    changed: whether the text of the file changes
    renamed: settings as the file names them, and their present names
    """

    changed: bool
    renamed: list[tuple[str, str]]


def upgrade(path: Path | str, *, check: bool = False) -> Upgrade:
    """Rewrites a recipe, a shot, a preset or a file of edits in the present format; all but the names stays.

    check: leaves the file as it is

    Raises UserError for another file, and for a setting by both of its names; the file then stays as it was.
    """
    path = Path(path)
    before = read_text(path, "give a recipe or shot file")
    after, found = upgraded(before, path.name)
    if after != before and not check:
        ends = "\r\n" if b"\r\n" in read_bytes(path) else "\n"
        with replacing(path, update=True) as aside:
            aside.write_text(after, encoding="utf-8", newline=ends)
    return Upgrade(after != before, [(setting_name(one.place), one.key) for one in found])
