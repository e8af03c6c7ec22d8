"""Roots, lengths, hairs, and the same groom again, after an edit, and from its file."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from judged import SINGLE, check_curves, grown, same
from numpy.random import Generator
from random_recipe import Settings
from shapes import ball

import ringlet
from ringlet import Memory
from ringlet.groom import make_hairs


def attempt(random: Generator, folder: Path) -> None:
    settings = Settings(random, "recipe")
    table, scalp = settings.recipe(), ball()
    groom = grown(table, scalp)
    check_curves(groom.locks, scalp, "locks")
    assert (groom.locks.counts == table["locks"]["points"]).all(), "locks have another number of points"
    lengths = groom.locks.lengths()
    assert (lengths > 0.0).all(), "a lock of no length"
    same(grown(table, scalp).locks.points, groom.locks.points, 0.0, "the same recipe again")

    hairs = make_hairs(groom)
    check_curves(hairs.curves, scalp, "hairs")
    some = make_hairs(groom, fraction=0.5)
    rows = np.searchsorted(hairs.curves.ids, some.curves.ids)
    if len(hairs.curves) > 1 and (np.diff(hairs.curves.ids) > 0).all():
        whole = hairs.curves.points.reshape(len(hairs.curves), -1, 3)[rows]
        same(some.curves.points.reshape(whole.shape), whole, 1e-6, "half of the hairs")

    memory = Memory()
    other = json.loads(json.dumps(table))
    other["seed"] += 1
    for one in (other, table):
        kept = grown(one, scalp, memory)
    same(kept.locks.points, groom.locks.points, 0.0, "after an edit and back")

    ringlet.write_groom(groom, folder / "g.usdc")
    read = ringlet.read_groom(folder / "g.usdc")
    same(read.locks.points, groom.locks.points, SINGLE, "from its file")
    assert (read.locks.ids == groom.locks.ids).all()
