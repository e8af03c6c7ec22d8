"""The library that reads and writes archives, and what both of these agree on."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

from ringlet.data.errors import UserError

SHAPE = "Shape"  # ends the name of a shape, whose transform has the name itself


def library(path: Path) -> SimpleNamespace:
    """The modules of alembic3d; raises UserError where it is not installed."""
    try:
        import imath  # pyright: ignore[reportMissingImports]
        from alembic3d import Abc, AbcCoreAbstract, AbcGeom  # pyright: ignore[reportMissingImports]
    except ImportError:
        raise UserError(
            f"{path}: Alembic needs alembic3d, which is not installed; try: pip install 'ringlet[alembic]'"
        ) from None
    return SimpleNamespace(abc=Abc, geom=AbcGeom, core=AbcCoreAbstract, imath=imath)
