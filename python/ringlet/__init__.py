"""Ringlet grooms tightly curled hair and simulates it."""

from importlib.metadata import version
from typing import TYPE_CHECKING

from ringlet.api import (
    build_groom,
    build_hairs,
    load_groom,
    read_cache,
    read_groom,
    read_recipe,
    read_shot,
    run_bench,
    run_validation,
    schema,
    simulate,
    use_threads,
    write_cache,
    write_groom,
    write_hairs,
    write_sheet,
    write_still,
)
from ringlet.curves import Curves
from ringlet.demo import run_demo
from ringlet.errors import UserError
from ringlet.mesh import Clip, Mesh
from ringlet.run import Run
from ringlet.stage import StageSpace

if TYPE_CHECKING:
    from ringlet.groom.groom import Groom
    from ringlet.shot.cache import Cache

__version__ = version("ringlet")
__all__ = [
    "Cache",
    "Clip",
    "Curves",
    "Groom",
    "Mesh",
    "Run",
    "StageSpace",
    "UserError",
    "__version__",
    "build_groom",
    "build_hairs",
    "load_groom",
    "read_cache",
    "read_groom",
    "read_recipe",
    "read_shot",
    "run_bench",
    "run_demo",
    "run_validation",
    "schema",
    "simulate",
    "use_threads",
    "write_cache",
    "write_groom",
    "write_hairs",
    "write_sheet",
    "write_still",
]


def __getattr__(name: str) -> type:
    """Groom and Cache live in packages that load slowly, so those are imported when they are first asked for."""
    if name == "Groom":
        from ringlet.groom.groom import Groom

        return Groom
    if name == "Cache":
        from ringlet.shot.cache import Cache

        return Cache
    raise AttributeError(f"module 'ringlet' has no attribute '{name}'")
