"""Blender's Python for tests, and the extension as `make extension` builds it."""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

ROOT = Path(__file__).parents[2]
PYTHON = Path(os.environ.get("RINGLET_BLENDER_PYTHON", ROOT / ".venv-blender/bin/python"))
MISSING = f"Blender is not installed at {PYTHON}: make blender"
EXTENSION = ROOT / "integrations/blender/ringlet_groom"


def load(path: Path) -> ModuleType:
    """A module from its file."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    return module


def build_extension(folder: Path) -> Path:
    """The zip of the extension."""
    return load(ROOT / "tools/blender_extension.py").build(folder)


def run(script: str, found: Path, *arguments: object, seconds: float = 600, **environment: str) -> Any:
    """Runs a script of tests/python in Blender's Python; returns the JSON that it writes to the file ``found``.

    Blender prints a line for each primvar that it cannot read, in each frame: there must be none of ours.
    """
    # PYTHON… variables of the test run must not reach the Python of Blender.
    clean = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    command = [str(word) for word in (PYTHON, Path(__file__).with_name(script), found, *arguments)]
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=seconds, env={**clean, **environment}, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
    unread = [line for line in (done.stdout + done.stderr).splitlines() if "Primvar 'ringlet:" in line]
    assert not unread, unread[:4]
    return json.loads(found.read_text())
