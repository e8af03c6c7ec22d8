"""The clip: a nod, a quick turn of the head and a hop; frames 1 to 48 at 24 frames per second.

Every channel is a piecewise quintic through knots with a given value, velocity and acceleration, so that all of them
start and end at rest and nothing jerks. The eyes lead the head, the head leads the shoulders; the hop flies under
gravity alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BPoly
from scipy.spatial.transform import Rotation
from shapes import Array

FPS = 24.0
FRAMES = np.arange(1, 49)
GRAVITY = 981.0  # cm/s²
HOP = 11.0  # height [cm]

# Knots (frame, degrees); the channel rests for a moment at each.
NOD = [(2, 0), (6.5, 19), (11, -7), (16, 0)]  # down is positive
TURN = [(17, 0), (19.2, -5), (25.2, 43), (26.2, 43), (32.5, -2.5), (36, 0)]  # to the child's left
TILT = [(18, 0), (25, -6), (32, 2), (36, 0)]  # the ear goes towards the shoulder
GAZE = [(16.5, 0), (18.5, 14), (23.5, 12), (26, 0), (27.5, -13), (32, 0)]  # the eyes within the head
BRACE = [(31, 0), (34.6, 10), (37.5, -7), (42.2, -4), (45, 11), (48, 0)]  # the head in the hop, as in the nod
LEAN = [(31, 0), (34.4, 5), (37.2, -2), (42.5, 0), (44.8, 6), (48, 0)]  # the trunk in the hop


@dataclass(frozen=True)
class Joint:
    """A pivot [cm] and the share of each rest position that turns about it."""

    pivot: Array
    low: float  # heights between which the share grows from 0 to 1, measured along the slanted line of the jaw
    high: float
    slope: float

    def share(self, rest: Array) -> Array:
        t = np.clip((rest[:, 1] + self.slope * rest[:, 2] - self.low) / (self.high - self.low), 0.0, 1.0)
        return t * t * t * (t * (6.0 * t - 15.0) + 10.0)


TRUNK = Joint(np.array([0.0, -27.0, -3.0]), -90.0, -80.0, 0.0)
NECK = Joint(np.array([0.0, -13.0, -3.2]), -17.0, -9.5, 0.2)
SKULL = Joint(np.array([0.0, -7.2, -2.2]), -12.2, -7.6, 0.33)


def channel(knots: list[tuple[float, float]]) -> BPoly:
    """Rest at every knot: velocity and acceleration are zero there."""
    return BPoly.from_derivatives([f for f, _ in knots], [[value, 0.0, 0.0] for _, value in knots], extrapolate=False)


def at(knots: list[tuple[float, float]], frame: float) -> float:
    return float(channel(knots)(np.clip(frame, knots[0][0], knots[-1][0])))


def height(frame: float) -> float:
    """Height of the body over its rest [cm]: it crouches, pushes off, flies, lands and rises again."""
    speed = np.sqrt(2.0 * GRAVITY * HOP) / FPS  # cm per frame
    fall = -GRAVITY / FPS**2
    flight = -2.0 * speed / fall  # frames
    leave = 36.2
    land = leave + flight
    knots = [31.0, 34.4, leave, land, land + 1.7, 48.0]
    values = [[0, 0, 0], [-4.6, 0, 1.2], [0, speed, fall], [0, -speed, fall], [-4.2, 0, 2.0], [0, 0, 0]]
    return float(BPoly.from_derivatives(knots, values)(np.clip(frame, knots[0], knots[-1])))


def chain(frame: float) -> list[tuple[Joint, Array]]:
    """Joints from the trunk up, with their rotation vectors [rad]."""
    nod = at(NOD, frame) + at(BRACE, frame)
    turn, tilt = at(TURN, frame), at(TILT, frame)
    late = frame - 1.5
    trunk = [0.1 * at(NOD, late) + at(LEAN, frame), 0.16 * at(TURN, late), 0.0]
    return [
        (TRUNK, np.radians(trunk)),
        (NECK, np.radians([0.35 * nod, 0.35 * turn, 0.5 * tilt])),
        (SKULL, np.radians([0.65 * nod, 0.52 * turn, 0.5 * tilt])),
    ]


def pose(rest: Array, frame: float) -> Array:
    """Soft parts at a frame: every point turns about each pivot by its share of the angle; shape (n, 3)."""
    points = rest
    for joint, rotation in reversed(chain(frame)):
        turn = Rotation.from_rotvec(joint.share(rest)[:, None] * rotation)
        points = joint.pivot + turn.apply(points - joint.pivot)
    return points + [0.0, height(frame), 0.0]


def head_matrix(frame: float) -> Array:
    """Where the head, as a rigid body, is at a frame: a 4 × 4 matrix for column vectors."""
    matrix = np.eye(4)
    for joint, rotation in chain(frame):
        turn = Rotation.from_rotvec(rotation).as_matrix()
        step = np.eye(4)
        step[:3, :3], step[:3, 3] = turn, joint.pivot - turn @ joint.pivot
        matrix = matrix @ step
    matrix[1, 3] += height(frame)
    return matrix


def eye_matrix(centre: Array, frame: float) -> Array:
    """Where an eyeball, modelled about the origin, is at a frame."""
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_euler("y", at(GAZE, frame), degrees=True).as_matrix()
    matrix[:3, 3] = centre
    return head_matrix(frame) @ matrix
