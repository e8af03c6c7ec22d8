"""Running a shot: frame by frame, the scalp moves, and strands and cloth follow."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.cache import Cache, Touches
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.mesh import Clip
from ringlet.shot.shot import Shot, wrong_frames
from ringlet.sim.checkpoint import Checkpoints
from ringlet.sim.garment import Garment
from ringlet.sim.motion import Motion
from ringlet.sim.obstacle import Obstacle

TOUCHES = "touches "  # before the names of arrays that tell what touches

Progress = Callable[[str, int, int], None]
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
        for frame in replay(motion, checkpoints, done):
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


def replay(motion: Motion, checkpoints: Checkpoints, steps: int) -> Iterator[Frame]:
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


class StoredTouches:
    """What touched in the first steps of a motion, frame by frame, from where it is kept."""

    def __init__(self, motion: Motion, checkpoints: Checkpoints, steps: int) -> None:
        self._of = motion, checkpoints, steps

    def __iter__(self) -> Iterator[Touches]:
        return (frame.touches for frame in replay(*self._of) if frame.touches)
