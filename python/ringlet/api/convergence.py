"""How many iterations a shot needs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ringlet.api import shots
from ringlet.api.progress import Progress
from ringlet.data.convergence import Convergence
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.report.convergence import COLUMNS, advice, rows, write_page
from ringlet.shot.shot import Shot
from ringlet.sim import convergence

FRAMES = 8  # that are compared by default


def converge(
    shot: Shot | Path | str,
    groom: Groom | Path | str | None = None,
    *,
    frames: tuple[int, int] | None = None,
    enough: float = 0.95,
    allow_stale: bool = False,
    progress: Progress | None = None,
) -> Convergence:
    """Plays a few frames of a shot at several settings of its solver, and compares them with a run that converges.

    groom:  in place of the one that the shot names
    frames: first and last frame; by default the first eight of the shot. Up to the first the shot's own setting is used
    enough: part of the converged motion that the advised setting must keep

    Raises UserError for frames outside the shot's.
    """
    shot = shot if not isinstance(shot, str | Path) else shots.read_shot(shot)
    begin, end = shot.frames
    first, last = frames or (begin, min(begin + FRAMES, end))
    if not begin <= first < last <= end:
        raise UserError(
            f"converge: frames are {first}:{last}; must be two frames or more of the shot's, which are {begin}:{end}"
        )
    motion = shots.start_motion(shot, groom or shot.groom, allow_stale=allow_stale)
    return convergence.converge(motion, (first, last), enough=enough, progress=progress)


def convergence_table(result: Convergence) -> tuple[list[str], list[list[str]], str]:
    """Columns and rows of what ``converge`` found, and what to do, in words."""
    return COLUMNS, rows(result), advice(result)


def write_convergence(result: Convergence, path: Path | str, title: str = "converge") -> None:
    """Writes what ``converge`` found as a page of numbers and charts."""
    write_page(result, Path(path), title)


def lock_motion(points: NDArray[np.float64], offsets: NDArray[np.integer]) -> list[float]:
    """How far the fastest vertex of the median lock moves in each frame, relative to all roots [m].

    points:  positions [m], shape (frames, n, 3)
    offsets: offsets of the locks, shape (locks + 1,)
    """
    return convergence.lock_motion(points, offsets)


def tip_distance(points: NDArray[np.float64], offsets: NDArray[np.integer]) -> list[float]:
    """Median distance of the tips from their places in the first frame, relative to all roots, by frame [m].

    points:  positions [m], shape (frames, n, 3)
    offsets: offsets of the locks, shape (locks + 1,)
    """
    return convergence.tip_distance(points, offsets)
