"""Makes the example's hat: a stiff felt cap that is put on from above, follows the head, and presses the hair down.

    python examples/child/make_hat.py [-o hat.usdc]

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

CENTRE = np.array([0.0, 4.2, -1.6])  # final position of the rim's centre
RIM = np.array([11.6, 12.4])  # half-widths of the rim, across and along the head
HEIGHT = 11.0  # height of the crown above the rim
BRIM = 2.6  # width of the brim
TILT = np.radians(-14.0)  # lowers the back
LIFT = 20.0  # initial height above the final position
AROUND, UP = 72, 20  # number of vertices
BAND = 3  # prescribed rows at the rim
IN_PLACE = 22.0  # frame at which the hat is in place

FELT, RIBBON = np.array([0.10, 0.16, 0.24]), np.array([0.45, 0.05, 0.04])


def make() -> tuple[Array, NDArray[np.int32], Array, NDArray[np.int64]]:
    """Builds points [cm], triangles, colours, and the indices of the triangles in the prescribed band."""
    angles = np.linspace(0.0, 2 * np.pi, AROUND, endpoint=False)
    brim = np.array([[1.0 + width / RIM.mean(), -0.25 * width] for width in np.linspace(BRIM, 0.0, 5)[:-1]])
    t = np.linspace(0.0, 1.0, UP) * 0.97 * np.pi / 2
    crown = np.stack([np.cos(t) ** 0.55, HEIGHT * np.sin(t)], axis=1)  # steep sides, a flat top
    rows = np.concatenate([brim, crown])
    sides = np.stack([np.sin(angles) * RIM[0], np.cos(angles) * RIM[1]], axis=1)
    points = np.stack(
        [
            sides[:, None, 0] * rows[None, :, 0],
            np.broadcast_to(rows[None, :, 1], (AROUND, len(rows))),
            sides[:, None, 1] * rows[None, :, 0],
        ],
        axis=2,
    ).reshape(-1, 3)
    triangles = strip(AROUND, len(rows), closed=True)
    row = np.append(np.tile(np.arange(len(rows)), AROUND), len(rows))
    top = np.flatnonzero(row == len(rows) - 1)
    middle = np.full(AROUND, len(points))
    triangles = np.concatenate([triangles, np.stack([middle, top, np.roll(top, -1)], axis=1)]).astype(np.int32)
    points = np.concatenate([points, [[0.0, HEIGHT, 0.0]]])
    band = np.flatnonzero((np.abs(row[triangles] - len(brim) - BAND / 2) <= BAND / 2).all(axis=1))
    colors = np.where((np.abs(row - len(brim) - 2) <= 2)[:, None], RIBBON, FELT)
    cos, sin = np.cos(TILT), np.sin(TILT)
    tilted = points @ np.array([[1, 0, 0], [0, cos, sin], [0, -sin, cos]])
    return tilted + CENTRE, triangles, colors, band


def place(frame: int) -> Array:
    """Transform of the hat at a frame, shape (4, 4): lowered onto the head with an ease-out, then fixed to it."""
    remaining = np.clip((IN_PLACE - frame) / (IN_PLACE - FRAMES[0]), 0.0, 1.0)
    return head_matrix(frame) @ shifted(np.array([0.0, LIFT * remaining**2 * (3.0 - 2.0 * remaining), 0.0]))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).with_name("hat.usdc"))
    points, triangles, colors, band = make()
    write_garment(
        parser.parse_args().output,
        "hat",
        points,
        triangles,
        colors,
        subsets={"band": band},
        motion={int(frame): place(int(frame)) for frame in FRAMES},
    )


if __name__ == "__main__":
    main()
