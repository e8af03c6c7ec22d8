"""Strands that move: the core's solver with named settings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationInfo, field_validator

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.settings import Section, refuse

Vector = tuple[float, float, float]
Continuation = Literal["material_frame", "least_energy", "history"]


class Material(Section):
    """What a lock is made of: a hair's values, since hairs that do not stick together move like one of them."""

    youngs_modulus: float = Field(default=4e9, gt=0, le=1e13, description="E [Pa]; hair: 2e9 to 6e9")
    radius: float = Field(default=35e-6, gt=1e-7, le=0.1, description="r of one hair [m]")
    density: float = Field(default=1300.0, gt=0, le=1e5, description="[kg/m³]")
    stretch_scale: float = Field(
        default=0.01, gt=0, le=100, description="scales the resistance to stretch, E π r²; hair is hard to stretch"
    )
    bend_scale: float = Field(default=1.0, ge=0, le=1e6, description="scales the resistance to bend, E π r⁴ / 4")
    limit_twist: bool = Field(
        default=True, description="twist never exceeds bend; off only to study what this safeguard is for"
    )
    twist_ratio: float = Field(
        default=0.72,
        ge=0,
        le=100,
        description="twist stiffness as a part of bend stiffness, at most 1: the spring constant of a coil",
    )
    damping: float = Field(
        default=0.005,
        ge=0,
        le=100,
        description="[s] every strain resists its own rate with this time times its stiffness",
    )
    mass_damping: float = Field(default=0.0, ge=0, le=1e4, description="[1/s] rate at which velocities decay")
    drag: float = Field(default=2e-5, ge=0, le=100, description="air drag per length and speed [kg/(m s)]")
    correct_resolution: bool = Field(
        default=True, description="make coils of few vertices a turn as soft as smooth ones"
    )

    @field_validator("twist_ratio")
    @classmethod
    def _within_bend(cls, ratio: float, info: ValidationInfo) -> float:
        if ratio > 1 and info.data.get("limit_twist"):
            raise refuse(f"is {ratio}; must be at most 1 (or limit_twist = false, to study what the limit is for)")
        return ratio

    def core(self) -> _core.StrandMaterial:
        """The same, for the core."""
        material = _core.StrandMaterial()
        for name, value in self:
            setattr(material, name, value)
        return material


Safeguard = Literal["flip_history", "winding_number", "straight_fade"]
SAFEGUARDS: tuple[Safeguard, ...] = get_args(Safeguard)
MOST_ITERATIONS = 1000


class Solver(Section):
    """How a time step is solved."""

    newton: int = Field(
        default=5,
        ge=1,
        le=MOST_ITERATIONS,
        description="Newton iterations per step; 1 is stable, but with few hair comes late: "
        "5 for a look, 20 for the last run",
    )
    extra: int = Field(
        default=60,
        ge=0,
        le=MOST_ITERATIONS,
        description="iterations more, at most, for locks held back and stretched by over 3 %; fewer bound "
        "what a step costs, and leave them stretched",
    )
    until_converged: bool = Field(
        default=False,
        description=f"go on until every lock has converged, at most {MOST_ITERATIONS} iterations, whatever newton is",
    )
    substeps: int = Field(default=1, ge=1, le=1000, description="steps per frame")
    tolerance: float = Field(
        default=1e-6, gt=0, le=1e-2, description="[m] a lock has converged when no vertex moves more than this"
    )
    system: Literal["automatic", "banded", "conjugate_gradient", "direct"] = Field(
        default="automatic",
        description="how the linear system of locks that touch is solved: each alone (an error where something couples "
        "them), together by conjugate gradients, or by factoring the whole; automatic: alone or together, as needed",
    )
    linear_tolerance: float = Field(
        default=0.1,
        gt=0,
        le=0.5,
        description="what conjugate gradients leave of the linear system, as a part of what there was; the less, the "
        "more hair moves that lies in hair: 0.02 for the last run",
    )
    integrator: Literal["backward_euler", "bdf2"] = Field(
        default="backward_euler",
        description="first order and calm, or second order (BDF-2), which keeps a swing going for longer",
    )
    continuation: Continuation = Field(
        default="material_frame",
        description="how the signs of bends and the turns of twist are found: see the theory page",
    )
    safeguards: tuple[Safeguard, ...] = Field(
        default=SAFEGUARDS, description="those of `history` that are on; fewer only to study what each is for"
    )

    @field_validator("safeguards")
    @classmethod
    def _of_history(cls, safeguards: tuple[Safeguard, ...], info: ValidationInfo) -> tuple[Safeguard, ...]:
        continuation = info.data.get("continuation")
        if continuation != "history" and set(safeguards) != set(SAFEGUARDS):
            raise refuse(f"is {list(safeguards)}; continuation is '{continuation}', only 'history' can be without one")
        return safeguards

    @property
    def iterations(self) -> int:
        """Newton iterations per step, at most."""
        return MOST_ITERATIONS if self.until_converged else self.newton

    def for_core(self) -> tuple[int, float, _core.Continuation, _core.Integrator, _core.Safeguards]:
        """Iterations, tolerance, model, integrator and safeguards, as a step of the core takes them."""
        safeguards = _core.Safeguards()
        for name in SAFEGUARDS:
            setattr(safeguards, name, name in self.safeguards)
        continuation = getattr(_core.Continuation, self.continuation)
        return self.iterations, self.tolerance, continuation, getattr(_core.Integrator, self.integrator), safeguards


