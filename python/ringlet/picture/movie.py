"""Movies: frames in a folder, each kept when it was made from the same inputs and settings, and a video of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import astuple, dataclass, fields, replace
from hashlib import blake2b
from importlib.metadata import version
from importlib.util import find_spec
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from ringlet.data.errors import UserError
from ringlet.data.extras import need
from ringlet.data.files import check_place, replacing
from ringlet.data.picture import PictureSettings
from ringlet.picture.motion import Pose
from ringlet.picture.ocio import configured
from ringlet.picture.render import Progress
from ringlet.picture.rigs import about_the_vertical
from ringlet.picture.still import Standpoint, developed, place, subject, take

INPUTS = "ringlet:inputs"  # text in a frame: digest of all that it was made from
VIDEOS = (".mp4", ".mov")
MOST_POINTS = 20_000  # of one frame, by which a movie is framed
ROUND = 24  # views by which a turntable is framed
DO_NOT_COUNT = {"seconds"}  # settings that a frame may differ in


@dataclass(frozen=True)
class Shot:
    """A frame of a movie.

    number:     in the file's name
    poses:      poses when the shutter opens and closes; None for a shutter of no time
    standpoint: camera and light; None where the pose has a camera of the stage
    """

    number: int
    poses: Callable[[], tuple[Pose, Pose | None]]
    standpoint: Standpoint | None


@dataclass(frozen=True)
class Movie:
    """What was made.

    frames:   the pictures
    rendered: number of frames that were not there already
    video:    the video, or None
    wanted:   the video that is not made, since no encoder is installed
    """

    frames: list[Path]
    rendered: int
    video: Path | None = None
    wanted: Path | None = None


def frames_folder(output: Path) -> Path:
    """Folder of the frames: the output itself, or one of the name of the video."""
    return output.with_name(f"{output.stem}.frames") if output.suffix in VIDEOS else output


def check_output(output: Path, settings: PictureSettings) -> None:
    """Raises UserError for a movie that cannot be written, before the work for it."""
    need("mitsuba")
    if output.suffix not in ("", *VIDEOS):
        raise UserError(
            f"{output}: ends in '{output.suffix}'; must end in {' or '.join(VIDEOS)}, or be a folder of frames"
        )
    settings.refuse_lights("a movie")
    if output.suffix in VIDEOS and settings.background == "transparent":
        raise UserError(f"{output}: a video cannot be transparent; give a folder, for PNG frames")
    if output.suffix in VIDEOS:
        check_place(output)
    folder = frames_folder(output)
    if folder.exists() and not folder.is_dir():
        raise UserError(f"{folder}: is a file, but frames need a folder; give another name")


def film(
    shots: Sequence[Shot], output: Path, settings: PictureSettings, fps: float, progress: Progress | None = None
) -> Movie:
    """Renders the frames that are not there yet, and encodes all of them where an encoder is installed."""
    check_output(output, settings)
    folder, paths, rendered = frames_folder(output), list[Path](), 0
    for done, shot in enumerate(shots):
        if progress:
            progress("frames", done, len(shots))
        paths.append(folder / f"{shot.number:04d}.png")
        rendered += _frame(shot, paths[-1], settings)
    if progress:
        progress("frames", len(shots), len(shots))
    if output.suffix not in VIDEOS:
        return Movie(paths, rendered)
    if not can_encode():
        return Movie(paths, rendered, wanted=output)
    encode(paths, output, fps)
    return Movie(paths, rendered, video=output)


def _frame(shot: Shot, path: Path, settings: PictureSettings) -> bool:
    """Renders a frame unless it is there already; returns whether it did."""
    pose, closing = shot.poses()
    key = _digest(pose, closing, shot.standpoint, settings)
    if path.exists() and _made_from(path) == key:
        return False
    taken = take(pose, settings, closing=closing, standpoint=shot.standpoint)
    about = PngInfo()
    about.add_text(INPUTS, key)
    with replacing(path) as aside:
        developed(taken.image, settings.background).save(aside, pnginfo=about)
    return True


def _made_from(path: Path) -> str:
    """Digest in a frame; raises UserError for a file that is no frame of a movie."""
    try:
        with Image.open(path) as image:
            key = image.info.get(INPUTS)
    except OSError:
        key = None
    if not isinstance(key, str):
        raise UserError(f"{path}: is no frame that Ringlet made; give another folder, or move it away")
    return key


def _digest(pose: Pose, closing: Pose | None, standpoint: Standpoint | None, settings: PictureSettings) -> str:
    """Digest of all that a frame is made from: geometry, camera, light and settings."""
    found = blake2b(digest_size=16)
    look = {f.name: getattr(settings, f.name) for f in fields(settings) if f.name not in DO_NOT_COUNT}
    rest: list[Any] = [version("ringlet"), look, standpoint and astuple(standpoint), configured()]
    if Path(settings.light).is_file():
        rest.append(blake2b(Path(settings.light).read_bytes()).hexdigest())
    for at in (pose, closing):
        if at is None:
            continue
        rest.append(at.camera and astuple(at.camera))
        for body in at.bodies:
            rest += [body.mesh.name, body.mesh.color, body.opacity]
            for array in (body.points, body.mesh.triangles, body.mesh.colors):
                found.update(b"" if array is None else np.ascontiguousarray(array).tobytes())
        hairs = at.hairs
        for array in (hairs.points, hairs.offsets, *chain(*(sorted_values(a) for a in (hairs.point, hairs.curve)))):
            found.update(np.ascontiguousarray(array).tobytes())
    found.update(repr(rest).encode())
    return found.hexdigest()


def sorted_values(attributes: dict[str, NDArray]) -> list[NDArray]:
    """Arrays of attributes, in the order of their names."""
    return [attributes[name] for name in sorted(attributes)]


def still_standpoint(
    poses: Iterable[tuple[Pose, NDArray[np.floating] | None]], settings: PictureSettings
) -> Standpoint:
    """Camera and light for a whole clip.

    poses: the pose of each frame, and the points of the lock to look at, if one is
    """
    seen, locks = [], []
    for pose, lock in poses:
        seen += [_some(points) for points in subject(pose)]
        locks += [] if lock is None else [_some(lock)]
    return place(settings, seen, np.concatenate(locks) if locks else None)


def turned_standpoints(pose: Pose, settings: PictureSettings, count: int) -> list[Standpoint]:
    """Cameras on a circle around the subject, counter-clockwise from above; the studio goes with them."""
    seen = np.concatenate([_some(points) for points in subject(pose)]).astype(np.float64)
    low, high = seen.min(axis=0), seen.max(axis=0)
    axis = np.array([0.5 * (low[0] + high[0]), 0.0, 0.5 * (low[2] + high[2])])
    swept = [(seen - axis) @ about_the_vertical(360.0 * k / ROUND) + axis for k in range(ROUND)]
    start = place(settings, swept)
    centre = np.array([axis[0], start.rig.centre[1], axis[2]])
    views = []
    for k in range(count):
        turn = about_the_vertical(-360.0 * k / count)  # of row vectors
        axes = start.camera.axes @ turn
        camera = replace(start.camera, origin=(start.camera.origin - axis) @ turn + axis, axes=axes)
        views.append(Standpoint(camera, replace(start.rig, axes=axes, centre=centre)))
    return views


def _some(points: NDArray[np.floating]) -> NDArray[np.floating]:
    """At most so many points, evenly chosen, as a picture is framed by."""
    return points[:: -(-len(points) // MOST_POINTS)] if len(points) else points


def can_encode() -> bool:
    """Whether an encoder is installed (``imageio-ffmpeg``)."""
    try:
        return find_spec("imageio_ffmpeg") is not None
    except ValueError:  # a module that was kept from being imported has no specification
        return False


def encode(frames: Sequence[Path], path: Path, fps: float) -> None:
    """Encodes pictures of one size as H.264; an odd last row or column is left out."""
    import imageio_ffmpeg  # pyright: ignore[reportMissingImports]

    with Image.open(frames[0]) as first:
        width, height = (side // 2 * 2 for side in first.size)
    with replacing(path) as aside:
        writer = imageio_ffmpeg.write_frames(
            str(aside),
            (width, height),
            fps=fps,
            codec="libx264",
            quality=8,
            macro_block_size=2,
            ffmpeg_log_level="error",
        )
        writer.send(None)
        for frame in frames:
            with Image.open(frame) as image:
                writer.send(np.ascontiguousarray(np.asarray(image.convert("RGB"))[:height, :width]))
        writer.close()
