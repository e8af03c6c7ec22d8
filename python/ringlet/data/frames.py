"""Choice of frames that a file holds: what is asked for and is not there is refused, and so are gaps."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ringlet.data.errors import UserError

NAMED = 8  # missing frames that a message names


def frames_within(held: NDArray[np.float64], asked: tuple[float, float] | None, where: object) -> NDArray[np.float64]:
    """Frames of a file in a closed range; all of them for None.

    held:  frames of the file, ascending, shape (k,)
    where: the file, for messages

    Raises UserError for a range that reaches beyond the frames of the file.
    """
    if asked is None:
        return held
    first, last = asked
    span = f"it holds {held[0]:g} to {held[-1]:g}" if len(held) else "nothing in it moves"
    if not len(held) or last < held[0] or first > held[-1]:
        raise UserError(f"{where}: has no frame from {first:g} to {last:g}; {span}")
    beyond = [(first, math.floor(held[0]) - 1), (math.ceil(held[-1]) + 1, last)]
    if ends := [f"{one:g}" if one == two else f"{one:g} to {two:g}" for one, two in beyond if one <= two]:
        raise UserError(f"{where}: has no frames {' and '.join(ends)}; {span}: ask for those")
    chosen = held[(held >= first) & (held <= last)]
    if not len(chosen):
        raise UserError(f"{where}: has no frame from {first:g} to {last:g}; the nearest are {_around(held, first)}")
    return chosen


def frame_range(held: NDArray[np.float64]) -> str:
    """Frames in words: ``frames 1 to 48``."""
    return f"frames {held[0]:g} to {held[-1]:g}" if len(held) else "no frames"


def gaps(held: NDArray[np.float64]) -> list[int]:
    """Whole frames that are missing between two frames of a file that are more than one apart."""
    pairs = zip(held[:-1].tolist(), held[1:].tolist(), strict=True)
    return [k for one, two in pairs if two - one > 1.0 + 1e-6 for k in range(math.floor(one) + 1, math.ceil(two))]


def refuse_gaps(held: NDArray[np.float64], where: object, remedy: str) -> None:
    """Raises UserError for frames with one missing between them."""
    if missing := gaps(held):
        names = ", ".join(map(str, missing[:NAMED])) + (" …" if len(missing) > NAMED else "")
        raise UserError(f"{where}: has no frame {names}, but those before and after; {remedy}")


def _around(held: NDArray[np.float64], frame: float) -> str:
    after = int(np.searchsorted(held, frame))
    return " and ".join(f"{one:g}" for one in held[max(after - 1, 0) : after + 1])
