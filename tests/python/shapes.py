"""Small scalps for the tests of the groom."""

import numpy as np

from ringlet import Mesh


def ball(radius: float = 0.09, rings: int = 16) -> Mesh:
    """A closed sphere about the origin; its upper half is the region ``scalp``."""
    around = 2 * rings
    polar = np.linspace(0.0, np.pi, rings + 1)[1:-1, None]
    azimuth = np.linspace(0.0, 2.0 * np.pi, around, endpoint=False)[None, :]
    x, z = np.sin(polar) * np.sin(azimuth), np.sin(polar) * np.cos(azimuth)
    belt = np.stack([x, np.broadcast_to(np.cos(polar), x.shape), z], axis=-1).reshape(-1, 3)
    points = radius * np.concatenate([[[0.0, 1.0, 0.0]], belt, [[0.0, -1.0, 0.0]]])

    here = 1 + np.arange((rings - 2) * around).reshape(rings - 2, around)
    right, below = np.roll(here, -1, axis=1), here + around
    below_right = np.roll(below, -1, axis=1)
    top, bottom = 1 + np.arange(around), 1 + (rings - 2) * around + np.arange(around)
    last = np.full(around, len(points) - 1)
    faces = [
        np.stack([0 * top, top, np.roll(top, -1)], axis=1),
        np.stack([here, below, below_right], axis=-1).reshape(-1, 3),
        np.stack([here, below_right, right], axis=-1).reshape(-1, 3),
        np.stack([last, np.roll(bottom, -1), bottom], axis=1),
    ]
    triangles = np.concatenate(faces).astype(np.int32)
    upper = np.flatnonzero(points[triangles].mean(axis=1)[:, 1] > 0.0).astype(np.int32)
    return Mesh("ball", points, triangles, regions={"scalp": upper})


def sheet(cells: int = 8, size: float = 0.2) -> Mesh:
    """A square in the plane y = 0, facing up, centred on the origin."""
    at = np.linspace(-size / 2, size / 2, cells + 1)
    x, z = np.meshgrid(at, at, indexing="ij")
    points = np.stack([x, np.zeros_like(x), z], axis=-1).reshape(-1, 3)
    a = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)[None, :]).ravel()
    b, c, d = a + 1, a + cells + 1, a + cells + 2
    triangles = np.concatenate([np.stack([a, b, d], axis=1), np.stack([a, d, c], axis=1)]).astype(np.int32)
    return Mesh("sheet", points, triangles)


def rotation(axis: tuple[float, float, float], degrees: float) -> np.ndarray:
    """Rotation matrix about an axis (Rodrigues)."""
    k = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0.0, -k[2], k[1]], [k[2], 0.0, -k[0]], [-k[1], k[0], 0.0]])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
