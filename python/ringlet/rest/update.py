"""Rest shapes of a shot: found, stored with what they depend on, and found anew only for locks that have changed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.groom import Groom
from ringlet.rest.equilibrium import equilibrium, support_forces
from ringlet.rest.inverse_statics import external_loads
from ringlet.rest.loft import Loft, Progress, largest_per_lock
from ringlet.rest.preload import loft
from ringlet.rest.staleness import changed_locks, dependencies, rest_mode, same_locks, values_at_vertices
from ringlet.shot.shot import Shot
from ringlet.sim.obstacle import Obstacle
from ringlet.sim.shot_strands import make_strands, with_words

OPTIONAL = {"sagged": "sagged", "borne": "support"}  # values at vertices that a loft may lack, by their stored names
POSITIONS = ("groomed", "lofted", "sagged")  # values at vertices that are positions, wherever these are
SAME_SUPPORT = 1e-4  # change of the support of a lock, relative to its weight, below which it counts as the same


def solve_rest_shape(
    shot: Shot,
    groom: Groom,
    *,
    obstacles: Sequence[Obstacle] = (),
    support: NDArray[np.float64] | None = None,
    frames: NDArray[np.float64] | None = None,
    progress: Progress | None = None,
) -> Loft:
    """The rest shape that a shot asks for, by its method; one that asks for none gets a loft. See ``equilibrium``."""
    groom.locks.check("loft: locks")  # words are not: locks that fall over have none
    made = with_words(shot, groom)
    if rest_mode(shot) == "equilibrium":
        found = equilibrium(shot, made, obstacles=obstacles, support=support, frames=frames, progress=progress)
    else:
        found = loft(shot, made, progress=progress)
    return replace(found, groom=groom)


def to_curves(loft: Loft, shot: Shot) -> Curves:
    """A loft for storage: its rest shape, with all that it depends on and how it hangs as attributes."""
    rest = loft.rest
    point = {"groomed": loft.groom.locks.points, "lofted": loft.lofted, **values_at_vertices(shot, loft.groom)}
    point |= {stored: values for stored, name in OPTIONAL.items() if (values := getattr(loft, name)) is not None}
    curve = {"off": loft.off, "moving": loft.moving}
    if loft.stiffened is not None:
        curve["stiffened"] = loft.stiffened
    floats = {name: np.array(v, np.float64 if name in POSITIONS else np.float32) for name, v in point.items()}
    return Curves(rest.points, rest.offsets, rest.ids, curve, floats)


def from_curves(stored: Curves, groom: Groom) -> Loft:
    """The loft of the same locks from what ``to_curves`` gave."""
    lofted, off, moving = stored.point["lofted"], stored.curve["off"].copy(), stored.curve["moving"].copy()
    stiffened = stored.curve["stiffened"].copy() if "stiffened" in stored.curve else None
    sagged, support = (
        np.asarray(stored.point[name], np.float64) if name in stored.point else None for name in OPTIONAL
    )
    return Loft(groom, stored, sagged, np.asarray(lofted, np.float64), off, moving, stiffened, support)


def update_rest_shape(
    shot: Shot,
    groom: Groom,
    stored: Curves,
    made: dict[str, Any],
    *,
    obstacles: Sequence[Obstacle] = (),
    progress: Progress | None = None,
) -> Loft:
    """The loft of a groom. Locks that have not changed since a stored one was made are taken from it.

    made: the ``dependencies`` of the stored one
    """
    if not same_locks(stored, groom):
        return solve_rest_shape(shot, groom, obstacles=obstacles, progress=progress)
    whole, changed = from_curves(stored, groom), changed_locks(stored, shot, groom)
    if made != (now := dependencies(shot, obstacles)):
        same = not changed.any() and _of_support(made) == _of_support(now)
        return solve_rest_shape(
            shot, groom, obstacles=obstacles, support=whole.support if same else None, progress=progress
        )
    if not changed.any():
        return whole
    support, known = None, {}
    if whole.support is not None:
        strands = make_strands(shot, groom)
        frames = strands.directors.copy()
        support = support_forces(shot, groom, obstacles, strands)
        changed |= _support_changed(external_loads(shot, strands), groom.locks, whole.support, support)
        known = {"support": support, "frames": frames}
    rows = np.repeat(changed, groom.locks.counts)
    part = replace(groom, locks=groom.locks.take(changed))
    of_part = {name: values[rows] for name, values in known.items()}
    part = solve_rest_shape(shot, part, obstacles=obstacles, **of_part, progress=progress)
    whole.rest.points[rows], whole.lofted[rows] = part.rest.points, part.lofted
    whole.off[changed], whole.moving[changed] = part.off, part.moving
    if whole.stiffened is not None and part.stiffened is not None:
        whole.stiffened[changed] = part.stiffened
    if whole.sagged is not None and part.sagged is not None:
        whole.sagged[rows] = part.sagged
    return replace(whole, support=support, sagged=None if part.sagged is None else whole.sagged)


def _of_support(made: dict[str, Any]) -> dict[str, Any]:
    """Those of the dependencies that support depends on: weight and contact, not stiffness."""
    of_weight = {name: made["strands"][name] for name in ("radius", "density", "drag", "correct_resolution")}
    return {**{name: made[name] for name in made if name not in ("rest", "solver")}, "strands": of_weight}


def _support_changed(
    loads: NDArray[np.float64], locks: Curves, before: NDArray[np.float64], now: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Locks whose support forces differ from before, as their neighbours have changed, shape (count,)."""
    weight = np.add.reduceat(np.linalg.norm(loads, axis=1), locks.offsets[:-1])
    return largest_per_lock(locks, np.linalg.norm(now - before, axis=1)) > SAME_SUPPORT * weight
