"""Inverse statics of rods: the rest shape with which strands are in equilibrium where they were groomed.

The energy of a rod with a material frame depends on its edge vectors and on how its directors turn about them. In
equilibrium its derivative by an edge is the load of all vertices beyond, and its derivative by a director is zero. From
tip to root these are as many equations for each edge as there are internal forces: one stretches it, two bend the
corner at its beginning, one twists the edge before (rest/balance.h). So the internal forces follow from the loads
alone. Divided by the stiffness they are strains, and the groomed strains less these are the rest strains.

The problem is that of Derouet-Jourdan et al., *Inverse Dynamic Hair Modeling with Frictional Contact*, 2013.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ringlet import _core
from ringlet.data.curves import Curves
from ringlet.data.groom import Groom
from ringlet.rest.loft import largest_per_lock
from ringlet.rest.rod_strains import RodStrains, measure_strains, shape_of_strains
from ringlet.shot.shot import Shot
from ringlet.sim.hair_pins import rigid_elements
from ringlet.sim.shot_strands import make_strands
from ringlet.sim.strands import Strands

Array = NDArray[np.float64]
Locks = NDArray[np.bool_]

CONVERGED = 1e-5  # change of a lock's strains from round to round, relative to their size
SHARPEST = 2.6  # bend of a corner at rest above which a lock counts as too soft [rad]


def internal_forces(
    curves: Curves, points: Array, directors: Array, loads: Array, held: int, twisting: Array | None = None
) -> RodStrains:
    """Tensions [N], bending and twisting moments [N m] that balance loads.

    points, directors: where the strands are in equilibrium [m] and their directors, shapes (n, 3)
    loads:             the force on each vertex [N], shape (n, 3)
    held:              vertices of each strand that are held from its root; at least three, which hold its frame
    twisting:          moments that turn the director of each edge besides, as pins do [N m], shape (n,)
    Exact, whatever the shape and the stiffness. Between held vertices forces are undetermined, and zero here.
    """
    twisting = np.zeros(len(points)) if twisting is None else twisting
    points, directors, loads = (np.ascontiguousarray(of, np.float64) for of in (points, directors, loads))
    return RodStrains(*_core.balance(curves.offsets, held, points, directors, loads, twisting))


def external_loads(shot: Shot, strands: Strands) -> Array:
    """Gravity and wind on the vertices that move [N], shape (n, 3)."""
    loads = strands.loads(shot.forces.gravity, shot.forces.wind)
    loads[strands.held] = 0.0
    return loads


def balanced_rest_shape(
    shot: Shot, groom: Groom, frames: Array, support: Array, stiffened: Array
) -> tuple[Curves, Locks]:
    """The rest shape of locks that are in equilibrium as groomed, and which locks have one.

    frames:    the directors of the locks where they were groomed, shape (n, 3)
    support:   the forces that carry them besides their roots [N], shape (n, 3)
    stiffened: times that each is stiffer against bend, shape (count,)

    Stiffness and mass depend a little on the rest shape, so this is a fixed-point iteration.
    """
    locks, groomed = groom.locks, np.asarray(groom.locks.points, np.float64)
    groomed_strains = measure_strains(locks, groomed, frames)
    strain = groomed_strains.take(np.ones(len(groomed), bool))
    rest, going, good = groomed.copy(), np.ones(len(locks), bool), np.zeros(len(locks), bool)
    for done in range(shot.rest.iterations):
        rows = np.repeat(going, locks.counts)
        part = replace(groom, locks=locks.take(going))
        strands = make_strands(shot, part, part.locks.with_points(rest[rows]), stiffened[going])
        loads = external_loads(shot, strands) + support[rows]
        balance = partial(internal_forces, part.locks, groomed[rows], frames[rows], loads, shot.held)
        now = _strain_between_pins(strands, balance)
        at_rest = groomed_strains.take(rows).plus(now, -1.0)
        rest[rows], _ = shape_of_strains(part.locks, at_rest, frames[rows])
        size, change, sharpest = (
            largest_per_lock(part.locks, np.linalg.norm(bend, axis=1))
            for bend in (now.bend, now.bend - strain.bend[rows], at_rest.bend)
        )
        strain.put(rows, now)
        converged, soft = change <= CONVERGED * size, sharpest > SHARPEST
        good[going] = converged & ~soft
        going[going] = ~converged & ~(soft & (done > 0))
        if not going.any():
            break
    return locks.with_points(rest), good


def _strain(strands: Strands, forces: RodStrains) -> RodStrains:
    """The differences from the rest strains at which strands have these internal forces.

    Elements between held vertices have none: they stay as groomed, and the core takes its frames from them.
    """
    stretch, bend, twist = (
        np.where((stiffness > 0.0) & ~rigid, stiffness, np.inf)
        for stiffness, rigid in zip(strands.stiffness, rigid_elements(np.asarray(strands.held)), strict=True)
    )
    return RodStrains(forces.length / stretch, forces.bend / bend[:, None], forces.twist / twist)


def _strain_between_pins(strands: Strands, balance: Callable[[Array], RodStrains]) -> RodStrains:
    """The strains that balance the loads, with moments at pins that keep the directors of pinned edges.

    The director of an edge between pins is where the twists at rest lead from the root. It is the groomed one if the
    strains of twist cancel from the root to the pin, and these are linear in the moments at the pins.

    balance: the internal forces for further moments on the edges' directors [N m], shape (n,)
    """
    locks, stiffness = strands.curves, strands.stiffness[2]
    moments = np.zeros(len(stiffness))
    strain = _strain(strands, balance(moments))
    pinned = _first_pinned(strands)
    if not pinned.any():
        return strain
    lock, which = np.searchsorted(locks.offsets, np.flatnonzero(pinned), side="right") - 1, np.cumsum(pinned)
    which = (which - np.append(0, which)[locks.offsets[:-1]].repeat(locks.counts))[pinned] - 1
    edge, rows = np.flatnonzero(pinned), which.max() + 1

    def turned(strain: RodStrains) -> Array:
        """The angle by which the first edge of each row of pins is turned, shape (count, rows)."""
        angle, sums = np.zeros((len(locks), rows)), np.append(0.0, np.cumsum(strain.twist))
        angle[lock, which] = sums[edge] - sums[locks.offsets[lock]]
        return angle

    by_loads, by_moments = turned(strain), np.tile(np.eye(rows), (len(locks), 1, 1))
    for k in range(rows):
        of = which == k
        moments[:] = 0.0
        moments[edge[of]] = stiffness[edge[of] - 1]
        by_moments[lock[of], :, k] = (turned(_strain(strands, balance(moments))) - by_loads)[lock[of]]
    moments[edge] = np.linalg.solve(by_moments, -by_loads[:, :, None])[lock, which, 0] * stiffness[edge - 1]
    return _strain(strands, balance(moments))


def _first_pinned(strands: Strands) -> Locks:
    """The first edge of every row of pins that holds edges, as a mask of shape (n,)."""
    held_edge, _, _ = rigid_elements(np.asarray(strands.held))
    held_edge[strands.curves.offsets[1:] - 1] = False
    at_root = np.zeros(len(held_edge), bool)
    at_root[strands.curves.offsets[:-1]] = True
    return held_edge & ~np.append(True, held_edge[:-1]) & ~at_root
