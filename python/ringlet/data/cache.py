"""The result of a simulation: the positions of all groom guides, frame by frame."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.frames import frame_range


@dataclass
class CachedCloth:
    """Simulated cloth over time.

    name:   its name in the shot
    file:   the USD file of its mesh, None where it has none
    prim:   the path of the mesh there
    points: positions [m], shape (k, n, 3), as in ``Cache``; the same points as the mesh's
    """

    name: str
    file: Path | None
    prim: str
    points: NDArray[np.floating]


@dataclass
class Touches:
    """The contacts at one time.

    places: midpoints of the closest points [m], shape (k, 3), as in ``Cache``
    force:  normal force [N], shape (k,), float32
    gap:    relative to the activation distance, from 0 to 1, shape (k,), float32
    """

    places: NDArray[np.floating]
    force: NDArray[np.float32]
    gap: NDArray[np.float32]


@dataclass
class Cache:
    """Simulated groom guides over time, and the cloth that moved with them.

    frames:     frame numbers (time codes), shape (k,)
    points:     positions [m], shape (k, n, 3), float32, or float64 more than 8 m from the origin of coordinates; the
                same points as ``groom.locks``
    statistics: the reports of the solver, one dict per frame
    start:      the report of initial penetration (see ``sim/initial_penetration.py``); empty without contact
    cloths:     the cloths at the same frames
    touches:    the contacts at the end of each frame, where they were asked for
    notes:      a sentence for each visible surface that hair does not touch
    """

    frames: NDArray[np.float64]
    points: NDArray[np.floating]
    statistics: list[dict[str, Any]] = field(default_factory=list)
    start: dict[str, Any] = field(default_factory=dict)
    cloths: list[CachedCloth] = field(default_factory=list)
    touches: list[Touches] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def __repr__(self) -> str:
        cloths = "".join(f", {cloth.name}" for cloth in self.cloths)
        return f"Cache({frame_range(self.frames)}, {self.points.shape[1]:,} points{cloths})"


@dataclass
class SimulationRecord:
    """The result of a simulation but for positions; see ``Cache``.

    cloths:  the number of points of each, by name
    touches: read from checkpoints each time they are iterated over, since they may be many
    notes:   a sentence for each visible surface that hair does not touch
    """

    frames: list[float] = field(default_factory=list)
    statistics: list[dict[str, Any]] = field(default_factory=list)
    start: dict[str, Any] = field(default_factory=dict)
    cloths: dict[str, int] = field(default_factory=dict)
    touches: Iterable[Touches] = ()
    notes: list[str] = field(default_factory=list)
