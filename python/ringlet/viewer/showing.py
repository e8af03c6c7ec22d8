"""Posts grooms to the board, limited to the data that changed."""

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
    """The displayed grooms on sides a and b.

    look:   groom on side a
    bodies: visible meshes with their animation
    """

    def __init__(self, board: Board) -> None:
        self._board = board
        self.look: Look | None = None
        self.bodies: list[Seen] = []
        self._scalp: Mesh | None = None
        self._head: list[Seen] = []
        self._shot_inputs: object = None
        self._layouts: dict[str, Curves] = {}
        self._names: protocol.Names | None = None

    def show(self, look: Look, side: str, revision: int = 0) -> None:
        """Shows a groom on one side. revision: of its recipe."""
        if side == "a":
            self.look = look
            self._show_scalp(look)
            self._post_names(look.groom, look.curves)
        layout = look.hairs.curves if look.hairs else look.groom.locks
        if self._layouts.get(side) is not layout:
            self._layouts[side] = layout
            self._board.post(f"{side}/hairs", look.layout(side))
        self._board.post(f"{side}/locks", look.locks(side))
        if side == "a":
            self._post_numbers(look, revision)

    def stage(self, look: Look, bodies: list[Seen]) -> None:
        """Shows the contents of a USD file."""
        self._scalp = look.groom.scalp
        self._post_bodies(bodies)
        self.show(look, "a")

    def show_bodies(self, shot: Shot, groom: Groom) -> None:
        """Shows cloths and colliders of a shot; raises UserError when one of its files cannot be read."""
        inputs = shot.cloth, shot.collider, shot.touching is None
        if inputs != self._shot_inputs:
            self._post_bodies(dressed(self._head, shot, groom))
            self._shot_inputs = inputs

    def clear_beside(self) -> None:
        """Removes the groom on side b."""
        self._board.clear("b/")
        self._layouts.pop("b", None)

    def _show_scalp(self, look: Look) -> None:
        if self._scalp is not look.groom.scalp:
            self._scalp = look.groom.scalp
            self._head = read_bodies(look.groom.scalp, look.groom.scalp_file)
            self._shot_inputs = None
            self._post_bodies(self._head)

    def _post_bodies(self, bodies: list[Seen]) -> None:
        self._board.clear("body/")
        self.bodies = bodies
        for index, seen in enumerate(bodies):
            self._board.post(f"body/{index}", seen.message(index))

    def _post_names(self, groom: Groom, curves: Collection[str]) -> None:
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

    def _post_numbers(self, look: Look, revision: int) -> None:
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
    """Message with measurements of a groom. depth: depths of lock points in the head [m], shape (n,)."""
    return pack(
        protocol.Measured(inside=int(np.count_nonzero(depth))),
        depth=overlays.as_bytes(depth / overlays.DEPTH_SHOWN),
        nail=overlays.as_bytes(groom.locks.point.get("nail", np.empty(0))),
    )
