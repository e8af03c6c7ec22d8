"""Rotations, rotation vectors, and rigid motions of points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def best_rotation(before: Array, after: Array) -> Array:
    """The rotation of row vectors that takes points nearest to others, both about their centres (Kabsch 1976).

    before, after: corresponding points, shape (..., n, 3). Returns matrices of shape (..., 3, 3).
    """
    before, after = (points - points.mean(axis=-2, keepdims=True) for points in (before, after))
    left, _, right = np.linalg.svd(before.swapaxes(-1, -2) @ after)
    left[..., 2] *= np.sign(np.linalg.det(left @ right))[..., None]  # a rotation, and no mirror image
    return left @ right


def rotate(vectors: Array, rotations: Array) -> Array:
    """Vectors rotated by rotation vectors [rad], shapes (k, 3); Rodrigues' formula."""
    angle = np.linalg.norm(rotations, axis=1, keepdims=True)
    axis = rotations / np.where(angle > 0.0, angle, 1.0)
    along = np.einsum("ij,ij->i", axis, vectors)[:, None] * axis
    return along + np.cos(angle) * (vectors - along) + np.sin(angle) * np.cross(axis, vectors)


def rotation_matrix(rotation: Array) -> Array:
    """The matrix of a rotation vector [rad], which acts on columns."""
    return rotate(np.eye(3), np.tile(rotation, (3, 1))).T


def rotation_vector(matrix: Array) -> Array:
    """The rotation vector of a matrix [rad], of less than half a turn."""
    axis = np.array([matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]])
    sine = float(np.linalg.norm(axis))
    return np.zeros(3) if sine < 1e-12 else np.arctan2(sine, np.trace(matrix) - 1.0) / sine * axis


def moved(points: Array, pose: Array) -> Array:
    """Points (..., n, 3) after rigid motions (..., 4, 4) that act on columns; one of each may stand for all."""
    return points @ pose[..., :3, :3].swapaxes(-1, -2) + pose[..., None, :3, 3]


def in_frame(points: Array, pose: Array) -> Array:
    """Points (..., n, 3) in the frames of rigid motions (..., 4, 4): what ``moved`` takes to them."""
    return (points - pose[..., None, :3, 3]) @ pose[..., :3, :3]
