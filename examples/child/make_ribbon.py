"""Makes the example's ribbon: a bow tied into the hair, whose knot goes with the head.

    python examples/child/make_ribbon.py [-o ribbon.usdc]

The result is kept beside this file; nobody has to run it.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from distances import Array
from garments import shifted, strip, write_garment
from motion import FRAMES, head_matrix
from numpy.typing import NDArray

MIDDLE = np.array([0.0, 2.4, -1.3])  # of the head
TURN, RISE = np.radians([47.0, 37.0])  # where on it: from the front to the child's left, and up
DIRECTION = np.array([np.sin(TURN) * np.cos(RISE), np.sin(RISE), np.cos(TURN) * np.cos(RISE)])
OUT = 13.0  # of the knot from the middle [cm]
ROLL = np.radians(14.0)  # one loop is higher

LOOP, FULL, TIED = 5.0, 2.5, 0.5  # length of a loop, and half the ribbon's width there and in the knot [cm]
FRONT, BACK, APART = 1.5, 0.25, 0.22  # how far a loop bulges, and its two layers from the middle of the knot [cm]
TAIL, WIDE = 6.4, 1.5  # length and half the width of an end [cm]
KNOT = np.array([0.62, 1.0, 0.82])  # half the size of the knot [cm]
SPACING = 0.42

BEGIN, THERE = -11, -3  # frames at which it begins to come, and is where it is worn
AWAY = 3.0  # how far out of the hair it begins [cm]

COLOR = np.array([0.30, 0.012, 0.020])

Part = tuple[Array, NDArray[np.int32], NDArray[np.bool_]]  # points, triangles, and which vertices are tied


def loop(side: float) -> Part:
    """Out from the knot, around and back behind; flat behind, full in front, pleated where it is tied."""
    columns, rows = round(2.3 * LOOP / SPACING), round(2 * FULL / SPACING) + 1
    u, v = np.linspace(1.0, -1.0, columns)[:, None], np.linspace(-1.0, 1.0, rows)
    t = np.pi * (1.0 - 0.55 * u) - 0.9 * np.arcsin(u)  # columns hardly closer together where it is tied
    out = 0.5 * (1.0 - np.cos(t))  # 0 in the knot, 1 at the far end
    open_ = smooth(out / 0.55)
    bulge = np.sin(t) * out**0.6 * np.where(t < np.pi, FRONT, BACK)
    pleats = 0.12 * (1.0 - open_) * np.cos(3 * np.pi * v)
    x = 0.3 + LOOP * out * (1.0 - 0.08 * v**2)
    y = (TIED + (FULL - TIED) * open_) * v
    z = APART * np.cos(0.5 * t) + bulge * (1.0 - 0.25 * v**2) + pleats
    return grid(side * x, y, z), strip(columns, rows), np.repeat(x[:, rows // 2] < KNOT[0], rows)


def tail(side: float) -> Part:
    """An end that leaves the knot behind the loops and hangs to its side, cut like a swallow's tail."""
    columns, rows = round(TAIL / SPACING) + 1, round(2 * WIDE / SPACING) + 1
    s, v = np.linspace(0.0, 1.0, columns)[:, None], np.linspace(-1.0, 1.0, rows)
    along = s * (1.0 - 0.2 * (1.0 - np.abs(v)) * s)
    lean = 0.55 - 0.25 * along
    half = 0.42 + (WIDE - 0.42) * smooth(1.6 * s)
    x = 0.62 + TAIL * along * np.sin(lean) + half * v * np.cos(lean)
    y = -0.1 - TAIL * along * np.cos(lean) + half * v * np.sin(lean)
    z = -KNOT[2] - 0.2 + 0.25 * np.sin(2 * np.pi * along) + 0.0 * v
    return grid(side * x, y, z), strip(columns, rows), np.repeat(s[:, 0] * TAIL < 0.9, rows)


def knot() -> Part:
    """A band around what is tied."""
    around, across = 20, 5
    a, v = np.linspace(0.0, 2 * np.pi, around, endpoint=False)[:, None], np.linspace(-1.0, 1.0, across)
    round_ = 1.0 - 0.22 * v**2
    points = grid(KNOT[0] * v + 0.0 * a, KNOT[1] * np.sin(a) * round_, KNOT[2] * np.cos(a) * round_)
    return points, strip(around, across, closed=True), np.ones(len(points), bool)


def smooth(t: Array | float) -> Array:
    """From 0 to 1, level at both ends."""
    t = np.clip(t, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def grid(*xyz: Array) -> Array:
    """Points of coordinates that vary along columns and rows, column by column."""
    return np.stack(np.broadcast_arrays(*xyz), axis=-1).reshape(-1, 3)


def make() -> tuple[Array, NDArray[np.int32], NDArray[np.int64]]:
    """Points [cm], triangles, and those of them that are tied."""
    parts = [loop(1.0), loop(-1.0), tail(1.0), tail(-1.0), knot()]
    first = np.cumsum([0] + [len(points) for points, _, _ in parts])
    triangles = np.concatenate([first[k] + part[1] for k, part in enumerate(parts)]).astype(np.int32)
    tied = np.concatenate([part[2] for part in parts])
    return on_head(np.concatenate([part[0] for part in parts])), triangles, np.flatnonzero(tied[triangles].all(axis=1))


def on_head(points: Array) -> Array:
    """From the bow's own axes, along its loops, up and out of the head, to where it is worn."""
    along = np.array([np.cos(TURN), 0.0, -np.sin(TURN)])
    rolled = np.cos(ROLL) * along + np.sin(ROLL) * np.cross(DIRECTION, along)
    return MIDDLE + OUT * DIRECTION + points @ np.stack([rolled, np.cross(DIRECTION, rolled), DIRECTION])


def place(frame: int) -> Array:
    """Where the knot is: a 4 × 4 matrix. It comes into the hair before the clip begins, and goes with the head."""
    left = 1.0 - smooth((frame - BEGIN) / (THERE - BEGIN))
    return head_matrix(frame) @ shifted(AWAY * left * DIRECTION)


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
        motion={frame: place(frame) for frame in range(BEGIN, FRAMES[-1] + 1)},
    )


if __name__ == "__main__":
    main()
