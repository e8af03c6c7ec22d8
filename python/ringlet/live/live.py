"""Live hair: a groom that moves with its head step by step, in a small part of the time of a shot.

Each lock is a rod of few vertices that is as stiff as its coil, and carries it. Contact is not simulated: neighbours
share their velocities, and their coils are stiffer by what contact adds. docs/live.md says what is true of it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ringlet import _core
from ringlet.data.errors import UserError
from ringlet.data.groom import SECTION, STRAND_RADIUS, Groom
from ringlet.data.mesh import Mesh
from ringlet.data.rigid import moved, rotation_vector
from ringlet.live.bodies import Bodies, Palm, Poses
from ringlet.live.hanging import HangingRods
from ringlet.live.neck import neck
from ringlet.live.rods import HELD, VERTICES, Rods, Wire, places, vertex_places
from ringlet.live.touch import PRESSED, Hand, Touch, TouchedRods
from ringlet.shot.material import Material
from ringlet.shot.solver import Solver
from ringlet.sim.core import Vector
from ringlet.sim.cores import Cores
from ringlet.sim.shot_strands import WANTED
from ringlet.sim.strands import Springs, Strands
from ringlet.sim.worn import worn_factors

Array = NDArray[np.float64]

GRAVITY = (0.0, -9.81, 0.0)  # [m/s²]
# Stiffness of the crowd about a lock, force by its length and displacement, by style [N/m²]
CONTACT = {"curls": 2.1e-4, "locs": 5e-4, "braids and twists": 2.4e-3}
SOLVER = Solver(newton=2, tolerance=1e-5, integrator="backward_euler")

CELL, MARGIN = 0.02, 0.1  # of the grid through which neighbours share motion, and how far it goes beyond the hair [m]
SHARE, KEEP = 0.7, 0.9  # see src/ringlet/live/shared_velocities.h

ACROSS = 1.0, 0.3, 0.2  # some direction across the roots of rods

FARTHEST, FASTEST = 0.3, np.pi / 3.0  # of the head in a step [m], [rad]: beyond, hair is carried along rigidly
NOT_RIGID = 1e-3  # deviation of a rotation from one


class Live:
    """The locks of a groom in motion, as rods, on a head that moves rigidly.

    groom:    its locks hang still as they are groomed, under the gravity that is given here
    material: of the locks, as ``[strands]`` of a shot has it
    bodies:   closed meshes that move with the head, and that hair stays out of; by default the scalp. What is below
              the neck goes with the trunk
    clothes:  meshes that go with the trunk as a whole, such as a shirt
    gravity:  [m/s²]
    wind:     velocity of the air [m/s]
    fps:      steps a second
    contact:  how firmly neighbours hold each lock: force by its length and displacement [N/m²]; by default as its
              style does, see ``default_contact``, and ``calibrate`` for another

    All may be changed between steps, but for the rate. Raises UserError for values that are not finite.

    Example::

        live = ringlet.Live(ringlet.build_groom("curls.recipe.toml"))
        for turn in turns:
            live.head = turn  # a 4 × 4 matrix
            live.step()
            draw(live.positions)
    """

    def __init__(
        self,
        groom: Groom,
        material: Material | None = None,
        *,
        bodies: Sequence[Mesh] | None = None,
        clothes: Sequence[Mesh] = (),
        gravity: Sequence[float] = GRAVITY,
        wind: Sequence[float] = (0.0, 0.0, 0.0),
        fps: float = 24.0,
        contact: float | None = None,
    ) -> None:
        if not fps > 0.0:
            raise UserError(f"live: fps is {fps}; must be positive")
        self.dt = 1.0 / fps
        self._material, self._contact = (
            material or Material(),
            default_contact(groom)[0] if contact is None else contact,
        )
        self._groomed_gravity = self._gravity = _vector(gravity, "gravity")
        self._wind = _vector(wind, "wind")
        self._head = self._pose = np.eye(4)
        self._trunk: Array | None = None
        self._bodies = Bodies((groom.scalp,) if bodies is None else bodies, clothes)
        self._hand = Hand()
        self._set_groom(groom)
        self.reset()

    @property
    def head(self) -> Array:
        """The rigid transform of the head from where it was groomed, at the end of the next step: shape (4, 4), acting
        on columns [m].

        One that is not finite or not rigid raises UserError, and the head stays where it was.
        """
        return self._head.copy()

    @head.setter
    def head(self, transform: ArrayLike) -> None:
        self._head = _rigid(transform)

    @property
    def trunk(self) -> Array | None:
        """The rigid transform of what is below the neck, as ``head``; None, the default: it goes with the head."""
        return None if self._trunk is None else self._trunk.copy()

    @trunk.setter
    def trunk(self, transform: ArrayLike | None) -> None:
        self._trunk = None if transform is None else _rigid(transform)

    @property
    def clothes(self) -> tuple[Mesh, ...]:
        """The meshes that go with the trunk as a whole."""
        return self._bodies.clothes

    @property
    def gravity(self) -> Vector:
        """Gravity [m/s²]. Under the one that this was made with, hair hangs as it is groomed."""
        return self._gravity

    @gravity.setter
    def gravity(self, gravity: Sequence[float]) -> None:
        self._gravity = _vector(gravity, "gravity")

    @property
    def wind(self) -> Vector:
        """Velocity of the air [m/s]."""
        return self._wind

    @wind.setter
    def wind(self, wind: Sequence[float]) -> None:
        self._wind = _vector(wind, "wind")

    @property
    def touch(self) -> Touch | None:
        """What a hand does to the hair in the next step; None: it lets go."""
        return self._hand.touch

    @touch.setter
    def touch(self, touch: Touch | None) -> None:
        self._hand.take(touch)

    @property
    def contact(self) -> float:
        """How firmly neighbours hold each lock, as an elastic foundation: force by length and displacement [N/m²]."""
        return self._contact

    @contact.setter
    def contact(self, contact: float) -> None:
        if not (np.isfinite(contact) and contact >= 0.0):
            raise UserError(f"live: contact is {contact}; must be at least 0")
        self._contact = float(contact)
        self._hanging = HangingRods(self._rods, self._wire(), self._groomed_gravity)  # it carries more or less itself
        self._set_strands()

    @property
    def material(self) -> Material:
        """The material of the locks. Another one acts from the next step on; the hair goes on from where it is."""
        return self._material

    @material.setter
    def material(self, material: Material) -> None:
        self._material = material
        self._set_strands()

    @property
    def groom(self) -> Groom:
        """The groom. From another one, rods go on from where they are towards their new shape, with the new coils.

        Locks that are not in both, by their ids, begin as groomed.
        """
        return self._cores.whole

    @groom.setter
    def groom(self, groom: Groom) -> None:
        before, strands = self._hanging, self._strands
        self._set_groom(groom)
        self._go_on(before, strands)

    @property
    def rods(self) -> Array:
        """Where the vertices of the rods are, of the locks that are simulated [m], shape (rods, vertices, 3)."""
        return self._strands.positions.reshape(-1, VERTICES, 3).copy()

    @property
    def groomed_rods(self) -> Array:
        """Where the vertices of the rods are as groomed [m], shape (rods, vertices, 3)."""
        return self._rods.points.reshape(-1, VERTICES, 3).copy()

    @property
    def carriers(self) -> NDArray[np.int64]:
        """The rod that carries each lock, shape (locks,)."""
        return self._cores.simulated.copy()

    @property
    def vertex_places(self) -> Array:
        """Where on a lock the vertices of its rod are, from 0 at the root to 1, shape (vertices,)."""
        return vertex_places()

    @property
    def axes(self) -> Array:
        """A direction across the root of each rod as groomed, where its frames begin, shape (rods, 3)."""
        return np.tile(ACROSS, (len(self._rods.curves), 1))

    @property
    def rise(self) -> Array:
        """The length of each rod by that of its lock, as groomed, shape (rods,)."""
        return self._rods.rise

    @property
    def motions(self) -> Array:
        """The motions [A t] of the vertices of rods since they were groomed, shape (rods, vertices, 3, 4).

        A is a rotation where a rod is as long as groomed. A coil that is drawn out gets narrower, its wire as long.

        A point of a lock is at ``(1 - w) M_a(x) + w M_b(x)``, with the motions M of the vertices before and behind it,
        the weight w of ``places`` and its place x in the groom.
        """
        return self._carried.motions(self._strands.positions, self._pose).reshape(-1, VERTICES, 3, 4)

    @property
    def places(self) -> tuple[NDArray[np.int32], Array]:
        """Of each point of all locks the vertex of a rod before it, as a row of all vertices, and the weight of the one
        behind; shapes (n,)."""
        return self._vertex, self._weight

    @property
    def positions(self) -> Array:
        """The points of all locks [m], shape (n, 3)."""
        return self._carried.at(self._strands.positions, self._pose)

    def step(self) -> str:
        """Advances by 1 / fps [s], in which the head goes to ``head``.

        Returns a sentence about what was cut off, empty where nothing was. A head that is thrown farther than 0.3 m or
        60° carries its hair along rigidly. A hand that is thrown as far lets go, until ``touch`` is None. Locks that
        are lost begin again as groomed.
        """
        note = self._catch_up()
        touch, cut_off = self._hand.begin()
        note = note or cut_off
        poses = Poses(self._pose, self._head, self._trunk_pose, self._trunk_end)
        before, held = self._strands.positions.copy(), moved(self._rods.points, poses.head_end)
        inertia = np.where(self._held == 0, self._strands.masses / self.dt**2, 0.0)
        planes = self._bodies.planes(before, inertia, poses, self._palm(touch, poses))
        springs = self._hand.springs(touch, self._touched(held, inertia)) if touch else None
        report = self._strands.step(
            held,
            self.dt,
            gravity=self._gravity,
            wind=self._wind,
            forces=self._support @ poses.head_end[:3, :3].T,
            solver=SOLVER,
            planes=planes,
            springs=_either(springs, self._bodies.friction(before, poses)),
        )
        self._hand.end()
        positions, velocities = self._strands.positions, self._strands.velocities
        if planes is not None:
            self._bodies.rub(planes, before, positions, poses)
        head = poses.head, poses.head_end
        self._grid.share(positions, self._strands.masses, self._held, *head, self.dt, SHARE, KEEP, velocities)
        self._pose, self._trunk_pose = poses.head_end, poses.trunk_end
        lost = report["nan"] > 0.0
        if lost.any():
            self._begin_again(lost)
            note = note or f"{lost.sum()} of {lost.size} locks were lost and begin again as groomed"
        return note

    def _touched(self, held: Array, inertia: Array) -> TouchedRods:
        """The rods that a hand may touch in a step after which what is held is there."""
        edges = np.linalg.norm(np.diff(self.groomed_rods, axis=1, prepend=self.groomed_rods[:, :1]), axis=2)
        return TouchedRods(
            self._rods.curves.ids,
            self.rods,
            held[::VERTICES],
            edges.cumsum(axis=1) / self._rods.rise[:, None],
            inertia.reshape(-1, VERTICES),
        )

    def _palm(self, touch: Touch | None, poses: Poses) -> Palm | None:
        """The palm of a hand that pats, kept outside the head."""
        if touch is None or touch.does != "pat":
            return None
        start = self._bodies.outside(self._hand.start, touch.radius, poses.head)
        return Palm(
            start, self._bodies.outside(np.array(touch.at), touch.radius, poses.head_end), touch.radius, PRESSED
        )

    def reset(self) -> None:
        """Puts the hair at rest as it is groomed, on the head where that is."""
        self._pose, self._trunk_pose = self._head, self._trunk_end
        self._strands.place(*self._at_rest())
        self._bodies.let_go()

    @property
    def _trunk_end(self) -> Array:
        """Where the trunk is at the end of the next step."""
        return self._head if self._trunk is None else self._trunk

    def _set_groom(self, groom: Groom) -> None:
        """Takes over a groom; its hair is to be placed then."""
        groom.locks.check("live: locks").check_strands("live: locks")
        self._cores = Cores.of(groom)
        self._rods = Rods.of(self._cores.groom.locks)
        rods, whole = self._rods.points, groom.locks
        counts = whole.counts
        self._vertex = (VERTICES * np.repeat(self._cores.simulated, counts)).astype(np.int32)
        self._weight = np.zeros(len(whole.points))
        for count in np.unique(counts):
            rows = whole.point_rows(alike := counts == count)
            vertex, weight = places(int(count))
            self._vertex[rows] += np.tile(vertex, alike.sum())
            self._weight[rows] = np.tile(weight, alike.sum())
        self._carried = _core.CarriedLocks(
            np.array(whole.points, np.float64),
            self._vertex,
            self._weight,
            rods,
            self._rods.curves.offsets,
            self.axes,
            self.rise,
        )
        self._grid = _core.VelocityGrid(rods.min(axis=0) - MARGIN, rods.max(axis=0) + MARGIN, CELL)
        self._crowding = self._rods.crowding()
        self._bodies.fit(rods, np.repeat(self._rods.radius, VERTICES), MARGIN, neck(groom)[1])
        wire = self._wire()
        self._hanging = HangingRods(self._rods, wire, self._groomed_gravity)
        self._strands, self._support = self._hanging.strands(wire, self._groomed_gravity)
        self._held = np.ascontiguousarray(self._strands.held, np.uint8)

    def _wire(self) -> Wire:
        """What the locks that are simulated are made of."""
        locks = self._cores.groom.locks
        factors: dict[str, Array] = dict(self._cores.material())

        def multiply(name: str, factor: Array) -> None:
            factors[name] = factors.get(name, 1.0) * factor

        radius = factors.get("radius", np.ones(len(locks.points)))
        for name, factor in worn_factors(locks, self._material, radius).items():
            multiply(name, factor)
        for name, wanted in WANTED.items():
            if wanted in locks.curve:
                multiply(name, np.repeat(locks.curve[wanted], locks.counts))
        # A beam of length H on a foundation k is held as by the bend stiffness k H⁴.
        added = self._contact * self._crowding * self._rods.lengths**4 / self._rods.rise
        return Wire.of(locks, self._material, factors, added)

    def _set_strands(self) -> None:
        """Makes the rods of the present material; the hair goes on from where it is."""
        memory = self._strands.memory
        self._strands, self._support = self._hanging.strands(self._wire(), self._groomed_gravity)
        self._strands.recall(memory)

    def _at_rest(self) -> tuple[Array, Array]:
        """Positions [m] and directors of rods that are at rest as groomed, where the head is."""
        return moved(self._rods.points, self._pose), self._hanging.frames @ self._pose[:3, :3].T

    def _go_on(self, before: HangingRods, strands: Strands) -> None:
        """Puts the rods of locks that were there before where they were; held vertices are with the new groom.

        Directors have turned since they were groomed as the frames of their edges had before.
        """
        _, old, new = np.intersect1d(before.rods.curves.ids, self._rods.curves.ids, return_indices=True)
        positions, directors = self._at_rest()
        _of_rods(positions)[new, HELD:] = _of_rods(strands.positions)[old, HELD:]
        groomed = _edge_frames(before.rods.points, before.frames, old)
        turns = _edge_frames(strands.positions, strands.directors, old) @ groomed.transpose(0, 1, 3, 2)
        edges = new, slice(HELD - 1, -1)
        _of_rods(directors)[edges] = (turns @ _of_rods(self._hanging.frames)[edges][..., None])[..., 0]
        _of_rods(directors)[edges] = _edge_frames(positions, directors, new)[..., 1]
        self._strands.place(positions, directors)
        _of_rods(self._strands.velocities)[new] = _of_rods(strands.velocities)[old]

    def _catch_up(self) -> str:
        """Carries hair rigidly along with a head that is thrown; returns a sentence about that."""
        move = self._head @ np.linalg.inv(self._pose)
        centre = moved(self._rods.points.mean(axis=0, keepdims=True), self._pose)
        distance = float(np.linalg.norm(moved(centre, move) - centre))
        angle = float(np.linalg.norm(rotation_vector(move[:3, :3])))
        if distance <= FARTHEST and angle <= FASTEST:
            return ""
        memory = self._strands.memory
        memory["positions"] = moved(memory["positions"], move)
        for name in ("velocities", "directors", "normals"):
            memory[name] = memory[name] @ move[:3, :3].T
        memory["velocities"][:] = 0.0
        self._strands.recall({name: np.ascontiguousarray(values) for name, values in memory.items()})
        self._pose, self._trunk_pose = self._head, self._trunk_end
        self._bodies.let_go()
        return (
            f"the head was thrown {distance:.2g} m and {np.degrees(angle):.0f}° in a step of {self.dt:.3g} s; its hair "
            "was carried along"
        )

    def _begin_again(self, lost: NDArray[np.bool_]) -> None:
        """Puts some rods at rest as they are groomed."""
        memory, chosen = self._strands.memory, np.repeat(lost, VERTICES)
        self._strands.place(*self._at_rest())
        for name, groomed in self._strands.memory.items():
            of_rods = chosen if len(groomed) == len(chosen) else lost
            memory[name][of_rods] = groomed[of_rods]
        self._strands.recall(memory)


def default_contact(groom: Groom) -> tuple[float, str]:
    """How firmly neighbours hold a lock by default [N/m²], and the style of the groom that says so."""
    curve, style = groom.locks.curve, "curls"
    if STRAND_RADIUS in curve:
        sections = np.unique(curve.get(SECTION, groom.locks.ids))
        style = "locs" if len(sections) == len(groom.locks) else "braids and twists"
    return CONTACT[style], style


def _either(first: Springs | None, second: Springs) -> Springs | None:
    """Springs of vertices, the second where the first has none; None where there are none at all."""
    if first is None:
        return second if second[1].any() else None
    other = first[1] == 0.0
    return np.where(other[:, None], second[0], first[0]), np.where(other, second[1], first[1])


def _of_rods(values: Array) -> Array:
    """Values at all vertices, (n, 3), as those of each rod: shape (rods, vertices, 3)."""
    return values.reshape(-1, VERTICES, 3)


def _edge_frames(points: Array, directors: Array, rods: NDArray[np.integer]) -> Array:
    """The tangent, the director and the axis across both of the free edges of some rods, shape (rods, edges, 3, 3)."""
    tangents = np.diff(_of_rods(points)[rods, HELD - 1 :], axis=1)
    tangents /= np.linalg.norm(tangents, axis=2, keepdims=True)
    across = _of_rods(directors)[rods, HELD - 1 : -1]
    across = across - (across * tangents).sum(axis=2, keepdims=True) * tangents
    across /= np.linalg.norm(across, axis=2, keepdims=True)
    return np.stack([tangents, across, np.cross(tangents, across)], axis=-1)


def _vector(values: Sequence[float], name: str) -> Vector:
    """Three finite numbers."""
    vector = np.asarray(values, np.float64)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise UserError(f"live: {name} is {values}; must be three finite numbers")
    return tuple(vector.tolist())


def _rigid(transform: ArrayLike) -> Array:
    """A rigid transform, its rotation made exact."""
    matrix = np.array(transform, np.float64)
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
        raise UserError("live: head is not a 4 × 4 matrix of finite numbers; the head stays where it is")
    left, stretch, right = np.linalg.svd(matrix[:3, :3])
    turn = left @ right
    if np.abs(stretch - 1.0).max() > NOT_RIGID or np.linalg.det(turn) < 0.0 or not np.allclose(matrix[3], (0, 0, 0, 1)):
        raise UserError(
            f"live: head stretches by {np.abs(stretch - 1.0).max():.2g} or mirrors; must be rigid and act on columns, "
            "the head stays where it is"
        )
    matrix[:3, :3] = turn
    return matrix
