"""The locks of a groom as strands of a shot: their material, and what words about their motion make of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.data.painted import per_lock
from ringlet.data.random import Random
from ringlet.motion import Stepping, advised_steps
from ringlet.shot.motion import WORDS
from ringlet.shot.shot import Shot
from ringlet.sim.hair_pins import held_vertices
from ringlet.sim.hanging import hang
from ringlet.sim.strands import Strands
from ringlet.sim.variation import material_factors
from ringlet.sim.worn import worn_factors

Array = NDArray[np.float64]

# Attributes of locks: factors on their material, by its variation, with which they move as words say.
WANTED = {"bend": "wanted_bend", "damping": "wanted_damping"}
ROUNDS = 10  # in which stiffness and the shape that it gives are found
LARGEST = 4.0  # factor on the stiffness in a round
FOUND, MET = 0.002, 0.05  # changes of the stiffness in a round at which it is found, and at which it counts as such


def make_strands(
    shot: Shot,
    groom: Groom,
    rest: Curves | None = None,
    stiffened: Array | None = None,
    of_cores: Mapping[str, Array] | None = None,
) -> Strands:
    """The locks of a groom as strands of a shot's material, whose rest shape is the groomed or another one.

    stiffened: times that each lock is stiffer against bend than that material, shape (count,)
    of_cores:  further factors on the material, at the vertices of the locks, by name, shape (n,) each
    """
    groom = with_words(shot, groom, of_cores)
    locks, factors = groom.locks, {**material_factors(shot, groom)}
    for name, factor in (of_cores or {}).items():
        factors[name] = factors.get(name, 1.0) * factor
    of_worn = worn_factors(locks, shot.strands, factors.get("radius", np.ones(len(locks.points))))
    for name, factor in of_worn.items():
        factors[name] = factors.get(name, 1.0) * factor
    of_locks = {name: locks.curve[wanted] for name, wanted in WANTED.items() if wanted in locks.curve}
    if stiffened is not None:
        of_locks["bend"] = of_locks.get("bend", 1.0) * stiffened
    for name, factor in of_locks.items():
        factors[name] = factors.get(name, 1.0) * np.repeat(factor, locks.counts)
    return Strands(rest or locks, shot.strands, held_vertices(locks, shot.held), factors)


def steps_of(shot: Shot, fps: float) -> Stepping:
    """The steps of a shot at a frame rate."""
    return Stepping(1.0 / (fps * shot.solver.substeps), shot.solver.integrator)


def wanted_words(shot: Shot, groom: Groom) -> dict[str, Array | None]:
    """The words that a shot gives for each lock, shape (count,) each; None where it gives none."""

    def of(name: str) -> Array | None:
        if getattr(shot.motion, name) is None:
            return None
        setting = f"motion.{name}"
        random = Random(shot.motion.seed, setting)
        return per_lock(shot.motion, name, random, groom.locks, groom.scalp, f"shot: {setting}")

    return {name: of(name) for name in WORDS}


def with_words(shot: Shot, groom: Groom, of_cores: Mapping[str, Array] | None = None) -> Groom:
    """The groom whose locks have the factors on their material with which they move as the shot's words say.

    Locks that cannot, since they are pinned, fall over, or bounce faster by their weight alone, keep their material.
    Raises UserError for words that the steps of the shot cannot show.
    """
    words = wanted_words(shot, groom)
    if all(word is None for word in words.values()) or WANTED["bend"] in groom.locks.curve:
        return groom
    steps = steps_of(shot, groom.space.fps)
    _check_steps(shot, groom, steps, words)

    def material(which: NDArray[np.bool_], bend: Array) -> tuple[Array, Array]:
        """Factors for some locks that are so many times stiffer, as ``HangingLocks.material``."""
        rows = np.repeat(which, groom.locks.counts)
        part = _with_factors(replace(groom, locks=groom.locks.take(which)), bend[which], np.ones(which.sum()))
        strands = make_strands(shot, part, of_cores={name: of[rows] for name, of in (of_cores or {}).items()})
        hanging = hang(strands, part.locks.points, shot.forces.gravity, settle=sags)
        method = hanging.nearer_material if sags else hanging.material
        return method(steps, *(None if word is None else word[which] for word in words.values()))

    sags, pending = shot.rest.mode == "none", np.ones(len(groom.locks), bool)
    bend, damping = np.ones((2, len(groom.locks)))
    if not sags:
        bend, damping = (np.nan_to_num(of, nan=1.0) for of in material(pending, bend))
        return _with_factors(groom, bend, damping)
    met = ~pending
    for _ in range(ROUNDS):
        stiffer, of_pending = material(pending, bend)
        stiffer = np.nan_to_num(stiffer, nan=LARGEST)  # where they fall over
        damping[pending] = np.nan_to_num(of_pending, nan=1.0)
        met[pending] = np.abs(stiffer - 1.0) <= MET
        bend[pending] *= stiffer.clip(1.0 / LARGEST, LARGEST)
        pending[pending] = np.abs(stiffer - 1.0) > FOUND
        if not pending.any():
            break
    return _with_factors(groom, np.where(met, bend, 1.0), np.where(met, damping, 1.0))


def _with_factors(groom: Groom, bend: Array, damping: Array) -> Groom:
    """The groom whose locks have these factors on their material, shapes (count,)."""
    factors = {WANTED["bend"]: bend, WANTED["damping"]: damping}
    return replace(groom, locks=replace(groom.locks, curve=groom.locks.curve | factors))


def _check_steps(shot: Shot, groom: Groom, steps: Stepping, words: dict[str, Array | None]) -> None:
    """Refuses words that no lock can show at the steps of the shot."""
    bounce, settle = words["bounce"], words["settle"]
    if bounce is None:
        return
    settle = 1.0 / bounce if settle is None else settle  # one bounce at least is to be seen
    for lock in {int(bounce.argmax()), int(steps.wanted(bounce, settle).real.argmax())}:
        frequency, wanted, solver = float(bounce[lock]), float(settle[lock]), shot.solver
        if (longest := steps.longest(frequency)) >= wanted:
            continue
        enough = advised_steps(frequency, wanted, groom.space.fps)
        options = [f'solver.integrator = "{name}" and solver.substeps = {count}' for name, count in enough.items()]
        raise UserError(
            f"shot: motion.bounce is {frequency:.4g} Hz, to settle in {wanted:.3g} s, on lock {groom.locks.ids[lock]}; "
            f"{solver.integrator} with {solver.substeps} steps a frame settles it in {longest:.2g} s at most; "
            f"lower it, or set {', or '.join(options)}"
        )
