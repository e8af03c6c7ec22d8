"""Staleness: whether a stored rest shape still fits the settings, the bodies and the locks that it depends on."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.digest import digest
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.shot.motion import WORDS
from ringlet.shot.shot import Shot
from ringlet.shot.variation import VARIATIONS
from ringlet.sim.hair_pins import spring_fraction
from ringlet.sim.obstacle import Obstacle
from ringlet.sim.shot_strands import wanted_words
from ringlet.sim.variation import at_vertices, material_factors

PINNED = (
    "pin",
    "led_by_pin",
)  # values at vertices: how firmly a pin holds, and the fraction of a step that it leads
SAME_PLACE = 1e-6  # points closer than this are the same: a file in single precision rounds them [m]

# The settings that a rest shape depends on. `rest.gain` and the variation are stored as their values at the vertices.
_SETTINGS = {
    "held": True,
    "strands": True,
    "forces": True,
    "rest": {"stiffen", "spring", "iterations", "tolerance"},
    "solver": {"extra", "until_converged", "system", "integrator", "continuation", "safeguards"},
}


def rest_mode(shot: Shot) -> str:
    """The mode of rest shapes that a shot asks for; by default it is a loft."""
    return "lofted" if shot.rest.mode == "none" else shot.rest.mode


def dependencies(shot: Shot, obstacles: Sequence[Obstacle] = ()) -> dict[str, Any]:
    """The settings of a shot that a rest shape depends on, and what locks may lie on, as plain values."""
    settings = shot.model_dump(mode="json", include=_SETTINGS)
    made = {**settings, "rest": {**settings["rest"], "mode": rest_mode(shot)}}
    if shot.motion.given:
        of_hair = [name for name in shot.motion.given if getattr(shot.motion, name).of_hair]
        made["motion"] = {"seed": shot.motion.seed, "substeps": shot.solver.substeps}
        made["motion"] |= {"of_hair": of_hair} if of_hair else {}
    if shot.touching and rest_mode(shot) == "equilibrium":
        made["contact"] = shot.touching.model_dump(mode="json", include={"radius", "friction", "pair"})
        made["bodies"] = {body.name: _of_body(body) for body in obstacles}
    return made


def _of_body(body: Obstacle) -> dict[str, Any]:
    """The properties of a body that support depends on."""
    return {
        "thickness": body.settings.thickness,
        "friction": body.settings.friction,
        "shape": digest(np.asarray(body.mesh.points, np.float32), body.mesh.triangles)[:8],
    }


def values_at_vertices(shot: Shot, groom: Groom) -> dict[str, NDArray[np.float64]]:
    """The values at vertices that a rest shape depends on besides their positions, by name, shape (n,) each."""
    values = {"gain": at_vertices(shot.rest, "gain", groom, "rest.gain"), **material_factors(shot, groom)}
    for name, word in wanted_words(shot, groom).items():
        values[name] = np.repeat(word, groom.locks.counts)
    if "pin" in groom.locks.point:
        led = spring_fraction(groom.locks, 1.0 / (groom.space.fps * shot.solver.substeps))
        values |= dict(zip(PINNED, (groom.locks.point["pin"], led), strict=True))
    return values


def same_locks(stored: Curves, groom: Groom) -> bool:
    """Whether a stored rest shape has the locks of a groom, with as many points each."""
    return np.array_equal(stored.ids, groom.locks.ids) and np.array_equal(stored.offsets, groom.locks.offsets)


def changed_locks(stored: Curves, shot: Shot, groom: Groom) -> NDArray[np.bool_]:
    """Locks of a groom that differ from those of a stored rest shape, shape (count,)."""
    changed = np.linalg.norm(stored.point["groomed"] - groom.locks.points, axis=1) > SAME_PLACE
    values = values_at_vertices(shot, groom)
    defaults = {"gain": 1.0, **dict.fromkeys(VARIATIONS, 1.0), **dict.fromkeys((*PINNED, *WORDS), 0.0)}
    for name, default in defaults.items():
        old, now = (np.asarray(of.get(name, np.full(len(changed), default))) for of in (stored.point, values))
        changed |= np.abs(old - now) > 1e-5 * np.maximum(now, 1e-3)
    return np.logical_or.reduceat(changed, groom.locks.offsets[:-1])


def check_current(
    stored: Curves,
    made: dict[str, Any],
    shot: Shot,
    groom: Groom,
    path: Path,
    *,
    obstacles: Sequence[Obstacle] = (),
    allow_stale: bool,
) -> Curves:
    """The stored rest shape, if it fits; refuses one that was made from another groom, material or forces."""
    again = f"make it again with: ringlet loft {shot.path or 'SHOT.toml'}"
    if not same_locks(stored, groom):
        raise UserError(f"{path}: was made from other locks ({len(stored)}, the groom has {len(groom.locks)}); {again}")
    if allow_stale:
        return stored
    reason = next(_differences(made, dependencies(shot, obstacles)), None)
    if reason is None and (changed := changed_locks(stored, shot, groom)).any():
        reason = f"{changed.sum()} of {len(changed)} locks or their material have changed"
    if reason is not None:
        raise UserError(f"{path}: is stale, {reason}; {again}, or use it as it is with --allow-stale")
    return stored


def _differences(old: Any, now: Any, name: str = "") -> Iterator[str]:
    """Settings that differ, one sentence each."""
    if isinstance(old, dict) and isinstance(now, dict):
        for key in sorted({*old, *now}):
            yield from _differences(old.get(key), now.get(key), f"{name}.{key}".removeprefix("."))
    elif old != now:
        yield f"{name} was {old} and is {now}"
