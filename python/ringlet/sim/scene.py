"""Scenes: strands, cloth and bodies in contact, solved together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.cache import Touches
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.precision import compact
from ringlet.shot.contact import Contact
from ringlet.shot.material import Material
from ringlet.shot.solver import Solver
from ringlet.sim.cloth import Cloth
from ringlet.sim.core import Vector, assign, step_settings
from ringlet.sim.friction import friction_matrix
from ringlet.sim.obstacle import Body
from ringlet.sim.strands import Strands
from ringlet.sim.ties import Ties

OTHERWISE = {
    "radius",
    "own_radius",
    "friction",
    "on",
    "pair",
    "separation_speed",
}  # settings with other names in the core
_OF_CLOTH = ("positions", "velocities")  # the state of a cloth


@dataclass
class Scene:
    """Strands, cloths and bodies in contact, in one implicit step without intersections.

    strands:   in motion, stepped by the scene from now on; by default there are none
    bodies:    surfaces with prescribed motion
    rooted_in: per strand the body that holds its root, which the held vertices may touch; -1: none. Shape (count,)
    cloths:    in motion as well; contact begins half their thickness from them
    pinned_to: per cloth the body that carries its held vertices, which these may touch; -1: none. Shape (cloths,)
    friction:  Coulomb's μ of each pair of materials: strands, then each cloth, then each body; by default
               ``friction_matrix``
    radii:     half the distance at which two strands touch [m], at the vertices of strands and at least
               ``contact.radius``, which it is by default; shape (n,)
    ties:      between vertices of strands
    """

    strands: Strands = field(default_factory=lambda: Strands(Curves.from_list([]), Material()))
    bodies: Sequence[Body] = ()
    contact: Contact = field(default_factory=Contact)
    rooted_in: NDArray[np.integer] | None = None
    cloths: Sequence[Cloth] = ()
    pinned_to: NDArray[np.integer] | None = None
    friction: NDArray[np.floating] | None = None
    radii: NDArray[np.floating] | None = None
    ties: Ties | None = None

    def __post_init__(self) -> None:
        settings = assign(_core.SceneContact(), self.contact, without=OTHERWISE)
        settings.parting_speed = self.contact.separation_speed
        settings.strand_radius = self.contact.radius
        if self.radii is not None:
            settings.strand_radii = np.asarray(self.radii, np.float64).tolist()
        if self.ties is not None:
            settings.set_ties(self.ties.vertices, self.ties.lengths, self.ties.stiffness)
        friction = friction_matrix(self.contact, self.cloths, self.bodies) if self.friction is None else self.friction
        settings.friction = friction.ravel().tolist()
        pinned = [-1] * len(self.cloths) if self.pinned_to is None else [int(body) for body in self.pinned_to]
        cloths = [
            _core.SceneCloth(cloth._core, 1 + k, body)
            for k, (cloth, body) in enumerate(zip(self.cloths, pinned, strict=True))
        ]
        bodies = [
            _core.BodyModel(
                np.ascontiguousarray(body.points, np.float64),
                np.ascontiguousarray(body.triangles, np.int32),
                body.thickness,
                1 + len(cloths) + k,
            )
            for k, body in enumerate(self.bodies)
        ]
        rooted = [] if self.rooted_in is None else [int(body) for body in self.rooted_in]
        self._core = _core.Scene(self.strands._core, cloths, bodies, rooted, settings)
        self._cloth_rows = np.zeros((len(cloths), len(_core.CLOTH_REPORT)))

    @property
    def positions(self) -> NDArray[np.float64]:
        """Positions [m] of all vertices: those of the strands, then those of each cloth and of each body."""
        return self._core.positions

    @property
    def memory(self) -> dict[str, NDArray[Any]]:
        """The state that the next step depends on besides that of the strands, as arrays by name."""
        cloths = {
            f"cloth_{k}_{name}": getattr(cloth, name) for k, cloth in enumerate(self.cloths) for name in _OF_CLOTH
        }
        return {**self._core.memory, **{name: values.copy() for name, values in cloths.items()}}

    def recall(self, memory: Mapping[str, NDArray[Any]]) -> None:
        """Restores the state of a scene that was made from the same."""
        for k, cloth in enumerate(self.cloths):
            for name in _OF_CLOTH:
                getattr(cloth, name)[:] = memory[f"cloth_{k}_{name}"]
        self._core.recall({name: values for name, values in memory.items() if not name.startswith("cloth_")})

    def place(self) -> None:
        """Takes the positions of strands and cloths that were placed elsewhere since the last step."""
        self._core.place()

    @property
    def path(self) -> NDArray[np.float64]:
        """Positions [m] at the start and after each move of the last step, shape (k, n, 3); needs ``record()``.

        The first are those of the start after a rigid motion of everything, to the frame of the step's end. There is no
        intersection while every vertex moves straight from one to the next.
        """
        return self._core.path

    def record(self, on: bool = True) -> None:
        """Keeps the path of each step from now on."""
        self._core.record(on)

    def allow_penetration(self, vertices: NDArray[np.integer], body: int) -> None:
        """Exempts vertices of strands from contact with a body that they begin in, until they have come out of it."""
        self._core.allow_penetration(np.ascontiguousarray(vertices, np.int32), body)

    @property
    def penetrating(self) -> int:
        """The number of vertices with initial penetration that are still inside a body."""
        return self._core.penetrating

    @property
    def coincident(self) -> NDArray[np.int32]:
        """A vertex of both sides of pairs that coincided when the scene was made, shape (k, 2); they never touch."""
        return self._core.coincident

    @property
    def contacts(self) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """The last step's contacts: their vertices (k, 4); weights, normal, distance [m] and force [N], (k, 9)."""
        return self._core.contacts

    def touching(self) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """Contacts at the present positions, without a step: vertices (k, 4); weights, normal, distance [m], (k, 8).

        All pairs nearer than their distance of contact, also initial overlaps. No step depends on it.
        """
        vertices, values = self._core.touching()
        return vertices, values[:, :8]

    def set_initial_forces(self, vertices: NDArray[np.integer], forces: NDArray[np.floating]) -> None:
        """Sets the contact forces of pairs at the start, before the first step, which then begins with them.

        vertices: of pairs, as ``touching`` has them, shape (k, 4)
        forces:   on the first of the two [N], shape (k, 3): away from the second; across, towards the last vertex from
                  the one before, as far as that goes; across both
        """
        self._core.set_initial_forces(
            np.ascontiguousarray(vertices, np.int32), np.ascontiguousarray(forces, np.float64)
        )

    @property
    def touches(self) -> Touches:
        """The positions, gaps and normal forces of the last step's contacts."""
        vertices, values = self.contacts
        at, weights = self.positions[vertices], values[:, :4]
        one, other = (np.einsum("kv,kvi->ki", np.maximum(sign * weights, 0.0), at) for sign in (1.0, -1.0))
        gap = np.linalg.norm(one - other, axis=1) / values[:, 7]
        force, gap = np.asarray(values[:, 8], np.float32), np.asarray(gap, np.float32)
        return Touches(compact(0.5 * (one + other)), force, gap)

    @property
    def cloth_reports(self) -> list[dict[str, float]]:
        """The report of each cloth for the last step (see ``Cloth.step``)."""
        return [dict(zip(_core.CLOTH_REPORT, row.tolist(), strict=True)) for row in self._cloth_rows]

    def step(
        self,
        targets: NDArray[np.floating] | None,
        dt: float,
        *,
        cloths: Sequence[NDArray[np.floating]] | None = None,
        bodies: Sequence[NDArray[np.floating]] | None = None,
        gravity: Vector = (0.0, 0.0, 0.0),
        wind: Vector = (0.0, 0.0, 0.0),
        forces: NDArray[np.floating] | None = None,
        cloth_forces: Sequence[NDArray[np.floating]] | None = None,
        solver: Solver | None = None,
    ) -> tuple[dict[str, Any], dict[str, NDArray[np.float64]]]:
        """Advances by ``dt`` [s]; held vertices end where ``targets`` [m], shape (n, 3), has them.

        targets: of the vertices of strands; None: they stay
        cloths:  where each cloth's held and attached vertices end [m], shape (n, 3) each; without it they stay
        bodies:  where each body's points end [m]; without it they stay
        forces:  on each vertex of strands besides gravity and air [N], shape (n, 3)
        cloth_forces: likewise at those of each cloth
        Returns the scene's report and that of every strand (see ``Strands.step``).
        """
        solver = solver or Solver()
        now, strands = self.positions, len(self.strands.curves.points)
        moving = strands + sum(len(cloth.positions) for cloth in self.cloths)
        try:
            totals, rows, self._cloth_rows = self._core.step(
                _rows(None if targets is None else [targets], self.strands.positions),
                _rows(None if forces is None else [forces], np.zeros((strands, 3))),
                _rows([cloth.positions for cloth in self.cloths] if cloths is None else cloths, np.zeros((0, 3))),
                _rows(cloth_forces, np.zeros((moving - strands, 3))),
                _rows(bodies, now[moving:]),
                step_settings(solver, dt, gravity, wind),
            )
        except _core.FactorisationError as error:
            raise UserError(
                "solver.system is 'direct', but the matrix of a step has no factor in double precision; take "
                "'conjugate_gradient'"
            ) from error
        report = dict(zip(_core.SCENE_REPORT, totals.tolist(), strict=True))
        return report, dict(zip(_core.REPORT, rows.T, strict=True))


def _rows(arrays: Sequence[NDArray[np.floating]] | None, otherwise: NDArray[np.float64]) -> NDArray[np.float64]:
    """The rows of all arrays; without arrays those of ``otherwise``."""
    rows = otherwise if arrays is None else np.concatenate([np.zeros((0, 3)), *arrays])
    return np.ascontiguousarray(rows, np.float64)
