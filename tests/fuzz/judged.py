"""What holds for any groom, and the comparison of two results."""

from __future__ import annotations

from typing import Any

import numpy as np
from ringlet.data.binding import root_places
from ringlet.data.toml import to_toml
from shapes import ball

from ringlet import Curves, Groom, Memory, Mesh
from ringlet.groom import make_groom, parse_recipe

SINGLE = 5e-7  # relative error of what passes through a file


def grown(table: dict[str, Any], scalp: Mesh | None = None, memory: Memory | None = None) -> Groom:
    """The groom of a recipe's table."""
    return make_groom(parse_recipe(to_toml(table)), scalp or ball(), memory=memory)


def check_curves(curves: Curves, scalp: Mesh, what: str) -> None:
    """Asserts that curves are finite, have distinct ids, and grow where they are bound."""
    assert np.isfinite(curves.points).all(), f"{what}: not finite"
    assert len(np.unique(curves.ids)) == len(curves), f"{what}: ids that are not distinct"
    places = root_places(curves, scalp.points, scalp.triangles)
    off = np.linalg.norm(curves.roots - places, axis=1).max()
    size = np.abs(scalp.points).max()
    assert off <= 1e-5 * size, f"{what}: a root is {off:.2g} m off the skin"


def same(found: np.ndarray, wanted: np.ndarray, tolerance: float, what: str) -> None:
    """Asserts that two arrays agree."""
    assert found.shape == wanted.shape, f"{what}: {found.shape} instead of {wanted.shape}"
    worst = float(np.abs(found - wanted).max()) if found.size else 0.0
    assert worst <= tolerance, f"{what}: differs by {worst:.3g}"
