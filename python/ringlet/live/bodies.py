"""What live hair stays out of: closed meshes that move with the head or with the trunk, as planes and as friction."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.mesh import Mesh
from ringlet.data.rigid import moved
from ringlet.sim.strands import Planes, Springs

Array = NDArray[np.float64]

DISTANCES, BAND = 0.006, 0.02  # cell of the grids of distances to bodies, and where these are the closest [m]
CLEARANCE = 5e-4  # of a coil from them [m]
FIRM = 1000.0  # stiffness of a body, relative to the inertia of a vertex in a step
FRICTION, STICK = 0.3, 5e-4  # Coulomb's μ of hair on them, and slip in a step below which it sticks [m]
NEAR = 0.1  # from here on a body may be met in a step [m]


class Poses(NamedTuple):
    """The poses of head and trunk as a step begins and ends, shape (4, 4) each."""

    head: Array
    head_end: Array
    trunk: Array
    trunk_end: Array


class Palm(NamedTuple):
    """A ball that presses on hair.

    start, end: its centre as a step begins and ends [m]
    radius:     [m]
    depth:      by how much hair inside comes out in a step [m]
    """

    start: Array
    end: Array
    radius: float
    depth: float


class Bodies:
    """Meshes by their distances, sampled where hair may come.

    of_head: meshes that go with the head; what is below the neck of them goes with the trunk
    clothes: meshes that go with the trunk as a whole
    """

    def __init__(self, of_head: Sequence[Mesh], clothes: Sequence[Mesh]) -> None:
        self.of_head, self.clothes = tuple(of_head), tuple(clothes)
        self._grids: list[tuple[_core.DistanceGrid, bool]] = []
        self._low = self._high = np.zeros(3)
        self._clearance = self._friction = np.zeros(0)
        self._neck = 0.0

    def fit(self, vertices: Array, radius: Array, margin: float, neck: float) -> None:
        """Samples the distances around hair; what is groomed closer than its coil is wide stays so.

        vertices: of rods as groomed [m], shape (n, 3)
        radius:   of their coils [m], shape (n,)
        margin:   how far hair goes beyond where it is groomed [m]
        neck:     height of the neck [m]
        """
        low, high = vertices.min(axis=0) - margin, vertices.max(axis=0) + margin
        self._clearance, self._neck = radius + CLEARANCE, neck
        if not self._grids or (low < self._low).any() or (high > self._high).any():
            self._low, self._high = low - margin, high + margin
            self._grids = []
            for meshes, of_head in ((self.of_head, True), (self.clothes, False)):
                for mesh in meshes:
                    solid = _core.Solid(np.ascontiguousarray(mesh.points, np.float64), mesh.triangles)
                    self._grids.append((_core.DistanceGrid(solid, self._low, self._high, DISTANCES, BAND), of_head))
        for grid, _ in self._grids:
            self._clearance = np.minimum(self._clearance, grid.at(vertices)[0])
        self.let_go()

    def let_go(self) -> None:
        """Nothing rubs on them in the next step."""
        self._friction = np.zeros(len(self._clearance))

    def planes(self, positions: Array, inertia: Array, poses: Poses, palm: Palm | None) -> Planes | None:
        """The plane in front of each vertex that keeps it outside in a step; None where nothing is to be kept out of.

        inertia: of each vertex in the step, 0 where it is held [N/m], shape (n,)
        """
        if not self._grids and palm is None:
            return None
        planes, above = _core.BodyPlanes(len(positions)), self._above_neck(positions, poses.head)
        for grid, of_head in self._grids:
            if of_head:
                clearance = np.where(above, self._clearance, -np.inf)
                planes.add(grid, poses.head, poses.head_end, positions, clearance)
            clearance = np.where(above & of_head, -np.inf, self._clearance)
            planes.add(grid, poses.trunk, poses.trunk_end, positions, clearance)
        if palm is not None:
            planes.add_ball(palm.start, palm.end, palm.radius, palm.depth, positions, self._clearance)
        return planes.normals, planes.offsets, np.where(planes.gaps < NEAR, FIRM * inertia, 0.0)

    def friction(self, positions: Array, poses: Poses) -> Springs:
        """Springs that hold vertices to where they would be, had they gone with the body that is there."""
        return self._taken_along(positions, poses), self._friction

    def rub(self, planes: Planes, before: Array, after: Array, poses: Poses) -> None:
        """Coulomb friction in the next step: springs as stiff as it would have been on the slip of this one.

        before, after: positions of vertices as the step began and ended [m], shape (n, 3)
        """
        normals, offsets, stiffness = planes
        pressed = stiffness * np.maximum(offsets - np.einsum("ni,ni->n", normals, after), 0.0)
        slip = after - self._taken_along(before, poses)
        slip -= np.einsum("ni,ni->n", normals, slip)[:, None] * normals
        self._friction = FRICTION * pressed / np.maximum(np.linalg.norm(slip, axis=1), STICK)

    def outside(self, at: Array, radius: float, head: Array) -> Array:
        """The centre of a palm that is kept outside what moves with the head [m]."""
        at = np.array(at, np.float64)
        for grid in (grid for grid, of_head in self._grids if of_head):
            distance, away = grid.at(((at - head[:3, 3]) @ head[:3, :3])[None])
            at += max(0.0, radius + self._clearance.max() - distance[0]) * (head[:3, :3] @ away[0])
        return at

    def _above_neck(self, positions: Array, head: Array) -> NDArray[np.bool_]:
        """Which places are with what moves with the head, shape (n,)."""
        return positions @ head[:3, 1] - head[:3, 3] @ head[:3, 1] > self._neck

    def _taken_along(self, positions: Array, poses: Poses) -> Array:
        """Where places are at the end of a step that go with the body that is there [m], shape (n, 3)."""
        of_head = moved(positions, poses.head_end @ np.linalg.inv(poses.head))
        of_trunk = moved(positions, poses.trunk_end @ np.linalg.inv(poses.trunk))
        return np.where(self._above_neck(positions, poses.head)[:, None], of_head, of_trunk)
