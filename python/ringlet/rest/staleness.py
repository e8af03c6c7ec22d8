"""Whether a lofted shape still fits: it is kept with what it was made from, lock by lock."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.rest.equilibrium import equilibrium, external_loads, support_forces
from ringlet.rest.loft import Loft, Progress, largest_per_lock
from ringlet.rest.preload import loft
from ringlet.shot.shot import Shot
from ringlet.shot.variation import VARIATIONS
from ringlet.sim.checkpoint import digest
from ringlet.sim.motion import make_strands
from ringlet.sim.nails import spring_fraction
from ringlet.sim.obstacle import Obstacle
from ringlet.sim.variation import at_vertices, material_factors

NAILED = ("nail", "led_by_nail")  # how firmly, and what comes of it in a step
KNOWN_OR_NOT = ("sagged", "borne")  # of a loft
BARELY = 1e-4  # of a lock's weight: how much of it may be borne otherwise before it counts as changed
SAME_PLACE = 1e-6  # points closer than this are the same: a file in single precision rounds them [m]

# What a loft does not depend on, besides `rest.gain` and the variation, which are kept as their values at the vertices.
_FREE = {
    **dict.fromkeys(
        ("ringlet", "name", "groom", "frames", "preroll", "variation", "contact", "collider", "cloth"), True
    ),
    "solver": {"newton", "substeps", "tolerance", "linear_tolerance"},
    "rest": {"mode", "file", "gain"},
}


def dependencies(shot: Shot, obstacles: Sequence[Obstacle] = ()) -> dict[str, Any]:
    """The settings of a shot that a loft depends on, and what locks may lie on, as plain values."""
    settings = shot.model_dump(mode="json", exclude=_FREE)
    made = {**settings, "rest": {**settings["rest"], "mode": _mode(shot)}}
    if shot.touching and _mode(shot) == "equilibrium":
        of_locks = {"radius", "friction", "pair"}
        made["contact"] = shot.touching.model_dump(mode="json", include=of_locks)
        made["bodies"] = {one.name: _told(one) for one in obstacles}
    return made


def _told(body: Obstacle) -> dict[str, Any]:
    """What of a body bears locks."""
    points = np.asarray(body.mesh.points, np.float32)
    told = {"thickness": body.settings.thickness, "friction": body.settings.friction}
    return {**told, "shape": digest(points, body.mesh.triangles)[:8]}


def solve_rest_shape(
    shot: Shot,
    groom: Groom,
    *,
    obstacles: Sequence[Obstacle] = (),
    borne: NDArray[np.float64] | None = None,
    frames: NDArray[np.float64] | None = None,
    progress: Progress | None = None,
) -> Loft:
    """The rest shape that a shot asks for; one that asks for none gets a loft. See ``equilibrium``."""
    if _mode(shot) == "equilibrium":
        return equilibrium(shot, groom, obstacles=obstacles, borne=borne, frames=frames, progress=progress)
    return loft(shot, groom, progress=progress)


def _mode(shot: Shot) -> str:
    return "lofted" if shot.rest.mode == "none" else shot.rest.mode


def to_curves(loft: Loft, shot: Shot) -> Curves:
    """The rest shape of a loft with all that it was made from, and what it does, as attributes."""
    rest = loft.rest
    point = {"groomed": loft.groom.locks.points, "lofted": loft.lofted, **_values(shot, loft.groom)}
    point |= {name: values for name in KNOWN_OR_NOT if (values := getattr(loft, name)) is not None}
    curve = {"off": loft.off, "moving": loft.moving}
    if loft.stiffened is not None:
        curve["stiffened"] = loft.stiffened
    floats = {name: np.asarray(values, np.float32) for name, values in point.items()}
    return Curves(rest.points, rest.offsets, rest.ids, curve, floats)


def from_curves(kept: Curves, groom: Groom) -> Loft:
    """The loft that ``to_curves`` kept, of the same locks."""
    lofted, off, moving = kept.point["lofted"], kept.curve["off"].copy(), kept.curve["moving"].copy()
    stiffened = kept.curve["stiffened"].copy() if "stiffened" in kept.curve else None
    known = (np.asarray(kept.point[name], np.float64) if name in kept.point else None for name in KNOWN_OR_NOT)
    sagged, borne = known
    return Loft(groom, kept, sagged, np.asarray(lofted, np.float64), off, moving, stiffened, borne)


def update_rest_shape(
    shot: Shot,
    groom: Groom,
    kept: Curves,
    made: dict[str, Any],
    *,
    obstacles: Sequence[Obstacle] = (),
    progress: Progress | None = None,
) -> Loft:
    """The loft of a groom; locks that have not changed since a kept one was made are taken from it."""
    if not same_locks(kept, groom):
        return solve_rest_shape(shot, groom, obstacles=obstacles, progress=progress)
    whole, changed = from_curves(kept, groom), changed_locks(kept, shot, groom)
    if made != (now := dependencies(shot, obstacles)):
        same = not changed.any() and _weight_and_rests(made) == _weight_and_rests(now)
        return solve_rest_shape(
            shot, groom, obstacles=obstacles, borne=whole.borne if same else None, progress=progress
        )
    if not changed.any():
        return whole
    borne, known = None, {}
    if whole.borne is not None:
        strands = make_strands(shot, groom)
        frames = strands.directors.copy()
        borne = support_forces(shot, groom, obstacles, strands)
        changed |= _borne_otherwise(external_loads(shot, strands), groom.locks, whole.borne, borne)
        known = {"borne": borne, "frames": frames}
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
    return replace(whole, borne=borne, sagged=None if part.sagged is None else whole.sagged)


def _weight_and_rests(made: dict[str, Any]) -> dict[str, Any]:
    """Of the settings that a loft was made from, those that say how heavy locks are and what they rest on.

    Where only stiffness has changed, what bore the locks can bear them still.
    """
    of_weight = {name: made["strands"][name] for name in ("radius", "density", "drag", "correct_resolution")}
    return {**{name: made[name] for name in made if name not in ("rest", "solver")}, "strands": of_weight}


def _borne_otherwise(
    pulls: NDArray[np.float64], locks: Curves, before: NDArray[np.float64], now: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Which locks are borne otherwise than before, since those that they touch have changed, shape (count,)."""
    weight = np.add.reduceat(np.linalg.norm(pulls, axis=1), locks.offsets[:-1])
    return largest_per_lock(locks, np.linalg.norm(now - before, axis=1)) > BARELY * weight


