"""Live hair of a session: it moves in a thread, and each step goes to all pages."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Mapping
from types import MappingProxyType

from ringlet.data.errors import UserError, failure
from ringlet.viewer import protocol
from ringlet.viewer.play.head import MOTIONS
from ringlet.viewer.play.mover import Hand, LiveScene, Mover, rods_message, step_message
from ringlet.viewer.play.side_by_side import Followers
from ringlet.viewer.play.takes import TakeRing
from ringlet.viewer.protocol import Side
from ringlet.viewer.publisher import Publisher
from ringlet.viewer.wire import pack

LOOK_AGAIN = 0.2  # time after which a session without pages looks for one [s]


class LiveHair:
    """Live hair that is on or off. Public methods run on the session's thread.

    call:    runs a function on that thread
    failed:  reports an error message
    watched: whether a page is connected; without one, time stands still
    recent:  its last seconds, to be kept
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
        self._compared: Mapping[Side, LiveScene] = {}
        self._stopping, self._changed = threading.Event(), threading.Event()
        self._thread: threading.Thread | None = None
        self._hand, self._state = Hand(), protocol.Live(on=False)
        self._key = 0
        self.recent = TakeRing()

    @property
    def on(self) -> bool:
        """Whether hair moves live."""
        return self._thread is not None

    def start(self, scene: LiveScene, compared: Mapping[Side, LiveScene] = MappingProxyType({})) -> None:
        """Lets a scene move, from rest, and those that are compared with it, by side."""
        if self.on:
            return
        self._scene, self._hand, self._stopping = scene, Hand(), threading.Event()
        self._compared = compared
        self._thread = threading.Thread(target=self._run, args=(scene, self._stopping), name="live", daemon=True)
        self._publish(protocol.Live(on=True))
        self._thread.start()

    def show(self, scene: LiveScene, compared: Mapping[Side, LiveScene] = MappingProxyType({})) -> None:
        """Goes on with other scenes, if hair moves live."""
        self._scene, self._compared = scene, compared
        self._changed.set()

    def hold(self, message: protocol.HoldHead | protocol.TouchHair) -> None:
        """A hand holds the head in a pose, touches the hair, or lets go."""
        if isinstance(message, protocol.HoldHead):
            self._hand.held = None if message.turn is None else (message.turn, message.shift)
        elif message.does is None:
            self._hand.touch = None
        else:
            began = self._hand.touch[0] if self._hand.touch is not None else message
            self._hand.touch = (began if began.does == message.does else message, message)

    def let_go(self) -> None:
        """The hand lets go of head and hair."""
        self._hand.held = self._hand.touch = None

    def move_head(self, motion: str) -> None:
        """Plays a motion of the head; one that goes on is stopped where it plays. Raises UserError for no clip."""
        if not self.on:
            return
        if motion == "clip" and (self._scene is None or self._scene.shot is None):
            raise UserError("live: there is no shot whose clip could play; open one")
        self._hand.motions.put(motion)
        if motion == "clip" or MOTIONS[motion].seconds == math.inf:
            self._toggle(motion)

    def _toggle(self, motion: str) -> None:
        going = set(self._state.goes_on) ^ {motion}
        self._publish(self._state.model_copy(update={"goes_on": sorted(going)}))

    def blow(self, side: str) -> None:
        """Lets wind blow from a side, or ends it."""
        if self.on:
            self._hand.side = side
            self._publish(self._state.model_copy(update={"wind": side}))

    def stop(self, patience: float = 0.0) -> None:
        """Ends the motion. patience: how long to wait for the step in progress [s]"""
        if self._thread is None:
            return
        self._stopping.set()
        self._changed.set()
        if patience > 0.0:
            self._thread.join(patience)
        self._thread = None
        self.recent.clear()
        self._publisher.clear("live")
        self._publish(protocol.Live(on=False))

    def _publish(self, state: protocol.Live) -> None:
        self._state = state
        self._publisher.publish("live", pack(state))

    def _prepared(self, stopping: threading.Event, fps: float) -> None:
        if stopping is self._stopping and self.on:
            self._publish(self._state.model_copy(update={"fps": fps}))

    def _knows_contact(self, stopping: threading.Event, contact: str) -> None:
        if stopping is self._stopping and self.on:
            self._publish(self._state.model_copy(update={"contact": contact}))

    def _announce(self, stopping: threading.Event, rods: bytes | None, side: Side = "a") -> None:
        if stopping is not self._stopping or not self.on:
            return
        if rods is None:
            self._publisher.clear(f"live/{side}/")
        else:
            self._publisher.publish(f"live/{side}/rods", rods)

    def _end(self, stopping: threading.Event) -> None:
        if stopping is self._stopping:
            self.stop()

    # On the thread of the motion

    def _run(self, scene: LiveScene, stopping: threading.Event) -> None:
        try:
            self._move(scene, stopping)
        except Exception as error:
            if not stopping.is_set():
                self._call(self._failed, failure("hair could not move live", error))
                self._call(self._end, stopping)

    def _move(self, scene: LiveScene, stopping: threading.Event) -> None:
        mover, followers = Mover(scene, self._no_clip), Followers(lambda why: self._call(self._failed, why))
        try:
            self._step(mover, followers, stopping)
        finally:
            mover.stop()
            followers.stop()

    def _step(self, mover: Mover, followers: Followers, stopping: threading.Event) -> None:
        hand, dt, contact = self._hand, mover.live.dt, ""
        key = self._send_rods(mover, stopping)
        self._call(self._prepared, stopping, 1.0 / dt)
        step, late, due = 0, 0, time.monotonic()
        while not stopping.is_set():
            if not self._watched():
                stopping.wait(LOOK_AGAIN)
                due = time.monotonic()
                continue
            self._changed.clear()
            if self._scene is not None and mover.change(self._scene):
                key = self._send_rods(mover, stopping)
            if mover.contact != contact:
                contact = mover.contact
                self._call(self._knows_contact, stopping, contact)
            for side, rods in followers.change(self._compared, mover, self._new_key):
                self._call(self._announce, stopping, rods, side)
            if self._changed.wait(max(0.0, due - time.monotonic())):
                continue  # what has changed is taken over before the step is due
            note = mover.step(hand, (1 + late) * dt)
            if not stopping.is_set():
                message = step_message(key, step, mover, note)
                self.recent.add(message, mover.live.wind)
                self._publisher.send("live/a/step", message)
            for side, message in followers.step(mover, hand, step):
                if not stopping.is_set():
                    self._publisher.send(f"live/{side}/step", message)
            late = max(0, math.floor((time.monotonic() - due) / dt))  # steps to leave out, so that time goes on
            step, due = step + 1 + late, due + (1 + late) * dt

    def _no_clip(self, why: str) -> None:
        """The clip cannot be read: it does not play."""
        self._call(self._failed, why)
        self._call(self._toggle, "clip")

    def _send_rods(self, mover: Mover, stopping: threading.Event) -> int:
        """Tells pages which rods follow; returns their key."""
        key = self._new_key()
        message = rods_message(key, mover)
        if not stopping.is_set():
            self.recent.begin(message, mover.scene.groom, 1.0 / mover.live.dt)
        self._call(self._announce, stopping, message)
        return key

    def _new_key(self) -> int:
        self._key += 1
        return self._key
