"""A shot that is simulated frame by frame, for programs that look at each frame or end early."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ringlet import shot as shots
from ringlet import sim
from ringlet.api.progress import Progress
from ringlet.api.shots import as_simulated, contents_of, read_shot
from ringlet.data.cache import Cache
from ringlet.data.groom import Groom
from ringlet.shot import Shot
from ringlet.sim import Frame, Motion


class Simulation:
    """Moves the locks of a groom while the scalp plays its clip, one frame each time one is asked for.

    Example::

        simulation = ringlet.Simulation("nod.shot.toml")
        for frame in simulation:
            print(frame.number, frame.points.max(axis=0))
        ringlet.write_cache(simulation.cache, "groom.usdc", "cache.usdc")

    Frames are those of ``simulate``, to the bit. An iteration that ends early goes on where it was.

    groom:       in place of the one that the shot names
    frames:      first and last frame, in place of the shot's
    allow_stale: use a lofted shape although it was made from another groom, material or forces
    progress:    such as a ``Job``
    """

    def __init__(
        self,
        shot: Shot | Path | str,
        groom: Groom | Path | str | None = None,
        *,
        frames: tuple[int, int] | None = None,
        allow_stale: bool = False,
        progress: Progress | None = None,
    ) -> None:
        self.shot = shot if isinstance(shot, shots.Shot) else read_shot(shot)
        self.groom = as_simulated(groom or self.shot.groom, progress)
        self.frames = frames or self.shot.frames
        first, last = self.frames
        contents = contents_of(self.shot, self.groom, allow_stale, self.frames)
        self._motion = Motion(self.shot, self.groom, first=first, **contents)
        self._play = sim.play(self._motion, last, progress=progress)
        self._done = list[Frame]()

    def __iter__(self) -> Iterator[Frame]:
        return self

    def __next__(self) -> Frame:
        self._done.append(frame := next(self._play))
        return frame

    @property
    def positions(self) -> NDArray[np.floating]:
        """Points of the locks in the last frame, as groomed before the first one [m], shape (n, 3)."""
        return self._done[-1].points if self._done else self.groom.locks.points

    @property
    def cache(self) -> Cache:
        """The frames so far, for ``write_cache``."""
        made = Cache(
            np.array([frame.number for frame in self._done]),
            np.stack([frame.points for frame in self._done]) if self._done else np.empty((0, *self.positions.shape)),
            [frame.statistics for frame in self._done],
            self._motion.start,
            self._motion.cloths(len(self._done)),
        )
        for k, cloth in enumerate(made.cloths):
            for points, frame in zip(cloth.points, self._done, strict=True):
                points[:] = frame.cloths[k]
        return made

    def __repr__(self) -> str:
        first, last = self.frames
        return f"Simulation({len(self.groom.locks):,} locks, frames {first} to {last}, {len(self._done)} done)"
