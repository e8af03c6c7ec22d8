"""Folders of heads. Each head has one of its own, named by its id, in ``NAME.ringlet`` next to ``NAME.blend``.

Needs no Blender.
"""

from __future__ import annotations

import os
import shutil
import uuid
from collections.abc import Collection, Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from .names import identifier

SUFFIX = ".ringlet"
LONGEST = 40  # letters of the readable part of an id
SIMULATED = ("cache.*", "hair.*", "*.part")  # files of a folder that a copy of the head does not get
EARLIER = uuid.UUID("7d8a6c1e-6f0b-4a53-9c0e-2b1f4f0f7c11")  # ids of heads that a .blend without ids has


class Claim(NamedTuple):
    """What a head says of itself.

    session: number of its data-block, which names, undo and copies leave alone
    id:      in the .blend; empty for a head of an earlier extension
    parent:  whether the curves that it shows are below it
    """

    session: int
    id: str
    parent: bool


def new_id(name: str) -> str:
    """An id that no other head has, with the name of now in front, to be read by people."""
    return f"{identifier(name)[:LONGEST]}-{uuid.uuid4().hex[:16]}"


def earlier_id(name: str) -> str:
    """The id of a head that had none: the same each time, so that a .blend that is not saved finds it again."""
    return f"{identifier(name)[:LONGEST]}-{uuid.uuid5(EARLIER, name).hex[:16]}"


def wrong_ids(claims: Sequence[Claim], known: dict[int, str], elsewhere: Collection[str]) -> list[int]:
    """Rows of heads that carry the id of another: copies of a head, and heads that undo took back to when they were.

    known:     ids of this session, by the number of the data-block
    elsewhere: ids of heads of libraries
    """
    wrong, held = list[int](), set(elsewhere)
    rows = range(len(claims))
    for row in sorted(rows, key=lambda k: (claims[k].session not in known, not claims[k].parent, claims[k].session)):
        claim = claims[row]
        if claim.id and (claim.id in held or known.get(claim.session, claim.id) != claim.id):
            wrong.append(row)
        else:
            held.add(claim.id)
    return sorted(wrong)


def root_of(blend: Path) -> Path:
    """The folder of all heads of a .blend."""
    return blend.with_name(f"{blend.stem}{SUFFIX}")


def find(place: Path, earlier: str = "") -> None:
    """Brings the folder of a head to its place where there is none yet: from its earlier name, or from next to another
    .blend of the same folder, of which this one is a copy or was renamed.

    place:   ``NAME.ringlet/ID``
    earlier: name of the folder that an extension without ids gave the head; empty for none
    """
    if place.exists():
        return
    root = place.parent
    if earlier and (root / earlier).is_dir():
        (root / earlier).rename(place)
        return
    others = sorted(root.parent.glob(f"*{SUFFIX}/{place.name}"))
    if left := next((one for one in others if not one.parent.with_suffix(".blend").exists()), None):
        root.mkdir(parents=True, exist_ok=True)
        left.rename(place)
        with suppress(OSError):  # others are in it
            left.parent.rmdir()
    elif others:
        copy(others[0], place)


def copy(source: Path, place: Path, without: Sequence[str] = ("*.part",)) -> None:
    """Copies the folder of a head to a place where there is none; files that Ringlet alone writes become links."""
    if place.exists() or not source.is_dir():
        return
    place.parent.mkdir(parents=True, exist_ok=True)
    aside = place.with_name(f".{place.name}.{os.getpid()}")
    try:
        shutil.copytree(source, aside, ignore=shutil.ignore_patterns(*without), copy_function=_copy_file)
        aside.rename(place)
    finally:
        shutil.rmtree(aside, ignore_errors=True)


def _copy_file(source: str, target: str) -> None:
    """Copies a file. One of USD is linked, since it may be large: Ringlet replaces such files and never writes into
    them."""
    if source.endswith(".usdc"):
        try:
            os.link(source, target)
            return
        except OSError:  # a disk without links
            pass
    shutil.copy2(source, target)
