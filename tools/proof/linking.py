"""Linking number of closed polylines: an integer that changes only where one curve passes through the other."""

import numpy as np


def solid_angle(a, b, c):
    """Signed solid angles of triangles at the origin (Van Oosterom & Strackee 1983); corners (…, 3)."""
    la, lb, lc = (np.linalg.norm(x, axis=-1) for x in (a, b, c))
    volume = np.einsum("...k,...k", a, np.cross(b, c))
    ab, bc, ca = (np.einsum("...k,...k", x, y) for x, y in ((a, b), (b, c), (c, a)))
    return 2 * np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb)


def linking(first, second):
    """Gauss's integral ∮∮ (r₁ − r₂)·(dr₁ × dr₂) / (4π |r₁ − r₂|³) of two closed polylines, shapes (n, 3) and (m, 3).

    The integral over a pair of segments is the solid angle of the parallelogram of their differences, exactly.
    """
    start, end = first[:, None], np.roll(first, -1, axis=0)[:, None]
    other, next_other = second[None], np.roll(second, -1, axis=0)[None]
    a, b, c, d = other - start, next_other - start, next_other - end, other - end
    return float((solid_angle(a, b, c) + solid_angle(c, d, a)).sum() / (4 * np.pi))


def closed(points, away):
    """A strand closed into a loop: both ends continue by ``away`` [m], shape (3,), and join there."""
    return np.concatenate([points, [points[-1] + away, points[0] + away]])
