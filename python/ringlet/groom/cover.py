"""Cover: how much of the scalp hair hides from cameras around the head."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.mesh import Mesh
from ringlet.groom.density import region_samples

CAMERAS = 14
LOWEST = -0.2  # sine of the elevation of the lowest camera
PIXEL = 3e-3  # [m]
MOST_HAIRS = 6000
SAMPLES = 20_000  # of the scalp, and of the bodies that hide it
GRAZING = 0.25  # cosine of the angle beyond which skin is seen along its surface, and does not count
BEHIND = 3e-3  # distance below which two places are as deep as each other [m]


@dataclass(frozen=True)
class Cover:
    """Optical depth of hair in front of the samples of the scalp that cameras see, at the density it was measured at.

    A hair of width w and length l in a pixel of area A hides the part w l / A of it. Many hide 1 - exp(-Σ w l / A), as
    they overlap by chance (Kajiya and Kay 1989). The depth grows with the number of hairs, so one measurement
    serves for all densities.
    """

    depth: NDArray[np.float64]

    def seen(self, factor: float = 1.0) -> float:
        """Part of the scalp that is seen through hair, with ``factor`` times as many hairs."""
        return float(np.exp(-factor * self.depth).mean()) if len(self.depth) else 0.0

    def factor_for(self, cover: float, most: float) -> float:
        """Smallest factor on the number of hairs, at most ``most``, that hides the part ``cover`` of the scalp."""
        low, high = 0.0, most
        for _ in range(50):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self.seen(middle) <= 1.0 - cover else (middle, high)
        return high


def measure(
    scalp: Mesh, region: NDArray[np.int32], hairs: Curves, toward: Iterable[NDArray[np.float64]] | None = None
) -> Cover:
    """Measures the cover of hairs on the triangles ``region`` of a scalp.

    hairs:  points of equal count, with the point attribute ``width`` [m]
    toward: unit directions of cameras far away; ``directions`` by default
    """
    skin, normals = region_samples(scalp, region, SAMPLES)
    head = region_samples(scalp, np.arange(len(scalp.triangles), dtype=np.int32), SAMPLES)[0]
    middles, along, width = _pieces(hairs)
    low = np.minimum(skin.min(axis=0), head.min(axis=0))
    high = np.maximum(skin.max(axis=0), head.max(axis=0))
    reach = float(np.linalg.norm(high - low))
    depths = []
    for direction in directions() if toward is None else toward:
        frame = _View(direction, 0.5 * (low + high), reach)
        depths.append(_depths(frame, skin[normals @ direction > GRAZING], head, middles, along, width))
    return Cover(np.concatenate(depths))


def _pieces(hairs: Curves) -> tuple[NDArray, NDArray, NDArray]:
    """Pieces of at most MOST_HAIRS hairs that are not longer than a pixel: middles and vectors (n, 3) [m], widths (n,).

    Where not all hairs are taken, each is as wide as those that it stands for.
    """
    every = -(-len(hairs) // MOST_HAIRS)
    chosen = slice(every // 2, None, every)
    ends = hairs.points.reshape(len(hairs), -1, 3)[chosen].astype(np.float64)
    width = hairs.point["width"].reshape(len(hairs), -1)[chosen, 1:].reshape(-1) * (len(hairs) / len(ends))
    start, along = ends[:, :-1].reshape(-1, 3), np.diff(ends, axis=1).reshape(-1, 3)
    parts = np.maximum(1, np.ceil(np.linalg.norm(along, axis=1) / PIXEL)).astype(np.int64)
    row = np.repeat(np.arange(len(parts)), parts)
    at = (np.arange(len(row)) - np.repeat(np.cumsum(parts) - parts, parts) + 0.5) / parts[row]
    return start[row] + at[:, None] * along[row], along[row] / parts[row, None], width[row]


def _depths(
    frame: _View, skin: NDArray, head: NDArray, middles: NDArray, along: NDArray, width: NDArray
) -> NDArray[np.float64]:
    """Optical depths in front of the samples of the skin that one camera sees."""
    pixel, height = frame.project(skin)
    top = np.full(frame.pixels, -np.inf)
    for places in (skin, head):
        np.maximum.at(top, *frame.project(places))
    at_skin = np.full(frame.pixels, np.inf)
    seen = height > top[pixel] - BEHIND
    np.minimum.at(at_skin, pixel[seen], height[seen])
    at, over = frame.project(middles)
    inside = over > at_skin[at]
    across = np.linalg.norm(along - np.outer(along @ frame.toward, frame.toward), axis=1)
    hidden = np.bincount(at[inside], (width * across)[inside] / PIXEL**2, minlength=frame.pixels)
    return np.asarray(hidden[pixel[seen]], np.float64)


class _View:
    """A camera far away: pixels across its direction, and heights along it."""

    def __init__(self, toward: NDArray, middle: NDArray, reach: float) -> None:
        self.toward, self._middle = toward, middle
        side = np.cross(toward, [0.0, 1.0, 0.1])
        self._side = side / np.linalg.norm(side)
        self._up = np.cross(self._side, toward)
        self._row = int(np.ceil(reach / PIXEL)) + 2
        self.pixels = self._row**2

    def project(self, places: NDArray) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Pixels and heights of places, each of shape (n,); outside of the picture the nearest pixel at its border."""
        local = places - self._middle
        column, line = (
            np.clip(np.floor(local @ axis / PIXEL + 0.5 * self._row), 0, self._row - 1)
            for axis in (self._side, self._up)
        )
        return (line * self._row + column).astype(np.int64), local @ self.toward


def directions() -> NDArray[np.float64]:
    """Unit directions from the head to the cameras, evenly spread above LOWEST, shape (CAMERAS, 3)."""
    height = LOWEST + (1.0 - LOWEST) * (np.arange(CAMERAS) + 0.5) / CAMERAS
    angle = np.arange(CAMERAS) * np.pi * (3.0 - np.sqrt(5.0))
    flat = np.sqrt(1.0 - height**2)
    return np.stack([flat * np.sin(angle), height, flat * np.cos(angle)], axis=1)
