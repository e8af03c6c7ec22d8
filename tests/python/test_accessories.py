"""Accessories: meshes that locks carry rigidly."""

import numpy as np
import pytest
from ringlet.data.accessory import carried
from shapes import rotation


def test_a_mesh_goes_rigidly_with_what_carries_it():
    random = np.random.default_rng(1)
    points, carriers = random.normal(size=(5, 3)), random.normal(size=(7, 3))
    turn, shift = rotation((1, 2, 3), 50), np.array([0.2, -1.0, 3.0])
    np.testing.assert_allclose(
        carried(points, carriers, carriers @ turn.T + shift), points @ turn.T + shift, atol=1e-12
    )


@pytest.mark.parametrize("count", [1, 2, 5])
def test_carriers_on_a_line_turn_it_with_the_line_alone(count):
    along = np.linspace(0.0, 1.0, count)[:, None]
    a, b = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.6, 0.8])
    moved = carried(np.array([[0.5, 0.0, 0.0], [0.5, 0.0, 0.1]]), along * a, along * b)
    assert np.linalg.norm(moved[1] - moved[0]) == pytest.approx(0.1)
    if count > 1:
        np.testing.assert_allclose(moved[0], 0.5 * b, atol=1e-12)
        assert (moved[1] - moved[0]) @ b == pytest.approx(0.0, abs=1e-12)
