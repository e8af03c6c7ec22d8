"""Publishes grooms, limited to the data that changed."""

from __future__ import annotations

from collections.abc import Callable, Collection
from functools import partial

import numpy as np

from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.data.precision import origin_of
from ringlet.groom import Groom
from ringlet.shot import Shot
from ringlet.viewer import protocol
from ringlet.viewer.publisher import Publisher
from ringlet.viewer.show import display_colors, overlays
from ringlet.viewer.show.display_groom import DisplayGroom
from ringlet.viewer.show.scene import VisibleMesh, read_meshes, shot_meshes, worn_meshes
from ringlet.viewer.wire import pack


class Viewport:
    """The displayed grooms: that of the open recipe on side a, and those that it is compared with.

    display:  groom on side a
    revision: of its recipe
    """

    def __init__(self, publisher: Publisher) -> None:
        self._publisher = publisher
        self.display: DisplayGroom | None = None
        self.revision = 0
        self._scene: list[VisibleMesh] = []
        self._worn: list[VisibleMesh] = []
        self._scalp: Mesh | None = None
        self._origin = np.zeros(3)  # of positions in messages, near the head
        self._shot_inputs: object = None
        self._layouts: dict[str, Curves] = {}
        self._colors: dict[str, tuple[Curves, str]] = {}
        self._names: protocol.Names | None = None

    @property
    def bodies(self) -> list[VisibleMesh]:
        """Visible meshes with their animation, those that the hair wears last."""
        return self._scene + self._worn

    def made(self, what: str) -> DisplayGroom:
        """The displayed groom; raises UserError before it is made, in the name of what needs it."""
        if self.display is None:
            raise UserError(f"{what}: the groom is still being made; wait until it is shown")
        return self.display

    @property
    def origin(self) -> np.ndarray:
        """Origin of positions in messages [m], shape (3,)."""
        return self._origin

    def show_head(self, scalp: Mesh, region: str | None, bodies: Callable[[], list[VisibleMesh]]) -> None:
        """Shows the head, if it is not shown.

        region: of the scalp that hair grows on
        bodies: reads the visible meshes of its file
        """
        if self._scalp is scalp:
            return
        self._scalp, self._origin = scalp, origin_of(scalp.points)
        self._shot_inputs = None
        if len(scalp.points):
            triangles = scalp.triangles[scalp.regions[region]] if region in scalp.regions else scalp.triangles
            grown = scalp.points[np.unique(triangles)] - self._origin
            (x, y, z), (far_x, far_y, far_z) = grown.min(axis=0).tolist(), grown.max(axis=0).tolist()
            self._publisher.publish("subject", pack(protocol.Subject(low=(x, y, z), high=(far_x, far_y, far_z))))
        self._publish_bodies(bodies())

    def show(self, display: DisplayGroom, side: str, revision: int = 0) -> None:
        """Shows a groom on one side. revision: of its recipe."""
        if side == "a":
            self.display, self.revision = display, revision
            groom = display.groom
            read = partial(read_meshes, groom.scalp, groom.scalp_file, cage=groom.cage, hidden=groom.hidden)
            self.show_head(groom.scalp, groom.region, read)
            self._show_worn(display.groom)
            self._publish_names(display.groom, display.curves)
        layout = display.hairs.curves if display.hairs else display.groom.locks
        if self._layouts.get(side) is not layout:
            self._layouts[side] = layout
            self._publisher.publish(f"{side}/hairs", display.layout(side), display.glimpse(side))
        self._publish_colors(display, side)
        self._publisher.publish(f"{side}/locks", display.locks(side))
        if side == "a":
            self._publish_numbers(display, revision)

    def stage(self, display: DisplayGroom, bodies: list[VisibleMesh]) -> None:
        """Shows the contents of a USD file."""
        self.show_head(display.groom.scalp, display.groom.region, lambda: bodies)
        self.show(display, "a")

    def show_bodies(self, shot: Shot, groom: Groom) -> None:
        """Shows cloths and colliders of a shot; raises UserError when one of its files cannot be read."""
        inputs = shot.cloth, shot.collider, shot.touching is None, shot.frames
        if inputs != self._shot_inputs:
            self._publish_bodies(shot_meshes(shot, groom))
            self._shot_inputs = inputs

    def clear_compared(self, side: str = "b") -> None:
        """Removes the groom on a side."""
        self._publisher.clear(f"{side}/")
        self._layouts.pop(side, None)
        self._colors.pop(side, None)

    def _show_worn(self, groom: Groom) -> None:
        before, self._worn = self._worn, worn_meshes(groom)
        if len(before) != len(self._worn) or any(
            a.mesh.points.shape != b.mesh.points.shape or (a.mesh.points != b.mesh.points).any()
            for a, b in zip(before, self._worn, strict=True)
        ):
            self._publish_bodies(self._scene)

    def _publish_bodies(self, scene: list[VisibleMesh]) -> None:
        self._publisher.clear("body/")
        self._scene = scene
        for index, body in enumerate(self.bodies):
            self._publisher.publish(f"body/{index}", body.message(index, len(self.bodies), self._origin))

    def _publish_colors(self, display: DisplayGroom, side: str) -> None:
        inputs = self._layouts[side], display_colors.inputs(display.groom)
        before = self._colors.get(side)
        if before is None or before[0] is not inputs[0] or before[1] != inputs[1]:
            self._colors[side] = inputs
            self._publisher.publish(f"{side}/colors", display_colors.message(side, display.groom, display.hairs))

    def _publish_names(self, groom: Groom, curves: Collection[str]) -> None:
        scalp = groom.scalp
        names = protocol.Names(
            regions=sorted(scalp.regions),
            maps=sorted({*scalp.maps, *(name for name, one in scalp.textures.items() if not one.colored)}),
            vectors=sorted({*scalp.vectors, *(name for name, one in scalp.textures.items() if one.colored)}),
            curves=sorted(curves),
        )
        if names != self._names:
            self._names = names
            self._publisher.publish("names", pack(names))

    def _publish_numbers(self, display: DisplayGroom, revision: int) -> None:
        numbers = protocol.Numbers(
            revision=revision,
            locks=len(display.groom.locks),
            hairs=display.count,
            groom_ms=round(display.took, 1),
            times=display.times,
            draft=display.draft,
        )
        self._publisher.publish("numbers", pack(numbers))


def measured(groom: Groom, depth: np.ndarray) -> bytes:
    """Message with measurements of a groom. depth: depths of lock points in the head [m], shape (n,)."""
    return pack(
        protocol.Measured(inside=int(np.count_nonzero(depth))),
        depth=overlays.as_bytes(depth / overlays.DEPTH_SHOWN),
        pin=overlays.as_bytes(groom.locks.point.get("pin", np.empty(0))),
    )
