"""The child as signed distances, in centimetres: Y up, the face towards +Z, the origin between the eyes.

Every feature is modelled once, on the child's left (+X), and mirrored by ``mirrored``. Blend radii are large between
soft forms (skull, cheeks, jaw), and small at edges (lids, lips, wings of the nose).
"""

from __future__ import annotations

import numpy as np
from distances import Array, capsule, ellipsoid, engrave, intersect, smooth, sphere, stroke, subtract, union

EYE_CENTRE = np.array([3.15, -0.5, 4.5])
EYE_RADIUS = 2.25
EYE_WIDTH, UPPER_LID, LOWER_LID = np.radians([45.0, 28.5, 25.0])  # half angles of the opening at the eyeball's centre
EYE_SLANT = 0.06  # raises the outer corner
LID = 0.2  # thickness of the lids

WAIST, STRETCH = -17.0, 13.0  # height of the waist, and length of the constant width below, past any picture's edge

EAR_CENTRE = np.array([6.95, -1.5, -1.3])
EAR_FLARE = np.radians(33.0)  # angle of the rim from the skull
EAR_TILT = np.radians(12.0)  # tilts the top backwards


def mirrored(p: Array) -> Array:
    """Mirrors points to the left side, smoothly at the middle, so that the face has no crease."""
    return np.column_stack([np.sqrt(p[:, 0] ** 2 + 0.03**2), p[:, 1], p[:, 2]])


def skin(points: Array) -> Array:
    """Head, ears, neck, and the chest inside a neckline."""
    p = mirrored(points)
    visible = intersect(body(p), sphere(p, (0, -10.0, -2.5), 7.4), 0.6)
    d = union(head(p), visible, 1.4)
    for feature, centre, reach in FEATURES:
        near = np.flatnonzero(sphere(p, centre, reach) < 0.0)
        d[near] = feature(d[near], p[near])
    return d


def shirt(points: Array) -> Array:
    """A T-shirt: an offset of the body with an opening around the neck, a rib along the neckline and a rounded end."""
    p = mirrored(points)
    p[:, 1] += np.clip(WAIST - p[:, 1], 0.0, STRETCH)
    cloth = intersect(torso(p) - 0.45, ellipsoid(p, (0, -14.5, -3.0), (11.4, 10.6, 9.0)), 1.5)
    opening = neckline(p)
    rib = np.hypot(opening - 0.25, cloth + 0.05) - 0.36
    return union(subtract(cloth, opening, 0.15), rib, 0.12)


def neckline(p: Array) -> Array:
    """The opening of the shirt around the neck."""
    return capsule(p, (0, -10.7, -2.5), (0, -2.0, -4.0), 5.2, 7.5)


def head(p: Array) -> Array:
    d = ellipsoid(p, (0, 2.4, -1.3), (7.6, 7.9, 8.6))
    d = union(d, ellipsoid(p, (0, 3.4, 2.6), (6.5, 5.2, 5.1)), 3.0)  # forehead
    d = union(d, ellipsoid(p, (0, -3.0, 1.4), (5.9, 5.8, 5.9)), 2.5)  # face
    d = union(d, sphere(p, (3.4, -3.8, 4.0), 2.8), 1.6)  # cheeks
    d = union(d, capsule(p, (4.0, -5.0, 0.5), (1.0, -7.6, 4.7), 1.75, 1.4), 1.6)  # jaw
    return union(d, ellipsoid(p, (0, -7.75, 5.5), (1.4, 1.25, 1.5)), 1.2)  # chin


def body(p: Array) -> Array:
    d = union(torso(p), stroke(p, [(4.0, -4.8, -2.6), (0.7, -13.7, 0.1)], [0.6, 0.55]), 1.2)  # from ear to breastbone
    return union(d, stroke(p, [(0.7, -14.3, 0.2), (3.4, -14.1, -0.5), (5.6, -14.0, -2.2)], [0.3, 0.26, 0.2]), 0.9)


def torso(p: Array) -> Array:
    """The body under cloth, without the fine forms of neck and collar bones."""
    d = capsule(p, (0, -4.0, -2.4), (0, -14.0, -3.2), 2.9, 3.1)  # neck
    d = union(d, capsule(p, (0.8, -10.8, -3.7), (6.5, -14.0, -3.5), 1.7, 2.1), 2.2)  # trapezius
    d = union(d, ellipsoid(p, (0, -21.5, -3.0), (7.3, 7.6, 4.5)), 2.2)  # chest
    return union(
        d, stroke(p, [(6.5, -15.6, -3.2), (8.1, -20.5, -3.0), (8.5, -28.0, -2.6)], [2.5, 2.2, 2.1]), 1.6
    )  # arms


def eyes(d: Array, p: Array) -> Array:
    """Adds sockets, lids as shells around the eyeballs, and the opening between the lids."""
    d = subtract(d, ellipsoid(p, (3.15, -0.15, 7.6), (2.7, 2.0, 1.75)), 1.2)
    d = union(d, sphere(p, EYE_CENTRE, EYE_RADIUS + LID), 0.4)
    upper, lower = lid_edges(p)
    pocket = np.maximum(np.maximum(upper, lower), EYE_RADIUS - 0.3 - np.linalg.norm(p - EYE_CENTRE, axis=-1))
    return subtract(d, np.maximum(pocket, EYE_CENTRE[2] - p[:, 2]), 0.12)


