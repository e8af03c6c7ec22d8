"""Live hair of a session: it moves in a thread, and each step goes to all pages."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ringlet import sim
from ringlet.api.live import live_shot
from ringlet.data.errors import UserError, failure
from ringlet.groom import Groom
from ringlet.live import Live
from ringlet.shot import Shot
from ringlet.viewer import protocol
from ringlet.viewer.publisher import Publisher
from ringlet.viewer.show.display_groom import DisplayGroom
from ringlet.viewer.show.scene import VisibleMesh
from ringlet.viewer.wire import pack

LOOK_AGAIN = 0.2  # time after which a session without pages looks for one [s]
NECK = 0.02  # of the joint of the head below the lowest roots [m]


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


class LiveHair:
    """Live hair that is on or off. Public methods run on the session's thread.

    call:    runs a function on that thread
    failed:  reports an error message
    watched: whether a page is connected; without one, time stands still
    """

    def __init__(
        self,
        publisher: Publisher,
        call: Callable[..., None],
        failed: Callable[[str], None],
        watched: Callable[[], bool],
    ) -> None:
        self._publisher, self._call, self._failed, self._watched = publisher, call, failed, watched
        self._scene: LiveScene | None = None
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None
        self._key = 0

    @property
    def on(self) -> bool:
        """Whether hair moves live."""
        return self._thread is not None

    def start(self, scene: LiveScene) -> None:
        """Lets a scene move, from rest."""
        if self.on:
            return
        self._scene, self._stopping = scene, threading.Event()
        self._publisher.publish("live", pack(protocol.Live(on=True)))
        self._thread = threading.Thread(target=self._run, args=(scene, self._stopping), name="live", daemon=True)
        self._thread.start()

    def show(self, scene: LiveScene) -> None:
        """Goes on with another scene, if hair moves live."""
        self._scene = scene

    def stop(self, patience: float = 0.0) -> None:
        """Ends the motion. patience: how long to wait for the step in progress [s]"""
        if self._thread is None:
            return
        self._stopping.set()
        if patience > 0.0:
            self._thread.join(patience)
        self._thread = None
        self._publisher.clear("live")
        self._publisher.publish("live", pack(protocol.Live(on=False)))

    def _run(self, scene: LiveScene, stopping: threading.Event) -> None:
        try:
            self._move(scene, stopping)
        except Exception as error:
            if not stopping.is_set():
                self._call(self._failed, failure("hair could not move live", error))
                self._call(self._end, stopping)

    def _end(self, stopping: threading.Event) -> None:
        if stopping is self._stopping:
            self.stop()

    def _move(self, scene: LiveScene, stopping: threading.Event) -> None:
        live = live_shot(scene.shot, scene.groom) if scene.shot is not None else Live(scene.groom)
        key, step, due = self._announce(scene, live, stopping), 0, time.monotonic()
        self._call(self._publish, stopping, "live", pack(protocol.Live(on=True, fps=1.0 / live.dt)))
        while not stopping.is_set():
            if not self._watched():
                stopping.wait(LOOK_AGAIN)
                due = time.monotonic()
                continue
            if self._scene is not None and self._scene is not scene:
                before, scene = scene, self._scene
                if _change(live, before, scene):
                    key = self._announce(scene, live, stopping)
            note = live.step()
            if not stopping.is_set():
                self._publisher.send("live/step", step_message(key, step, scene, live, note))
            late = max(0, math.floor((time.monotonic() - due) / live.dt))  # steps to leave out, so that time goes on
            step, due = step + 1 + late, due + (1 + late) * live.dt
            stopping.wait(max(0.0, due - time.monotonic()))

    def _announce(self, scene: LiveScene, live: Live, stopping: threading.Event) -> int:
        """Tells pages which rods follow; returns their key."""
        self._key += 1
        self._call(self._publish, stopping, "live/rods", rods_message(self._key, scene.groom, live))
        return self._key

    def _publish(self, stopping: threading.Event, subject: str, message: bytes) -> None:
        if stopping is self._stopping and not stopping.is_set():
            self._publisher.publish(subject, message)


def _change(live: Live, before: LiveScene, now: LiveScene) -> bool:
    """Lets hair go on in another scene; returns whether its rods are others."""
    other = now.groom is not before.groom
    if other:
        live.groom = now.groom if now.shot is None else sim.with_words(now.shot, now.groom)
    if now.shot is not None and now.shot is not before.shot:
        live.material, live.gravity, live.wind = now.shot.strands, now.shot.forces.gravity, now.shot.forces.wind
    return other


def rods_message(key: int, groom: Groom, live: Live) -> bytes:
    """Message with the rods of a groom as groomed."""
    roots = groom.locks.points[groom.locks.offsets[:-1]] - groom.origin
    pivot = 0.5 * (roots.min(axis=0) + roots.max(axis=0))
    pivot[1] = roots[:, 1].min() - NECK
    return pack(
        protocol.Rods(key=key, pivot=tuple(pivot.tolist())),
        points=live.groomed_rods - groom.origin,
        along=live.vertex_places,
        axis=live.axes,
        carrier=live.carriers,
    )


def step_message(key: int, step: int, scene: LiveScene, live: Live, note: str) -> bytes:
    """Message with the rods as they are now."""
    origin, worn = scene.groom.origin, np.empty((0, 3))
    if scene.worn:
        points = live.positions
        worn = np.concatenate([body.worn[0].at(body.worn[1], points) for body in scene.worn if body.worn]) - origin
    head = relative(live.head, origin)
    return pack(
        protocol.LiveStep(key=key, step=step, head=head[:3].ravel().tolist(), trunk=(0.0, 0.0, 0.0), note=note),
        points=live.rods - origin,
        worn=worn,
    )


def relative(motion: NDArray[np.float64], origin: NDArray[np.float64]) -> NDArray[np.float64]:
    """A rigid motion, shape (4, 4), for positions relative to an origin [m]."""
    moved = motion.copy()
    moved[:3, 3] += motion[:3, :3] @ origin - origin
    return moved
