"""Where Ringlet's command is, and its installation into an environment of its own."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import threading
from pathlib import Path

import bpy

from .refused import Refused

EXTRAS = "pictures,review"  # what the buttons need beyond grooms and simulations


def command() -> list[str] | None:
    """Ringlet's command: that of the preferences, the one that the extension installed, or the one on the PATH."""
    chosen = preference("path")
    if chosen:
        return [bpy.path.abspath(chosen)]
    if (python := python_of(environment())).is_file():
        return [str(python), "-c", "import ringlet.cli; ringlet.cli.main()"]
    found = shutil.which("ringlet")
    return [found] if found else None


def python_of(folder: Path) -> Path:
    """The Python of an environment."""
    return folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


def environment() -> Path:
    """Folder of the extension's own environment. It lies where updates of the extension leave it alone."""
    if __package__.startswith("bl_ext."):
        return Path(bpy.utils.extension_path_user(__package__, path="ringlet"))
    return Path(bpy.utils.user_resource("DATAFILES", path="ringlet"))


def preference(name: str) -> str:
    """A preference of the extension; empty where it is registered without any."""
    addon = bpy.context.preferences.addons.get(__package__)
    return getattr(addon.preferences, name, "") if addon and addon.preferences else ""


class Installation:
    """Installs Ringlet on a thread: ``state`` is empty, what it does, ``done`` or a line that says what failed."""

    def __init__(self) -> None:
        self.state = ""
        self._thread: threading.Thread | None = None

    @property
    def running(self) -> bool:
        """Whether it is at work."""
        return self._thread is not None and self._thread.is_alive()

    def start(self, source: str) -> None:
        """Begins; ``source`` is a wheel, or a name that pip finds online. Raises Refused for what cannot begin.

        Wheels that a wheel needs are taken from its folder, and online where that is allowed.
        """
        if self.running:
            raise Refused("Ringlet is being installed; wait for it")
        wheel = Path(bpy.path.abspath(source)) if source.endswith(".whl") else None
        if wheel is not None and not wheel.is_file():
            raise Refused(f"{wheel}: there is no such file; choose a wheel of Ringlet")
        if wheel is None and not bpy.app.online_access:
            raise Refused("Online access is off; choose a wheel, or allow it in Preferences > System > Network")
        folder, python = environment(), preference("python") or sys.executable
        words = [f"{wheel or source}[{EXTRAS}]", *(["--find-links", str(wheel.parent)] if wheel else [])]
        if not bpy.app.online_access:
            words.append("--no-index")
        self._thread = threading.Thread(target=self._run, args=(folder, python, words), daemon=True)
        self._thread.start()

    def _run(self, folder: Path, python: str, source: list[str]) -> None:
        # A folder aside, which takes the place of the old one only when all is there.
        aside = folder.with_name(f"{folder.name}.new")
        steps = (
            ("Making an environment", [python, "-m", "venv", "--clear", str(aside)]),
            (
                "Installing Ringlet",
                [str(python_of(aside)), "-m", "pip", "install", "--disable-pip-version-check", *source],
            ),
        )
        clean = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
        try:
            for self.state, words in steps:
                done = subprocess.run(words, capture_output=True, text=True, env=clean, check=False)
                if done.returncode:
                    lines = (done.stderr or done.stdout).strip().splitlines() or ["no reason given"]
                    self.state = f"{self.state} failed: {lines[-1][:200]}"
                    shutil.rmtree(aside, ignore_errors=True)
                    return
            shutil.rmtree(folder, ignore_errors=True)
            aside.rename(folder)
            self.state = "done"
        except OSError as error:
            self.state = f"{self.state} failed: {error}"


installation = Installation()
