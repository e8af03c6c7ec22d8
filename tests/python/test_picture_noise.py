"""Denoising of pictures: fireflies, noise and edges."""

from __future__ import annotations

import numpy as np
import pytest
import scipy
from ringlet.picture import oidn
from ringlet.picture.hair_field import HairField
from ringlet.picture.passes import Passes

pytest.importorskip("pyoidn")


def accumulate(passes: np.ndarray) -> Passes:
    """Accumulates passes of a picture, shape (count, height, width, 4)."""
    added = Passes()
    for image in passes:
        added.add(image)
    return added


def test_fireflies_are_spread_over_their_neighbourhood_and_light_is_conserved() -> None:
    passes = np.full((5, 40, 40, 4), 0.5)
    passes[2, 20, 20, :3] += 5.0  # a firefly in one pass
    mean = passes.mean(axis=0)
    denoised = accumulate(passes).without_specks()
    assert denoised[20, 20, 0] < 0.6 * mean[20, 20, 0]
    assert denoised[:, :, :3].sum() == pytest.approx(mean[:, :, :3].sum(), rel=1e-3)
    assert np.array_equal(denoised[:, :, 3], mean[:, :, 3])


@pytest.mark.parametrize("where", [0, 1, 2])
def test_fireflies_leave_no_dot_on_noisy_skin(where: int) -> None:
    passes = np.random.default_rng(where).uniform(0.4, 0.6, (3, 40, 40, 4))
    passes[where, 20, 20, :3] += 5.0
    denoised = oidn.denoise(accumulate(passes).mean())
    around = denoised[14:27, 14:27, :3]
    assert np.abs(denoised[20, 20, :3] - around.mean()).max() < 0.1


def test_denoising_removes_noise_and_keeps_edges() -> None:
    clean = np.full((60, 60, 4), 0.2)
    clean[:, 30:] = 0.8
    noise = np.random.default_rng(4).normal(0.0, 0.05, clean.shape)
    denoised = oidn.denoise(clean + noise)
    assert np.abs(denoised - clean).mean() < 0.3 * np.abs(noise).mean()
    assert np.median(denoised[:, 30] - denoised[:, 29]) > 0.5
    assert (denoised[:, 30] - denoised[:, 29]).min() > 0.3
    assert np.abs(oidn.denoise(clean) - clean).mean() < 1e-2


def test_relief_brings_back_the_edges_of_hairs_that_the_denoiser_blurred() -> None:
    rng, size = np.random.default_rng(5), (80, 80)
    depth = scipy.ndimage.gaussian_filter(rng.normal(size=size), (8.0, 0.6))  # hairs a pixel wide
    depth /= depth.std()
    share = np.where(np.arange(80) < 60, 1.0, 0.0)[None, :].repeat(80, axis=0).astype(np.float32)  # the rest is skin
    truth = np.ones((*size, 4))
    truth[:, :, :3] = 0.1 * (1.0 - 0.3 * share * np.clip(depth, -2.0, 2.0))[:, :, None]
    shown = rng.gamma(0.5, 2.0, (6, *size, 1))  # as noisy as 8 samples of dark hair
    passes = np.concatenate([truth[:, :, :3] * shown, np.ones((6, *size, 1))], axis=3)
    blurred = np.full((*size, 4), (0.1, 0.1, 0.1, 1.0))
    layers = np.stack([share, depth, 0.0 * depth, 0.0 * depth, 0.0 * depth], axis=2).astype(np.float32)
    sharp = accumulate(passes).relief(blurred, HairField(share, layers))
    hair = np.s_[8:-8, 8:52, 0]
    assert np.corrcoef(sharp[hair].ravel(), truth[hair].ravel())[0, 1] > 0.8
    assert 0.6 < sharp[hair].std() / truth[hair].std() < 1.2
    assert sharp[hair].mean() == pytest.approx(0.1, rel=0.05)
    assert np.array_equal(sharp[:, 60:], blurred[:, 60:])
