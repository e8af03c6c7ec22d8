"""The adult as signed distances, in centimetres: Y up, the face towards +Z, the origin between the eyes.

The middle of the skull is that of the child, so that recipes and their helper curves fit both heads. The face has
adult proportions: eyes at half the height of the head; hairline, brows, base of the nose and chin at even distances.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
from anatomy import Head, mirrored
from distances import Array, capsule, ellipsoid, intersect, smooth, sphere, stroke, subtract, union
from features import Ear, Eye, Mouth, Nose, with_features, with_neckline
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

EYE = Eye(
    centre=np.array([3.15, -0.9, 5.45]),
    radius=1.5,
    width=np.radians(53.0),
    upper=np.radians(22.0),
    lower=np.radians(19.0),
    slant=0.09,
    lid=0.14,
)
NOSE = Nose(
    bridge=((0, -0.3, 7.1), (0, -4.0, 8.4), 0.6, 0.75),
    tip=((0, -4.5, 8.75), (1.05, 0.85, 0.95)),
    wing=((1.25, -4.85, 7.7), (0.65, 0.62, 0.8)),
    blend=0.45,
    nostril=((0.6, -5.5, 8.25), (0.34, 0.4, 0.46)),
)
MOUTH = Mouth(
    mound=((0, -7.3, 5.3), (2.8, 2.3, 2.15)),
    philtrum=((0, -5.5, 7.9), (0, -6.6, 7.9), 0.16, 0.24),
    groove=0.3,
    upper=([(2.6, -7.42, 6.5), (1.5, -7.2, 7.15), (0.5, -6.92, 7.45), (0, -7.05, 7.45)], [0.16, 0.42, 0.55, 0.5]),
    lower=([(2.45, -7.52, 6.52), (1.35, -8.1, 6.95), (0, -8.4, 7.15)], [0.16, 0.56, 0.7]),
    line=-7.66,
    bow=2.2,
    smile=0.04,
)
EAR = Ear(centre=np.array([6.75, -2.0, -1.2]), flare=np.radians(24.0), tilt=np.radians(14.0))
SKULL = np.array([0.0, 0.5, -1.2])
BROW = ((1.5, 0.75, 8.2), (3.5, 1.5, 7.4), (5.6, 0.35, 5.6))

WAIST = -27.0  # height of the waist, below which the width is constant
BUST, TRUNK = 8.0, 36.0  # lengths of that width: of a bust past any picture's edge, and for hair of 60 cm to lie on


def skin(points: Array) -> Array:
    """Head, ears, neck, and the chest inside a neckline."""
    p = mirrored(points)
    return with_features(union(head(p), chest(p), 1.6), p, FEATURES)


def skin_to_neckline(points: Array) -> Array:
    """The same, with no more chest than is seen: nothing comes through the shirt."""
    p = mirrored(points)
    return with_features(union(head(p), intersect(chest(p), neckline(p) - 0.5, 0.4), 1.6), p, FEATURES)


def dressed(points: Array) -> Array:
    """The skin in its shirt, which presses the collar bones down beyond its neckline."""
    p = mirrored(points)
    seen = union(torso(p) - 0.15, neckline(p) - 0.25, 0.3)
    return with_features(union(head(p), intersect(chest(p), seen, 0.1), 1.6), p, FEATURES)


def chest(p: Array) -> Array:
    """Neck and chest."""
    return intersect(body(p), sphere(p, (0, -15.5, -3.0), 11.0), 0.6)


def shirt(points: Array, below: float = BUST) -> Array:
    """A top: an offset of the body with an opening around the neck, a rib along the neckline and a rounded end.

    below: length of the constant width below the waist
    """
    p = mirrored(points)
    p[:, 1] += np.clip(WAIST - p[:, 1], 0.0, below)
    cloth = intersect(torso(p) - 0.4, ellipsoid(p, (0, -20.0, -3.0), (24.0, 13.0, 14.0)), 1.5)
    return with_neckline(cloth, neckline(p), 0.34)


def neckline(p: Array) -> Array:
    """The opening of the top around the neck."""
    return capsule(p, (0, -17.0, -2.0), (0, -3.0, -6.0), 7.2, 11.0)


def head(p: Array) -> Array:
    d = ellipsoid(p, (0, 2.2, -1.4), (7.4, 8.0, 8.9))
    d = union(d, ellipsoid(p, (0, 3.0, 2.7), (6.2, 5.6, 5.2)), 3.0)  # forehead
    d = union(d, ellipsoid(p, (0, -4.4, 1.7), (5.6, 6.6, 5.9)), 2.5)  # face
    d = union(d, stroke(p, [(1.2, 0.4, 7.3), (3.4, 0.9, 6.6), (5.4, 0.2, 4.7)], [0.5, 0.6, 0.5]), 1.4)  # brow ridge
    d = union(d, sphere(p, (4.0, -3.5, 4.2), 2.3), 2.2)  # cheekbones
    d = union(d, ellipsoid(p, (3.6, -6.6, 3.2), (2.1, 2.6, 2.4)), 2.4)  # cheeks
    d = union(d, capsule(p, (5.1, -3.0, -0.6), (4.3, -7.4, 0.2), 1.2, 1.2), 2.2)  # ramus of the jaw
    d = union(d, capsule(p, (4.2, -7.6, 0.4), (1.0, -10.5, 6.0), 1.35, 1.3), 2.2)  # jaw
    return union(d, ellipsoid(p, (0, -10.9, 6.6), (1.6, 1.35, 1.35)), 1.3)  # chin


def body(p: Array) -> Array:
    d = union(torso(p), stroke(p, [(5.0, -6.5, -2.8), (1.0, -18.8, 1.0)], [0.9, 0.7]), 1.6)  # from ear to breastbone
    bone = [(1.0, -19.6, 1.2), (5.0, -19.3, 0.3), (9.5, -18.6, -1.6), (13.5, -18.4, -3.4)]
    return union(d, stroke(p, bone, [0.5, 0.45, 0.4, 0.4]), 1.2)


def torso(p: Array) -> Array:
    """The body under cloth, without the fine forms of neck and collar bones."""
    d = capsule(p, (0, -5.0, -2.6), (0, -18.0, -3.8), 4.9, 5.5)  # neck
    d = union(d, capsule(p, (1.5, -14.0, -5.0), (13.0, -20.5, -4.6), 2.3, 2.4), 4.0)  # trapezius
    d = union(d, ellipsoid(p, (0, -31.0, -3.6), (14.5, 13.0, 7.6)), 3.5)  # chest
    return union(d, stroke(p, [(14.6, -22.6, -4.2), (16.6, -29.0, -4.0), (17.2, -46.0, -3.4)], [3.4, 3.7, 3.5]), 2.4)


def eyes(d: Array, p: Array) -> Array:
    """Adds sockets, lids and the openings between them."""
    d = subtract(d, ellipsoid(p, (3.2, -0.75, 7.7), (2.2, 1.15, 1.35)), 1.3)
    return EYE.added(d, p)


FEATURES = (
    (eyes, EYE.centre + [0, 0, 1.0], 4.2),
    (NOSE.added, (0, -3.2, 8.0), 4.6),
    (MOUTH.added, (0, -7.3, 5.9), 4.8),
    (EAR.added, EAR.centre, 5.0),
)

_HAIRLINE = PchipInterpolator(  # forehead, corner, temple, sideburn, over the ear, behind it, nape
    np.radians([0, 15, 30, 42, 55, 66, 78, 85, 90, 97, 104, 110, 118, 130, 150, 165, 180]),
    [6.3, 6.35, 6.2, 5.4, 3.9, 2.5, 0.4, -0.6, 0.0, 1.0, 0.6, -1.2, -3.4, -5.0, -6.4, -6.8, -6.6],
)
_JAWLINE = PchipInterpolator(np.radians([0, 30, 60, 90, 110, 180]), [-12.2, -11.6, -9.8, -7.6, -6.4, -6.0])
_BEARD = PchipInterpolator(  # under the nose, corner of the mouth, cheek, sideburn
    np.radians([0, 12, 20, 28, 38, 50, 62, 76, 84]), [-5.75, -5.85, -6.2, -6.7, -7.0, -6.4, -5.0, -2.2, -1.2]
)


def on_brow(p: Array) -> NDArray[np.bool_]:
    """Points of the skin where the left brow grows, shape (n,), bool."""
    line, width = smooth(BROW, [0.32, 0.42, 0.2], 8)
    return (stroke(p * [1, 1, 0.5], line * [1, 1, 0.5], width) < 0.0) & (p[:, 2] > 4.0)


def on_lid(p: Array) -> NDArray[np.bool_]:
    """Points on the edge of the left upper lid, where lashes grow, shape (n,), bool."""
    beyond = EYE.lid_edges(p)[0]
    return (np.abs(beyond) < 0.12) & (np.abs(EYE.radius + 0.5 * EYE.lid - np.linalg.norm(p - EYE.centre, axis=1)) < 0.2)


def on_beard(p: Array) -> NDArray[np.bool_]:
    """Points of jaw, chin, cheeks and upper lip where a beard grows, shape (n,), bool."""
    around = np.arctan2(p[:, 0], p[:, 2] - SKULL[2])
    below = (p[:, 1] < _BEARD(np.minimum(around, np.radians(84.0)))) & (around < np.radians(86.0))
    return below & (p[:, 1] > _JAWLINE(around) - 1.2) & (MOUTH.lips(p) > 0.12) & ~EAR.contains(p)


HEAD = Head(
    name="adult",
    skin=skin,
    dressed=dressed,
    shirt=shirt,
    neckline=neckline,
    lips=MOUTH.lips,
    skin_box=((-12.6, -28.0, -15.2), (12.6, 11.2, 11.0)),
    shirt_box=((-22.0, -42.4, -14.2), (22.0, -8.0, 8.2)),
    cell=0.25,
    fine=(
        (lambda p: sphere(p, EYE.centre + [0, 0, 0.9], 1.3), 0.11),
        (lambda p: capsule(p, (0, -7.5, 7.0), (2.3, -7.4, 6.2), 0.9), 0.14),
        (lambda p: sphere(p, (0.6, -4.9, 8.1), 1.1), 0.15),
        (lambda p: sphere(p, EAR.centre + [0.5, 0, -0.5], 2.8), 0.235),
    ),
    glow=(((4.4, -3.9, 5.4), 1.9), ((0.0, -4.6, 9.0), 1.0), (EAR.centre + [1.2, 0.5, -1.0], 2.0)),
    skull=SKULL,
    hairline=_HAIRLINE,
    jawline=_JAWLINE,
    eye=EYE,
    ear=EAR,
    brow=BROW,
    brow_width=(0.22, 0.36, 0.28, 0.05),
    brow_height=0.07,
    patches={"brows": on_brow, "lids": on_lid, "beard": on_beard},
    iris=np.radians(29.0),
    colors={
        "skin": np.array([0.235, 0.108, 0.06]),
        "lips": np.array([0.23, 0.06, 0.05]),
        "blush": np.array([0.28, 0.09, 0.055]),
        "shirt": np.array([0.05, 0.15, 0.16]),
        "iris": np.array([0.07, 0.028, 0.012]),
    },
)

TORSO = replace(  # the same head over a back
    HEAD,
    name="torso",
    skin=skin_to_neckline,
    dressed=skin_to_neckline,
    shirt=partial(shirt, below=TRUNK),
    shirt_box=((-22.0, -42.4 + BUST - TRUNK, -14.2), (22.0, -8.0, 8.2)),
)
