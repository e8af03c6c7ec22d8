"""Rods in equilibrium as they are groomed: their own tension carries their weight, as far as they are stable so."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.live.rods import HELD, VERTICES, Rods, Wire
from ringlet.rest.inverse_statics import internal_forces
from ringlet.rest.rod_strains import RodStrains, measure_strains, shape_of_strains
from ringlet.sim.core import Vector
from ringlet.sim.strands import Strands

Array = NDArray[np.float64]

ROUNDS = 2  # to find a rest shape, on which the weight depends a little
LEFT = 0.5  # of its stiffness without load, that a rod keeps in every direction
FALLS = 4.0  # how soon the share of a rod that is too soft falls to 0
STIFFEST = 64.0  # times that a rod would have to be stiffer, at most, to carry all of its weight
MOST_BENT = 0.5  # of a corner by the weight [rad]
MOST_PRESSED = 0.5  # pressure along a rod, relative to its stretch stiffness


class HangingRods:
    """Rods with the rest shape from which their weight pulls them into the groom (inverse statics).

    A rod that stands up, or is too soft, would fall. It carries the share of its weight with which it is stable, and a
    load in the frame of the head carries the rest. Stability is that of the least stiffness by weight, found once.
    """

    def __init__(self, rods: Rods, wire: Wire, gravity: Vector) -> None:
        self.rods = rods
        self._as_groomed = wire, rods.strands(wire)
        self.frames = self._as_groomed[1].directors.copy()
        self._groomed = measure_strains(rods.curves, rods.points, self.frames)
        self._least = np.zeros(len(rods.curves))  # EI by density with which a rod carries its weight
        strands, _ = self.strands(wire, gravity, 1)
        strands.place(rods.points, self.frames)
        needed = strands.stabilising_stiffness(np.full(len(self._least), LEFT), STIFFEST)
        self._least = needed * wire.bend / wire.density

    def strands(self, wire: Wire, gravity: Vector, rounds: int = ROUNDS) -> tuple[Strands, Array]:
        """The rods of a wire, and what carries their weight besides themselves under gravity [m/s²], as groomed: [N],
        shape (n, 3)."""
        stiffness = wire.bend / wire.density
        # What is a little unstable stands, until it is pushed; then it would lie elsewhere.
        shares = np.clip(FALLS * (stiffness / np.maximum(self._least, 1e-30) - 1.0) + 1.0, 0.0, 1.0)
        strands = self._as_groomed[1] if wire is self._as_groomed[0] else self.rods.strands(wire)
        for _ in range(rounds):
            strain = self._strain(strands, wire, gravity)
            bent = _most(np.linalg.norm(strain.bend, axis=1)) / MOST_BENT
            pressed = _most(-strain.length / np.maximum(self._groomed.length, 1e-30)) / MOST_PRESSED
            shares = np.minimum(shares, 1.0 / np.maximum(np.maximum(bent, pressed), 1e-30))
            strain = RodStrains(*(_rows(shares, of) * of for of in (strain.length, strain.bend, strain.twist)))
            strain.length[:] *= self._groomed.length / np.maximum(self._groomed.length + strain.length, 1e-30)
            rest = shape_of_strains(self.rods.curves, self._groomed.plus(strain, -1.0), self.frames)[0]
            strands = self.rods.strands(wire, rest)
        support = -np.repeat(1.0 - shares, VERTICES)[:, None] * np.outer(strands.masses, gravity)
        return strands, support

    def _strain(self, strands: Strands, wire: Wire, gravity: Vector) -> RodStrains:
        """The strains by which all of its weight pulls a rod into the groom; none where it is held.

        That of length is of the groomed one.
        """
        curves, number = self.rods.curves, np.arange(len(self.frames)) % VERTICES
        loads = strands.loads(gravity)
        loads[strands.held] = 0.0
        forces = internal_forces(curves, self.rods.points, self.frames, loads, HELD)
        pull = np.repeat(self.rods.coil(wire).axial_stretch, VERTICES)
        _, bend, twist = (np.where(stiffness > 0.0, stiffness, np.inf) for stiffness in strands.stiffness)
        free, behind = number >= HELD - 1, number >= HELD - 2
        return RodStrains(
            np.where(free, self._groomed.length * forces.length / pull, 0.0),
            np.where(free[:, None], forces.bend / bend[:, None], 0.0),
            np.where(behind, forces.twist / twist, 0.0),
        )


def _most(values: Array) -> Array:
    """The largest of each rod, shape (count,)."""
    return values.reshape(-1, VERTICES).max(axis=1)


def _rows(of_rods: Array, values: Array) -> Array:
    """A number of each rod at its vertices, to multiply values of them."""
    return np.repeat(of_rods, VERTICES).reshape(-1, *[1] * (values.ndim - 1))
