"""Running a shot: frame by frame, the scalp moves, and strands and cloth follow."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.cache import Cache, CachedCloth, Touches
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip
from ringlet.shot import start
from ringlet.shot.checkpoint import Checkpoints, digest
from ringlet.shot.collider import LOCKS, Obstacle, with_pairs
from ringlet.shot.garment import Garment
from ringlet.shot.nails import held_vertices, pull
from ringlet.shot.resting import shared
from ringlet.shot.roots import Roots
from ringlet.shot.scene import Scene, friction_of
from ringlet.shot.shot import Shot, wrong_frames
from ringlet.shot.strands import Strands
from ringlet.shot.worn import Worn

Progress = Callable[[str, int, int], None]
# Where things are read from is not what they are, and neither is how far a run goes.
_PLACES = {
    "groom": True,
    "frames": True,
    "rest": {"file"},
    "collider": {"__all__": {"file"}},
    "cloth": {"__all__": {"file"}},
}

TOUCHES = "touches "  # before the names of arrays that tell what touches

OnFrame = Callable[[float, NDArray[np.float32], dict[str, Any]], None]


def simulate(
    shot: Shot,
    groom: Groom,
    clip: Clip,
    *,
    rest: Curves | None = None,
    obstacles: Sequence[Obstacle] = (),
    garments: Sequence[Garment] = (),
    frames: tuple[int, int] | None = None,
    touches: bool = False,
    progress: Progress | None = None,
    on_frame: OnFrame | None = None,
    checkpoints: Checkpoints | None = None,
    resume: bool = False,
) -> Cache:
    """Moves the locks of ``groom`` while its scalp plays ``clip``.

    rest:      the shape that the locks remember, in the rest pose of the scalp; the groomed one by default. Its
               attribute ``stiffened`` says how many times each is stiffer against bend
    obstacles: what the locks touch, where the shot has contact
    garments:  what becomes cloth there
    frames:    first and last frame, in place of the shot's
    touches:   keep what touches in every frame
    progress:  called as progress("sim", done, total)
    on_frame:  called with each frame's number, positions [m] of shape (n, 3) and statistics, as soon as it is there
    checkpoints: where to keep what is done, so that ``resume`` goes on after a run that was broken off, to the same
               bits
    """
    first, last = frames or shot.frames
    motion = Motion(shot, groom, clip, rest, obstacles, garments, first)
    _check_frames(first, last)
    numbers = np.arange(first, last + 1, dtype=np.float64)
    points = np.empty((len(numbers), len(groom.locks.points), 3), np.float32)
    cache = Cache(numbers, points, start=motion.start, cloths=motion.cloths(len(numbers)))
    run = play(motion, last, touches=touches, progress=progress, checkpoints=checkpoints, resume=resume)
    for k, frame in enumerate(run):
        cache.points[k] = frame.points
        for cloth, places in zip(cache.cloths, frame.cloths, strict=True):
            cloth.points[k] = places
        cache.statistics.append(frame.statistics)
        if frame.touches:
            cache.touches.append(frame.touches)
        if on_frame:
            on_frame(frame.number, cache.points[k], frame.statistics)
    return cache


def _check_frames(first: int, last: int) -> None:
    if wrong := wrong_frames(first, last):
        raise UserError(f"sim: frames are {first}:{last}; {wrong}")


@dataclass
class Frame:
    """What a run gives at one frame.

    number:     of the frame
    points:     positions of the locks [m], shape (n, 3), float32
    cloths:     those of each cloth
    statistics: what the solver reports
    touches:    what touches, where that was asked for
    """

    number: float
    points: NDArray[np.float32]
    cloths: list[NDArray[np.float32]]
    statistics: dict[str, Any]
    touches: Touches | None = None


def play(
    motion: Motion,
    last: int,
    *,
    touches: bool = False,
    progress: Progress | None = None,
    checkpoints: Checkpoints | None = None,
    resume: bool = False,
) -> Iterator[Frame]:
    """Yields the frames from the first of a motion to ``last``, each as soon as it is there; see ``simulate``."""
    _check_frames(motion.first, last)
    before = motion.shot.preroll
    total = before + last - motion.first + 1
    done, memory = (checkpoints.begin(resume) if checkpoints else None) or (0, {})
    done = min(done, total)
    if checkpoints and done:
        for frame in played(motion, checkpoints, done):
            if touches and not frame.touches:
                raise UserError(
                    f"{checkpoints.folder}: the run that left it did not keep what touched; "
                    "leave out --contacts, or run without --resume to start over"
                )
            yield frame
        motion.recall(memory)
    for step in range(done, total):
        k = step - before
        statistics = motion.advance(motion.first + max(k - 1, 0), motion.first + max(k, 0))
        moved = {name: np.asarray(points, np.float32) for name, points in motion.positions.items()} if k >= 0 else {}
        touching = motion.scene.touches if touches and motion.scene and k >= 0 else None
        if checkpoints:
            kept = {f"{TOUCHES}{name}": values for name, values in vars(touching).items()} if touching else {}
            checkpoints.keep(step, moved | kept, statistics)
            if (step + 1) % checkpoints.every == 0 and step + 1 < total:
                checkpoints.remember(step + 1, motion.memory)
        if progress:
            progress("sim", step + 1, total)
        if k >= 0:
            yield Frame(motion.first + k, moved.pop("locks"), list(moved.values()), statistics, touching)


def played(motion: Motion, checkpoints: Checkpoints, steps: int) -> Iterator[Frame]:
    """The frames among the first steps of a motion, from where they are kept."""
    for k, (arrays, statistics) in enumerate(checkpoints.kept(steps), -motion.shot.preroll):
        if k >= 0:
            touching = {name: arrays.pop(name) for name in [*arrays] if name.startswith(TOUCHES)}
            touches = (
                Touches(**{name.removeprefix(TOUCHES): values for name, values in touching.items()})
                if touching
                else None
            )
            yield Frame(motion.first + k, arrays.pop("locks"), list(arrays.values()), statistics, touches)


class KeptTouches:
    """What touched in the first steps of a motion, frame by frame, from where it is kept."""

    def __init__(self, motion: Motion, checkpoints: Checkpoints, steps: int) -> None:
        self._of = motion, checkpoints, steps

    def __iter__(self) -> Iterator[Touches]:
        return (frame.touches for frame in played(*self._of) if frame.touches)


def made_of(
    shot: Shot,
    groom: Groom,
    clip: Clip,
    rest: Curves | None,
    obstacles: Sequence[Obstacle],
    garments: Sequence[Garment],
    frames: tuple[int, int] | None,
) -> str:
    """A digest of all that a run is made from."""
    curves = [groom.locks] if rest is None else [groom.locks, rest]
    arrays = [
        part for c in curves for part in (c.offsets, c.ids, c.points, *(c.curve[name] for name in sorted(c.curve)))
    ]
    arrays += [moving.points for moving in (clip, *(o.clip for o in obstacles), *(g.clip for g in garments))]
    first, _ = frames or shot.frames  # how far it goes changes nothing before
    return digest(version("ringlet"), shot.model_dump(mode="json", exclude=_PLACES), first, *arrays)


def make_strands(
    shot: Shot, groom: Groom, rest: Curves | None = None, stiffened: NDArray[np.float64] | None = None
) -> Strands:
    """The locks of a groom as strands of a shot's material that remember the groomed shape, or another one.

    stiffened: times that each lock is stiffer against bend than that material, shape (count,)
    """
    factors = shot.variation.factors(groom)
    if stiffened is not None:
        factors["bend"] = factors.get("bend", 1.0) * np.repeat(stiffened, groom.locks.counts)
    return Strands(rest or groom.locks, shot.strands, held_vertices(groom.locks, shot.held), factors)


class Motion:
    """Locks on their moving scalp, in contact where the shot has it; see ``simulate`` for what it is made of.

    first: the frame at which everything starts
    start: what was in the way then (see ``start.py``)
    worn:  the cloths that move with them
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
        groom.locks.check("sim: locks")
        if (groom.locks.counts <= shot.held).any():
            raise UserError(
                f"sim: held is {shot.held}, but a lock has {groom.locks.counts.min()} points; "
                "hold fewer, or resample the locks"
            )
        self.first, self.shot, self.clip, self.locks, self.roots = first, shot, clip, groom.locks, Roots(groom)
        self.strands = make_strands(shot, groom, rest, None if rest is None else rest.curve.get("stiffened"))
        self.strands.place(self.roots.carry(clip.at(first), first))
        self.scene: Scene | None = None
        self.start: dict[str, Any] = {}
        self.obstacles = [obstacle.starting_at(first) for obstacle in obstacles]
        self.worn = [Worn(garment, self.obstacles, first) for garment in garments]
        if shot.touching:
            self._touch(groom, first)
            if rest is not None and "borne" in rest.point:
                self._bear(groom, np.asarray(rest.point["borne"], np.float64))

    def _bear(self, groom: Groom, borne: NDArray[np.float64]) -> None:
        """What bears the locks where they were groomed does so from the start."""
        assert self.scene is not None and self.shot.touching is not None
        groomed, of_locks = make_strands(self.shot, groom), len(groom.locks.points)
        vertices, forces = shared(self.shot.touching, groom.locks, groomed, self.obstacles, borne)
        of_cloths = sum(len(worn.cloth.positions) for worn in self.worn)  # between those of locks and of bodies
        self.scene.bear(np.where(vertices < of_locks, vertices, vertices + of_cloths), forces)

    def _touch(self, groom: Groom, first: float) -> None:
        """Puts locks and cloths into a scene with the obstacles; what starts inside one is excused until it is out."""
        contact = self.shot.touching
        assert contact is not None
        locks = groom.locks.with_points(self.strands.positions.copy())
        carriers = [k for k, obstacle in enumerate(self.obstacles) if obstacle.is_surface_of(groom.scalp)]
        rooted_in = np.full(len(locks), carriers[0] if carriers else -1)
        bodies, cloths = [obstacle.body(first) for obstacle in self.obstacles], [worn.cloth for worn in self.worn]
        of_bodies = [obstacle.name for obstacle in self.obstacles]
        for worn in self.worn:
            start.refuse_pierced(worn, of_bodies, bodies)
        names = [LOCKS, *(worn.name for worn in self.worn), *of_bodies]
        friction = with_pairs(friction_of(contact, cloths, bodies), contact.pair, names)
        pinned_to = np.array([worn.pinned_to for worn in self.worn])
        self.scene = Scene(self.strands, bodies, contact, rooted_in, cloths, pinned_to, friction)
        inside = []
        for k, (obstacle, body) in enumerate(zip(self.obstacles, bodies, strict=True)):
            depth = start.depths(locks.points, obstacle.mesh.triangles, body.points)
            depth[self.strands.held] = 0.0
            if depth.any():
                inside.append(start.tell_inside(locks, obstacle.mesh, depth))
                self.scene.excuse(np.flatnonzero(depth), k)
        self.start = start.told(
            inside,
            start.tell_piercing(locks, self.worn),
            start.tell_overlapping(locks, self.scene),
        )

    def cloths(self, frames: int) -> list[CachedCloth]:
        """The cloths as a cache has them, with room for so many frames."""
        return [
            CachedCloth(
                worn.name,
                worn.garment.file,
                worn.garment.prim,
                np.empty((frames, len(worn.cloth.positions), 3), np.float32),
            )
            for worn in self.worn
        ]

    @property
    def positions(self) -> dict[str, NDArray[np.float64]]:
        """Where everything is [m]: ``locks``, shape (n, 3), and each cloth."""
        cloths = {f"cloth {n}": worn.cloth.positions for n, worn in enumerate(self.worn)}
        return {"locks": self.strands.positions, **cloths}

    @property
    def memory(self) -> dict[str, NDArray[Any]]:
        """All that the next frame depends on besides what this was made from, as arrays by name."""
        memory = {f"strands {name}": values for name, values in self.strands.memory.items()}
        if self.scene:
            memory |= {f"scene {name}": values for name, values in self.scene.memory.items()}
        return memory

    def recall(self, memory: Mapping[str, NDArray[Any]]) -> None:
        """Goes back to a memory of a motion that was made from the same."""

        def of(part: str) -> dict[str, NDArray[Any]]:
            return {name.removeprefix(part): values for name, values in memory.items() if name.startswith(part)}

        self.strands.recall(of("strands "))
        if self.scene:
            self.scene.recall(of("scene "))

    def advance(self, begin: float, end: float) -> dict[str, Any]:
        """One frame's time passes while the scalp goes from frame ``begin`` to ``end``; returns what happened."""
        wall, cpu = time.perf_counter(), time.process_time()
        substeps = self.shot.solver.substeps
        dt = 1.0 / (self.clip.fps * substeps)
        touched: list[dict[str, float]] = []
        of_cloths: list[list[dict[str, float]]] = []
        reports: list[dict[str, NDArray[np.float64]]] = []
        outside: dict[str, Any] = {
            "gravity": self.shot.forces.gravity,
            "wind": self.shot.forces.wind,
            "solver": self.shot.solver,
        }
        for k in range(1, substeps + 1):
            frame = begin + (end - begin) * k / substeps
            targets = self.roots.carry(self.clip.at(frame), frame)
            outside["forces"] = pull(self.locks, self.strands, targets, dt, self.shot.forces.gravity)
            if self.scene:
                ends = [obstacle.at(frame) for obstacle in self.obstacles]
                for worn in self.worn:
                    worn.draw_together(frame)
                places = [worn.targets(frame) for worn in self.worn]
                contact, report = self.scene.step(targets, dt, cloths=places, bodies=ends, **outside)
                touched.append(contact)
                of_cloths.append(self.scene.cloth_reports)
            else:
                report = self.strands.step(targets, dt, **outside)
            reports.append(report)
        return {
            "frame": float(end),
            "wall_ms": 1e3 * (time.perf_counter() - wall),
            "cpu_ms": 1e3 * (time.process_time() - cpu),
            **_summary(reports, self.strands),
            **(_contact_summary(touched, self.scene) if self.scene else {}),
            **({"cloth": _cloth_summary(of_cloths, [worn.name for worn in self.worn])} if self.worn else {}),
        }


