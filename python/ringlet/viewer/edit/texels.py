"""The texels of a map on a scalp: where each lies in space."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, uniform_filter

from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh

MARGIN = 3.0  # texels around the scalp's charts that go with them, so that no seam shows between texels
BLUR = 9  # width of the mean that smooths [texels]


class Texels:
    """Positions of the texels that a region of a mesh covers.

    covered:  which texels lie on the region or in the margin of a chart, shape (rows, columns)
    position: of the covered texels [m], shape (count, 3)

    Raises UserError for a mesh without texture coordinates.
    """

    def __init__(self, mesh: Mesh, region: NDArray[np.integer], shape: tuple[int, int]) -> None:
        if mesh.uv is None:
            raise UserError(f"paint: {mesh.name} has no texture coordinates (st) to paint over; unwrap it")
        self.mesh, self.shape = mesh, shape
        inside, position = _rasterized(mesh.uv[region], mesh.points[mesh.triangles[region]], shape)
        found: Any = distance_transform_edt(~inside, return_indices=True)
        distance, (rows, columns) = found
        self._inside = inside
        self.covered: NDArray[np.bool_] = distance <= MARGIN
        self.position: NDArray[np.float64] = position[rows, columns][self.covered]
        self._rows, self._columns = rows[self.covered], columns[self.covered]

    def changed(
        self, values: NDArray[np.floating], weight: NDArray[np.floating], to: NDArray[np.floating] | float | None
    ) -> NDArray[np.float32]:
        """Values with a stroke of a brush.

        values: shape (rows, columns), or (rows, columns, 3) for directions
        weight: fraction of the way of each covered texel, shape (count,)
        to:     value to which the brush goes; None for the mean around each texel
        """
        target = self._mean(values)[self._rows, self._columns] if to is None else to
        changed = values.astype(np.float32)
        before = changed[self.covered]
        changed[self.covered] = before + weight.reshape(-1, *[1] * (before.ndim - 1)) * (target - before)
        return changed

    def _mean(self, values: NDArray[np.floating]) -> NDArray[np.float64]:
        """Mean of the values on the region around each texel, of the shape of ``values``."""
        if values.ndim == 3:
            return np.stack([self._mean(channel) for channel in np.moveaxis(values, -1, 0)], axis=-1)
        share = np.maximum(uniform_filter(self._inside.astype(np.float64), BLUR), 1e-6)
        return uniform_filter(np.where(self._inside, values, 0.0), BLUR) / share


def _rasterized(
    uv: NDArray[np.floating], corners: NDArray[np.floating], shape: tuple[int, int]
) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """Texels with their centres in triangles, shape (rows, columns), and their positions [m], shape (…, 3).

    uv, corners: texture coordinates and positions of the corners, shape (k, 3, 2) and (k, 3, 3)
    """
    rows, columns = shape
    inside, position = np.zeros(shape, bool), np.zeros((*shape, 3))
    at = np.stack([(1.0 - uv[..., 1]) * rows, uv[..., 0] * columns], axis=-1) - 0.5
    low, high = np.floor(at.min(axis=1)).astype(int), np.ceil(at.max(axis=1)).astype(int) + 1
    a, b = at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]
    double_area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    for k in np.flatnonzero(np.abs(double_area) > 1e-12):
        i, j = np.mgrid[low[k, 0] : high[k, 0], low[k, 1] : high[k, 1]]
        di, dj = i - at[k, 0, 0], j - at[k, 0, 1]
        v = (di * b[k, 1] - dj * b[k, 0]) / double_area[k]
        w = (a[k, 0] * dj - a[k, 1] * di) / double_area[k]
        within = (v >= -1e-9) & (w >= -1e-9) & (v + w <= 1.0 + 1e-9)
        i, j, v, w = np.mod(i[within], rows), np.mod(j[within], columns), v[within], w[within]
        inside[i, j] = True
        position[i, j] = np.stack([1.0 - v - w, v, w], axis=-1) @ corners[k]
    return inside, position
