"""One version of Ringlet stands in the package, the Blender extension, its page and the changelog."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]
VERSION = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]


def test_the_extension_for_blender_has_the_version_of_the_package():
    manifest = ROOT / "integrations/blender/ringlet_groom/blender_manifest.toml"
    assert tomllib.loads(manifest.read_text())["version"] == VERSION
    assert f"ringlet_groom-{VERSION}.zip" in (ROOT / "docs/blender.md").read_text()


def test_the_newest_release_of_the_changelog_is_the_version_of_the_package():
    titles = re.findall(r"^## (.*)$", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert titles[0] == "[Unreleased]"
    assert re.fullmatch(rf"\[{re.escape(VERSION)}\] - \d{{4}}-\d\d-\d\d", titles[1])
