"""A chain without bending stiffness: its catenary between two supports, and its vibrations when it hangs from one.

Frequencies ω = (j₀ₙ / 2) √(g / L), with the zeros j₀ₙ of the Bessel function J₀; catenary with L = 1 and span 0.6: sag
0.362782.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.linalg import eigh
from scipy.optimize import root_scalar
from scipy.special import jn_zeros

from ringlet.validate.case import Case, Row, convergence
from ringlet.validate.rods import masses, rod_material, stiffness, strand

GRAVITY = 9.81  # [m/s²]
LENGTH = 0.1  # [m], of the swinging chain
SPAN, SAG = 0.6, 0.362782


def frequency(mode: int, edges: int) -> float:
    """Angular frequency ω of a mode of the vertically hanging chain [1/s]."""
    material = rod_material().model_copy(update={"bend_scale": 0.0})
    s = LENGTH * np.arange(edges + 1) / edges
    chain = strand(np.c_[0 * s, -s, 0 * s], material, 1)
    weight = GRAVITY * masses(chain)
    tension = np.cumsum(weight[::-1])[::-1][1:]
    stretched = LENGTH / edges * (1 + tension / (material.youngs_modulus * np.pi * material.radius**2))
    hanging = np.zeros_like(chain.curves.points)
    hanging[1:, 1] = -np.cumsum(stretched)
    free = np.arange(1, edges + 1)
    squares = eigh(stiffness(chain, hanging, free, axis=0), np.diag(masses(chain)[free]), eigvals_only=True)
    return float(np.sqrt(squares[mode]))


def sag(edges: int) -> float:
    """Sag of a chain of length 1 m between supports 0.6 m apart [m]."""
    material = rod_material().model_copy(update={"bend_scale": 0.0})
    # The initial shape is a circular arc whose chords sum to the chain's length.
    opening = root_scalar(lambda half: np.sin(half) / (edges * np.sin(half / edges)) - SPAN, bracket=(0.1, 3.1)).root
    turn = np.linspace(-opening, opening, edges + 1)
    points = 0.5 * SPAN / np.sin(opening) * np.c_[np.sin(turn), np.cos(opening) - np.cos(turn), 0 * turn]
    prescribed = np.isin(np.arange(edges + 1), (0, edges))
    chain = strand(points, material, prescribed)
    chain.settle(gravity=(0.0, -GRAVITY, 0.0), dt=0.5, tolerance=1e-10)
    return float(-chain.positions[:, 1].min())


def run() -> Iterator[Row]:
    zeros = jn_zeros(0, 3)
    for mode in range(3):
        yield from convergence(
            f"hanging chain mode {mode + 1} ω",
            zeros[mode] / 2 * np.sqrt(GRAVITY / LENGTH),
            lambda n, m=mode: frequency(m, n),
            (25, 50, 100),
            (1e-3, 2e-3, 4e-3)[mode],
        )
    yield from convergence("catenary sag/L", SAG, sag, (16, 32, 64), 5e-4)


CASE = Case("hanging-chain", "A chain without bending stiffness swings and sags as theory says", run)
