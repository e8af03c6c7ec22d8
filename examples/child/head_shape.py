"""The child as signed distances, in centimetres: Y up, the face towards +Z, the origin between the eyes.

A face is symmetric, so every feature is modelled once, on the child's left (+X), and seen through ``mirrored``.
Blend radii carry the softness: large where forms flow into one another (skull, cheeks, jaw), small where a form has an
edge (lids, lips, wings of the nose).
"""

from __future__ import annotations

import numpy as np
from shapes import Array, capsule, ellipsoid, engrave, intersect, sphere, stroke, subtract, union

EYE_CENTRE = np.array([3.05, -0.2, 4.75])
EYE_RADIUS = 1.95
EYE_WIDTH, UPPER_LID, LOWER_LID = np.radians([47.0, 36.0, 27.0])  # half the opening, seen from the eyeball's middle
EYE_SLANT = 0.06  # the outer corner is a little higher
LID = 0.2  # thickness of the lids

EAR_CENTRE = np.array([6.95, -1.5, -1.3])
EAR_FLARE = np.radians(33.0)  # how far the rim stands off the skull
EAR_TILT = np.radians(12.0)  # the top leans back


def mirrored(p: Array) -> Array:
    """Points folded onto the left side, rounded at the middle so that no crease runs down the face."""
    return np.column_stack([np.sqrt(p[:, 0] ** 2 + 0.03**2), p[:, 1], p[:, 2]])


def skin(points: Array) -> Array:
    """Head, ears, neck and the part of the chest that a neckline can show."""
    p = mirrored(points)
    shown = intersect(body(p), sphere(p, (0, -11.0, -2.5), 8.6), 0.6)
    d = union(head(p), shown, 1.6)
    d = eyes(d, p)
    d = nose(d, p)
    d = mouth(d, p)
    return ear(d, p)


def shirt(points: Array) -> Array:
    """A T-shirt: the body with an offset, open around the neck, with a rib along the neckline."""
    p = mirrored(points)
    cloth = intersect(body(p) - 0.45, -(p[:, 1] + 27.0), 1.6)
    neckline = capsule(p, (0, -13.6, -1.9), (0, 4.0, -8.0), 4.7, 12.0)
    open_cloth = subtract(cloth, neckline, 0.15)
    rib = np.hypot(np.maximum(np.abs(neckline - 0.3) - 0.3, 0.0), cloth) - 0.2
    return union(open_cloth, rib, 0.15)


def head(p: Array) -> Array:
    d = ellipsoid(p, (0, 2.4, -1.3), (7.5, 7.9, 8.6))
    d = union(d, ellipsoid(p, (0, 3.4, 2.6), (6.4, 5.2, 5.1)), 3.0)  # forehead
    d = union(d, ellipsoid(p, (0, -3.2, 1.4), (5.9, 6.0, 5.9)), 2.5)  # face
    d = union(d, sphere(p, (3.5, -3.9, 4.1), 2.75), 1.8)  # cheeks
    d = union(d, capsule(p, (4.4, -5.0, 0.5), (1.0, -7.7, 4.7), 1.9, 1.4), 1.6)  # jaw
    return union(d, ellipsoid(p, (0, -7.7, 5.5), (1.6, 1.35, 1.6)), 1.3)  # chin


def body(p: Array) -> Array:
    d = capsule(p, (0, -4.0, -2.4), (0, -15.0, -3.2), 3.3, 3.5)  # neck
    d = union(d, stroke(p, [(4.6, -4.5, -2.8), (0.8, -15.4, 0.7)], [0.8, 0.7]), 1.4)  # the cord from ear to breastbone
    d = union(d, capsule(p, (1.0, -11.0, -3.8), (7.3, -17.0, -3.4), 2.0, 2.4), 2.6)  # trapezius
    d = union(d, ellipsoid(p, (0, -23.5, -3.0), (8.6, 8.2, 5.0)), 2.4)  # chest
    d = union(d, stroke(p, [(7.6, -18.0, -3.2), (9.6, -23.0, -3.0), (10.0, -30.0, -2.6)], [2.9, 2.5, 2.4]), 1.6)  # arms
    return union(d, stroke(p, [(0.9, -15.6, 1.0), (4.0, -15.5, 0.5), (7.4, -15.6, -2.0)], [0.35, 0.3, 0.3]), 0.9)


def eyes(d: Array, p: Array) -> Array:
    """Sockets, then lids as shells around the eyeballs, then the opening between the lids."""
    d = subtract(d, ellipsoid(p, (3.0, 0.1, 8.0), (2.3, 1.35, 1.5)), 1.3)
    d = union(d, sphere(p, EYE_CENTRE, EYE_RADIUS + LID), 0.7)
    upper, lower = lid_edges(p)
    crease = np.abs(upper - 0.42) - 0.03
    d = engrave(d, np.maximum(crease, EYE_CENTRE[2] - p[:, 2]), 0.1, 0.2)
    pocket = np.maximum(np.maximum(upper, lower), EYE_RADIUS - 0.3 - np.linalg.norm(p - EYE_CENTRE, axis=-1))
    return subtract(d, np.maximum(pocket, EYE_CENTRE[2] - p[:, 2]), 0.12)


