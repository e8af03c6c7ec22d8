"""Pictures of what is in a USD stage, and of lofts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ringlet.api.grooms import read_groom
from ringlet.api.hairs import build_hairs
from ringlet.api.progress import Progress
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.reads import recorded
from ringlet.data.settings import check_name

if TYPE_CHECKING:
    from ringlet.rest.loft import Loft

__all__ = ["write_loft_picture", "write_sheet", "write_still", "write_touches_picture"]


LOCK_WIDTH = 8e-4  # of locks among their contacts: thinner ones are lost before skin in a quick picture [m]
VEIL = 0.3  # opacity of cloth in a picture of contacts: most of them are behind it


@recorded()
def write_still(
    stage: Path | str,
    path: Path | str,
    *,
    frame: float | None = None,
    width: int = 900,
    height: int = 1000,
    samples: int = 40,
    view: str = "three_quarter",
    color: str | None = None,
    seconds: float | None = None,
    progress: Progress | None = None,
) -> None:
    """Path-traces one frame of a USD stage to a PNG: the hairs and the bodies in it, framed on their own.

    frame:   the first of the stage by default
    view:    ``three_quarter``, ``front``, ``side`` or ``back``
    color:   a name of ``HAIR_COLORS``; by default the hairs' own, or dark brown where they have none
    seconds: stop adding samples after that long
    """
    from ringlet import picture

    bodies, hairs = _posed(Path(stage), frame)
    picture.still(
        bodies,
        hairs,
        Path(path),
        width=width,
        height=height,
        samples=samples,
        view=view,
        color=color,
        seconds=seconds,
        progress=progress,
    )


@recorded()
def write_touches_picture(
    stage: Path | str,
    path: Path | str,
    *,
    show: str = "force",
    frame: float | None = None,
    width: int = 900,
    height: int = 1000,
    samples: int = 40,
    view: str = "three_quarter",
    seconds: float | None = None,
    progress: Progress | None = None,
) -> None:
    """Draws what ``write_touches`` wrote, with the locks and the bodies around it, as coloured beads;
    cloth is seen through, since most of what touches it is behind it.

    show:  ``force``: where how hard, from blue to red over three decades, up to the strongest in a hundred;
           ``gap``: red where hardly anything is left;
           ``start``: all places that were in the way when the shot began, red where worst
    frame: the first by default
    """
    from ringlet import io, picture

    check_name(show, ("force", "gap", "start"), "picture", "way to show contacts")
    stage = Path(stage)
    touches, colors = io.read_touches(stage, frame)
    locks = read_groom(stage).locks
    with io.open_cache(stage) as cache:
        at = cache.frames[0] if frame is None else frame
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
    picture.still(
        posed,
        Curves(posed_locks, locks.offsets, locks.ids, point={"width": np.full(len(posed_locks), LOCK_WIDTH)}),
        Path(path),
        width=width,
        height=height,
        samples=samples,
        view=view,
        color="black",
        seconds=seconds,
        progress=progress,
    )


@recorded()
def write_sheet(
    stage: Path | str,
    path: Path | str,
    *,
    frames: tuple[int, int] | None = None,
    count: int = 12,
    title: str = "",
    color: str | None = None,
    progress: Progress | None = None,
) -> None:
    """Draws ``count`` frames of a USD stage, evenly spread, on one page, under a title if there is one."""
    from ringlet import io, picture

    chosen = [f for f in io.read_hair_frames(Path(stage)) if frames is None or frames[0] <= f <= frames[1]]
    if not chosen:
        raise UserError(f"{stage}: has no frames to draw a sheet of; give hairs made with --cache, or other frames")
    spread = [chosen[i] for i in np.unique(np.linspace(0, len(chosen) - 1, count).round().astype(int))]
    picture.sheet(
        ((frame, *_posed(Path(stage), frame)) for frame in spread),
        Path(path),
        title=title,
        fps=io.read_space(Path(stage)).fps,
        color=color,
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
    from ringlet import groom as grooms
    from ringlet import picture

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


def _posed(stage: Path, frame: float | None) -> tuple[list[Any], Any]:
    """Bodies and hairs of a stage at a frame, as the pictures take them."""
    from ringlet import io, picture

    if len(frames := io.read_hair_frames(stage)):
        frame = float(frames[0]) if frame is None else frame
        if not frames[0] <= frame <= frames[-1]:
            raise UserError(f"{stage}: has no hairs at frame {frame:g}; it holds {frames[0]:g} to {frames[-1]:g}")
    bodies, hairs, _ = io.read_stage(stage, frame)
    if hairs is None:
        raise UserError(f"{stage}: has no hairs; make them with: ringlet hair {stage} -o hair.usdc")
    return [picture.PosedBody(body.mesh, body.clip.points[0]) for body in bodies], hairs
