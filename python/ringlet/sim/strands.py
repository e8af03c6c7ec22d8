"""Strands that move: the core's solver with named settings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.shot.material import Material
from ringlet.shot.solver import Continuation, Solver
from ringlet.shot.variation import VARIATIONS
from ringlet.sim.core import Vector, assign, step_settings

Planes = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]
Springs = tuple[NDArray[np.float64], NDArray[np.float64]]


@dataclass
class Strands:
    """Strands in motion, at the start at rest in their rest shape.

    curves:    the rest shape, positions [m]
    material:  their material
    held:      the vertices that follow ``targets``: a number of them from each root (three hold position and frame), or
               a mask of shape (n,) that contains the roots
    variation: factors on the material per vertex, shape (n,) each, by name: radius, stretch, bend, twist, damping,
               drag
    """

    curves: Curves
    material: Material
    held: int | NDArray[np.bool_] = 3
    variation: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if unknown := set(self.variation) - set(VARIATIONS):
            raise ValueError(f"strands: variation of {unknown.pop()}; there are: {', '.join(VARIATIONS)}")
        if isinstance(self.held, int):
            from_root = np.arange(len(self.curves.points)) - np.repeat(self.curves.offsets[:-1], self.curves.counts)
            self.held = from_root < self.held
        self.curves.check_strands("strands")
        self._core = _core.Strands(
            self.curves.offsets,
            np.ascontiguousarray(self.curves.points, np.float64),
            np.ascontiguousarray(self.held, np.uint8),
            assign(_core.StrandMaterial(), self.material),
            **{name: np.ascontiguousarray(self.variation.get(name, ()), np.float64) for name in VARIATIONS},
        )
        self._no_forces = np.zeros_like(self.curves.points, np.float64)

    @property
    def positions(self) -> NDArray[np.float64]:
        """Positions [m], shape (n, 3): the solver's own memory."""
        return self._core.positions

    @property
    def velocities(self) -> NDArray[np.float64]:
        """Velocities [m/s], shape (n, 3): the solver's own memory."""
        return self._core.velocities

    @property
    def directors(self) -> NDArray[np.float64]:
        """Directors of the material frame, one per edge from the second of each strand on, shape (n, 3): the solver's
        own memory. Only ``material_frame`` moves them with the strands."""
        return self._core.directors

    @property
    def masses(self) -> NDArray[np.float64]:
        """Mass of each vertex [kg], shape (n,)."""
        return self._core.masses

    @property
    def drag(self) -> NDArray[np.float64]:
        """Air drag of each vertex [kg/s], shape (n,)."""
        return self._core.drag

    @property
    def damping(self) -> NDArray[np.float64]:
        """Damping time of the strains at each vertex [s], shape (n,)."""
        return self.material.damping * np.broadcast_to(self.variation.get("damping", 1.0), len(self.positions))

    def loads(self, gravity: Vector, wind: Vector = (0.0, 0.0, 0.0)) -> NDArray[np.float64]:
        """The forces of gravity [m/s²] and wind [m/s] on strands that are still [N], shape (n, 3)."""
        return np.outer(self._core.masses, gravity) + np.outer(self._core.drag, wind)

    @property
    def stiffness(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Against stretch [N/m] and twist [N m] of the edge that begins at each vertex, against bend [N m] at it:
        stretch, bend, twist, shapes (n,)."""
        return self._core.stretch_stiffness, self._core.bend_stiffness, self._core.twist_stiffness

    def place(self, positions: NDArray[np.floating], directors: NDArray[np.floating] | None = None) -> None:
        """Puts the strands at rest at other positions [m], shape (n, 3), and keeps their rest shape.

        directors: of their material frames there, shape (n, 3); by default those of least energy are found
        """
        frames = None if directors is None else np.ascontiguousarray(directors, np.float64)
        self._core.place(np.ascontiguousarray(positions, np.float64), frames)

    @property
    def memory(self) -> dict[str, NDArray[Any]]:
        """The state that the next step depends on, as arrays by name."""
        return self._core.memory

    def recall(self, memory: Mapping[str, NDArray[Any]]) -> None:
        """Restores the state of strands that were made from the same."""
        self._core.recall(dict(memory))

    def step(
        self,
        targets: NDArray[np.floating],
        dt: float,
        *,
        gravity: Vector = (0.0, 0.0, 0.0),
        wind: Vector = (0.0, 0.0, 0.0),
        forces: NDArray[np.floating] | None = None,
        solver: Solver | None = None,
        planes: Planes | None = None,
        springs: Springs | None = None,
    ) -> dict[str, NDArray[np.float64]]:
        """Advances by ``dt`` [s]; held vertices end where ``targets`` [m], shape (n, 3), has them.

        forces: on each vertex besides gravity and air [N], shape (n, 3)
        planes: one in front of each vertex: unit normals, shape (n, 3), distances from the origin along them [m], and
                stiffnesses against what comes behind [N/m], shapes (n,). Only material frames have them
        springs: one from each vertex: targets [m], shape (n, 3), and stiffnesses [N/m], shape (n,)
        Returns the report of every strand, one array of shape (count,) per quantity (see ``_core.REPORT``).
        """
        solver = solver or Solver()
        rows = self._core.step(
            np.ascontiguousarray(targets, np.float64),
            self._no_forces if forces is None else np.ascontiguousarray(forces, np.float64),
            step_settings(solver, dt, gravity, wind),
            planes,
            springs,
        )
        return dict(zip(_core.REPORT, rows.T, strict=True))

    def energy(
        self, positions: NDArray[np.floating], *, continuation: str = "material_frame", hessian: bool = False
    ) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
        """Elastic energy [J], its gradient [N], shape (n, 3), and, for a single strand, the Hessian Newton uses."""
        points = np.ascontiguousarray(positions, np.float64)
        return self._core.energy(points, getattr(_core.Continuation, continuation), hessian)

    def stabilising_stiffness(self, left: NDArray[np.float64], most: float) -> NDArray[np.float64]:
        """The factors on bend and twist stiffness, at least 1, with which strands in equilibrium are stable.

        A strand is stable where the second derivative of its energy is positive in every direction.
        left: the fraction of its stiffness without load that it must keep in every direction, from 0 below 1, shape
              (count,)
        most: the largest factor; infinite where it does not suffice
        """
        return self._core.stabilising_stiffness(np.ascontiguousarray(left, np.float64), most)

    def settle(
        self,
        *,
        gravity: Vector = (0.0, 0.0, 0.0),
        wind: Vector = (0.0, 0.0, 0.0),
        forces: NDArray[np.floating] | None = None,
        tolerance: float = 1e-9,
        within: float | None = None,
        dt: float = 1.0,
        steps: int = 2000,
        continuation: Continuation = "material_frame",
    ) -> bool:
        """Lets the strands come to rest under gravity, wind and forces [N], in large steps; held vertices stay.

        within: tolerance of Newton's method within a step [m], by default a hundredth of ``tolerance``
        Returns whether they have: no coordinate moved more than ``tolerance`` [m] in the last step.
        """
        still = self.positions.copy()
        within = max(tolerance * 1e-2, 1e-14) if within is None else within
        solver = Solver(newton=50, tolerance=within, continuation=continuation)
        for _ in range(steps):
            before = self.positions.copy()
            self.velocities[:] = 0.0
            self.step(still, dt, gravity=gravity, wind=wind, forces=forces, solver=solver)
            if np.abs(self.positions - before).max() < tolerance:
                return True
        return False
