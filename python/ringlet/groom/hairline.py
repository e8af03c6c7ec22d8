"""The hairline: towards the border of the scalp hair gets sparser, shorter and flatter."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from scipy.spatial import KDTree

from ringlet.data.quantities import Quantity, Section
from ringlet.data.random import Random
from ringlet.groom.operators.operator import along_edges, unit
from ringlet.groom.scalp import Scalp

BORDER_SPACING = 5e-4  # [m] of samples along the border
UPRIGHT = 0.1  # lean of a lock below which the border decides which way it lies down


class Hairline(Section):
    """Fades loose locks over a band along the border of the scalp. A value is the one given here at the border and 1
    where the band ends, smooth in between."""

    width: Annotated[float, Quantity("m", 1e-4, 0.5)] = Field(default=0.012, description="width of the band")
    density: Annotated[float, Quantity("", 0.0, 1.0)] = Field(
        default=0.3, description="fraction of the locks that grow at the border itself"
    )
    length: Annotated[float, Quantity("", 0.01, 1.0)] = Field(
        default=0.45, description="length of locks at the border, relative to their length elsewhere"
    )
    laid: Annotated[float, Quantity("", 0.0, 1.0)] = Field(
        default=0.5, description="how far locks at the border are laid on the skin: 0 as elsewhere, 1 along it"
    )

    def of(self, scalp: Scalp) -> Fade:
        """The hairline of a scalp."""
        return Fade(self, border_points(scalp))


class Fade:
    """The band along the border of one scalp. A closed surface has no border, and nothing fades on it."""

    def __init__(self, hairline: Hairline, border: NDArray[np.float64]) -> None:
        self._hairline, self._border = hairline, border
        self._tree = KDTree(border) if len(border) else None

    def inside(self, roots: NDArray) -> NDArray[np.float64]:
        """How far within the band roots (n, 3) [m] are: 0 at the border, 1 beyond the band, shape (n,)."""
        if self._tree is None:
            return np.ones(len(roots))
        distance = np.asarray(self._tree.query(roots)[0], np.float64)
        t = np.clip(distance / self._hairline.width, 0.0, 1.0)
        return t * t * (3.0 - 2.0 * t)

    def grows(self, roots: NDArray, ids: NDArray, random: Random) -> NDArray[np.bool_]:
        """Mask of the locks that grow, shape (n,)."""
        least = self._hairline.density
        return random.uniform(ids) < least + (1.0 - least) * self.inside(roots)

    def shaped(self, points: NDArray, normals: NDArray) -> NDArray[np.floating]:
        """Shapes (n, points, 3) [m], shorter and flatter towards the border, for normals of the skin (n, 3).

        A lock lies down the way it leans, or away from the border where it stands upright.
        """
        inside = self.inside(points[:, 0])
        edges = np.diff(points, axis=1)
        sizes = np.linalg.norm(edges, axis=2, keepdims=True)
        off = np.maximum(np.einsum("npx,nx->np", edges, normals), 0.0)[:, :, None]
        chord = points[:, -1] - points[:, 0]
        way = unit(chord) + UPRIGHT * self._inward(points[:, 0])
        way = unit(way - np.sum(way * normals, axis=1, keepdims=True) * normals)
        laid = edges + (self._hairline.laid * (1.0 - inside))[:, None, None] * off * (way - normals)[:, None]
        factor = self._hairline.length + (1.0 - self._hairline.length) * inside
        return along_edges(points[:, 0], factor[:, None, None] * sizes * unit(laid))

    def _inward(self, roots: NDArray) -> NDArray[np.float64]:
        """Unit directions away from the nearest point of the border, shape (n, 3); 0 without a border."""
        if self._tree is None:
            return np.zeros((len(roots), 3))
        return unit(roots - self._border[self._tree.query(roots)[1]])


def border_points(scalp: Scalp) -> NDArray[np.float64]:
    """Points along the border of the scalp's region, at most BORDER_SPACING apart [m], shape (n, 3)."""
    return border(scalp)[0]


def border(scalp: Scalp) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points along the border of the scalp's region, at most BORDER_SPACING apart [m], and unit directions out of the
    region, along the skin and across the border, shape (n, 3) each."""
    corners = scalp.triangles[scalp.region].astype(np.int64)
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    _, first, uses = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
    sides = first[uses == 1]
    a, b = scalp.points[edges[sides]].transpose(1, 0, 2)
    opposite = scalp.points[np.concatenate([corners[:, 2], corners[:, 0], corners[:, 1]])[sides]]
    along = unit(b - a)
    inward = opposite - a
    outward = -unit(inward - np.sum(inward * along, axis=1, keepdims=True) * along)
    count = np.maximum(1, np.ceil(np.linalg.norm(b - a, axis=1) / BORDER_SPACING)).astype(np.int64)
    side = np.repeat(np.arange(len(a)), count)
    t = (np.arange(len(side)) - np.repeat(np.cumsum(count) - count, count)) / count[side]
    return a[side] + t[:, None] * (b - a)[side], outward[side]
