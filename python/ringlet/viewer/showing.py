"""From looks to messages: the board is told what has changed since the look before."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from ringlet.data.curves import Curves
from ringlet.data.mesh import Mesh
from ringlet.groom import Groom
from ringlet.shot import Shot
from ringlet.viewer import overlays, protocol
from ringlet.viewer.board import Board
from ringlet.viewer.looks import Look
from ringlet.viewer.scene import Seen, dressed, read_bodies
from ringlet.viewer.wire import pack


class Showing:
    """What pages see of the looks a and b.

    look:   the one on side a
    bodies: what else is seen, with how it moves
    """

    def __init__(self, board: Board) -> None:
        self._board = board
        self.look: Look | None = None
        self.bodies: list[Seen] = []
        self._scalp: Mesh | None = None
        self._head: list[Seen] = []
        self._dressed: object = None
        self._layouts: dict[str, Curves] = {}
        self._names: protocol.Names | None = None

    def show(self, look: Look, side: str, revision: int = 0) -> None:
        """Shows a look on one side. revision: of the recipe that it comes from."""
        if side == "a":
            self.look = look
            self._show_scalp(look)
            self._tell_names(look.groom, look.curves)
        layout = look.hairs.curves if look.hairs else look.groom.locks
        if self._layouts.get(side) is not layout:
            self._layouts[side] = layout
            self._board.post(f"{side}/hairs", look.layout(side))
        self._board.post(f"{side}/locks", look.locks(side))
        if side == "a":
            self._tell_numbers(look, revision)

    def stage(self, look: Look, bodies: list[Seen]) -> None:
        """Shows what a USD file holds."""
        self._scalp = look.groom.scalp
        self._post_bodies(bodies)
        self.show(look, "a")

    def dress(self, shot: Shot, groom: Groom) -> None:
        """Shows what a shot brings along besides the head. Raises UserError where one of its files cannot be read."""
        brings = shot.cloth, shot.collider, shot.touching is None
        if brings != self._dressed:
            self._post_bodies(dressed(self._head, shot, groom))
            self._dressed = brings

    def clear_beside(self) -> None:
        """Takes the look on side b away."""
        self._board.wipe("b/")
        self._layouts.pop("b", None)

    def _show_scalp(self, look: Look) -> None:
        if self._scalp is not look.groom.scalp:
            self._scalp = look.groom.scalp
            self._head = read_bodies(look.groom.scalp, look.groom.scalp_file)
            self._dressed = None
            self._post_bodies(self._head)

    def _post_bodies(self, bodies: list[Seen]) -> None:
        self._board.wipe("body/")
        self.bodies = bodies
        for index, seen in enumerate(bodies):
            self._board.post(f"body/{index}", seen.message(index))

    def _tell_names(self, groom: Groom, curves: Collection[str]) -> None:
        scalp = groom.scalp
        names = protocol.Names(
            regions=sorted(scalp.regions),
            maps=sorted({*scalp.maps, *scalp.textures}),
            vectors=sorted(scalp.vectors),
            curves=sorted(curves),
        )
        if names != self._names:
            self._names = names
            self._board.post("names", pack(names))

    def _tell_numbers(self, look: Look, revision: int) -> None:
        numbers = protocol.Numbers(
            revision=revision,
            locks=len(look.groom.locks),
            hairs=look.count,
            groom_ms=round(look.took, 1),
            times=look.times,
            draft=look.draft,
        )
        self._board.post("numbers", pack(numbers))


def measured(groom: Groom, depth: np.ndarray) -> bytes:
    """The message with what is only measured at rest. depth: of the points of the locks in the head [m]."""
    return pack(
        protocol.Measured(inside=int(np.count_nonzero(depth))),
        depth=overlays.as_bytes(depth / overlays.DEPTH_SHOWN),
        nail=overlays.as_bytes(groom.locks.point.get("nail", np.empty(0))),
    )
