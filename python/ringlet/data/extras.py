"""Packages that Ringlet grooms and simulates without, and the extras that bring them."""

from __future__ import annotations

from importlib.util import find_spec

from ringlet.data.errors import UserError

EXTRAS = {
    "mitsuba": "pictures",
    "matplotlib": "pictures",
    "fastapi": "review",
    "uvicorn": "review",
    "websockets": "review",
}


def need(*packages: str) -> None:
    """Raises UserError for a package that is not installed, before the work for which it is needed."""
    for package in packages:
        if find_spec(package) is None:
            raise UserError(f"{package} is not installed; install it with: pip install 'ringlet[{EXTRAS[package]}]'")
