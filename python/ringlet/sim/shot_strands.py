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
from ringlet.motion import STIFFNESS, HangingLocks, Stepping, advised_steps, find_stiffness
from ringlet.shot.shot import Shot
from ringlet.sim.hair_pins import held_vertices
from ringlet.sim.hanging import NEARLY_STILL, hang
from ringlet.sim.strands import Strands
from ringlet.sim.variation import material_factors
from ringlet.sim.worn import worn_factors

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# Attributes of locks: factors on their material, by its variation, with which they move as words say.
WANTED = {"bend": "wanted_bend", "damping": "wanted_damping"}
ASKED = "asked_"  # begins the names of attributes of locks with the words that are asked of them


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


def wanted_words(shot: Shot, groom: Groom) -> dict[str, Array]:
    """The words that a shot gives, by name, with the value of each lock as it stands there, shape (count,)."""

    def of(name: str) -> Array:
        setting = f"motion.{name}"
        random = Random(shot.motion.seed, setting)
        return per_lock(shot.motion, name, random, groom.locks, groom.scalp, f"shot: {setting}")

    return {name: of(name) for name in shot.motion.given}


def with_words(shot: Shot, groom: Groom, of_cores: Mapping[str, Array] | None = None) -> Groom:
    """The groom whose locks have the factors on their material with which they move as the shot's words say.

    Locks that cannot, since they are pinned, fall over, or bounce faster by their weight alone, keep their material.
    Raises UserError for words that the steps of the shot cannot show.
    """
    given = wanted_words(shot, groom)
    if not given or WANTED["bend"] in groom.locks.curve:
        return groom
    steps, sags = steps_of(shot, groom.space.fps), shot.rest.mode == "none"
    # Where all locks hang, as far as that is known: to recall it is fast, to place them not.
    states: dict[str, Array] = {}

    def hanging(which: Mask, bend: Array, settle: bool) -> HangingLocks:
        """Some locks that are so many times stiffer; the first time all of them."""
        vertices = np.repeat(which, groom.locks.counts)

        def rows(of: Array) -> Mask:
            return vertices if len(of) == len(vertices) else which

        part = _with_factors(replace(groom, locks=groom.locks.take(which)), bend, np.ones(len(bend)))
        strands = make_strands(shot, part, of_cores={name: of[vertices] for name, of in (of_cores or {}).items()})
        if states:
            strands.recall({name: of[rows(of)] for name, of in states.items()})
        hung = hang(strands, part.locks.points, shot.forces.gravity, settle=settle, still=NEARLY_STILL)
        for name, of in strands.memory.items():
            states.setdefault(name, of)[rows(states[name])] = of
        return hung

    everything, ones = np.ones(len(groom.locks), bool), np.ones(len(groom.locks))
    of_hair = {name for name in given if getattr(shot.motion, name).of_hair}
    searched = sags and bool(STIFFNESS & given.keys())
    own = hanging(everything, ones, sags and (bool(of_hair) or not searched))
    words = {name: value * (getattr(own.words(), name) if name in of_hair else 1.0) for name, value in given.items()}
    _check_steps(shot, groom, steps, words)

    def excess(which: Mask, logarithm: Array) -> Array:
        of_which = {name: word[which] for name, word in words.items()}
        return hanging(which, np.exp(logarithm), True).excess(steps, of_which)

    if searched:
        # Locks begin with what they need as long as they hang as groomed.
        begin = np.zeros(len(ones)) if "sag" in words else np.log(np.nan_to_num(own.material(steps, words)[0], nan=1.0))
        logarithm, met = find_stiffness(excess, begin)
        bend, damping = np.where(met, np.exp(logarithm), np.nan), ones
        if "settle" in words:
            damping = hanging(everything, np.where(met, bend, 1.0), True).damping(steps, words)
    else:
        bend, damping = own.material(steps, words)
    kept = np.isnan(bend)
    made = _with_factors(groom, np.where(kept, 1.0, bend), np.where(kept, 1.0, np.nan_to_num(damping, nan=1.0)))
    made.locks.curve.update({f"{ASKED}{name}": word for name, word in words.items()})
    return made


def _with_factors(groom: Groom, bend: Array, damping: Array) -> Groom:
    """The groom whose locks have these factors on their material, shapes (count,)."""
    factors = {WANTED["bend"]: bend, WANTED["damping"]: damping}
    return replace(groom, locks=replace(groom.locks, curve=groom.locks.curve | factors))


def _check_steps(shot: Shot, groom: Groom, steps: Stepping, words: Mapping[str, Array]) -> None:
    """Refuses words that no lock can show at the steps of the shot."""
    if "bounce" not in words or np.isnan(words["bounce"]).all():
        return
    bounce = words["bounce"]
    settle = words.get("settle", 1.0 / bounce)  # one bounce at least is to be seen
    for lock in {int(np.nanargmax(of)) for of in (bounce, steps.wanted(bounce, settle).real)}:
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
