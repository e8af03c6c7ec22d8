"""Movies of a USD stage: the clip, and a turntable."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

from ringlet import io, picture
from ringlet.api.pictures import first_frame, lock_points, pose_at, shutter_poses
from ringlet.api.progress import Progress
from ringlet.data import limits
from ringlet.data.errors import UserError
from ringlet.data.frames import frames_within
from ringlet.data.picture import PictureSettings
from ringlet.data.reads import recorded
from ringlet.picture import Movie, Pose

TURNTABLE_FPS = 24.0


@recorded()
def write_movie(
    stage: Path | str,
    path: Path | str,
    *,
    frames: tuple[int, int] | None = None,
    progress: Progress | None = None,
    **settings: Any,
) -> Movie:
    """Path-traces the frames of a USD stage, with one camera that sees the whole motion, or with one of the stage.

    Frames that are there already, from the same hairs, bodies, camera and settings, are kept.

    path:     a .mp4 or .mov, whose frames go to a folder of its name, or a folder of PNG frames. Without the package
              imageio-ffmpeg there are only frames
    frames:   first and last; all by default
    settings: those of ``PictureSettings``
    """
    stage, path, look = Path(stage), Path(path), PictureSettings.of(settings)
    picture.check_output(path, look)
    if not len(held := io.read_hair_frames(stage)):
        raise UserError(f"{stage}: has no frames for a movie; give hairs made with --cache")
    chosen = frames_within(held, frames, stage).tolist()
    standpoint = None
    if look.camera is None:
        poses = (pose_at(stage, frame) for frame in _reported(chosen, progress))
        standpoint = picture.still_standpoint(
            ((pose, lock_points(stage, pose.hairs, look.look_at)) for pose in poses), look
        )
    shots = [picture.Shot(int(frame), partial(_poses, stage, frame, look), standpoint) for frame in chosen]
    return picture.film(shots, path, look, io.read_space(stage).fps, progress)


@recorded()
def write_turntable(
    stage: Path | str,
    path: Path | str,
    *,
    frame: float | None = None,
    views: int = 72,
    progress: Progress | None = None,
    **settings: Any,
) -> Movie:
    """Path-traces one frame of a USD stage from all sides, at 24 views a second; the studio goes with the camera.

    Views that are there already, from the same hairs, bodies and settings, are kept.

    path:     as in ``write_movie``
    frame:    the first of the stage by default
    views:    their number, counter-clockwise from above
    settings: those of ``PictureSettings``, without a camera of the stage, a lock, and motion blur
    """
    stage, path, look = Path(stage), Path(path), PictureSettings.of(settings)
    limits.check_count("views", views, limits.FRAMES)
    for name in ("camera", "look_at", "shutter"):
        if getattr(look, name):
            raise UserError(f"turntable: --{name.replace('_', '-')} has no effect on a turntable; leave it out")
    picture.check_output(path, look)
    pose = pose_at(stage, first_frame(stage, frame))
    shots = [
        picture.Shot(number, lambda: (pose, None), standpoint)
        for number, standpoint in enumerate(picture.turned_standpoints(pose, look, views), 1)
    ]
    return picture.film(shots, path, look, TURNTABLE_FPS, progress)


def _poses(stage: Path, frame: float, look: PictureSettings) -> tuple[Pose, Pose | None]:
    return shutter_poses(stage, frame, pose_at(stage, frame, look.camera), look)


def _reported(frames: list[float], progress: Progress | None) -> Any:
    """The frames, reported as they are read to place the camera."""
    for done, frame in enumerate(frames):
        if progress:
            progress("framing", done, len(frames))
        yield frame
    if progress:
        progress("framing", len(frames), len(frames))
