"""The result of a simulation: where every groom guide is, frame by frame."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass
class CachedCloth:
    """Simulated cloth over time.

    name:   what the shot calls it
    file:   the USD file of its mesh, None where it has none
    prim:   the path of the mesh there
    points: positions [m], shape (k, n, 3), float32; the same points as the mesh's
    """

    name: str
    file: Path | None
    prim: str
    points: NDArray[np.float32]


@dataclass
class Touches:
    """What touches at one time.

    places: in the middle between the two that touch [m], shape (k, 3), float32
    force:  with which they push each other away [N], shape (k,), float32
    gap:    between them, as a part of the distance at which they begin to push, from 0 to 1, shape (k,), float32
    """

    places: NDArray[np.float32]
    force: NDArray[np.float32]
    gap: NDArray[np.float32]


@dataclass
class Cache:
    """Simulated groom guides over time, and the cloth that moved with them.

    frames:     frame numbers (time codes), shape (k,)
    points:     positions [m], shape (k, n, 3), float32; the same points as ``groom.locks``
    statistics: what the solver reports, one dict per frame
    start:      what was in the way when the shot began (see ``sim/initial_penetration.py``); empty without contact
    cloths:     each at the same frames
    touches:    what touches at the end of each frame, where that was asked for
    """

    frames: NDArray[np.float64]
    points: NDArray[np.float32]
    statistics: list[dict[str, Any]] = field(default_factory=list)
    start: dict[str, Any] = field(default_factory=dict)
    cloths: list[CachedCloth] = field(default_factory=list)
    touches: list[Touches] = field(default_factory=list)


@dataclass
class Told:
    """What a simulation tells besides where everything is; see ``Cache``.

    cloths:  how many points each has, by name
    touches: read from where they are kept each time they are gone through, since they may be many
    """

    frames: list[float] = field(default_factory=list)
    statistics: list[dict[str, Any]] = field(default_factory=list)
    start: dict[str, Any] = field(default_factory=dict)
    cloths: dict[str, int] = field(default_factory=dict)
    touches: Iterable[Touches] = ()
