"""Part lines are as straight as they are drawn, however few guides there are."""

import numpy as np
import pytest
from shapes import ball

from ringlet.groom import make_groom, make_hairs, parse_recipe

ARC = [[1.0, round(float(np.sqrt(80.0 - z * z)), 3), float(z)] for z in range(8, -9, -1)]  # on the ball
DRAWN = f"[curves.line]\npoints = {ARC}\n"


@pytest.mark.parametrize("part", ["offset = 1", "curve = 'line'"])
def test_locks_part_along_the_line_and_not_between_guides(part):
    recipe = (
        f"ringlet = 2\n[scalp]\nregion = 'scalp'\n{DRAWN}[guides]\ncount = 40\nlength = 6\nlift = 0.2\nwhorl = false\n"
        f"flow = [0, -1, 0]\npart_line = {{ {part}, falloff = 3 }}\n[locks]\ncount = 1500\n"
    )
    locks = make_groom(parse_recipe(recipe), ball()).shapes
    off = locks.roots[:, 0] - 0.01
    lean = locks.points.reshape(len(locks), -1, 3)[:, 5, 0] - locks.roots[:, 0]
    near = (np.abs(off) < 0.01) & (np.abs(off) > 0.0005) & (locks.roots[:, 1] > 0.06)
    assert near.sum() > 60
    assert (np.sign(lean[near]) == np.sign(off[near])).mean() > 0.98


@pytest.mark.parametrize("part", ["offset = 1", "curve = 'line'"])
def test_hairs_part_along_the_line_and_not_in_steps_of_their_locks(part):
    recipe = (
        f"ringlet = 2\n[scalp]\nregion = 'scalp'\n{DRAWN}[guides]\ncount = 40\nlength = 6\nlift = 0.2\nwhorl = false\n"
        f"flow = [0, -1, 0]\npart_line = {{ {part}, falloff = 3 }}\n[locks]\ncount = 600\n[hairs]\ndensity = 150\n"
    )
    groom = make_groom(parse_recipe(recipe), ball())
    hairs = make_hairs(groom).curves
    off, along = hairs.roots[:, 0] - 0.01, hairs.roots[:, 2]
    of_lock = (groom.locks.roots[:, 0] - 0.01)[hairs.curve["lock"]]
    near = (np.abs(off) < 0.01) & (hairs.roots[:, 1] > 0.07)
    assert near.sum() > 1500
    assert (np.sign(off[near]) == np.sign(of_lock[near])).mean() > 0.995
    steps = [
        np.abs(off[near & (side * off > 0.0) & (np.abs(along - z) < 0.001)]).min()
        for side in (-1.0, 1.0)
        for z in np.arange(-0.04, 0.04, 0.002)
    ]
    assert np.mean(steps) < 5e-4 and max(steps) < 0.0015


def test_hairs_are_as_dense_beside_a_part_line_as_elsewhere():
    recipe = (
        "ringlet = 2\n[scalp]\nregion = 'scalp'\n[guides]\ncount = 40\nlength = 6\nlift = 0.2\nwhorl = false\n"
        "flow = [0, -1, 0]\npart_line = { offset = 1, falloff = 3 }\n[locks]\ncount = 600\n[hairs]\ndensity = 400\n"
    )
    roots = make_hairs(make_groom(parse_recipe(recipe), ball())).curves.roots
    top = roots[np.abs(roots[:, 2]) < 0.04]
    bands = np.arange(-0.016, 0.0161, 0.002)  # across the line
    counts = np.histogram(top[:, 0] - 0.01, bands)[0]
    assert np.abs(counts / counts.mean() - 1.0).max() < 0.12