def same_locks(kept: Curves, groom: Groom) -> bool:
    """Whether a kept shape has the locks and the points of a groom, wherever they are."""
    return np.array_equal(kept.ids, groom.locks.ids) and np.array_equal(kept.offsets, groom.locks.offsets)


def changed_locks(kept: Curves, shot: Shot, groom: Groom) -> NDArray[np.bool_]:
    """Which locks of a groom, the same ones, are not those that a kept shape was made from, shape (count,)."""
    changed = np.linalg.norm(kept.point["groomed"] - groom.locks.points, axis=1) > SAME_PLACE
    values = _values(shot, groom)
    for name, default in {"gain": 1.0, **dict.fromkeys(VARIATIONS, 1.0), **dict.fromkeys(NAILED, 0.0)}.items():
        old, now = (np.asarray(of.get(name, np.full(len(changed), default))) for of in (kept.point, values))
        changed |= np.abs(old - now) > 1e-5 * np.maximum(now, 1e-3)
    return np.logical_or.reduceat(changed, groom.locks.offsets[:-1])


def check_current(
    kept: Curves,
    made: dict[str, Any],
    shot: Shot,
    groom: Groom,
    path: Path,
    *,
    obstacles: Sequence[Obstacle] = (),
    allow_stale: bool,
) -> Curves:
    """The kept shape, as long as it fits; refuses one that was made from another groom, material or forces."""
    again = f"make it again with: ringlet loft {shot.path or 'SHOT.toml'}"
    if not same_locks(kept, groom):
        raise UserError(f"{path}: was made from other locks ({len(kept)}, the groom has {len(groom.locks)}); {again}")
    if allow_stale:
        return kept
    reason = next(_differences(made, dependencies(shot, obstacles)), None)
    if reason is None and (changed := changed_locks(kept, shot, groom)).any():
        reason = f"{changed.sum()} of {len(changed)} locks or their material have changed"
    if reason is not None:
        raise UserError(f"{path}: is stale, {reason}; {again}, or use it as it is with --allow-stale")
    return kept


def _values(shot: Shot, groom: Groom) -> dict[str, NDArray[np.float64]]:
    """What a lock's rest shape depends on besides its points, at the vertices, shape (n,) each."""
    values = {"gain": at_vertices(shot.rest.gain, groom, "rest.gain"), **material_factors(shot.variation, groom)}
    if "nail" in groom.locks.point:
        led = spring_fraction(groom.locks, 1.0 / (groom.space.fps * shot.solver.substeps))
        values |= dict(zip(NAILED, (groom.locks.point["nail"], led), strict=True))
    return values


def _differences(old: Any, now: Any, name: str = "") -> Iterator[str]:
    """What settings were and are, one sentence each."""
    if isinstance(old, dict) and isinstance(now, dict):
        for key in sorted({*old, *now}):
            yield from _differences(old.get(key), now.get(key), f"{name}.{key}".removeprefix("."))
    elif old != now:
        yield f"{name} was {old} and is {now}"
