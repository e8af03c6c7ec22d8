"""The clip: a nod, a quick turn of the head and a hop; frames 1 to 48 at 24 frames per second.

Every channel is a piecewise quintic through knots with value, velocity and acceleration. It starts and ends at rest,
and has continuous acceleration. The eyes lead the head, the head leads the shoulders. The flight of the hop is
ballistic.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from distances import Array
from scipy.interpolate import BPoly
from scipy.spatial.transform import Rotation

FPS = 24.0
FRAMES = np.arange(1, 49)
GRAVITY = 981.0  # cm/s²
HOP = 10.5  # height [cm]


def channel(*knots: tuple[float, float]) -> BPoly:
    """Angles [degrees] by frame, with zero velocity and acceleration at every knot."""
    return BPoly.from_derivatives([f for f, _ in knots], [[value, 0.0, 0.0] for _, value in knots])


NOD = channel((2, 0), (6.5, 19), (11, -7), (16, 0))  # down is positive
TURN = channel((17, 0), (19.2, -5), (25.2, 43), (26.2, 43), (32.5, -2.5), (36, 0))  # to the child's left
TILT = channel((18, 0), (25, -6), (32, 2), (36, 0))  # of the ear towards the shoulder
GAZE = channel((16.5, 0), (18.5, 14), (23.5, 12), (26, 0), (27.5, -13), (32, 0))  # of the eyes relative to the head
BRACE = channel((30, 0), (34.6, 8), (39.5, -6), (45.2, 8), (48, 0))  # of the head in the hop, like NOD
LEAN = channel((30, 0), (34.4, 4), (38.5, -2), (44.8, 4), (48, 0))  # of the trunk in the hop


def at(curve: BPoly, frame: float) -> float:
    """Value at a frame, constant before the first knot and after the last."""
    return float(curve(np.clip(frame, curve.x[0], curve.x[-1])))


@dataclass(frozen=True)
class Joint:
    """A joint: its pivot [cm], and skinning weights of rest positions."""

    pivot: Array
    low: float  # heights between which the weight grows from 0 to 1, measured along the slanted line of the jaw
    high: float
    slope: float

    def weights(self, rest: Array) -> Array:
        t = np.clip((rest[:, 1] + self.slope * rest[:, 2] - self.low) / (self.high - self.low), 0.0, 1.0)
        return t * t * t * (t * (6.0 * t - 15.0) + 10.0)


TRUNK = Joint(np.array([0.0, -25.0, -3.0]), -90.0, -80.0, 0.0)
NECK = Joint(np.array([0.0, -12.0, -3.2]), -15.5, -9.0, 0.2)
SKULL = Joint(np.array([0.0, -7.2, -2.2]), -12.6, -8.2, 0.33)


def hop() -> BPoly:
    """Height of the body above its rest position by frame [cm]: crouch, take-off, flight, landing and recovery."""
    speed = np.sqrt(2.0 * GRAVITY * HOP) / FPS  # cm per frame
    fall = -GRAVITY / FPS**2
    takeoff = 36.4
    landing = takeoff - 2.0 * speed / fall
    knots = [30.0, 34.2, takeoff, landing, landing + 2.0, 48.0]
    return BPoly.from_derivatives(
        knots, [[0, 0, 0], [-5.2, 0, 1.6], [0, speed, fall], [0, -speed, fall], [-5.0, 0, 1.8], [0, 0, 0]]
    )


HEIGHT = hop()


def chain(frame: float) -> list[tuple[Joint, Array]]:
    """Joints from the trunk upwards, with their rotation vectors [rad]."""
    nod = at(NOD, frame) + at(BRACE, frame)
    turn, tilt = at(TURN, frame), at(TILT, frame)
    delayed = frame - 1.5
    trunk = [0.1 * at(NOD, delayed) + at(LEAN, frame), 0.16 * at(TURN, delayed), 0.0]
    return [
        (TRUNK, np.radians(trunk)),
        (NECK, np.radians([0.35 * nod, 0.35 * turn, 0.5 * tilt])),
        (SKULL, np.radians([0.65 * nod, 0.52 * turn, 0.5 * tilt])),
    ]


def pose(rest: Array, frame: float) -> Array:
    """Deformed positions at a frame [cm], shape (n, 3): each point rotates about each pivot by its weighted angle."""
    points = rest
    for joint, rotation in reversed(chain(frame)):
        turn = Rotation.from_rotvec(joint.weights(rest)[:, None] * rotation)
        points = joint.pivot + turn.apply(points - joint.pivot)
    return points + [0.0, at(HEIGHT, frame), 0.0]


def head_matrix(frame: float) -> Array:
    """Rigid transform of the head at a frame, shape (4, 4), for column vectors."""
    matrix = np.eye(4)
    for joint, rotation in chain(frame):
        turn = Rotation.from_rotvec(rotation).as_matrix()
        step = np.eye(4)
        step[:3, :3], step[:3, 3] = turn, joint.pivot - turn @ joint.pivot
        matrix = matrix @ step
    matrix[1, 3] += at(HEIGHT, frame)
    return matrix


def eye_matrix(centre: Array, frame: float) -> Array:
    """Transform of an eyeball, modelled about the origin, at a frame, shape (4, 4)."""
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_euler("y", at(GAZE, frame), degrees=True).as_matrix()
    matrix[:3, 3] = centre
    return head_matrix(frame) @ matrix
