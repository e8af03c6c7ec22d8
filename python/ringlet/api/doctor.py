"""A check of the installation: versions, processor, optional packages, and a self-test of some seconds."""

from __future__ import annotations

import os
import platform
import re
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from importlib.metadata import PackageNotFoundError, requires, version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

import ringlet
from ringlet import _core
from ringlet.api.progress import Progress
from ringlet.data.share import share

ENOUGH_MEMORY = 4 * 2**30  # for the example and its picture
PICTURE = 96  # height of the self-test's picture [pixels]


@dataclass
class Finding:
    """One item of the check.

    state:  ``ok``; ``optional``: not there, and not needed; ``fails``
    remedy: what to do about it; empty where nothing needs doing
    """

    name: str
    state: str
    found: str
    remedy: str = ""

    def json(self) -> dict[str, Any]:
        """As plain values."""
        return asdict(self)


def diagnose(*, self_test: bool = True, progress: Progress | None = None) -> list[Finding]:
    """Checks the installation and, with ``self_test``, grooms, simulates, writes, reads and draws a little."""
    looks = [
        _ringlet,
        _processor,
        _memory,
        *(_package(name) for name in _needed()),
        _mitsuba,
        _oidn,
        _matplotlib,
        _server,
        _pardiso,
        _dask,
        _openjd,
        _alembic,
        _ffmpeg,
        _page,
    ]
    tests: list[Callable[[Path], Finding]] = (
        [_test_core, _test_contact, _test_files, _test_picture] if self_test else []
    )
    findings = [_guarded(look) for look in looks]
    with tempfile.TemporaryDirectory(prefix="ringlet-") as folder:
        for done, test in enumerate(tests):
            if progress:
                progress("self-test", done, len(tests))
            findings.append(_guarded(test, Path(folder)))
    if progress and tests:
        progress("self-test", len(tests), len(tests))
    return findings


def _ringlet() -> Finding:
    return Finding("Ringlet", "ok", f"{version('ringlet')}, Python {platform.python_version()}, {platform.platform()}")


def _processor() -> Finding:
    slow = _core.simd() == "baseline" and platform.machine() in ("x86_64", "AMD64")
    remedy = "a processor with AVX2 is several times faster" if slow else ""
    return Finding("processor", "ok", f"{_core.simd()}, {_core.thread_count()} of {os.cpu_count()} threads", remedy)


def _memory() -> Finding:
    if sys.platform != "linux":
        return Finding("memory", "ok", "not measured on this system")
    total = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    enough = total >= ENOUGH_MEMORY
    remedy = "" if enough else "the example takes up to 4 GiB; simulate fewer locks and draw fewer hairs"
    return Finding("memory", "ok" if enough else "fails", f"{total / 2**30:.1f} GiB", remedy)


def _needed() -> list[str]:
    """Packages that Ringlet does not run without."""
    lines = [line for line in requires("ringlet") or [] if "extra ==" not in line]
    return [re.split(r"[ <>=!~;\[]", line)[0] for line in lines]


def _package(name: str) -> Callable[[], Finding]:
    def look() -> Finding:
        try:
            return Finding(name, "ok", version(name))
        except PackageNotFoundError:
            return Finding(
                name, "fails", "is not installed", "install Ringlet again: pip install --force-reinstall ringlet"
            )

    return look


def _pardiso() -> Finding:
    one = np.zeros(1, int)
    if ringlet.DirectSolver(one, one, rows=1, block=1).method == "pardiso":
        return Finding("MKL PARDISO", "ok", "opened")
    return Finding(
        "MKL PARDISO", "optional", "is not installed", "for large direct solves: pip install 'ringlet[direct]'"
    )


def _optional(package: str, title: str, use: str) -> Callable[[], Finding]:
    def look() -> Finding:
        try:
            return Finding(title, "ok", version(package))
        except PackageNotFoundError:
            return Finding(title, "optional", "is not installed", use)

    return look


