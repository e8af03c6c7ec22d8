"""The one exception for what a user can mend."""

from __future__ import annotations

import bpy


class Refused(Exception):
    """What a user can mend, in one line."""


def need_blender(version: tuple[int, int], what: str) -> None:
    """Raises Refused in an older Blender. what: a file or an image, and what cannot be done with it there."""
    if bpy.app.version < version:
        raise Refused(f"{what} in Blender {bpy.app.version_string}; use {'.'.join(map(str, version))} or later")
