"""Locks and cloth in motion: their state, and how one frame's time advances it."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.bounds import check_curves, check_positions
from ringlet.data.cache import CachedCloth
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip
from ringlet.data.precision import compact
from ringlet.shot.shot import Shot
from ringlet.sim.cores import Cores
from ringlet.sim.garment import Garment, SimulatedGarment, moved_with
from ringlet.sim.hair_pins import spring_forces
from ringlet.sim.lag import ROOTS, lagging
from ringlet.sim.obstacle import Obstacle
from ringlet.sim.resting_contacts import initial_contact_forces
from ringlet.sim.roots import Roots
from ringlet.sim.scene import Scene
from ringlet.sim.shot_strands import make_strands, with_words
from ringlet.sim.start import scene_at_start
from ringlet.sim.statistics import StepReports, frame_statistics
from ringlet.sim.written import Written

UNSTABLE = "raise solver.substeps, or lower the forces and the speed of the head"


class Motion:
    """Locks on their moving scalp, in contact where the shot has it; see ``simulate`` for what it is made of.

    first:    the frame at which everything starts
    cores:    the braids that are simulated as one rod each; ``locks`` are those that are simulated
    scene:    all that is in contact; None without contact
    start:    the report of initial penetration (see ``initial_penetration.py``)
    garments: the cloths that move with the locks
    """

    def __init__(
        self,
        shot: Shot,
        groom: Groom,
        clip: Clip,
        rest: Curves | None,
        obstacles: Sequence[Obstacle],
        garments: Sequence[Garment],
        first: int,
    ) -> None:
        check_locks(shot, groom.locks)
        self.cores, rest_of_all = Cores.of(groom), rest
        groom, rest = with_words(shot, self.cores.groom, self.cores.material()), rest and self.cores.reduced(rest)
        self.shot, self.clip, self.locks, self.first = shot, clip, groom.locks, first
        self.roots = Roots(groom)
        stiffened = None if rest is None else rest.curve.get("stiffened")
        self.strands = make_strands(shot, groom, rest, stiffened, self.cores.material())
        self.strands.place(self.roots.carry(clip.at(first), first))
        self._written = Written(self.cores, rest_of_all, np.asarray(self.strands.held))
        self.obstacles = [obstacle.starting_at(first) for obstacle in obstacles]
        self.garments = [SimulatedGarment(garment, self.obstacles, first) for garment in garments]
        self.scene: Scene | None = None
        self._lagging: list[dict[str, Any]] = []
        self.start: dict[str, Any] = {}
        if shot.touching:
            self.scene, self.start = scene_at_start(
                shot.touching, groom, self.strands, self.obstacles, self.garments, first
            )
            if rest is not None and "borne" in rest.point:
                self._support(groom, np.asarray(rest.point["borne"], np.float64))

    def _support(self, groom: Groom, forces: NDArray[np.float64]) -> None:
        """Contacts carry from the first step what supports the locks where they were groomed: ``forces`` [N]."""
        assert self.scene is not None and self.shot.touching is not None
        groomed = make_strands(self.shot, groom, of_cores=self.cores.material())
        of_locks = len(groom.locks.points)
        vertices, shares = initial_contact_forces(self.shot.touching, groom.locks, groomed, self.obstacles, forces)
        # Vertices of cloths are between those of locks and of bodies.
        of_cloths = sum(len(garment.cloth.positions) for garment in self.garments)
        self.scene.set_initial_forces(np.where(vertices < of_locks, vertices, vertices + of_cloths), shares)

    def cloths(self, frames: int) -> list[CachedCloth]:
        """The cloths of a cache with room for so many frames."""
        return [
            CachedCloth(
                simulated.name,
                simulated.garment.file,
                simulated.garment.prim,
                np.empty((frames, *simulated.cloth.positions.shape), compact(simulated.garment.clip.points).dtype),
            )
            for simulated in self.garments
        ]

    def points(self, frame: float) -> NDArray[np.float64]:
        """The points of all locks of the groom at ``frame``, where the motion is [m], shape (n, 3)."""
        return self.cores.carried(self.strands.positions, self.clip.at(frame), frame)

    @property
    def memory(self) -> dict[str, NDArray[Any]]:
        """The state that the next frame depends on, as arrays by name."""
        memory = {f"strands {name}": values for name, values in self.strands.memory.items()}
        if self.scene:
            memory |= {f"scene {name}": values for name, values in self.scene.memory.items()}
        return memory

    def recall(self, memory: Mapping[str, NDArray[Any]]) -> None:
        """Restores the state of a motion that was made from the same."""

        def of(part: str) -> dict[str, NDArray[Any]]:
            return {name.removeprefix(part): values for name, values in memory.items() if name.startswith(part)}

        self.strands.recall(of("strands "))
        if self.scene:
            self.scene.recall(of("scene "))

    def reach(self, k: int) -> dict[str, Any]:
        """Goes on to the k-th frame from the first, from the one before; the head is still in the preroll, where k is
        negative. Returns the frame's statistics.

        Raises UserError for positions that are not finite or far from the head.
        """
        end = self.first + max(k, 0)
        statistics = self.begin() if k == 0 else self.advance(self.first + max(k - 1, 0), end)
        self._check_positions(end)
        return statistics

    def _check_positions(self, frame: float) -> None:
        """Refuses positions that are not finite or far from the head."""
        head = self.clip.at(frame)
        check_curves(self.cores.whole.locks, self.points(frame), head, f"sim: locks at frame {frame:g}", UNSTABLE)
        for garment in self.garments:
            where = f"sim: cloth '{garment.name}' at frame {frame:g}"
            check_positions(garment.cloth.positions, head, where, lambda row: f"vertex {row}", UNSTABLE)

    def begin(self) -> dict[str, Any]:
        """Locks and cloths take over the motion that the clip has at the first frame.

        Returns the statistics of that frame, in which there was no step.
        """
        other = self.clip.next_to(self.first)
        rate = self.clip.fps / (other - self.first)
        memory = self.strands.memory
        led = self.roots.move(self.strands.positions, self.clip.at(self.first), self.clip.at(other), self.first)
        memory["velocities"] += rate * (led - self.strands.positions)
        memory["last_dt"][:] = 0.0  # BDF-2 starts over
        self.strands.recall(memory)
        bodies = [(obstacle.mesh.triangles, obstacle.at(self.first), obstacle.at(other)) for obstacle in self.obstacles]
        for cloth in (garment.cloth for garment in self.garments if bodies):
            cloth.velocities[:] += rate * (moved_with(cloth.positions, bodies) - cloth.positions)
        return {"frame": float(self.first), **self._judged(self.first)}

    def advance(self, begin: float, end: float) -> dict[str, Any]:
        """One frame's time passes while the scalp goes from frame ``begin`` to ``end``; returns its statistics."""
        wall, cpu = time.perf_counter(), time.process_time()
        substeps = self.shot.solver.substeps
        reports = StepReports()
        for k in range(1, substeps + 1):
            self._step(begin + (end - begin) * k / substeps, 1.0 / (self.clip.fps * substeps), reports)
        return {
            "frame": float(end),
            "wall_ms": 1e3 * (time.perf_counter() - wall),
            "cpu_ms": 1e3 * (time.process_time() - cpu),
            **frame_statistics(
                reports,
                self.strands.curves.ids,
                [garment.name for garment in self.garments],
                self.scene.penetrating if self.scene else 0,
                self._lagging,
                len(self.strands.positions) + sum(len(garment.cloth.positions) for garment in self.garments),
                self.shot.solver.accuracy,
            ),
            **self._judged(end),
        }

    def _judged(self, frame: float) -> dict[str, Any]:
        """Statistics of the locks as they are written at ``frame``, where the motion is."""
        return self._written.statistics(self.points(frame), self.obstacles, frame, self.garments)

    def _step(self, frame: float, dt: float, reports: StepReports) -> None:
        """One time step of ``dt`` [s]: roots, bodies and pinned cloth go to their places at ``frame``."""
        forces = self.shot.forces
        targets = self.roots.carry(self.clip.at(frame), frame)
        drawn = spring_forces(self.locks, self.strands, targets, dt, forces.gravity)
        if self.scene is None:
            reports.strands.append(
                self.strands.step(
                    targets, dt, gravity=forces.gravity, wind=forces.wind, forces=drawn, solver=self.shot.solver
                )
            )
            return
        bodies = [obstacle.at(frame) for obstacle in self.obstacles]
        for garment in self.garments:
            garment.scale_rest(frame)
        cloths = [garment.targets(frame) for garment in self.garments]
        scene, strands = self.scene.step(
            targets,
            dt,
            cloths=cloths,
            bodies=bodies,
            gravity=forces.gravity,
            wind=forces.wind,
            forces=drawn,
            solver=self.shot.solver,
        )
        self._lagging = self._compare(targets, cloths, bodies) if scene["lag"] > 0.0 else []
        reports.strands.append(strands)
        reports.scene.append(scene)
        reports.cloths.append(self.scene.cloth_reports)

    def _compare(
        self, targets: NDArray[np.float64], cloths: list[NDArray[np.float64]], bodies: list[NDArray[np.float64]]
    ) -> list[dict[str, Any]]:
        """What lags its targets after the last step."""
        assert self.scene is not None
        parts = [(ROOTS, np.where(np.asarray(self.strands.held)[:, None], targets, np.nan))]
        for garment, places in zip(self.garments, cloths, strict=True):
            parts.append((f"pins of {garment.name}", np.where(garment.cloth.held[:, None], places, np.nan)))
        parts += [(obstacle.name, places) for obstacle, places in zip(self.obstacles, bodies, strict=True)]
        return lagging(self.scene, parts)


def check_locks(shot: Shot, locks: Curves) -> None:
    """Refuses locks with no vertex that is free to move."""
    locks.check("sim: locks").check_strands("sim: locks")
    if (locks.counts <= shot.held).any():
        raise UserError(
            f"sim: held is {shot.held}, but a lock has {locks.counts.min()} points; hold fewer, or resample the locks"
        )
