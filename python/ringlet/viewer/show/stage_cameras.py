"""Cameras in the files of a scene: of the head, or of the stage that is shown."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ringlet import io
from ringlet.data.camera import Camera
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.shot import Shot
from ringlet.viewer import protocol
from ringlet.viewer.protocol import StageCamera
from ringlet.viewer.publisher import Publisher
from ringlet.viewer.show.scene import USD
from ringlet.viewer.wire import pack

FILM = 36.0  # height of the picture that focal lengths of the review refer to [mm]
MOST = 100


class StageCameras:
    """Publishes the cameras of a scene when its files change."""

    def __init__(self, publisher: Publisher) -> None:
        self._publisher = publisher
        self._files: list[Path] | None = None

    def show(self, groom: Groom, shot: Shot | None) -> None:
        """Publishes the cameras of the head's file, and of the other files of a shot."""
        named = [] if shot is None else list(shot.named_files().values())
        files = [file for file in dict.fromkeys([groom.scalp_file, *named]) if file and file.suffix in USD]
        if files == self._files:
            return
        self._files = files
        subject = 0.5 * (groom.locks.points.min(axis=0) + groom.locks.points.max(axis=0))
        cameras = [camera for file in files for camera in stage_cameras(file, groom.origin, subject)]
        self._publisher.publish("cameras", pack(protocol.Cameras(cameras=cameras)))


def stage_cameras(file: Path, origin: NDArray[np.float64], subject: NDArray[np.float64]) -> list[StageCamera]:
    """Cameras of a USD file at their first frame; those of which no picture can be taken are left out.

    origin:  of positions in messages [m]
    subject: what a camera without a focus looks at [m], shape (3,)
    """
    found: list[StageCamera] = []
    if not file.exists():
        return found
    for prim in io.camera_paths(file)[:MOST]:
        try:
            camera = io.read_camera(file, prim)
        except UserError:
            continue
        found.append(
            StageCamera(
                name=prim.rsplit("/", 1)[-1],
                camera=[*(camera.origin - origin), *(_target(camera, subject) - origin)],
                focal_length=float(np.clip(0.5 * FILM / camera.slopes[1], 10.0, 500.0)),
            )
        )
    return found


def _target(camera: Camera, subject: NDArray[np.float64]) -> NDArray[np.float64]:
    """Point on the optical axis about which the view turns: at the distance of the subject, or of the focus."""
    distance = float(camera.depths(subject[None])[0])
    return camera.origin - (distance if distance > 0.0 else camera.distance) * camera.axes[2]
