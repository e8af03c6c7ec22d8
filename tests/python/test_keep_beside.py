"""Hairs that join a row all along it are kept out of surfaces as if each were alone."""

from __future__ import annotations

import numpy as np
from shapes import sheet

from ringlet import _core

HAIRS, POINTS, MARGIN = 400, 24, 1e-4


def kept(lock, first, hairs, join, mesh):
    points = np.ascontiguousarray(np.concatenate([lock] * (len(first) - 1)), np.float32)
    offsets = (np.arange(len(first)) * len(lock)).astype(np.int32)
    hold = np.zeros(POINTS, np.float32)
    hold[0] = 1.0
    moved = _core.keep_beside(
        points,
        offsets,
        hairs,
        mesh.points,
        mesh.triangles,
        MARGIN,
        first=np.asarray(first, np.int32),
        tip=np.ones(HAIRS, np.float32),
        join=join,
        flat=np.zeros(HAIRS, np.float32),
        hold=hold,
        pace=np.linspace(0.0, 1.0, POINTS, dtype=np.float32),
        shares=None,
    )
    return moved, hairs


def test_hairs_of_a_row_are_kept_as_if_each_were_alone():
    random = np.random.default_rng(5)
    mesh = sheet(cells=120, size=0.3)
    lock = np.c_[np.linspace(-0.12, 0.12, 60), np.full(60, 2e-3), np.zeros(60)]
    join = random.uniform(0.0, 0.8, HAIRS).astype(np.float32)
    u = join[:, None] + (1.0 - join[:, None]) * np.linspace(0.0, 1.0, POINTS)
    along = np.stack([np.interp(u, np.linspace(0, 1, 60), lock[:, k]) for k in range(3)], axis=-1)
    hairs = (along + random.normal(0.0, 2e-3, along.shape)).astype(np.float32).reshape(-1, 3)
    moved, together = kept(lock, [0, HAIRS], hairs.copy(), join, mesh)
    _, alone = kept(lock, range(HAIRS + 1), hairs.copy(), join, mesh)
    assert moved > HAIRS / 2
    np.testing.assert_array_equal(together, alone)
