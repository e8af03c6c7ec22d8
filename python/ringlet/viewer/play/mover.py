"""Live hair of a scene with its head and the wind, and the messages that show it."""

from __future__ import annotations

import math
import queue
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ringlet import sim
from ringlet.api.live import clothes_of, head_motion, live_shot
from ringlet.data.errors import UserError
from ringlet.groom import Groom
from ringlet.live import Calibration, Live, Touch, default_contact
from ringlet.live.neck import neck
from ringlet.shot import Shot, ShotContact
from ringlet.viewer import protocol
from ringlet.viewer.play.calibrator import Calibrator
from ringlet.viewer.play.head import MOTIONS, Head, clip_motion
from ringlet.viewer.protocol import Side
from ringlet.viewer.show.display_groom import DisplayGroom
from ringlet.viewer.show.scene import VisibleMesh
from ringlet.viewer.wire import pack

WIND = 6.0  # speed of the wind of a side [m/s]
GUSTS, GUST_PERIOD = 0.4, 1.3  # how far its speed changes, relative to it, and in which time [s]
WIND_RISE = 0.2  # time in which it rises to 1 − 1/e [s]
SIDES = {"": (0, 0, 0), "left": (1, 0, 0), "right": (-1, 0, 0), "front": (0, 0, 1), "back": (0, 0, -1)}  # of the head

Vector = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class LiveScene:
    """What moves live.

    shot: its material, forces and words of motion hold; None: the material by default
    worn: what the hair wears
    """

    groom: Groom
    shot: Shot | None
    worn: list[VisibleMesh]

    @classmethod
    def of(cls, display: DisplayGroom, shot: Shot | None, bodies: list[VisibleMesh]) -> LiveScene:
        """The scene of a displayed groom; raises UserError for hair that has no locks to move."""
        if display.hairs is None or not len(display.groom.locks):
            raise UserError("live: there are no locks to move; open a recipe, a shot or a groom with locks")
        return cls(display.groom, shot, [body for body in bodies if body.worn is not None])


@dataclass
class Hand:
    """What is done to live hair, on one thread, until the next step takes it over on another.

    held:    pose in which a hand has the head: rotation vector [rad] and shift [m]; None: it has let go
    touch:   what a hand does to the hair as it begins and now, relative to the origin of the groom; None: nothing
    motions: names of those that were asked for since the last step
    side:    that wind blows from; empty for none
    """

    held: tuple[Vector, Vector] | None = None
    touch: tuple[protocol.TouchHair, protocol.TouchHair] | None = None
    motions: queue.SimpleQueue[str] = field(default_factory=queue.SimpleQueue)
    side: str = ""


