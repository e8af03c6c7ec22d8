"""Triangle meshes, such as the scalp and bodies, and their animation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ringlet.data.frames import frame_range
from ringlet.data.surfaces import UNCOLORED, Color, color_of

if TYPE_CHECKING:
    from ringlet.data.texture import Texture


@dataclass
class Mesh:
    """A triangle mesh in its rest pose, in metres.

    name:      its source, for messages, e.g. ``head.usdc /child/head``
    points:    positions [m], shape (n, 3), float64
    triangles: vertex indices, counter-clockwise from outside, shape (m, 3), int32
    uv:        texture coordinates per triangle corner, shape (m, 3, 2), or None
    faces:     the source polygon of each triangle, shape (m,), int32 (Houdini's ``skinprim``)
    places:    parametric coordinates of the corners in their source polygons, shape (m, 3, 2) (``skinprimuv``)
    regions:   named sets of triangles, e.g. ``scalp``; index arrays, int32
    color:     display colour (linear r, g, b), the mean of it where it varies; by default that of what it is called
    colors:    display colour of each vertex (linear r, g, b), shape (n, 3), or None where it does not vary
    maps:      painted values by name, at the corners of each triangle, shape (m, 3), float64
    vectors:   painted directions by name, at the corners of each triangle, shape (m, 3, 3), float64, as the points are
    textures:  painted values by name, as pictures over ``uv``
    gradients: values by name that are computed from places (n, 3) [m], shape (n,)
    """

    name: str
    points: NDArray[np.float64]
    triangles: NDArray[np.int32]
    uv: NDArray[np.float64] | None = None
    faces: NDArray[np.int32] | None = None
    places: NDArray[np.float64] | None = None
    regions: dict[str, NDArray[np.int32]] = field(default_factory=dict)
    color: Color = UNCOLORED
    colors: NDArray[np.float64] | None = None
    maps: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    vectors: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    textures: dict[str, Texture] = field(default_factory=dict)
    gradients: dict[str, Callable[[NDArray[np.float64]], NDArray[np.float64]]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.color is UNCOLORED:
            self.color = color_of(self.name)

    def __repr__(self) -> str:
        return f"Mesh({self.name!r}, {len(self.points):,} points, {len(self.triangles):,} triangles)"

    def region(self, name: str | None) -> NDArray[np.int32]:
        """Triangles of a named region; all of them for None. Raises KeyError with the names there are."""
        if name is None:
            return np.arange(len(self.triangles), dtype=np.int32)
        if name not in self.regions:
            raise KeyError(f"{self.name} has no region '{name}'; it has: {', '.join(self.regions) or 'none'}")
        return self.regions[name]

    def normals(self, points: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Area-weighted vertex normals, shape (n, 3), of the rest pose or of the given positions."""
        at = self.points if points is None else points
        a, b, c = (at[self.triangles[:, k]] for k in range(3))
        face = np.cross(b - a, c - a)
        normals = np.zeros_like(at, dtype=np.float64)
        for k in range(3):
            np.add.at(normals, self.triangles[:, k], face)
        return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)


@dataclass
class Clip:
    """Positions of a mesh over time.

    frames: frame numbers (time codes), shape (k,)
    points: positions [m], shape (k, n, 3), float64
    fps:    frames per second
    """

    frames: NDArray[np.float64]
    points: NDArray[np.float64]
    fps: float

    def __repr__(self) -> str:
        return f"Clip({frame_range(self.frames)}, {self.points.shape[1]:,} points, {self.fps:g} fps)"

    def at(self, frame: float) -> NDArray[np.float64]:
        """Positions at a frame, linear between samples, held beyond the ends; shape (n, 3)."""
        after = (
            int(np.clip(np.searchsorted(self.frames, frame), 1, len(self.frames) - 1)) if len(self.frames) > 1 else 0
        )
        if after == 0:
            return self.points[0]
        start, end = self.frames[after - 1], self.frames[after]
        weight = float(np.clip((frame - start) / (end - start), 0.0, 1.0))
        return (1.0 - weight) * self.points[after - 1] + weight * self.points[after]

    def next_to(self, frame: float) -> float:
        """The frame whose difference to this one is the motion there: the one before, or the one after where the clip
        begins later."""
        return frame - 1.0 if self.frames[0] <= frame - 1.0 else frame + 1.0
