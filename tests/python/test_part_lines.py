"""Part lines are as straight as they are drawn, however few guides there are."""

import numpy as np
import pytest
from shapes import ball

from ringlet.groom import make_groom, parse_recipe

DRAWN = "[curves.line]\npoints = [[1, 5, 8], [1, 9, 0], [1, 5, -8]]\n"


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
