"""The child as signed distances, in centimetres: Y up, the face towards +Z, the origin between the eyes.

Every feature is modelled once, on the child's left (+X), and mirrored by ``mirrored``. Blend radii are large between
soft forms (skull, cheeks, jaw), and small at edges (lids, lips, wings of the nose).
"""

from __future__ import annotations

import numpy as np
from anatomy import Head, mirrored
from distances import Array, capsule, ellipsoid, intersect, sphere, stroke, subtract, union
from features import Ear, Eye, Mouth, Nose, with_features, with_neckline
from scipy.interpolate import PchipInterpolator

EYE = Eye(
    centre=np.array([3.15, -0.5, 4.5]),
    radius=2.25,
    width=np.radians(45.0),
    upper=np.radians(28.5),
    lower=np.radians(25.0),
    slant=0.06,
    lid=0.2,
)
NOSE = Nose(
    bridge=((0, 0.2, 6.4), (0, -2.5, 7.5), 0.62, 0.75),
    tip=((0, -2.9, 7.85), (1.05, 0.9, 1.0)),
    wing=((1.0, -3.2, 7.2), (0.64, 0.58, 0.75)),
    blend=0.4,
    nostril=((0.52, -3.82, 7.75), (0.32, 0.42, 0.44)),
)
MOUTH = Mouth(
    mound=((0, -5.4, 5.2), (2.6, 1.7, 1.9)),
    philtrum=((0, -3.9, 7.4), (0, -4.45, 7.4), 0.14, 0.2),
    groove=0.25,
    upper=([(2.4, -4.8, 6.9), (1.4, -4.97, 7.0), (0.45, -4.8, 7.22), (0, -4.93, 7.22)], [0.2, 0.34, 0.43, 0.38]),
    lower=([(2.35, -4.94, 6.88), (1.3, -5.64, 6.86), (0, -5.98, 7.05)], [0.2, 0.44, 0.56]),
    line=-5.38,
    bow=2.4,
    smile=0.11,
)
EAR = Ear(centre=np.array([6.95, -1.5, -1.3]), flare=np.radians(33.0), tilt=np.radians(12.0))

WAIST, STRETCH = -17.0, 13.0  # height of the waist, and length of the constant width below, past any picture's edge


def skin(points: Array) -> Array:
    """Head, ears, neck, and the chest inside a neckline."""
    p = mirrored(points)
    visible = intersect(body(p), sphere(p, (0, -10.0, -2.5), 7.4), 0.6)
    return with_features(union(head(p), visible, 1.4), p, FEATURES)


def shirt(points: Array) -> Array:
    """A T-shirt: an offset of the body with an opening around the neck, a rib along the neckline and a rounded end."""
    p = mirrored(points)
    p[:, 1] += np.clip(WAIST - p[:, 1], 0.0, STRETCH)
    cloth = intersect(torso(p) - 0.45, ellipsoid(p, (0, -14.5, -3.0), (11.4, 10.6, 9.0)), 1.5)
    return with_neckline(cloth, neckline(p), 0.36)


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
    """Adds sockets, lids and the openings between them."""
    return EYE.added(subtract(d, ellipsoid(p, (3.15, -0.15, 7.6), (2.7, 2.0, 1.75)), 1.2), p)


FEATURES = (
    (eyes, EYE.centre + [0, 0, 1.5], 5.0),
    (NOSE.added, (0, -2.0, 7.2), 4.5),
    (MOUTH.added, (0, -5.2, 5.8), 4.8),
    (EAR.added, EAR.centre, 5.0),
)

_HAIRLINE = PchipInterpolator(  # forehead, corner, temple, sideburn, over the ear, behind it, nape
    np.radians([0, 15, 30, 42, 55, 66, 78, 85, 90, 97, 104, 110, 118, 130, 150, 165, 180]),
    [6.0, 6.05, 6.0, 5.3, 3.9, 2.6, 0.6, -0.3, 0.3, 1.2, 0.9, -0.8, -2.6, -4.0, -5.1, -5.4, -5.2],
)

HEAD = Head(
    name="child",
    skin=skin,
    dressed=skin,
    shirt=shirt,
    neckline=neckline,
    lips=MOUTH.lips,
    skin_box=((-9.6, -20.0, -11.2), (9.6, 11.2, 9.8)),
    shirt_box=((-11.6, -38.6, -9.2), (11.6, -7.6, 3.2)),
    cell=0.3,
    fine=(
        (lambda p: sphere(p, EYE.centre + [0, 0, 1.4], 1.9), 0.155),
        (lambda p: capsule(p, (0, -5.1, 7.0), (2.3, -4.9, 6.0), 0.8), 0.14),
        (lambda p: sphere(p, (0.5, -3.2, 7.8), 1.0), 0.155),
        (lambda p: sphere(p, EAR.centre + [0.5, 0, -0.5], 2.8), 0.235),
    ),
    glow=(((3.9, -3.4, 6.0), 1.7), ((0.0, -3.2, 8.6), 1.0), (EAR.centre + [1.2, 0.5, -1.0], 2.0)),
    skull=np.array([0.0, 0.5, -1.2]),
    hairline=_HAIRLINE,
    jawline=PchipInterpolator(np.radians([0, 30, 60, 90, 110, 180]), [-8.7, -8.3, -7.2, -5.6, -4.4, -4.0]),
    eye=EYE,
    ear=EAR,
    brow=((1.45, 2.1, 8.0), (3.35, 2.8, 7.3), (5.35, 1.8, 5.6)),
    brow_width=(0.2, 0.34, 0.3, 0.07),
    brow_height=0.14,
    patches={},
    iris=np.radians(30.0),
    colors={
        "skin": np.array([0.34, 0.165, 0.095]),
        "lips": np.array([0.32, 0.085, 0.07]),
        "blush": np.array([0.40, 0.125, 0.08]),
        "shirt": np.array([0.55, 0.31, 0.085]),
        "iris": np.array([0.105, 0.041, 0.016]),
    },
)
