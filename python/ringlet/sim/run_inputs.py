"""The inputs of a run: two runs with the same inputs give the same bits.

They are all that was read and given: nothing is chosen from it, so that nothing can be forgotten.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from importlib.metadata import version
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np

from ringlet.data.digest import digest
from ringlet.data.groom import Groom
from ringlet.data.reads import Reads
from ringlet.shot.shot import Shot

# Settings that change no frame: file names, whose contents are among the inputs, and how far a run goes.
_PLACES = {
    "groom": True,
    "frames": True,
    "rest": {"file"},
    "collider": {"__all__": {"file"}},
    "cloth": {"__all__": {"file"}},
}

Inputs = dict[str, Any]


def run_inputs(shot: Shot, groom: Groom, read: Reads, frames: tuple[int, int] | None) -> Inputs:
    """The program, the settings, the groom, and the files that were read for a run, as plain values.

    read: the files of the clip, the rest shape, the colliders and the cloths
    """
    first, _ = frames or shot.frames  # how far it goes changes nothing before
    return {
        "Ringlet": version("ringlet"),
        "the first frame": first,
        "settings": _plain(shot.model_dump(mode="json", exclude=_PLACES)),
        "groom": dict(_digests(replace(groom, accessories=[]), "")),  # locks have their mass and radius
        "files": [list(one) for one in read.contents()],
    }


def changed_input(before: Inputs, now: Inputs) -> str | None:
    """One sentence on the first input that differs; None where all are the same."""
    return next(_changes(before, now), None)


def _changes(before: Inputs, now: Inputs) -> Iterator[str]:
    for name in ("Ringlet", "the first frame"):
        if before.get(name) != now[name]:
            yield f"{name} was {before.get(name)} and is {now[name]}"
    settings, groom = before.get("settings", {}), before.get("groom", {})
    for name in _differing(settings, now["settings"]):
        yield f"{name} was {settings.get(name)} and is {now['settings'].get(name)}"
    for old, new in zip_longest(before.get("files", []), now["files"]):
        if old != new:
            yield _changed_file(old, new)
    for name in _differing(groom, now["groom"]):
        yield f"the groom has changed ({name})"


def _changed_file(old: list[str] | None, new: list[str] | None) -> str:
    if new is None or old is None:
        return f"{(old or new or [''])[0]} is {'read too' if old is None else 'not read any more'}"
    return f"{new[0]} has changed" if old[0] == new[0] else f"{new[0]} is read in place of {old[0]}"


def _differing(before: Mapping[str, Any], now: Mapping[str, Any]) -> list[str]:
    return [name for name in sorted({*before, *now}) if before.get(name) != now.get(name)]


def _plain(value: Any, name: str = "") -> dict[str, Any]:
    """Nested settings as one table, by names such as ``contact.friction``."""
    if isinstance(value, Mapping):
        return {full: leaf for key in value for full, leaf in _plain(value[key], f"{name}.{key}".strip(".")).items()}
    return {name: value}


def _digests(value: Any, name: str) -> Iterator[tuple[str, str]]:
    """The digests of all that a value holds, by names such as ``locks.point.pin``; places of files do not count."""
    if is_dataclass(value):
        value = {field.name: getattr(value, field.name) for field in fields(value)}
    if isinstance(value, Mapping):
        for key in sorted(value):
            yield from _digests(value[key], f"{name}.{key}".strip("."))
    elif isinstance(value, np.ndarray):
        array = value.astype(str) if value.dtype == object else value
        yield name, digest(str(array.dtype), array.shape, array)
    elif value is not None and not isinstance(value, Path):
        yield name, digest(value)
