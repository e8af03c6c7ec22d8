"""Makes the example's ribbon: a bow tied into the hair, whose knot goes with the head.

    python examples/child/make_ribbon.py [-o ribbon.usdc]

The result is in the repository; there is no need to run the script.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from distances import Array
from garments import shifted, strip, write_garment
from motion import FRAMES, head_matrix
from numpy.typing import NDArray

HEAD_CENTRE = np.array([0.0, 2.4, -1.3])
AZIMUTH, ELEVATION = np.radians([47.0, 37.0])  # of the knot: from the front to the child's left, and up
DIRECTION = np.array([np.sin(AZIMUTH) * np.cos(ELEVATION), np.sin(ELEVATION), np.cos(AZIMUTH) * np.cos(ELEVATION)])
DISTANCE = 13.0  # from the head's centre to the knot [cm]
ROLL = np.radians(14.0)  # raises one loop

LOOP, HALF_WIDTH, KNOT_HALF_WIDTH = 5.0, 2.5, 0.5  # length of a loop, half-widths of the ribbon in loop and knot [cm]
FRONT, BACK, LAYER_OFFSET = 1.5, 0.25, 0.22  # bulge of a loop, offset of its two layers from the knot's centre [cm]
TAIL, TAIL_HALF_WIDTH = 6.4, 1.5  # length and half-width of an end [cm]
KNOT = np.array([0.62, 1.0, 0.82])  # half-sizes of the knot [cm]
SPACING = 0.42

FIRST_MOVED, IN_PLACE = -11, -3  # frames at which the knot starts to move, and is in place
START_DISTANCE = 3.0  # initial distance from the final position [cm]

COLOR = np.array([0.30, 0.012, 0.020])

Piece = tuple[Array, NDArray[np.int32], NDArray[np.bool_]]  # points, triangles, and mask of prescribed vertices


def loop(side: float) -> Piece:
    """Builds a loop from the knot and back: flat behind, full in front, pleated in the knot."""
    columns, rows = round(2.3 * LOOP / SPACING), round(2 * HALF_WIDTH / SPACING) + 1
    u, v = np.linspace(1.0, -1.0, columns)[:, None], np.linspace(-1.0, 1.0, rows)
    t = np.pi * (1.0 - 0.55 * u) - 0.9 * np.arcsin(u)  # keeps columns almost evenly spaced in the knot
    out = 0.5 * (1.0 - np.cos(t))  # 0 in the knot, 1 at the far end
    opening = smooth(out / 0.55)
    bulge = np.sin(t) * out**0.6 * np.where(t < np.pi, FRONT, BACK)
    pleats = 0.12 * (1.0 - opening) * np.cos(3 * np.pi * v)
    x = 0.3 + LOOP * out * (1.0 - 0.08 * v**2)
    y = (KNOT_HALF_WIDTH + (HALF_WIDTH - KNOT_HALF_WIDTH) * opening) * v
    z = LAYER_OFFSET * np.cos(0.5 * t) + bulge * (1.0 - 0.25 * v**2) + pleats
    return grid(side * x, y, z), strip(columns, rows), np.repeat(x[:, rows // 2] < KNOT[0], rows)


def tail(side: float) -> Piece:
    """Builds an end of the ribbon, which hangs behind the loops to one side and has a swallowtail cut."""
    columns, rows = round(TAIL / SPACING) + 1, round(2 * TAIL_HALF_WIDTH / SPACING) + 1
    s, v = np.linspace(0.0, 1.0, columns)[:, None], np.linspace(-1.0, 1.0, rows)
    along = s * (1.0 - 0.2 * (1.0 - np.abs(v)) * s)
    lean = 0.55 - 0.25 * along
    half = 0.42 + (TAIL_HALF_WIDTH - 0.42) * smooth(1.6 * s)
    x = 0.62 + TAIL * along * np.sin(lean) + half * v * np.cos(lean)
    y = -0.1 - TAIL * along * np.cos(lean) + half * v * np.sin(lean)
    z = -KNOT[2] - 0.2 + 0.25 * np.sin(2 * np.pi * along) + 0.0 * v
    return grid(side * x, y, z), strip(columns, rows), np.repeat(s[:, 0] * TAIL < 0.9, rows)


def knot() -> Piece:
    """Builds the band of the knot."""
    around, across = 20, 5
    a, v = np.linspace(0.0, 2 * np.pi, around, endpoint=False)[:, None], np.linspace(-1.0, 1.0, across)
    roundness = 1.0 - 0.22 * v**2
    points = grid(KNOT[0] * v + 0.0 * a, KNOT[1] * np.sin(a) * roundness, KNOT[2] * np.cos(a) * roundness)
    return points, strip(around, across, closed=True), np.ones(len(points), bool)


def smooth(t: Array | float) -> Array:
    """Smoothstep from 0 to 1."""
    t = np.clip(t, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def grid(*xyz: Array) -> Array:
    """Points of a grid from coordinates that vary along columns and rows, by column; shape (n, 3)."""
    return np.stack(np.broadcast_arrays(*xyz), axis=-1).reshape(-1, 3)


def make() -> tuple[Array, NDArray[np.int32], NDArray[np.int64]]:
    """Builds points [cm], triangles, and the indices of the prescribed triangles."""
    pieces = [loop(1.0), loop(-1.0), tail(1.0), tail(-1.0), knot()]
    first = np.cumsum([0] + [len(points) for points, _, _ in pieces])
    triangles = np.concatenate([first[k] + piece[1] for k, piece in enumerate(pieces)]).astype(np.int32)
    tied = np.concatenate([piece[2] for piece in pieces])
    return (
        on_head(np.concatenate([piece[0] for piece in pieces])),
        triangles,
        np.flatnonzero(tied[triangles].all(axis=1)),
    )


def on_head(points: Array) -> Array:
    """Transforms points from the bow's axes, along its loops, up and outwards, to its position on the head."""
    along = np.array([np.cos(AZIMUTH), 0.0, -np.sin(AZIMUTH)])
    rolled = np.cos(ROLL) * along + np.sin(ROLL) * np.cross(DIRECTION, along)
    return HEAD_CENTRE + DISTANCE * DIRECTION + points @ np.stack([rolled, np.cross(DIRECTION, rolled), DIRECTION])


def place(frame: int) -> Array:
    """Transform of the knot at a frame, shape (4, 4): moves into the hair before the clip, then fixed to the head."""
    remaining = 1.0 - smooth((frame - FIRST_MOVED) / (IN_PLACE - FIRST_MOVED))
    return head_matrix(frame) @ shifted(START_DISTANCE * remaining * DIRECTION)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).with_name("ribbon.usdc"))
    points, triangles, tied = make()
    write_garment(
        parser.parse_args().output,
        "ribbon",
        points,
        triangles,
        COLOR,
        subsets={"tied": tied},
        motion={frame: place(frame) for frame in range(FIRST_MOVED, FRAMES[-1] + 1)},
    )


if __name__ == "__main__":
    main()
