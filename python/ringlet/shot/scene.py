"""Scenes: strands and bodies that touch one another, solved together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from ringlet import _core
from ringlet.settings import Section
from ringlet.shot.strands import Solver, Strands, Vector


class Contact(Section):
    """How strands touch one another and bodies."""

    radius: float = Field(
        default=5e-4, gt=0, le=0.1, description="[m] half the distance at which two locks begin to push each other away"
    )
    friction: float = Field(default=0.3, ge=0, le=10, description="Coulomb's μ of lock on lock")
    stiffness: float = Field(default=1.0, gt=0, le=1e6, description="scales how hard contacts push")
    creep_speed: float = Field(
        default=1e-3, gt=0, le=1, description="[m/s] contacts that slide slower than this count as sticking"
    )


@dataclass
class Body:
    """A surface that moves as it is told, touched from both sides.

    points:    positions [m] to begin with, shape (n, 3)
    triangles: indices into points, shape (m, 3)
    thickness: [m] how far from the surface contact begins, besides what touches it
    friction:  Coulomb's μ of a lock on it
    """

    points: NDArray[np.floating]
    triangles: NDArray[np.integer]
    thickness: float = 5e-4
    friction: float = 0.3


@dataclass
class Scene:
    """Strands and bodies in contact, in one implicit step; nothing passes through anything.

    strands:   in motion; they go on being stepped here
    bodies:    the surfaces that they touch
    rooted_in: per strand the body that holds its root, which the held vertices may touch; -1: none. Shape (count,)
    """

    strands: Strands
    bodies: Sequence[Body] = ()
    contact: Contact = field(default_factory=Contact)
    rooted_in: NDArray[np.integer] | None = None

    def __post_init__(self) -> None:
        settings = _core.SceneContact()
        settings.strand_radius = self.contact.radius
        settings.stiffness = self.contact.stiffness
        settings.creep_speed = self.contact.creep_speed
        # Material 0: strands; body k: k + 1. Bodies do not touch each other.
        friction = np.zeros((len(self.bodies) + 1, len(self.bodies) + 1))
        friction[0, 0] = self.contact.friction
        for k, body in enumerate(self.bodies):
            friction[0, k + 1] = friction[k + 1, 0] = body.friction
        settings.friction = friction.ravel().tolist()
        models = [
            _core.BodyModel(
                np.ascontiguousarray(body.points, np.float64),
                np.ascontiguousarray(body.triangles, np.int32),
                body.thickness,
                k + 1,
            )
            for k, body in enumerate(self.bodies)
        ]
        rooted = [] if self.rooted_in is None else [int(body) for body in self.rooted_in]
        self._core = _core.Scene(self.strands._core, models, rooted, settings)

    @property
    def positions(self) -> NDArray[np.float64]:
        """Positions [m] of all vertices: those of the strands, then those of each body."""
        return self._core.positions

    @property
    def path(self) -> NDArray[np.float64]:
        """Positions [m] at the start and after each move of the last step, shape (k, n, 3); needs ``record()``.

        Nothing meets while every vertex goes straight from one to the next.
        """
        return self._core.path

    def record(self, on: bool = True) -> None:
        """Keeps the path of each step from now on."""
        self._core.record(on)

    def excuse(self, vertices: NDArray[np.integer], body: int) -> None:
        """Lets vertices of strands be inside a body until they have been pushed out of it, gently."""
        self._core.excuse(np.ascontiguousarray(vertices, np.int32), body)

    @property
    def excused(self) -> int:
        """How many vertices are still inside a body, excused."""
        return self._core.excused

    @property
    def contacts(self) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """The last step's contacts: their vertices (k, 4); weights, normal, distance [m] and force [N], (k, 9)."""
        return self._core.contacts

    def step(
        self,
        targets: NDArray[np.floating],
        dt: float,
        *,
        bodies: Sequence[NDArray[np.floating]] | None = None,
        gravity: Vector = (0.0, 0.0, 0.0),
        wind: Vector = (0.0, 0.0, 0.0),
        forces: NDArray[np.floating] | None = None,
        solver: Solver | None = None,
        system_tolerance: float = 0.05,
    ) -> tuple[dict[str, Any], dict[str, NDArray[np.float64]]]:
        """Advances by ``dt`` [s]; held vertices end where ``targets`` [m], shape (n, 3), has them.

        bodies: where each body's points end [m]; without it they stay
        Returns the scene's report and that of every strand (see ``Strands.step``).
        """
        solver = solver or Solver()
        count = len(self.strands.curves.points)
        ends = self.positions[count:] if bodies is None else np.concatenate([np.zeros((0, 3)), *bodies])
        totals, rows = self._core.step(
            np.ascontiguousarray(targets, np.float64),
            np.zeros((count, 3)) if forces is None else np.ascontiguousarray(forces, np.float64),
            np.ascontiguousarray(ends, np.float64),
            dt,
            gravity,
            wind,
            solver.iterations,
            solver.tolerance,
            getattr(_core.Continuation, solver.continuation),
            getattr(_core.Integrator, solver.integrator),
            solver.core_safeguards(),
            system_tolerance,
        )
        report = dict(zip(_core.SCENE_REPORT, totals.tolist(), strict=True))
        return report, dict(zip(_core.REPORT, rows.T, strict=True))
