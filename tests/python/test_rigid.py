"""Rotation vectors and matrices are one another's inverse, and turn as the right hand says."""

from __future__ import annotations

import numpy as np
import pytest
from ringlet.data.rigid import rotate, rotation_matrix, rotation_vector


def test_a_quarter_turn_about_z_takes_x_to_y() -> None:
    turn = np.array([0.0, 0.0, 0.5 * np.pi])
    assert rotation_matrix(turn) @ [1.0, 0.0, 0.0] == pytest.approx([0.0, 1.0, 0.0], abs=1e-15)
    assert rotate(np.array([[1.0, 0.0, 0.0]]), turn[None])[0] == pytest.approx([0.0, 1.0, 0.0], abs=1e-15)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 0.3, 2.0, 3.1])
def test_the_vector_of_a_matrix_is_that_which_made_it(angle: float) -> None:
    axis = np.array([2.0, -1.0, 2.0]) / 3.0
    matrix = rotation_matrix(angle * axis)
    assert matrix @ matrix.T == pytest.approx(np.eye(3), abs=1e-14)
    assert rotation_vector(matrix) == pytest.approx(angle * axis, abs=1e-12)
