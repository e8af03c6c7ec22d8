"""Bounds on the counts that a caller can ask for."""

from __future__ import annotations

from ringlet.data.errors import UserError

THREADS = 1024  # of the core, in one process
WORKERS = 256  # local processes of a wedge
RETRIES = 100  # of a task of a wedge
SAMPLES = 65_536  # paths per pixel of a picture
SECONDS = 86_400.0  # time limit of a picture
PIXELS = 8192  # width and height of a picture
BOUNCES = 1024  # of a light path
FRAMES = 100_000  # of a shot
FRAME = 10_000_000  # largest distance of a frame number from zero
FARTHEST = 1e9  # coordinate of a point, in the unit of its file
POINTS = 10_000  # of a lock
SAMPLES_OF_SCALP = 1_000_000  # guides, locks, clump centres and what else is spread over a scalp
ID = 2**53  # largest id of a curve, which the page keeps as a double


def check_count(what: str, count: int, most: int) -> None:
    """Raises UserError for a count that is not from 1 to ``most``."""
    if not 1 <= count <= most:
        raise UserError(f"{what} is {count}; must be from 1 to {most}")


def wrong_frames(first: int, last: int) -> str:
    """The condition that a range of frames violates; empty for a valid one."""
    if last < first:
        return "the last must not come before the first"
    if last - first >= FRAMES:
        return f"must be at most {FRAMES:,} frames"
    if max(-first, last) > FRAME:
        return f"must be from {-FRAME:,} to {FRAME:,}"
    return ""
