"""Cloth that moves: the core's solver with named settings."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.shot.cloth import ClothMaterial
from ringlet.shot.solver import ClothSolver
from ringlet.sim.core import Vector, assign, step_settings


class Cloth:
    """Cloth in motion, at the start at rest in its rest shape.

    mesh:       the rest shape with its folds
    material:   its material
    held:       the vertices that follow ``targets``: indices, or a mask of shape (n,)
    attachment: stiffness [N/m] of a spring from each vertex to its target, shape (n,); none by default
    warp:       a direction whose projection on each triangle is the warp; by default that of the texture's u, and x
                where there is no texture
    """

    def __init__(
        self,
        mesh: Mesh,
        material: ClothMaterial | None = None,
        held: NDArray[np.integer] | NDArray[np.bool_] | None = None,
        *,
        attachment: NDArray[np.floating] | None = None,
        warp: Vector | None = None,
    ) -> None:
        self.mesh, self.material = mesh, material or ClothMaterial()
        self.held = np.zeros(len(mesh.points), bool)
        if held is not None:
            self.held[held] = True
        _check(mesh, self.held)
        self._core = _core.Cloth(
            np.ascontiguousarray(mesh.triangles, np.int32),
            np.ascontiguousarray(mesh.points, np.float64),
            np.ascontiguousarray(warp_directions(mesh, warp), np.float64),
            np.ascontiguousarray(self.held, np.uint8),
            np.ascontiguousarray(() if attachment is None else attachment, np.float64),
            assign(_core.ClothMaterial(), self.material, without={"friction"}),  # which is of a pair
        )
        self._no_forces = np.zeros((len(mesh.points), 3))

    @property
    def positions(self) -> NDArray[np.float64]:
        """Positions [m], shape (n, 3): the solver's own memory."""
        return self._core.positions

    @property
    def velocities(self) -> NDArray[np.float64]:
        """Velocities [m/s], shape (n, 3): the solver's own memory."""
        return self._core.velocities

    def scale_rest(self, scale: float) -> None:
        """Scales the rest shape to ``scale`` times the mesh: elastic that contracts, below 1.

        Masses and bend stiffness stay. Self-contact in a scene leaves room for the rest shape with which the scene is
        made.
        """
        self._core.scale_rest(scale)

    @property
    def masses(self) -> NDArray[np.float64]:
        """Mass of each vertex [kg], shape (n,): a third of its triangles'."""
        return self._core.masses

    def step(
        self,
        targets: NDArray[np.floating],
        dt: float,
        *,
        gravity: Vector = (0.0, 0.0, 0.0),
        wind: Vector = (0.0, 0.0, 0.0),
        forces: NDArray[np.floating] | None = None,
        solver: ClothSolver | None = None,
    ) -> dict[str, float]:
        """Advances by ``dt`` [s]; held vertices end where ``targets`` [m], shape (n, 3), has them.

        forces: on each vertex besides gravity and air [N], shape (n, 3)
        Returns the report (see ``_core.CLOTH_REPORT``): energies [J], iterations, residuals.
        """
        solver = solver or ClothSolver()
        shape = self.positions.shape
        for name, rows in (("targets", targets), ("forces", self._no_forces if forces is None else forces)):
            if np.shape(rows) != shape:
                raise ValueError(f"cloth: {name} has shape {np.shape(rows)}; must be {shape}")
        row = self._core.step(
            np.ascontiguousarray(targets, np.float64),
            self._no_forces if forces is None else np.ascontiguousarray(forces, np.float64),
            step_settings(solver, dt, gravity, wind),
        )
        return dict(zip(_core.CLOTH_REPORT, row.tolist(), strict=True))

    def energy(
        self, positions: NDArray[np.floating], *, hessian: bool = False
    ) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
        """Elastic energy [J], its gradient [N], shape (n, 3), and the Hessian Newton uses, dense, shape (3n, 3n)."""
        return self._core.energy(np.ascontiguousarray(positions, np.float64), hessian)

    def settle(
        self,
        *,
        gravity: Vector = (0.0, 0.0, 0.0),
        forces: NDArray[np.floating] | None = None,
        tolerance: float = 1e-9,
        dt: float = 1.0,
        steps: int = 200,
    ) -> bool:
        """Lets the cloth come to rest under gravity and forces [N], in large steps; held vertices stay.

        Returns whether it has: no coordinate moved more than ``tolerance`` [m] in the last step.
        """
        still = self.positions.copy()
        solver = ClothSolver(newton=100, tolerance=max(tolerance * 1e-2, 1e-14), linear_tolerance=1e-6)
        for _ in range(steps):
            before = self.positions.copy()
            self.velocities[:] = 0.0
            self.step(still, dt, gravity=gravity, forces=forces, solver=solver)
            if np.abs(self.positions - before).max() < tolerance:
                return True
        return False


def warp_directions(mesh: Mesh, warp: Vector | None = None) -> NDArray[np.float64]:
    """A direction of the warp for each triangle, shape (m, 3)."""
    count = len(mesh.triangles)
    if warp is not None or mesh.uv is None:
        return np.tile(np.array((1.0, 0.0, 0.0) if warp is None else warp), (count, 1))
    corners = mesh.points[mesh.triangles]
    e1, e2 = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    v1, v2 = mesh.uv[:, 1, 1] - mesh.uv[:, 0, 1], mesh.uv[:, 2, 1] - mesh.uv[:, 0, 1]
    u1, u2 = mesh.uv[:, 1, 0] - mesh.uv[:, 0, 0], mesh.uv[:, 2, 0] - mesh.uv[:, 0, 0]
    along_u = v2[:, None] * e1 - v1[:, None] * e2  # ∂x/∂u, up to the determinant, which may be negative
    return np.where((u1 * v2 - u2 * v1)[:, None] < 0, -along_u, along_u)


def _check(mesh: Mesh, held: NDArray[np.bool_]) -> None:
    """Refuses a mesh with triangles without area or with vertices without triangles."""
    corners = mesh.points[mesh.triangles]
    e1, e2 = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    longest = np.maximum((e1 * e1).sum(1), (e2 * e2).sum(1))
    flat = ~(np.linalg.norm(np.cross(e1, e2), axis=1) > 1e-12 * longest)
    if flat.any():
        raise UserError(
            f"{mesh.name}: triangle {flat.argmax()} has no area ({flat.sum()} of {len(flat)} have none); "
            "cloth needs triangles with an area: remove or repair them"
        )
    loose = ~held
    loose[mesh.triangles] = False
    if loose.any():
        raise UserError(
            f"{mesh.name}: vertex {loose.argmax()} belongs to no triangle "
            f"({loose.sum()} of {len(loose)} belong to none); remove or hold them"
        )
