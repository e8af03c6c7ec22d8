"""The folder next to a recipe, ``NAME.review``, with all that a review keeps in readable files.

``snapshots/`` has the files of each snapshot, ``notes/`` a file for each note, ``references/`` the reference pictures,
and ``views.toml`` the bookmarks and the light. Other programs may change them. A file that cannot be read is left as
it is, and reported.
"""

from __future__ import annotations

import base64
import binascii
import io
import tomllib
from datetime import datetime
from pathlib import Path
from typing import TypeVar

from PIL import Image
from pydantic import BaseModel, ValidationError

from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.regular import read_bytes, read_text
from ringlet.data.toml import to_toml
from ringlet.viewer.project import Project

SUFFIX = ".review"
MOST_PIXELS = 8192  # on each side of a picture
MOST_PICTURE = 8_000_000  # bytes of a picture
FORMATS = {"PNG": ".png", "JPEG": ".jpg"}

Entry = TypeVar("Entry", bound=BaseModel)


class ReviewFolder:
    """Reads and writes files of the folder that belongs to a recipe, or to another file that is reviewed."""

    def __init__(self, file: Path, project: Project) -> None:
        name = file.name.removesuffix(".toml").removesuffix(".recipe")
        self._project, self.path = project, project.inside(file.with_name(f"{name}{SUFFIX}"), "review")

    def file(self, name: str) -> Path:
        """Path of a file; raises UserError for a link out of the project."""
        return self._project.inside(self.path / name, f"{self.path.name}/{name}")

    def names(self, pattern: str) -> list[str]:
        """Names of the files that match a pattern, sorted."""
        return sorted(path.relative_to(self.path).as_posix() for path in self.path.glob(pattern) if path.is_file())

    def state(self) -> list[tuple[str, int]]:
        """Names and modification times of all files; changes with them."""
        return [(name, (self.path / name).stat().st_mtime_ns) for name in self.names("**/*")]

    def read(self, name: str, kind: type[Entry]) -> Entry:
        """An entry from its TOML file; raises UserError for an invalid one."""
        path = self.file(name)
        try:
            data = tomllib.loads(read_text(path))
            data.pop("ringlet", None)
            return kind.model_validate(data)
        except (tomllib.TOMLDecodeError, ValidationError) as error:
            reason = " ".join(str(error).split())[:200]
            raise UserError(f"{self.path.name}/{name}: cannot be read ({reason}); mend it, or remove it") from None

    def write(self, name: str, entry: BaseModel) -> None:
        """Writes an entry to its TOML file."""
        self.write_text(name, to_toml({"ringlet": 1, **entry.model_dump(mode="json", exclude_none=True)}))

    def text(self, name: str) -> str:
        """Text of a file; empty for none."""
        path = self.file(name)
        return read_text(path) if path.exists() else ""

    def write_text(self, name: str, text: str) -> None:
        """Writes a text file."""
        with replacing(self.file(name), update=True) as aside:
            aside.write_text(text, encoding="utf-8")

    def write_bytes(self, name: str, data: bytes) -> None:
        """Writes a file."""
        with replacing(self.file(name), update=True) as aside:
            aside.write_bytes(data)

    def bytes(self, name: str, most: int = MOST_PICTURE) -> bytes:
        """Contents of a picture, or of another file of at most so many bytes; raises UserError for one that cannot be
        read."""
        return read_bytes(self.file(name), "check the file", most)

    def remove(self, *names: str) -> None:
        """Removes files that exist."""
        for name in names:
            self.file(name).unlink(missing_ok=True)


def now() -> str:
    """The present time in ISO 8601, in seconds, with its zone."""
    return datetime.now().astimezone().isoformat(timespec="seconds")


def decode_picture(text: str, what: str) -> tuple[bytes, str]:
    """A picture in base64 and its suffix; raises UserError for one that is no PNG or JPEG, or too large."""
    try:
        data = base64.b64decode(text, validate=True)
        with Image.open(io.BytesIO(data), formats=list(FORMATS)) as image:
            suffix, size = FORMATS[image.format or ""], image.size
            if max(size) <= MOST_PIXELS:
                image.verify()
    except (binascii.Error, OSError, SyntaxError, KeyError, ValueError, Image.DecompressionBombError):
        raise UserError(f"{what}: is no picture; must be a PNG or JPEG file") from None
    if max(size) > MOST_PIXELS:
        raise UserError(f"{what}: has {size[0]} × {size[1]} pixels; must be at most {MOST_PIXELS} on each side")
    return data, suffix
