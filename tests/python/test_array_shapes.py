"""Arrays whose rows do not fit are refused before the core reads them."""

import numpy as np
import pytest
from ringlet.data.curves import Curves
from ringlet.data.mesh import Mesh
from ringlet.shot.material import Material
from ringlet.sim.cloth import Cloth
from ringlet.sim.strands import Strands

STRAND = np.array([[0.0, -0.01 * k, 0.0] for k in range(6)])
SQUARE = Mesh("square", np.array([[0.0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]]), np.array([[0, 1, 2], [0, 2, 3]]))


def strands():
    return Strands(Curves.from_list([STRAND]), Material())


@pytest.mark.parametrize("make", [strands, lambda: Cloth(SQUARE)], ids=["strands", "cloth"])
@pytest.mark.parametrize("rows", [0, 1, 1000])
def test_rows_that_do_not_fit_are_refused(make, rows):
    moving = make()
    wrong = np.zeros((rows, 3))
    calls = [
        lambda: moving.step(wrong, 0.01),
        lambda: moving.step(moving.positions.copy(), 0.01, forces=wrong),
        lambda: moving.energy(wrong),
        *([lambda: moving.place(wrong)] if hasattr(moving, "place") else []),
    ]
    for call in calls:
        with pytest.raises(ValueError, match=r"strands|cloth"):
            call()
