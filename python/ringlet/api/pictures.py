"""Pictures of what is in a USD stage, and of lofts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet import groom as grooms
from ringlet import io, picture
from ringlet.api.grooms import read_groom
from ringlet.api.hairs import build_hairs
from ringlet.api.progress import Progress
from ringlet.data.camera import Camera
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.frames import frames_within
from ringlet.data.picture import PictureSettings
from ringlet.data.reads import recorded
from ringlet.data.settings import check_name
from ringlet.picture import Pose
from ringlet.rest.loft import Loft

LOCK_WIDTH = 8e-4  # of locks among their contacts: thinner ones are lost before skin in a quick picture [m]
SHEET_SETTINGS = ("view", "color", "light", "light_turn")  # that a sheet takes
VEIL = 0.3  # opacity of cloth in a picture of contacts: most of them are behind it


@recorded()
def write_still(
    stage: Path | str,
    path: Path | str,
    *,
    frame: float | None = None,
    progress: Progress | None = None,
    **settings: Any,
) -> None:
    """Path-traces one frame of a USD stage: the hairs and the bodies in it, framed on their own.

    path:     a PNG, a JPEG, or an EXR, which has linear light and layers: depth, normal, albedo, motion until the next
              frame, lock, and mattes of locks, grooms and bodies
    frame:    the first of the stage by default
    settings: those of ``PictureSettings``: ``width=480, samples=16, view="side", light="window"``
    """
    stage, chosen = Path(stage), PictureSettings.of(settings)
    frame = first_frame(stage, frame)
    pose = pose_at(stage, frame, chosen.camera)
    opening, closing = shutter_poses(stage, frame, pose, chosen)
    lock = lock_points(stage, pose.hairs, chosen.look_at)
    later = pose_after(stage, frame, chosen) if Path(path).suffix.lower() == ".exr" else None
    picture.still(opening, path, chosen, lock=lock, closing=closing, later=later, progress=progress)


@recorded()
def write_touches_picture(
    stage: Path | str,
    path: Path | str,
    *,
    show: str = "force",
    frame: float | None = None,
    progress: Progress | None = None,
    **settings: Any,
) -> None:
    """Draws what ``write_touches`` wrote, with the locks and the bodies around it, as coloured beads;
    cloth is seen through, since most of what touches it is behind it.

    show:  ``force``: where how hard, from blue to red over three decades, up to the strongest in a hundred;
           ``gap``: red where hardly anything is left;
           ``start``: all places that were in the way when the shot began, red where worst
    frame: the first by default
    settings: those of ``PictureSettings``; locks are black
    """
    chosen = PictureSettings.of(settings | {"color": "black"})
    if chosen.shutter:
        raise UserError("picture: contacts have no motion blur; leave out the shutter")
    check_name(show, ("force", "gap", "start"), "picture", "way to show contacts")
    stage = Path(stage)
    touches, colors = io.read_touches(stage, frame)
    locks = read_groom(stage).locks
    with io.open_cache(stage) as cache:
        at = cache.frames[0] if frame is None else cache.within((frame, frame))[0]
        posed_locks, start, cloths = cache.points(at), cache.start, cache.cloth_prims
    places, part = touches.places, 0.009  # of the picture's size
    if show == "gap":
        colors = io.heat(1.0 - np.clip(touches.gap, 0.0, 1.0))
    elif show == "start":
        places, depth = io.start_marks(start)
        colors = io.heat(depth)
    bodies, _, _ = io.read_stage(stage, float(at))
    veils = [VEIL if body.mesh.name.rsplit(" ", 1)[-1] in cloths else 1.0 for body in bodies]
    posed = [picture.PosedBody(body.mesh, body.clip.points[0], veil) for body, veil in zip(bodies, veils, strict=True)]
    if len(places):
        posed.append(picture.beads(places, colors, part * float(np.ptp(posed_locks, axis=0).max())))
    shown = Curves(posed_locks, locks.offsets, locks.ids, point={"width": np.full(len(posed_locks), LOCK_WIDTH)})
    lock, camera = _curve_points(stage, shown, chosen.look_at), _camera(stage, chosen.camera, float(at))
    picture.still(picture.Pose(posed, shown, camera), path, chosen, lock=lock, progress=progress)


@recorded()
def write_sheet(
    stage: Path | str,
    path: Path | str,
    *,
    frames: tuple[int, int] | None = None,
    count: int = 12,
    title: str = "",
    progress: Progress | None = None,
    **settings: Any,
) -> None:
    """Draws ``count`` frames of a USD stage, evenly spread, on one page, under a title if there is one.

    settings: ``view``, ``color``, ``light`` and ``light_turn`` of ``PictureSettings``
    """
    look = PictureSettings.of(settings)
    look.refuse_all_but(SHEET_SETTINGS, "a sheet of small pictures")
    if not len(held := io.read_hair_frames(Path(stage))):
        raise UserError(f"{stage}: has no frames to draw a sheet of; give hairs made with --cache")
    chosen = frames_within(held, frames, stage).tolist()
    spread = [chosen[i] for i in np.unique(np.linspace(0, len(chosen) - 1, count).round().astype(int))]
    picture.sheet(
        ((frame, *_posed(Path(stage), frame)) for frame in spread),
        Path(path),
        title=title,
        fps=io.read_space(Path(stage)).fps,
        settings=look,
        progress=progress,
    )


def write_loft_picture(
    loft: Loft,
    path: Path | str,
    *,
    title: str = "",
    view: str = "three_quarter",
    progress: Progress | None = None,
) -> None:
    """Draws the hair as groomed, as it hangs without the loft, where that is known, and with it, on one page."""
    groom = loft.groom
    hairs = build_hairs(groom, fraction=min(1.0, 6000 / grooms.hair_count(groom)))
    shapes = {"groomed": groom.locks.points, "hanging, not lofted": loft.sagged, "hanging, lofted": loft.lofted}
    shapes = {name: points for name, points in shapes.items() if points is not None}
    picture.compare(
        {name: hairs.curves.with_points(hairs.deformed(points, groom.scalp.points)) for name, points in shapes.items()},
        [picture.PosedBody(groom.scalp, groom.scalp.points)],
        Path(path),
        title=title,
        view=view,
        progress=progress,
    )


def first_frame(stage: Path, frame: float | None) -> float | None:
    """The frame of a picture, by default the first of the stage; None for static hair."""
    if not len(frames := io.read_hair_frames(stage)):
        return frame
    frame = float(frames[0]) if frame is None else frame
    if not frames[0] <= frame <= frames[-1]:
        raise UserError(f"{stage}: has no hairs at frame {frame:g}; it holds {frames[0]:g} to {frames[-1]:g}")
    return frame


def _posed(stage: Path, frame: float | None) -> tuple[list[Any], Any]:
    """Bodies and hairs of a stage at a frame, as the pictures take them."""
    bodies, hairs, _ = io.read_stage(stage, frame)
    if hairs is None:
        raise UserError(f"{stage}: has no hairs; make them with: ringlet hair {stage} -o hair.usdc")
    return [picture.PosedBody(body.mesh, body.clip.points[0]) for body in bodies], hairs


def pose_at(stage: Path, frame: float | None, camera: str | None = None) -> Pose:
    """Bodies, hairs, and the camera if one is named, of a stage at a frame."""
    return Pose(*_posed(stage, frame), _camera(stage, camera, frame), io.groom_names(stage))


def pose_after(stage: Path, frame: float | None, settings: PictureSettings) -> Pose | None:
    """The pose of the frame after one; None at the last one, and where nothing moves."""
    frames = io.read_hair_frames(stage)
    if frame is None or not len(frames) or frame + 1 > frames[-1]:
        return None
    return pose_at(stage, frame + 1, settings.camera)


def shutter_poses(stage: Path, frame: float | None, pose: Pose, settings: PictureSettings) -> tuple[Pose, Pose | None]:
    """Poses when the shutter opens and closes: from the frame on, or up to the frame if it is the last.

    Raises UserError for motion blur of hair that does not move.
    """
    if not settings.shutter:
        return pose, None
    frames = io.read_hair_frames(stage)
    if frame is None or len(frames) < 2:
        raise UserError(f"{stage}: has no frames, so that nothing moves; leave out the shutter")
    fraction = settings.shutter / 360.0
    if frame + 1 <= frames[-1]:
        return pose, pose.towards(pose_at(stage, frame + 1, settings.camera), fraction)
    return pose.towards(pose_at(stage, frame - 1, settings.camera), fraction), pose


def _camera(stage: Path, prim: str | None, frame: float | None) -> Camera | None:
    """The camera of a stage at a frame, if one is named."""
    return None if prim is None else io.read_camera(stage, prim, frame)


def lock_points(stage: Path, hairs: Curves, lock: int | None) -> NDArray[np.floating] | None:
    """Points of the hairs of a lock by its id [m]; of one curve, in a stage without locks; None for no lock."""
    if lock is None or "lock" not in hairs.curve:
        return _curve_points(stage, hairs, lock)
    row = read_groom(stage).locks.row_of(lock, str(stage))
    chosen = hairs.take(hairs.curve["lock"] == row)
    if not len(chosen):
        raise UserError(f"{stage}: lock {lock} has no hairs in it; choose another, or make all hairs")
    return chosen.points


def _curve_points(stage: Path, curves: Curves, lock: int | None) -> NDArray[np.floating] | None:
    """Points of the curve with an id [m]."""
    return None if lock is None else curves[curves.row_of(lock, str(stage))]
