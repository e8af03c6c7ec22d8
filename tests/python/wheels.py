"""Wheels for tests of installation: of this Ringlet as it is, without a build."""

from __future__ import annotations

import sys
import sysconfig
import zipfile
from collections.abc import Mapping
from pathlib import Path

from ringlet.data.share import share

import ringlet
from ringlet import _core

TAG = f"cp{sys.version_info.major}{sys.version_info.minor}-none-{sysconfig.get_platform().replace('-', '_')}"
NEEDED = "ringlet_needs"  # stands for the packages that Ringlet requires


def wheel_of_ringlet(folder: Path) -> Path:
    """The package with its compiled part and the examples; it requires ``NEEDED``."""
    package, examples = Path(ringlet.__file__).parent, share("examples")
    files = {
        f"ringlet/{place}{path.relative_to(top)}": path.read_bytes()
        for top, place in ((package, ""), (examples, "share/examples/"))
        for path in top.rglob("*")
        if path.is_file() and not {"__pycache__", "static"} & set(path.parts)
    }
    core = Path(_core.__file__)
    files[f"ringlet/{core.name}"] = core.read_bytes()
    return _wheel(folder, "ringlet", ringlet.__version__, files, f"Requires-Dist: {NEEDED}\n")


def wheel_of_needed(folder: Path) -> Path:
    """Brings the packages of the Python that runs, where they are."""
    paths = "\n".join({sysconfig.get_path(name) for name in ("purelib", "platlib")})
    return _wheel(folder, NEEDED, "1.0", {f"{NEEDED}.pth": paths.encode()})


def _wheel(folder: Path, name: str, version: str, files: Mapping[str, bytes], metadata: str = "") -> Path:
    about, path = f"{name}-{version}.dist-info", folder / f"{name}-{version}-{TAG}.whl"
    texts = {
        f"{about}/METADATA": f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n{metadata}",
        f"{about}/WHEEL": f"Wheel-Version: 1.0\nRoot-Is-Purelib: false\nTag: {TAG}\n",
    }
    names = [*files, *texts, f"{about}/RECORD"]
    texts[f"{about}/RECORD"] = "".join(f"{one},,\n" for one in names)
    with zipfile.ZipFile(path, "w") as wheel:
        for one, values in {**files, **texts}.items():
            wheel.writestr(one, values)
    return path