class Mover:
    """Live hair of a scene with its head.

    failed: hears of a clip that cannot be read
    gust:   velocity of the wind of a side now [m/s], shape (3,)

    ``contact`` says where the stiffness that contact adds is from.
    """

    def __init__(self, scene: LiveScene, failed: Callable[[str], None]) -> None:
        self.scene, self._failed = scene, failed
        groom, shot = scene.groom, scene.shot
        self.live = live = live_shot(shot, groom) if shot is not None else Live(groom, clothes=clothes_of(groom))
        self.head = Head(neck(scene.groom))
        self._began: protocol.TouchHair | None = None
        self.gust, self._time, self._wind = np.zeros(3), 0.0, np.array(live.wind)
        self._calibrator = Calibrator()
        self._use_default_contact()

    def stop(self) -> None:
        """Ends what goes on besides the steps."""
        self._calibrator.stop()

    def _calibration(self) -> Calibration:
        """What the contact of its hair is found from."""
        live, shot = self.live, self.scene.shot
        touching = (shot.touching if shot is not None else None) or ShotContact()
        return Calibration(live.groom, live.material, live.clothes, live.gravity, 1.0 / live.dt, touching)

    def change(self, now: LiveScene) -> bool:
        """Goes on with what is new in a scene, with the contact by default; returns whether its rods are others."""
        live, before, self.scene = self.live, self.scene, now
        if now.groom is before.groom and now.shot is before.shot:
            return False
        other = now.groom is not before.groom
        if now.shot is not None and before.shot is not None and now.shot is not before.shot:
            live.material, live.gravity = now.shot.strands, now.shot.forces.gravity
            self._wind = np.array(now.shot.forces.wind)
            other = other or bool(now.shot.motion.given or before.shot.motion.given)  # its words are factors of locks
        if other:
            live.groom = now.groom if now.shot is None else sim.with_words(now.shot, now.groom)
        self._use_default_contact()
        return other

    def _use_default_contact(self) -> None:
        """Neighbours hold locks by default until it is known how they do."""
        contact, style = default_contact(self.live.groom)
        if self.live.contact != contact:
            self.live.contact = contact
        self.contact = f"default for {style}"
        self._calibrator.change(self._calibration)

    def _use_found_contact(self) -> None:
        if (contact := self._calibrator.poll()) is not None:
            self.live.contact, self.contact = contact, "calibrated"

    def step(self, hand: Hand, seconds: float) -> str:
        """Takes over what the hand does, and steps once after some time; returns what was cut off."""
        self._use_found_contact()
        while not hand.motions.empty():
            self._play(hand.motions.get())
        if (held := hand.held) is not None:
            self.head.hold(np.array(held[0]), np.array(held[1]))
        else:
            self.head.let_go()
        self.head.advance(seconds)
        self._time += seconds
        blows = np.array(SIDES[hand.side]) * -WIND * (1.0 + GUSTS * math.sin(2.0 * math.pi * self._time / GUST_PERIOD))
        self.gust += (1.0 - math.exp(-seconds / WIND_RISE)) * (blows - self.gust)
        self.live.wind = tuple((self._wind + self.gust).tolist())
        self.live.head, self.live.trunk = self.head.transform, shifted(self.head.trunk)
        self._touch(hand.touch)
        return self.live.step()

    def join(self, leader: Mover) -> None:
        """Is at rest on the head of another one from now on, and follows it."""
        self.head, live, other = leader.head, self.live, leader.live
        live.dt, live.head, live.trunk = other.dt, other.head, other.trunk
        live.reset()

    def follow(self, leader: Mover, hand: Hand) -> None:
        """Steps as another one has: with the same head, in the same gusts and under the same hand."""
        self._use_found_contact()
        self.live.wind = tuple((self._wind + leader.gust).tolist())
        self.live.head, self.live.trunk = leader.live.head, leader.live.trunk
        self._touch(hand.touch)
        self.live.step()

    def _touch(self, touch: tuple[protocol.TouchHair, protocol.TouchHair] | None) -> None:
        """A hand that begins does so where it began, wherever it has gone since the last step."""
        began, now = touch or (None, None)
        if began is not self._began:
            self.live.touch, self._began, now = None, began, began
        if now is not None and now.does is not None:
            at = np.array(now.at) + self.scene.groom.origin
            self.live.touch = Touch(now.does, tuple(at.tolist()), now.radius)

    def _play(self, name: str) -> None:
        groom, shot = self.scene.groom, self.scene.shot
        if name in MOTIONS:
            self.head.play(name, MOTIONS[name])
        elif shot is not None:
            try:
                transforms = head_motion(groom, shot.frames)
            except UserError as error:
                self._failed(str(error))
            else:
                self.head.play(name, clip_motion(transforms, self.head.pivot, groom.space.fps))


def rods_message(key: int, mover: Mover, side: Side = "a") -> bytes:
    """Message with the rods of a groom as groomed."""
    live, origin = mover.live, mover.scene.groom.origin
    return pack(
        protocol.Rods(side=side, key=key, pivot=tuple((mover.head.pivot - origin).tolist())),
        points=live.groomed_rods - origin,
        along=live.vertex_places,
        axis=live.axes,
        rise=live.rise,
        ids=live.groom.locks.ids,
        carrier=live.carriers,
    )


def step_message(key: int, step: int, mover: Mover, note: str, side: Side = "a") -> bytes:
    """Message with the rods as they are now."""
    live, origin = mover.live, mover.scene.groom.origin
    worn = [body.worn for body in mover.scene.worn if body.worn is not None]
    places = np.empty((0, 3))
    if worn:
        points = live.positions
        places = np.concatenate([accessory.at(rest, points) for accessory, rest in worn]) - origin
    head = relative(live.head, origin)[:3].ravel().tolist()
    return pack(
        protocol.LiveStep(side=side, key=key, step=step, head=head, trunk=tuple(mover.head.trunk.tolist()), note=note),
        points=live.rods - origin,
        worn=places,
    )


def shifted(by: NDArray[np.float64]) -> NDArray[np.float64]:
    """The rigid motion without rotation, shape (4, 4)."""
    motion = np.eye(4)
    motion[:3, 3] = by
    return motion


def relative(motion: NDArray[np.float64], origin: NDArray[np.float64]) -> NDArray[np.float64]:
    """A rigid motion, shape (4, 4), for positions relative to an origin [m]."""
    moved = motion.copy()
    moved[:3, 3] += motion[:3, :3] @ origin - origin
    return moved
