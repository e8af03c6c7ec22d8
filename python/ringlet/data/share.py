"""The folders of the example and the benchmarks: in the repository, or beside an installed package."""

from __future__ import annotations

from pathlib import Path

from ringlet.data.errors import UserError


def share(name: str) -> Path:
    """The folder ``name`` that comes with Ringlet: ``examples/child`` or ``bench``."""
    package = Path(__file__).parents[1]
    for root in (package.parents[1], package / "share"):
        if (root / name).exists():
            return root / name
    raise UserError(f"{name}: does not come with this installation of Ringlet; install it again")
