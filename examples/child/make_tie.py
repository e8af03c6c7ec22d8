"""Makes the example's hair tie: a ring of elastic around the hair on top of the head, to be drawn together.

    python examples/child/make_tie.py [-o tie.usdc]

The result is in the repository; there is no need to run the script.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from distances import Array
from garments import strip, write_garment
from numpy.typing import NDArray

CENTRE = np.array([0.0, 12.3, -2.5])
RADIUS = 14.0  # [cm]
HEIGHT = 1.2
AROUND, UP = 144, 4  # number of vertices
COLOR = np.array([0.75, 0.16, 0.35])


def make() -> tuple[Array, NDArray[np.int32]]:
    """Builds points [cm] and triangles of a cylindrical band around the vertical axis."""
    angles = np.linspace(0.0, 2 * np.pi, AROUND, endpoint=False)
    heights = np.linspace(-HEIGHT / 2, HEIGHT / 2, UP)
    a, y = np.meshgrid(angles, heights, indexing="ij")
    points = np.stack([RADIUS * np.sin(a), y, RADIUS * np.cos(a)], axis=-1).reshape(-1, 3)
    return points + CENTRE, strip(AROUND, UP, closed=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).with_name("tie.usdc"))
    write_garment(parser.parse_args().output, "tie", *make(), COLOR)


if __name__ == "__main__":
    main()
