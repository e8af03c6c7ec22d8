"""The run of a shot: frame by frame, the scalp moves, and strands and cloth follow."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.cache import Cache, Touches
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.limits import wrong_frames
from ringlet.data.mesh import Clip
from ringlet.data.precision import compact
from ringlet.shot.shot import Shot
from ringlet.sim.checkpoint import Checkpoints
from ringlet.sim.garment import Garment
from ringlet.sim.motion import Motion
from ringlet.sim.obstacle import Obstacle

CLOTH, TOUCHES = "cloth ", "touches "  # prefixes of the arrays of cloths and of contacts in checkpoints

Progress = Callable[[str, int, int], None]
OnFrame = Callable[[float, NDArray[np.floating], dict[str, Any]], None]


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

    rest:        the rest shape of the locks, in the rest pose of the scalp; the groomed one by default. Its attribute
                 ``stiffened`` has the times that each lock is stiffer against bend
    obstacles:   meshes in contact with the locks, where the shot has contact
    garments:    meshes that become cloth there
    frames:      first and last frame, in place of the shot's
    touches:     keep the contacts of every frame
    progress:    called as progress("sim", done, total)
    on_frame:    called with each frame's number, positions [m] of shape (n, 3) and statistics, as soon as it is done
    checkpoints: the folder from which ``resume`` continues a run that was interrupted, to the same bits
    """
    first, last = frames or shot.frames
    check_frames(first, last)
    motion = Motion(shot, groom, clip, rest, obstacles, garments, first)
    numbers = np.arange(first, last + 1, dtype=np.float64)
    points = np.empty((len(numbers), len(groom.locks.points), 3), compact(clip.points).dtype)
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


def check_frames(first: int, last: int) -> None:
    """Raises UserError for a range of frames that is none, or too long."""
    if wrong := wrong_frames(first, last):
        raise UserError(f"sim: frames are {first}:{last}; {wrong}")


@dataclass
class Frame:
    """The result of a run at one frame.

    number:     of the frame
    points:     positions of the locks [m], shape (n, 3), float32; float64 far from the origin
    cloths:     those of each cloth
    statistics: the report of the solver
    touches:    the contacts, where they were asked for
    """

    number: float
    points: NDArray[np.floating]
    cloths: list[NDArray[np.floating]]
    statistics: dict[str, Any]
    touches: Touches | None = None

    def __repr__(self) -> str:
        return f"Frame({self.number:g}, {len(self.points):,} points)"

    @classmethod
    def now(cls, number: float, motion: Motion, statistics: dict[str, Any], touches: bool) -> Frame:
        """The frame at which a motion is."""
        cloths = [compact(garment.cloth.positions) for garment in motion.garments]
        contacts = motion.scene.touches if touches and motion.scene else None
        return cls(number, compact(motion.points(number)), cloths, statistics, contacts)

    @classmethod
    def stored(cls, number: float, arrays: Mapping[str, NDArray[Any]], statistics: dict[str, Any]) -> Frame:
        """The frame of arrays in a checkpoint."""
        contacts = {name.removeprefix(TOUCHES): values for name, values in arrays.items() if name.startswith(TOUCHES)}
        cloths = [values for name, values in arrays.items() if name.startswith(CLOTH)]
        return cls(number, arrays["locks"], cloths, statistics, Touches(**contacts) if contacts else None)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Its arrays for a checkpoint, by name."""
        cloths = {f"{CLOTH}{k}": points for k, points in enumerate(self.cloths)}
        contacts = {f"{TOUCHES}{name}": values for name, values in vars(self.touches).items()} if self.touches else {}
        return {"locks": self.points, **cloths, **contacts}


def play(
    motion: Motion,
    last: int,
    *,
    touches: bool = False,
    progress: Progress | None = None,
    checkpoints: Checkpoints | None = None,
    resume: bool = False,
) -> Iterator[Frame]:
    """Yields the frames from the first of a motion to ``last``, each as soon as it is done; see ``simulate``."""
    check_frames(motion.first, last)
    preroll = motion.shot.preroll
    total = preroll + last - motion.first + 1
    done, state = (checkpoints.begin(resume) if checkpoints else None) or (0, {})
    done = min(done, total)
    if checkpoints and done:
        yield from _resumed(motion, checkpoints, done, touches)
        motion.recall(state)
    if progress:
        progress("sim", done, total)
    for step in range(done, total):
        k = step - preroll  # from the first frame; negative while the head is still
        statistics = motion.reach(k)
        frame = Frame.now(motion.first + k, motion, statistics, touches) if k >= 0 else None
        if checkpoints:
            checkpoints.write_step(step, frame.arrays() if frame else {}, statistics)
            if (step + 1) % checkpoints.every == 0 and step + 1 < total:
                checkpoints.write_state(step + 1, motion.memory)
        if progress:
            progress("sim", step + 1, total)
        if frame:
            yield frame


def _resumed(motion: Motion, checkpoints: Checkpoints, done: int, touches: bool) -> Iterator[Frame]:
    """The frames that an interrupted run left behind; refuses those without contacts where these are wanted."""
    for frame in replay(motion, checkpoints, done):
        if touches and not frame.touches:
            raise UserError(
                f"{checkpoints.folder}: the run that left it did not keep what touched; "
                "leave out --contacts, or run without --resume to start over"
            )
        yield frame


def replay(motion: Motion, checkpoints: Checkpoints, steps: int) -> Iterator[Frame]:
    """The frames among the first steps of a motion, from its checkpoints."""
    for k, (arrays, statistics) in enumerate(checkpoints.read_steps(steps), -motion.shot.preroll):
        if k >= 0:
            yield Frame.stored(motion.first + k, arrays, statistics)


class StoredTouches:
    """The contacts of the first steps of a motion, frame by frame, from its checkpoints."""

    def __init__(self, motion: Motion, checkpoints: Checkpoints, steps: int) -> None:
        self._of = motion, checkpoints, steps

    def __iter__(self) -> Iterator[Touches]:
        return (frame.touches for frame in replay(*self._of) if frame.touches)