_dask = _optional("distributed", "dask.distributed", "for wedges: pip install 'ringlet[farm]'")
_openjd = _optional("openjd-cli", "Open Job Description", "to run templates: pip install 'ringlet[farm]'")
_alembic = _optional("alembic3d", "Alembic", "for .abc files: pip install 'ringlet[alembic]'")
_mitsuba = _optional("mitsuba", "Mitsuba", "for pictures: pip install 'ringlet[pictures]'")
_oidn = _optional("pyoidn", "Open Image Denoise", "for pictures without noise: pip install 'ringlet[pictures]'")
_matplotlib = _optional("matplotlib", "Matplotlib", "for charts: pip install 'ringlet[pictures]'")
_server = _optional("uvicorn", "server of the review", "for ringlet view: pip install 'ringlet[review]'")
_ffmpeg = _optional("imageio-ffmpeg", "imageio-ffmpeg", "for videos: pip install 'ringlet[movie]'")


def _page() -> Finding:
    if (Path(__file__).parents[1] / "viewer" / "static" / "index.html").exists():
        return Finding("review page", "ok", "built")
    return Finding("review page", "optional", "is not built", "for ringlet view, in a clone: make build")


def _guarded(look: Callable[..., Finding], *folder: Path) -> Finding:
    """The finding of a look or a test, also where it breaks off, such as without a package that it loads."""
    try:
        return look(*folder)
    except Exception as error:  # whatever it is, it is what was asked for
        remedy = "run it with --debug, and report what it prints"
        name = look.__name__.removeprefix("_test").strip("_")
        return Finding(name, "fails", f"{type(error).__name__}: {error}", remedy)


def _test_core(_: Path) -> Finding:
    """A cantilever against its known answer."""
    start = time.perf_counter()
    rows = ringlet.run_validation(["cantilever"])
    held, took = sum(row.passed for row in rows), f"{time.perf_counter() - start:.1f} s"
    state = "ok" if held == len(rows) else "fails"
    remedy = "" if state == "ok" else "run: ringlet validate, and report it"
    return Finding("simulation", state, f"{held} of {len(rows)} known answers hold, {took}", remedy)


def _test_contact(_: Path) -> Finding:
    """A strand that falls onto another has to stay above it."""
    start = time.perf_counter()
    x = np.linspace(-0.02, 0.02, 9)
    below, above = np.c_[x, 0 * x, 0 * x], np.c_[0 * x, 0 * x + 5e-3, x]
    held = np.isin(np.arange(2 * len(x)), (0, 8, 9))
    strands = ringlet.Strands(ringlet.Curves.from_list([below, above]), ringlet.Material(bend_scale=0.0), held)
    scene, touched = ringlet.Scene(strands, contact=ringlet.Contact()), False
    for _step in range(24):
        scene.step(strands.curves.points, 1 / 240, gravity=(0.0, -98.1, 0.0))
        touched = touched or len(scene.contacts[0]) > 0
    gap = strands.positions[13, 1] - strands.positions[4, 1]
    works = touched and bool(gap > 0.0)
    found = (
        f"a strand fell onto another and {'stopped' if works else 'went through'}, {time.perf_counter() - start:.1f} s"
    )
    return Finding(
        "contact", "ok" if works else "fails", found, "" if works else "run: ringlet validate, and report it"
    )


def _test_files(folder: Path) -> Finding:
    """The example's groom, to USD and back."""
    start = time.perf_counter()
    recipe = share("examples/child") / "curls.recipe.toml"
    groom = ringlet.build_groom(recipe)
    ringlet.write_groom(groom, folder / "groom.usdc")
    off = np.abs(ringlet.read_groom(folder / "groom.usdc").locks.points - groom.locks.points).max()
    same = bool(off < 1e-6)
    found = f"{len(groom.locks):,} locks groomed, written and read, {time.perf_counter() - start:.1f} s"
    remedy = "" if same else f"points come back {off:.2g} m away; report it"
    return Finding("groom and USD", "ok" if same else "fails", found, remedy)


def _test_picture(folder: Path) -> Finding:
    """A small picture of that groom, where Mitsuba is installed."""
    if find_spec("mitsuba") is None:
        return Finding("picture", "optional", "not drawn")
    start = time.perf_counter()
    ringlet.write_hairs(folder / "groom.usdc", folder / "hair.usdc", fraction=0.01)
    path = folder / "still.png"
    ringlet.write_still(folder / "hair.usdc", path, width=PICTURE * 3 // 4, height=PICTURE, samples=2)
    found = f"drawn, {path.stat().st_size / 1024:.0f} kB, {time.perf_counter() - start:.1f} s"
    return Finding("picture", "ok", found)