def lid_edges(p: Array) -> tuple[Array, Array]:
    """Distances along the eyeball past the edge of the upper and of the lower lid; both negative in the opening."""
    out = p - EYE_CENTRE
    across = np.arctan2(out[:, 0], np.maximum(out[:, 2], 1e-3)) / EYE_WIDTH
    along = np.arctan2(out[:, 1], np.hypot(out[:, 0], out[:, 2])) - EYE_SLANT * across
    return EYE_RADIUS * (along - UPPER_LID * lid_arch(across)), EYE_RADIUS * (-along - LOWER_LID * lid_arch(across))


def lid_arch(across: Array) -> Array:
    """Opening of the lids over the position from the inner corner (-1) to the outer one (1), highest at 1."""
    return 1.0 - np.minimum(np.abs(across + 0.08), 1.6) ** 2.2


def lid_direction(across: Array) -> Array:
    """Directions from the middle of the eyeball to the edge of the upper lid, shape (n, 3)."""
    along = UPPER_LID * lid_arch(across) + EYE_SLANT * across
    turn = EYE_WIDTH * across
    return np.column_stack([np.cos(along) * np.sin(turn), np.sin(along), np.cos(along) * np.cos(turn)])


def nose(d: Array, p: Array) -> Array:
    d = union(d, capsule(p, (0, 0.6, 6.3), (0, -2.3, 7.6), 0.7, 0.85), 1.3)  # bridge
    d = union(d, ellipsoid(p, (0, -2.75, 8.0), (1.12, 0.98, 1.1)), 0.6)  # tip
    d = union(d, ellipsoid(p, (1.0, -3.05, 7.3), (0.62, 0.6, 0.8)), 0.45)  # wings
    return subtract(d, ellipsoid(p, (0.52, -3.72, 7.85), (0.3, 0.34, 0.42)), 0.2)  # nostrils


def mouth(d: Array, p: Array) -> Array:
    d = union(d, ellipsoid(p, (0, -5.2, 5.4), (2.5, 1.7, 1.9)), 1.2)
    d = engrave(d, capsule(p, (0, -3.7, 7.6), (0, -4.2, 7.6), 0.14, 0.2), 0.12, 0.25)  # philtrum
    lip = [(2.0, -4.9, 6.2), (1.2, -4.75, 7.0), (0.42, -4.6, 7.38), (0, -4.72, 7.38)]
    d = union(d, stroke(p, lip, [0.1, 0.28, 0.34, 0.32]), 0.3)
    lip = [(1.9, -5.0, 6.2), (1.1, -5.5, 6.95), (0, -5.65, 7.25)]
    d = union(d, stroke(p, lip, [0.1, 0.36, 0.44]), 0.3)
    gap = np.hypot(p[:, 1] - mouth_line(p[:, 0]), np.maximum(p[:, 0] - 2.2, 0.0)) - 0.05
    d = engrave(d, np.maximum(gap, 3.0 - p[:, 2]), 0.35, 0.15)
    return engrave(d, capsule(p, (2.3, -4.55, 5.0), (2.3, -4.55, 9.0), 0.16), 0.18, 0.5)  # corners


def mouth_line(x: Array) -> Array:
    """Height of the line where the lips meet: a bow that ends in a slight smile."""
    return -5.12 + 0.08 * np.cos(2.4 * x) + 0.1 * x**2


def ear(d: Array, p: Array) -> Array:
    q = ear_frame(p)
    d = union(d, ear_leaf(q), 0.5)
    d = subtract(d, ellipsoid(q, (0.45, -0.35, 0.85), (0.75, 0.95, 0.8)), 0.3)  # the bowl
    return union(d, ellipsoid(q, (-0.5, -0.55, 0.35), (0.35, 0.5, 0.3)), 0.3)  # tragus


def ear_leaf(q: Array) -> Array:
    leaf = ellipsoid(q, (0.7, 0.1, 0.0), (1.75, 2.6, 0.5))
    rim = [(-0.2, 0.0, 0.15), (-0.5, 1.0, 0.2), (-0.1, 2.1, 0.3), (0.8, 2.6, 0.35), (1.8, 2.15, 0.4)]
    rim += [(2.25, 0.8, 0.4), (2.0, -0.7, 0.35), (1.35, -1.9, 0.2), (0.6, -2.5, 0.1)]
    leaf = union(leaf, stroke(q, rim, [0.2, 0.3, 0.34, 0.36, 0.36, 0.34, 0.32, 0.3, 0.3]), 0.25)
    leaf = union(leaf, ellipsoid(q, (0.35, -2.4, 0.05), (0.75, 0.75, 0.42)), 0.5)  # lobe
    fold = [(1.2, 1.5, 0.3), (1.4, 0.3, 0.4), (1.15, -0.8, 0.4), (0.5, -1.45, 0.3)]
    return union(leaf, stroke(q, fold, [0.2, 0.3, 0.3, 0.25]), 0.3)


def ear_frame(p: Array) -> Array:
    """Points in the ear's own frame: backwards along its leaf, up, and out of the leaf."""
    back = np.array([np.sin(EAR_FLARE), 0.0, -np.cos(EAR_FLARE)])
    up = np.array([0.0, np.cos(EAR_TILT), -np.sin(EAR_TILT)])
    up -= (up @ back) * back
    up /= np.linalg.norm(up)
    return (p - EAR_CENTRE) @ np.column_stack([back, up, np.cross(back, up)])
