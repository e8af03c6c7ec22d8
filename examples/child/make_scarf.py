"""Makes the example's scarf: it winds around the neck more than once, and both ends hang over the chest.

    python examples/child/make_scarf.py [-o scarf.usdc]

The result is in the repository; there is no need to run the script.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from distances import Array
from garments import body, strip, without, write_garment
from numpy.typing import NDArray

TURN = 440.0  # total angle, from the left of the chest over the nape and around to its right [degrees]
START = 42.0  # angle of the inner end, from the front to the child's left [degrees]
END = 34.0  # angle of each hanging end [degrees]
AXIS = np.array([0.0, 0.0, -2.7])  # axis of the neck
FRONT, NAPE = -12.0, -10.4  # heights of the upper edge: under the chin, and at the back, below the hair
WIDTH, LENGTH = 7.5, 17.0  # widths down the body: around the neck and at the ends [cm]
OFF, LAYER = 0.55, 1.0  # distance from the body, and between turns [cm]
FOLDS, DEPTH = 3.0, 0.22  # number of folds across the width, and their depth [cm]
SPACING = 0.52

RED, CREAM = np.array([0.42, 0.035, 0.03]), np.array([0.62, 0.52, 0.40])


def make() -> tuple[Array, NDArray[np.int32], Array]:
    """Builds points [cm], triangles and colours."""
    turns = np.linspace(0.0, TURN, round(TURN / 360.0 * 2 * np.pi * 5.6 / SPACING))
    down = np.arange(0.0, LENGTH, SPACING)
    points = laid_on_body(START - turns, heights_off(turns[:, None], down))
    at_ends = (np.minimum(turns, TURN - turns) < END)[:, None]
    kept = (at_ends | (down <= WIDTH)).ravel()
    striped = at_ends & (down > WIDTH) & (np.mod(down - WIDTH, 3.2) > 2.2)
    colors = np.where(striped[:, :, None], CREAM, RED).reshape(-1, 3)
    flat, triangles = without(points.reshape(-1, 3), strip(len(turns), len(down)), kept)
    return flat, triangles, colors[kept]


def heights_off(turns: Array, down: Array) -> Array:
    """Distances of the scarf from the body [cm], shape (turns, down): each turn over the previous one, with folds."""
    wave = np.sin(2 * np.pi * FOLDS * down / WIDTH + 2.0 * np.sin(np.radians(1.5 * turns)) + 0.011 * turns)
    hanging = np.clip((down - WIDTH) / 2.0, 0.0, 1.0)  # no folds at the ends
    return OFF + LAYER * turns / 360.0 + DEPTH * (1.0 + wave * (1.0 - hanging))


def laid_on_body(angles: Array, off: Array) -> Array:
    """Points of the scarf on the body [cm], shape (angles, down, 3).

    Each column runs in a half-plane through the neck's axis, from the upper edge down along the surface.

    angles: angles from the front [degrees], shape (angles,)
    off:    distances from the body [cm], shape (angles, down)
    """
    radial = np.stack([np.sin(np.radians(angles)), 0.0 * angles, np.cos(np.radians(angles))], axis=1)

    def place(q: Array) -> Array:
        return AXIS + q[:, :1] * radial + q[:, 1:] * [0.0, 1.0, 0.0]

    def distance(q: Array) -> Array:
        return body(place(q))

    def normal(q: Array) -> Array:
        h = 1e-3
        slopes = [distance(q + np.array(step)) - distance(q - np.array(step)) for step in ((h, 0.0), (0.0, h))]
        slope = np.stack(slopes, axis=1)
        return slope / np.linalg.norm(slope, axis=1, keepdims=True)

    rays = np.arange(1.0, 12.0, 0.05)
    top = FRONT + (NAPE - FRONT) * np.abs(np.sin(np.radians(0.5 * angles))) ** 2
    clear = np.stack([body(place(np.stack([0.0 * top + r, top], axis=1))) > off[:, 0] for r in rays])
    q = np.stack([rays[clear.argmax(axis=0)], top], axis=1)
    columns = [place(q)]
    for before, now in zip(off.T[:-1], off.T[1:], strict=True):
        n = normal(q)
        step = np.sqrt(np.maximum(SPACING**2 - (now - before) ** 2, (0.5 * SPACING) ** 2))
        q = q + step[:, None] * np.stack([n[:, 1], -n[:, 0]], axis=1)  # outwards on a level surface, else down
        for _ in range(3):
            q = q - (distance(q) - now)[:, None] * normal(q)
        columns.append(place(q))
    return np.stack(columns, axis=1)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).with_name("scarf.usdc"))
    output = parser.parse_args().output
    write_garment(output, "scarf", *make())


if __name__ == "__main__":
    main()
