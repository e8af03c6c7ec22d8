"""The assembled energy of strands: gradient against finite differences, positive semi-definite Hessian."""

import numpy as np
import pytest
from coils import helix, jittered
from ringlet.data.curves import Curves
from ringlet.shot import Material
from ringlet.sim import Strands

CONTINUATIONS = ["history", "least_energy", "material_frame"]


def strands_of(points, **material):
    return Strands(Curves.from_list([points]), Material(**material), 3)


@pytest.mark.parametrize("continuation", CONTINUATIONS)
@pytest.mark.parametrize("hand", [1, -1])
@pytest.mark.parametrize("per_turn", [5, 12, 24])
def test_gradient_agrees_with_finite_differences(continuation, hand, per_turn):
    rest = helix(24, per_turn=per_turn, hand=hand)
    strand = strands_of(rest, stretch_scale=1.0)
    x = jittered(rest, 2e-4, seed=per_turn, prescribed=3)
    _, gradient, _ = strand.energy(x, continuation=continuation)
    h, expected = 1e-8, np.zeros_like(x)
    for i in range(3, len(x)):
        for k in range(3):
            step = np.zeros_like(x)
            step[i, k] = h
            up, down = (strand.energy(x + s * step, continuation=continuation)[0] for s in (1, -1))
            expected[i, k] = (up - down) / (2 * h)
    assert np.abs(gradient - expected).max() < 1e-6 * np.abs(expected).max()
    assert not gradient[:3].any(), "prescribed vertices have no gradient"


@pytest.mark.parametrize("continuation", CONTINUATIONS)
@pytest.mark.parametrize("amount", [0.0, 1e-4, 1e-2])
def test_hessian_is_symmetric_and_positive_semidefinite(continuation, amount):
    rest = helix(30)
    _, _, hessian = strands_of(rest).energy(jittered(rest, amount), continuation=continuation, hessian=True)
    values = np.linalg.eigvalsh(hessian)
    assert (hessian == hessian.T).all()
    assert values[0] > -1e-12 * values[-1]


@pytest.mark.parametrize("continuation", CONTINUATIONS)
def test_the_rest_shape_has_zero_energy_and_gradient(continuation):
    rest = helix(60)
    energy, gradient, _ = strands_of(rest).energy(rest, continuation=continuation)
    assert energy < 1e-25
    assert np.abs(gradient).max() < 1e-12


@pytest.mark.parametrize("shape", ["straight", "folded", "coincident"])
@pytest.mark.parametrize("continuation", CONTINUATIONS)
def test_degenerate_shapes_have_finite_energy_gradient_and_hessian(shape, continuation):
    rest = helix(20)
    x = rest.copy()
    along = np.array([0.0, -1e-3, 0.0])
    if shape == "straight":
        x[3:] = rest[2] + along * np.arange(1, 18)[:, None]
    elif shape == "folded":
        x[3:] = rest[2] + along * (np.arange(1, 18) % 2)[:, None]
    else:
        x[10] = x[9]
    energy, gradient, hessian = strands_of(rest).energy(x, continuation=continuation, hessian=True)
    assert np.isfinite(energy) and np.isfinite(gradient).all() and np.isfinite(hessian).all()
