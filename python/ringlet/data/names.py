"""Names as USD, recipes and disks take them, made of names as people give them: different names stay different.

Needs the standard library alone: extensions for hosts contain a copy of this file.
"""

from __future__ import annotations

import itertools
import re
import unicodedata
from collections.abc import Callable, Collection, Sequence

MOST_BYTES = 100  # of the name of a file, without what comes after it
RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\.|$)", re.IGNORECASE)  # of Windows


def identifier(name: str) -> str:
    """A name of ASCII letters, digits and ``_``: ``Scalp area`` is ``Scalp_area``. Several names may give the same."""
    valid = re.sub(r"\W", "_", name, flags=re.ASCII)
    return valid if re.match(r"[A-Za-z_]", valid) else f"_{valid}"


def file_name(name: str) -> str:
    """A name that disks of all systems take, of at most ``MOST_BYTES``. Several names may give the same."""
    valid = re.sub(r'[<>:"/\\|?*\x00-\x1f\x7f]', "_", unicodedata.normalize("NFC", name))
    valid = shortened(valid, MOST_BYTES).rstrip(" .").lstrip(" ")
    return f"_{valid}" if not valid.strip(".") or RESERVED.match(valid) else valid


def shortened(name: str, most: int) -> str:
    """The beginning of a name, of at most so many bytes in UTF-8."""
    return name.encode("utf-8", "replace")[:most].decode("utf-8", "ignore")


def folded(name: str) -> str:
    """What a disk that ignores case compares: names with the same result are one file there."""
    return unicodedata.normalize("NFC", unicodedata.normalize("NFC", name).casefold())


def unique(name: str, taken: Collection[str], compared: Callable[[str], str] = str) -> str:
    """The name, or with a number where it is taken: ``name_2``.

    compared: what names are compared by: ``folded`` for files
    """
    used = {compared(one) for one in taken}
    numbered = itertools.chain([name], (f"{name}_{k}" for k in itertools.count(2)))
    return next(one for one in numbered if compared(one) not in used)


def distinct(
    names: Sequence[str], valid: Callable[[str], str] = identifier, compared: Callable[[str], str] = str
) -> list[str]:
    """Valid names of several, all different, in the same order. A name that is valid already stays as it is, whichever
    others there are; of several that are one to ``compared`` the first.

    valid:    makes a name valid
    compared: as for ``unique``
    """
    kept: dict[str, int] = {}
    for row, name in enumerate(names):
        if valid(name) == name:
            kept.setdefault(compared(name), row)
    made = {row: names[row] for row in kept.values()}
    for row, name in enumerate(names):
        if row not in made:
            made[row] = unique(valid(name), list(made.values()), compared)
    return [made[row] for row in range(len(names))]
