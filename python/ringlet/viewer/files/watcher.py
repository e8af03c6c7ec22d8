"""Watches files that other programs write: reports those whose contents changed."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path

Stamp = tuple[int, int, int]


class FileWatcher:
    """Contents of watched files, by digest.

    A file counts as changed once two looks find it with the same stamp, so that no half-written file is reported. A
    missing file is no change: editors remove files before they rename others.
    """

    def __init__(self) -> None:
        self._digests: dict[Path, bytes] = {}
        self._stamps: dict[Path, Stamp] = {}
        self._settled: dict[Path, Stamp] = {}

    def changed(self, files: Iterable[Path]) -> set[Path]:
        """Files whose contents changed since the last call that found them; a new one counts as unchanged."""
        return {file for file in files if self._has_changed(file)}

    def _has_changed(self, file: Path) -> bool:
        stamp = stamp_of(file)
        before, self._stamps[file] = self._stamps.get(file), stamp or self._stamps.get(file, (0, 0, 0))
        first = file not in self._digests
        if stamp is None or stamp == self._settled.get(file) or (stamp != before and not first):
            return False
        try:
            digest = hashlib.blake2b(file.read_bytes()).digest()
        except OSError:
            return False
        if stamp_of(file) != stamp:
            return False
        changed = not first and self._digests[file] != digest
        self._digests[file], self._settled[file] = digest, stamp
        return changed


def stamp_of(file: Path) -> Stamp | None:
    """What changes when a file is written or replaced; None for a missing one."""
    try:
        status = file.stat()
    except OSError:
        return None
    return status.st_ino, status.st_size, status.st_mtime_ns
