"""The scene of a simulation, which packs its frames and measures how tips swing."""

from __future__ import annotations

import threading
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data.mesh import Clip
from ringlet.groom import AnyHairs, Groom
from ringlet.groom.thinning import spread
from ringlet.sim.motion import Motion
from ringlet.viewer import protocol
from ringlet.viewer.show import overlays
from ringlet.viewer.show.scene import FrameState, VisibleMesh
from ringlet.viewer.wire import pack


@dataclass
class Stage:
    """The scene of a simulation: groom, hairs, animated scalp and bodies."""

    groom: Groom
    hairs: AnyHairs | None
    clip: Clip
    bodies: list[VisibleMesh]
    _lock: threading.Lock = field(default_factory=threading.Lock, init=False)  # guards the buffer of hairs

    @cached_property
    def _buffer(self) -> NDArray[np.float32] | None:
        return self.hairs.new_buffer() if self.hairs is not None else None

    @cached_property
    def turning(self) -> NDArray[np.float64]:
        """Turning of the groomed locks [rad], shape (n,)."""
        return overlays.turning(self.groom.locks, self.groom.locks.points)

    def frame(
        self,
        layer: str,
        frame: float,
        state: FrameState,
        motion: Motion | None = None,
    ) -> bytes:
        """Message of a frame; contact and depth need ``motion``."""
        points, statistics, _ = state
        axis, root, left = np.empty(0), np.empty(0), np.empty((0, 0), np.uint8)
        corners, locks = self.clip.at(frame), self.groom.locks
        bodies = [body.at(frame, state) for body in self.bodies]
        if self.hairs is not None:
            deformation = self.hairs.deformation(corners)
            order = spread(np.diff(deformation["first"]))
            axis, root = deformation["axis"], deformation["root"][order]
            surfaces = [(at, body.mesh.triangles) for at, body in zip(bodies, self.bodies, strict=True)]
            with self._lock:
                left = self.hairs.offset_fractions(points, deformation, surfaces, buffer=self._buffer)[order]
        drawn = np.flatnonzero((left < 255).any(axis=1))
        shown, contact, depth = shown_statistics(statistics), np.empty(0), np.empty(0)
        if motion is not None:
            contact = overlays.contact(motion)
            depth = np.concatenate(list(overlays.depths(self.groom.scalp, corners, locks, points)))
            shown["inside"] = int(np.count_nonzero(depth))
        return pack(
            protocol.Frame.model_validate({"layer": layer, "frame": frame, "statistics": shown}),
            points=points - self.groom.origin,
            axis=axis,
            root=root,
            drawn=drawn,
            left=left[drawn],
            bodies=np.concatenate([np.empty((0, 3)), *bodies]) - self.groom.origin,
            stretch=overlays.stretch(locks, points),
            contact=contact,
            depth=overlays.as_bytes(depth / overlays.DEPTH_SHOWN),
            curl=overlays.curl_loss(locks, self.turning, points),
        )

    def speeds(self, before: NDArray[np.floating], now: NDArray[np.floating]) -> tuple[float, float]:
        """Mean speeds of tips and of roots between two successive frames [m/s].

        before, now: positions of the locks [m], shape (n, 3)
        """
        offsets = self.groom.locks.offsets
        moved = self.clip.fps * np.linalg.norm(np.asarray(now, np.float64) - before, axis=1)
        return float(moved[offsets[1:] - 1].mean()), float(moved[offsets[:-1]].mean())


def shown_statistics(statistics: dict[str, Any]) -> dict[str, Any]:
    """Statistics of a frame that the page displays."""
    contact = statistics.get("contact", {})
    return {
        "wall_ms": statistics.get("wall_ms"),
        "max_stretch": statistics.get("max_stretch"),
        "newton": statistics.get("newton"),
        "nan": statistics.get("nan", 0),
        "contacts": contact.get("contacts"),
        "inside": None,
    }