def lid_edges(p: Array) -> tuple[Array, Array]:
    """Distances along the eyeball beyond the edges of the upper and the lower lid; both negative in the opening."""
    direction = p - EYE_CENTRE
    across = np.arctan2(direction[:, 0], np.maximum(direction[:, 2], 1e-3)) / EYE_WIDTH
    along = np.arctan2(direction[:, 1], np.hypot(direction[:, 0], direction[:, 2])) - EYE_SLANT * across
    return EYE_RADIUS * (along - UPPER_LID * lid_arch(across)), EYE_RADIUS * (-along - LOWER_LID * lid_arch(across))


def lid_arch(across: Array) -> Array:
    """Relative opening of the lids, at most 1, by the position from the inner corner (-1) to the outer one (1)."""
    return 1.0 - np.minimum(np.abs(across + 0.08), 1.6) ** 2.2


def lid_direction(across: Array) -> Array:
    """Directions from the eyeball's centre to the edge of the upper lid, shape (n, 3)."""
    along = UPPER_LID * lid_arch(across) + EYE_SLANT * across
    turn = EYE_WIDTH * across
    return np.column_stack([np.cos(along) * np.sin(turn), np.sin(along), np.cos(along) * np.cos(turn)])


def nose(d: Array, p: Array) -> Array:
    d = union(d, capsule(p, (0, 0.2, 6.4), (0, -2.5, 7.5), 0.62, 0.75), 1.3)  # bridge
    d = union(d, ellipsoid(p, (0, -2.9, 7.85), (1.05, 0.9, 1.0)), 0.6)  # tip
    d = union(d, ellipsoid(p, (1.0, -3.2, 7.2), (0.64, 0.58, 0.75)), 0.4)  # wings
    return subtract(d, ellipsoid(p, (0.52, -3.82, 7.75), (0.32, 0.42, 0.44)), 0.15)  # nostrils


def mouth(d: Array, p: Array) -> Array:
    d = union(d, ellipsoid(p, (0, -5.4, 5.2), (2.6, 1.7, 1.9)), 1.4)
    d = engrave(d, capsule(p, (0, -3.9, 7.4), (0, -4.45, 7.4), 0.14, 0.2), 0.1, 0.25)  # philtrum
    d = union(d, lips(p), 0.25)
    gap = np.hypot(p[:, 1] - mouth_line(p[:, 0]), np.maximum(p[:, 0] - 2.5, 0.0)) - 0.12
    return engrave(d, np.maximum(gap, 3.0 - p[:, 2]), 0.26 - 0.06 * p[:, 0], 0.18)


def lips(p: Array) -> Array:
    upper = [(2.4, -4.8, 6.9), (1.4, -4.97, 7.0), (0.45, -4.8, 7.22), (0, -4.93, 7.22)]
    lower = [(2.35, -4.94, 6.88), (1.3, -5.64, 6.86), (0, -5.98, 7.05)]
    d = stroke(p, *smooth(upper, [0.2, 0.34, 0.43, 0.38]))
    return np.minimum(d, stroke(p, *smooth(lower, [0.2, 0.44, 0.56])))


def mouth_line(x: Array) -> Array:
    """Height of the line between the lips: a bow with a slight smile."""
    return -5.38 + 0.07 * np.cos(2.4 * x) + 0.11 * x**2


def ear(d: Array, p: Array) -> Array:
    q = ear_frame(p)
    d = union(d, ear_leaf(q), 0.5)
    d = subtract(d, ellipsoid(q, (0.45, -0.4, 0.72), (0.72, 0.95, 0.8)), 0.25)  # the bowl
    return union(d, ellipsoid(q, (-0.5, -0.55, 0.35), (0.35, 0.5, 0.3)), 0.3)  # tragus


def ear_leaf(q: Array) -> Array:
    """The ear without its bowl: a flat ellipsoid with a rolled rim, a lobe and an inner fold."""
    leaf = ellipsoid(q, (0.7, 0.1, 0.0), (1.75, 2.6, 0.5))
    rim = [(-0.2, 0.0, 0.15), (-0.5, 1.0, 0.2), (-0.15, 2.0, 0.3), (0.75, 2.6, 0.35), (1.7, 2.2, 0.4)]
    rim += [(2.25, 0.9, 0.4), (2.05, -0.7, 0.35), (1.4, -1.9, 0.2), (0.6, -2.5, 0.1)]
    leaf = union(leaf, stroke(q, *smooth(rim, [0.2, 0.3, 0.34, 0.36, 0.36, 0.34, 0.32, 0.3, 0.3])), 0.25)
    leaf = union(leaf, ellipsoid(q, (0.35, -2.4, 0.05), (0.75, 0.75, 0.42)), 0.5)  # lobe
    fold = [(1.2, 1.5, 0.3), (1.4, 0.3, 0.4), (1.15, -0.8, 0.4), (0.5, -1.45, 0.3)]
    return union(leaf, stroke(q, *smooth(fold, [0.2, 0.3, 0.3, 0.25])), 0.3)


def ear_frame(p: Array) -> Array:
    """Transforms points to the frame of the ear: backwards in its plane, up, and along its normal."""
    back = np.array([np.sin(EAR_FLARE), 0.0, -np.cos(EAR_FLARE)])
    up = np.array([0.0, np.cos(EAR_TILT), -np.sin(EAR_TILT)])
    up -= (up @ back) * back
    up /= np.linalg.norm(up)
    return (p - EAR_CENTRE) @ np.column_stack([back, up, np.cross(back, up)])


# Features of the head, in the order of modelling, each with the ball that bounds its effect.
FEATURES = (
    (eyes, EYE_CENTRE + [0, 0, 1.5], 5.0),
    (nose, (0, -2.0, 7.2), 4.5),
    (mouth, (0, -5.2, 5.8), 4.8),
    (ear, EAR_CENTRE, 5.0),
)
