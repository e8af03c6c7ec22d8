"""The variant of Mitsuba that renders: scalar code, which runs anywhere, or code that LLVM compiles."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ringlet.data.errors import UserError
from ringlet.data.extras import need

VARIANTS = {"scalar": "scalar_rgb", "llvm": "llvm_ad_rgb"}
OLDEST_LLVM = 17  # older ones cannot compile the maximum of two floats on x86, and end the process

_engine = "scalar"


def mitsuba() -> Any:
    """Loads Mitsuba in the variant of the engine; lazily, since loading is slow. Raises UserError without Mitsuba."""
    need("mitsuba")
    import mitsuba as mi

    mi.set_variant(VARIANTS[_engine])
    return mi


@contextmanager
def using(name: str) -> Iterator[None]:
    """Renders with an engine. Raises UserError for ``llvm`` without a library of LLVM that is new enough."""
    global _engine
    if name == "llvm":
        _check_llvm()
    before, _engine = _engine, name
    try:
        yield
    finally:
        _engine = before


def llvm_version() -> int:
    """Major version of the library of LLVM that Mitsuba finds; -1 without one."""
    mitsuba()
    import drjit

    return int(drjit.detail.llvm_version()[0])


def _check_llvm() -> None:
    if (found := llvm_version()) < OLDEST_LLVM:
        have = f"finds version {found} of it" if found > 0 else "finds none"
        raise UserError(
            f"picture: engine is llvm, which needs LLVM {OLDEST_LLVM} or newer, and Mitsuba {have}; install one and "
            "name it in DRJIT_LIBLLVM_PATH, or use the engine scalar"
        )