def _summary(reports: list[dict[str, NDArray[np.float64]]], strands: Strands) -> dict[str, Any]:
    """What happened in a frame's substeps, over all strands: sums of events, the worst values, energies at its end."""
    last = reports[-1]
    unsolved = np.any([report["unconverged"] > 0 for report in reports], axis=0)

    def total(name: str) -> int:
        return int(sum(report[name].sum() for report in reports))

    def worst(name: str) -> float:
        return float(max(report[name].max() for report in reports))

    return {
        "newton": float(np.mean([report["newton"].mean() for report in reports])),
        "newton_max": int(worst("newton")),
        "unconverged": total("unconverged"),
        "unconverged_locks": [int(lock) for lock in strands.curves.ids[unsolved]],
        "line_search_cuts": total("cuts"),
        "residual": worst("residual"),
        "energy": {name: float(last[name].sum()) for name in ("stretch", "bend", "twist", "gravity", "kinetic")},
        "max_stretch": worst("max_stretch"),
        "worst_lock": int(strands.curves.ids[int(last["max_stretch"].argmax())]),
        "flips": total("flips"),
        "winding_changes": total("winding_changes"),
        "too_straight": total("too_straight"),
        "clamped": total("clamped"),
        "nan": total("nan"),
    }


def _cloth_summary(reports: list[list[dict[str, float]]], names: list[str]) -> dict[str, Any]:
    """Of each cloth, by name, its worst stretch in a frame's substeps, and its energies at the end of it."""
    return {
        name: {
            "max_stretch": max(report[k]["max_stretch"] for report in reports),
            "energy": {term: reports[-1][k][term] for term in ("stretch", "bend", "gravity", "kinetic")},
            "nan": int(sum(report[k]["nan"] for report in reports)),
        }
        for k, name in enumerate(names)
    }


def _contact_summary(reports: list[dict[str, float]], scene: Scene) -> dict[str, Any]:
    """What happened in a frame's substeps in a scene, which is solved as one: it replaces what strands tell of that."""

    def total(name: str) -> float:
        return sum(report[name] for report in reports)

    closest = min(report["closest"] for report in reports)
    times = [name for name in reports[0] if name.startswith("time_")]
    return {
        "newton": float(np.mean([report["newton"] for report in reports])),
        "newton_max": int(max(report["newton"] for report in reports)),
        "unconverged": int(total("unconverged")),
        "unconverged_locks": [],
        "line_search_cuts": int(total("cuts")),
        "residual": max(report["residual"] for report in reports),
        "contact": {
            "candidates": int(reports[-1]["candidates"]),
            "contacts": int(reports[-1]["contacts"]),
            "closest": closest if np.isfinite(closest) else None,
            "violations": int(total("violations")),
            "zone_vertices": int(total("zone_vertices")),
            "excused": scene.excused,
            "linear_iterations": int(total("linear_iterations")),
            "fraction": min(report["fraction"] for report in reports),
            **{f"{name}_ms".removeprefix("time_"): 1e3 * total(name) for name in times},
        },
    }