VARIATIONS = ("radius", "stretch", "bend", "twist", "damping")


@dataclass
class Strands:
    """Strands in motion, at rest in their rest shape to begin with.

    curves:    the rest shape, positions [m]
    material:  what they are made of
    held:      which vertices follow ``targets``: a number of them from each root (three hold position and frame), or a
               mask of shape (n,) that contains the roots
    variation: factors on the material per vertex, shape (n,) each, by name: radius, stretch, bend, twist, damping
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
        self._core = _core.Strands(
            self.curves.offsets,
            np.ascontiguousarray(self.curves.points, np.float64),
            np.ascontiguousarray(self.held, np.uint8),
            self.material.core(),
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

    def loads(self, gravity: Vector, wind: Vector = (0.0, 0.0, 0.0)) -> NDArray[np.float64]:
        """What gravity [m/s²] and wind [m/s] do to strands that are still [N], shape (n, 3)."""
        return np.outer(self._core.masses, gravity) + np.outer(self._core.drag, wind)

    @property
    def stiffness(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Against stretch [N/m] and twist [N m] of the edge that begins at each vertex, against bend [N m] at it:
        stretch, bend, twist, shapes (n,)."""
        return self._core.stretch_stiffness, self._core.bend_stiffness, self._core.twist_stiffness

    def place(self, positions: NDArray[np.floating]) -> None:
        """Puts the strands at rest at other positions [m], shape (n, 3); the rest shape stays what it was."""
        self._core.place(np.ascontiguousarray(positions, np.float64))

    @property
    def memory(self) -> dict[str, NDArray[Any]]:
        """All that the next step depends on besides what the strands were made from, as arrays by name."""
        return self._core.memory

    def recall(self, memory: Mapping[str, NDArray[Any]]) -> None:
        """Goes back to a memory of strands that were made from the same."""
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
    ) -> dict[str, NDArray[np.float64]]:
        """Advances by ``dt`` [s]; held vertices end where ``targets`` [m], shape (n, 3), has them.

        forces: what pulls at each vertex besides gravity and air [N], shape (n, 3)
        Returns the report of every strand, one array of shape (count,) per quantity (see ``_core.REPORT``).
        """
        solver = solver or Solver()
        rows = self._core.step(
            np.ascontiguousarray(targets, np.float64),
            self._no_forces if forces is None else np.ascontiguousarray(forces, np.float64),
            dt,
            gravity,
            wind,
            *solver.for_core(),
        )
        return dict(zip(_core.REPORT, rows.T, strict=True))

    def energy(
        self, positions: NDArray[np.floating], *, continuation: str = "material_frame", hessian: bool = False
    ) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
        """Elastic energy [J], its gradient [N], shape (n, 3), and, for a single strand, the Hessian Newton uses."""
        points = np.ascontiguousarray(positions, np.float64)
        return self._core.energy(points, getattr(_core.Continuation, continuation), hessian)

    def stiffness_to_stand(self, left: NDArray[np.float64], most: float) -> NDArray[np.float64]:
        """How many times stiffer against bend and twist each strand must be, at least 1, to stand where it is still.

        It stands where all of its energy's second derivative is positive, whatever it is nudged by.
        left: the part of its resistance to bend and twist without load that it must keep, in every direction; from 0
              below 1, shape (count,)
        most: infinite where so much does not suffice
        """
        return self._core.stiffness_to_stand(np.ascontiguousarray(left, np.float64), most)

    def settle(
        self,
        *,
        gravity: Vector = (0.0, 0.0, 0.0),
        wind: Vector = (0.0, 0.0, 0.0),
        forces: NDArray[np.floating] | None = None,
        tolerance: float = 1e-9,
        dt: float = 1.0,
        steps: int = 2000,
        continuation: Continuation = "material_frame",
    ) -> bool:
        """Lets the strands come to rest under gravity, wind and forces [N], in large steps; what is held stays put.

        Returns whether they have: no coordinate moved more than ``tolerance`` [m] in the last step.
        """
        still = self.positions.copy()
        solver = Solver(newton=50, tolerance=max(tolerance * 1e-2, 1e-14), continuation=continuation)
        for _ in range(steps):
            before = self.positions.copy()
            self.velocities[:] = 0.0
            self.step(still, dt, gravity=gravity, wind=wind, forces=forces, solver=solver)
            if np.abs(self.positions - before).max() < tolerance:
                return True
        return False
