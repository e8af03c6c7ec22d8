"""Denoising of pictures: fireflies, noise and edges."""

from __future__ import annotations

import numpy as np
import pytest
from ringlet.picture.denoise import denoise
from ringlet.picture.passes import Passes


def accumulate(passes: np.ndarray) -> Passes:
    """Accumulates passes of a picture, shape (count, height, width, 4)."""
    added = Passes()
    for image in passes:
        added.add(image)
    return added


def test_fireflies_are_spread_over_their_neighbourhood_and_light_is_conserved() -> None:
    passes = np.full((5, 40, 40, 4), 0.5)
    passes[2, 20, 20, :3] += 5.0  # a firefly in one pass
    total = passes.sum(axis=0)
    even, odd = accumulate(passes).without_specks()
    denoised = even + odd
    assert denoised[20, 20, 0] < 0.6 * total[20, 20, 0]
    assert denoised[:, :, :3].sum() == pytest.approx(total[:, :, :3].sum(), rel=1e-3)
    assert np.array_equal(denoised[:, :, 3], total[:, :, 3])
    assert even[20, 20, 0] / odd[20, 20, 0] < 2.0  # three passes against two, with the firefly removed from its half


@pytest.mark.parametrize("where", [0, 1, 2])
def test_fireflies_leave_no_dot_on_noisy_skin(where: int) -> None:
    passes = np.random.default_rng(where).uniform(0.4, 0.6, (3, 40, 40, 4))
    passes[where, 20, 20, :3] += 5.0
    accumulated = accumulate(passes)
    denoised = accumulated.without_noise(accumulated.without_specks())
    around = denoised[14:27, 14:27, :3]
    assert np.abs(denoised[20, 20, :3] - around.mean()).max() < 0.1


def test_denoising_removes_noise_and_keeps_edges() -> None:
    clean = np.full((60, 60, 4), 0.2)
    clean[:, 30:] = 0.8
    noise = np.random.default_rng(4).normal(0.0, 0.05, clean.shape)
    other = np.random.default_rng(5).normal(0.0, 0.05, clean.shape)
    denoised = denoise(clean + noise, clean + other, np.full(clean.shape, 0.05**2))
    assert np.abs(denoised - clean).mean() < 0.3 * np.abs(noise).mean()
    assert (denoised[:, 30] - denoised[:, 29]).min() > 0.5
    assert np.allclose(denoise(clean, clean, np.zeros(clean.shape)), clean, atol=1e-3)


@pytest.mark.parametrize("passes", [3, 4, 5, 10])
def test_cross_filtering_leaves_less_noise_than_self_filtering(passes: int) -> None:
    light = np.random.default_rng(passes).uniform(0.0, 1.0, (passes, 80, 80, 1)).repeat(4, axis=3)
    mean, variance = light.mean(axis=0), light.var(axis=0, ddof=1)
    accumulated = accumulate(light)
    denoised = accumulated.without_noise([light[::2].sum(axis=0), light[1::2].sum(axis=0)])
    assert denoised.std() < 0.8 * denoise(mean, mean, variance / passes).std()
    assert denoised.mean() == pytest.approx(mean.mean(), rel=5e-3)
