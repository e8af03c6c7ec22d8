"""Hairs of matted locks: how thick the lock is along its length, and how its hairs wander in the cross-section.

Locks carry this as curve attributes with KNOTS values each, from root to tip: ``strand_profile``, a factor on
``strand_radius``; ``strand_matting``, from 0 (hairs keep their places in the lock) to 1 (they wander through all of
it); ``strand_fuzz``, how far hairs stand off the surface [m].
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ringlet.data.curves import Curves
from ringlet.data.groom import STRAND_PROFILE
from ringlet.data.random import Random

KNOTS = 36  # from root to tip; every fifth is a knot of the frizz of other hair
PROFILE, MATTING, FUZZ = STRAND_PROFILE, "strand_matting", "strand_fuzz"
FUZZY = 0.25  # part of the knots at which a hair leaves the surface of a fully fuzzy lock


def with_profile(attributes: dict[str, NDArray], rows: NDArray, profile: NDArray) -> dict[str, NDArray]:
    """Curve attributes with a profile (KNOTS,) of some locks; hairs of locks without matting keep their places."""
    count = len(next(iter(attributes.values())))
    plain = {PROFILE: np.ones, MATTING: np.zeros, FUZZ: np.zeros}
    attributes = {**{name: make((count, KNOTS), np.float32) for name, make in plain.items()}, **attributes}
    attributes[PROFILE] = attributes[PROFILE].copy()
    attributes[PROFILE][rows] = profile
    return attributes


def is_felted(locks: Curves) -> bool:
    """Whether a lock is thicker in places or matted."""
    return PROFILE in locks.curve


def most_thick(locks: Curves) -> NDArray[np.floating]:
    """Largest factor on the radius along each lock, shape (locks,)."""
    return locks.curve[PROFILE].max(axis=1) if is_felted(locks) else np.ones(len(locks), np.float32)


def felted(
    locks: Curves, lock: NDArray, ids: NDArray, section: NDArray, radius: NDArray, frizz: NDArray, seed: int
) -> NDArray[np.float64]:
    """Offsets of hairs from their places in the cross-section [m], shape (hairs, 2 · KNOTS).

    lock:    lock of each hair, shape (hairs,)
    section: places in the cross-section relative to its radius, shape (hairs, 2); hairs at 0 stay there
    radius:  radius at the knots before the profile [m], shape (hairs, KNOTS)
    frizz:   offsets of hairs that are not matted [m], shape (hairs, 2 · knots)
    """
    random = Random(seed, "hairs/felt")
    count = len(ids)
    knots = frizz.reshape(count, -1, 2)
    at = np.linspace(0.0, knots.shape[1] - 1.0, KNOTS)
    i = np.minimum(at.astype(int), knots.shape[1] - 2)
    t = (at - i)[None, :, None]
    plain = knots[:, i] + t * t * (3.0 - 2.0 * t) * (knots[:, i + 1] - knots[:, i])

    free = (section != 0.0).any(axis=1)[:, None]
    matting, fuzz = (locks.curve[name][lock] * free for name in (MATTING, FUZZ))
    chance = random.uniforms(ids, 3 * KNOTS).reshape(count, KNOTS, 3)
    angle = 2.0 * np.pi * chance[:, :, 0]
    anywhere = np.sqrt(chance[:, :, 1])[:, :, None] * np.stack([np.cos(angle), np.sin(angle)], axis=2)
    place = section[:, None] + matting[:, :, None] * (anywhere - section[:, None])
    out = place / np.maximum(np.linalg.norm(place, axis=2, keepdims=True), 1e-9)
    stands = np.clip(1.0 - chance[:, :, 2] / FUZZY, 0.0, 1.0) * fuzz
    matted = radius[:, :, None] * (locks.curve[PROFILE][lock][:, :, None] * place - section[:, None])
    matted += stands[:, :, None] * out
    # Frizz is the noise of hair that is not matted.
    return ((1.0 - matting)[:, :, None] * plain + matted).reshape(count, -1)
