"""Local regression of a noisy picture on layers that rays give without noise."""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

WINDOW = 4.0  # deviation of the window of pixels that share their coefficients [pixels]
RIDGE = 0.02  # of the coefficients, in variances of a layer


def regressed(
    values: NDArray[np.floating], layers: NDArray[np.floating], weights: NDArray[np.floating]
) -> NDArray[np.float64]:
    """What layers explain of values, less its mean around each pixel.

    First-order regression in a Gaussian window around each pixel, with its weights (Moon et al. 2014, Bitterli et al.
    2016): values are noisy, layers are not, so that an edge comes back at the sharpness of the layers.

    values:  shape (height, width)
    layers:  shape (height, width, k); their scale does not matter
    weights: of pixels in the regression, shape (height, width)
    """
    weights = np.maximum(weights, 1e-6)
    total = around(weights)

    def mean(image: NDArray[np.floating]) -> NDArray[np.floating]:
        return around(image * weights) / total

    apart = [layer - mean(layer) for layer in np.moveaxis(np.asarray(layers, np.float64), 2, 0)]
    apart = [layer / np.sqrt(mean(layer**2) + 1e-6 * layer.var() + 1e-30) for layer in apart]
    values = values - mean(values)
    count = len(apart)
    moments = np.empty((*values.shape, count, count))
    shared = np.empty((*values.shape, count))
    for i, one in enumerate(apart):
        shared[:, :, i] = mean(one * values)
        for j in range(i + 1):
            moments[:, :, i, j] = moments[:, :, j, i] = mean(one * apart[j])
    slopes = np.linalg.solve(moments + RIDGE * np.eye(count), shared[:, :, :, None])[:, :, :, 0]
    explained = np.einsum("hwk,hwk->hw", slopes, np.stack(apart, axis=2))
    return explained - mean(explained)


def around(image: NDArray[np.floating]) -> NDArray[np.floating]:
    """Means of an image around its pixels, shape (height, width)."""
    return scipy.ndimage.gaussian_filter(image, WINDOW)
