"""Builds the Blender extension: one zip with the client of ``ringlet serve``, the schema and the looks.

Usage: python tools/blender_extension.py [FOLDER], by default dist. Prints the path of the zip.
"""

from __future__ import annotations

import json
import sys
import tomllib
import zipfile
from pathlib import Path

from ringlet.data import names
from ringlet.host import link, texts

import ringlet

SOURCE = Path(__file__).parents[1] / "integrations/blender/ringlet_groom"


def contents() -> dict[str, str]:
    """Texts of the files of the extension, by name."""
    found = {path.name: path.read_text(encoding="utf-8") for path in sorted(SOURCE.iterdir()) if path.is_file()}
    for path in map(Path, (link.__file__, names.__file__)):
        found[path.name] = path.read_text(encoding="utf-8")
    found["schema.json"] = json.dumps(ringlet.schema(), separators=(",", ":"))
    found["looks.json"] = json.dumps(
        {one["name"]: {"group": one["group"], "text": texts.look(one["name"])} for one in texts.looks()}
    )
    return found


def build(folder: Path) -> Path:
    """Writes the zip to a folder; returns its path."""
    manifest = tomllib.loads((SOURCE / "blender_manifest.toml").read_text(encoding="utf-8"))
    path = folder / f"{manifest['id']}-{manifest['version']}.zip"
    folder.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        for name, text in contents().items():
            file.writestr(name, text)
    return path


if __name__ == "__main__":
    print(build(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("dist")))
