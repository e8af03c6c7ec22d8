"""Conversion of hair between file formats."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import numpy as np

from ringlet import io
from ringlet.data import limits
from ringlet.data.bounds import check_curves
from ringlet.data.errors import UserError
from ringlet.data.files import check_place
from ringlet.data.frames import frames_within
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.random import Random
from ringlet.data.reads import recorded
from ringlet.data.resampling import Resampling
from ringlet.data.stage import StageSpace
from ringlet.io import Rod
from ringlet.shot import read_shot

SEED = 1  # of the choice of strands


@recorded()
def convert(
    source: Path | str,
    target: Path | str,
    *,
    source_unit: float | None = None,
    source_up: Literal["Y", "Z"] | None = None,
    unit: float | None = None,
    up: Literal["Y", "Z"] | None = None,
    only: Literal["hairs", "guides"] | None = None,
    bodies: bool = True,
    frames: tuple[int, int] | None = None,
    fraction: float = 1.0,
    wider: bool = False,
    points: int | None = None,
    unreal: bool = False,
    deformable: Path | str | None = None,
) -> dict[str, Any]:
    """Converts a file of hair to the format that the suffix of the target names.

    Formats are USD, Alembic (``.abc``), ``.hair``, TressFX (``.tfx``) and polylines of OBJ.

    source_unit, source_up: unit [m] and up-axis of a source that stores neither; by default centimetres for Alembic,
                            else metres, and Y
    unit, up: unit [m] and up-axis of the target; by default centimetres and Y for Alembic, else those of the source;
              metres with ``deformable``, as simulators ask for
    only:     leaves the other curves out
    bodies:   writes surfaces too, where the format holds any
    frames:   first and last frame; all by default. A format of one pose holds that of the first, or the rest pose
    fraction: share of the hairs to keep, in (0, 1], or of the guides where there are no hairs; the same ones every
              time. With ``wider`` these make up by their width for those left out
    points:   points of each curve, evenly spaced along it; as they are by default
    unreal:   writes an archive that Unreal imports as a groom: without surfaces, of at most 255 points a hair and 32 a
              guide
    deformable: a shot, whose ``[strands]`` is the material: writes guides at rest, or hairs where there are none, as
              elastic rods of the AOUSD proposal for deformable bodies, with surfaces as colliders

    Returns numbers of ``hairs``, ``guides``, ``points``, ``bodies`` and ``frames`` that were written, the ``unit`` [m]
    and the axis ``up``, and ``lost``: a sentence for each thing that the format cannot hold.
    """
    limits.check_count("points", 2 if points is None else points - 1, limits.POINTS - 1)
    if not 0.0 < fraction <= 1.0:
        raise UserError(f"fraction is {fraction:g}; must be more than 0 and at most 1")
    kind = io.format_of(target)
    if unreal and kind.name != "Alembic":
        raise UserError(f"{target}: is no archive, which is what Unreal imports; must end in .abc")
    rod = None if deformable is None else _rod(deformable, target, frames)
    source_space = source_space_of(source, source_unit, source_up)
    with io.open_scene(source, source_space) as scene:
        check_place(target)
        default = kind.space if kind.several and kind.space else scene.space
        if rod is not None:
            default = replace(default, meters_per_unit=1.0)
        space = StageSpace(unit or default.meters_per_unit, up or default.up_axis, scene.space.fps)
        chosen = frames_within(scene.frames, frames, source)
        scene = replace(scene, frames=chosen, bodies=scene.bodies if bodies else [])
        scene.sets = _thinned(_chosen(scene, only, source), fraction, wider, points)
        has_unit = io.format_of(source).space is None
        remedy = "write the file again, in its unit" if has_unit else "give the unit of the file with --from-unit"
        for one in scene.sets if kind.name == "USD" else ():
            check_curves(one.curves, one.curves.points, one.curves.roots, f"{source}: {one.name}", remedy)
        one_pose = frames is not None and not kind.several
        if one_pose:
            scene = scene.posed(scene.frames[0])
        lost = list[str]()
        if unreal:
            scene, lost = io.for_unreal(scene)
        if rod is None:
            written, unheld = io.write_scene(scene, target, space)
        else:
            written, unheld = _simulated(scene)
            io.write_deformable_scene(written, rod, Path(target), space)
        lost += unheld
        if one_pose:
            lost.insert(0, f"{kind.name} holds one pose: that of frame {scene.frames[0]:g}")
    return {
        "hairs": sum(len(one.curves) for one in written.sets if not one.guide),
        "guides": sum(len(one.curves) for one in written.sets if one.guide),
        "points": sum(len(one.curves.points) for one in written.sets),
        "bodies": len(written.bodies),
        "frames": len(written.frames),
        "unit": space.meters_per_unit,
        "up": space.up_axis,
        "lost": lost,
    }


def _rod(shot: Path | str, target: Path | str, frames: tuple[int, int] | None) -> Rod:
    """The material of a shot's strands, for a target that holds rods; raises UserError for another target."""
    if io.format_of(target).name != "USD":
        raise UserError(f"{target}: holds no deformable curves; must be a .usdc, .usd or .usda file")
    if frames is not None:
        raise UserError(f"frames {frames[0]} to {frames[1]}: deformable curves are written at rest; leave them out")
    material = read_shot(shot).strands
    stretch = material.youngs_modulus * np.pi * material.radius**2
    bend = material.bend_scale * stretch * material.radius**2 / 4
    return io.Rod(
        radius=material.radius,
        density=material.density,
        stretch=material.stretch_scale * stretch,
        bend=bend,
        twist=material.twist_ratio * bend,
    )


def _simulated(scene: HairScene) -> tuple[HairScene, list[str]]:
    """Guides at rest, or hairs where there are none, with surfaces at rest; and what is left out."""
    sets = [one for one in scene.sets if one.guide] or scene.sets
    hairs = sum(len(one.curves) for one in scene.sets if one not in sets)
    lost = [f"deformable curves are guides: without {hairs:,} hairs"] if hairs else []
    if any(clip for _, clip in scene.bodies):
        lost.append(f"deformable curves are at rest: without the motion of {len(scene.frames)} frames")
    at_rest = replace(scene, sets=sets, bodies=[(mesh, None) for mesh, _ in scene.bodies], frames=np.empty(0))
    return at_rest.posed(None), lost


def source_space_of(source: Path | str, unit: float | None, up: Literal["Y", "Z"] | None) -> StageSpace | None:
    """Unit and up-axis of a source that stores neither; None for its defaults.

    Raises UserError where one is given for a format that stores it.
    """
    if unit is None and up is None:
        return None
    default = io.format_of(source).space
    if default is None:
        raise UserError(f"{source}: stores its unit and up-axis; leave --from-unit and --from-up out")
    return StageSpace(unit or default.meters_per_unit, up or default.up_axis)


def _chosen(scene: HairScene, only: str | None, source: Path | str) -> list[CurveSet]:
    """Hairs, guides, or both; raises UserError for a source without those that are asked for."""
    chosen = [one for one in scene.sets if only is None or one.guide == (only == "guides")]
    if only is not None and not chosen:
        other = "guides" if only == "hairs" else "hairs"
        raise UserError(f"{source}: has no {only}; leave --only out, or ask for its {other}")
    return chosen


def _thinned(sets: list[CurveSet], fraction: float, wider: bool, points: int | None) -> list[CurveSet]:
    """A share of the curves, with other numbers of points; all guides of hairs, which name them by their rows."""
    if fraction < 1.0:
        hairs = any(not one.guide for one in sets)
        sets = [one if one.guide and hairs else _share(one, fraction, wider) for one in sets]
    return sets if points is None else [Resampling(one.curves, points).curve_set(one) for one in sets]


def _share(one: CurveSet, fraction: float, wider: bool) -> CurveSet:
    """A share of the curves, the same ones every time; wider by as much, if asked for."""
    order = Random(SEED, "convert").uniform(one.curves.ids)
    kept = np.sort(np.argsort(order, kind="stable")[: max(1, round(fraction * len(one.curves)))])
    rows, curves, motion = one.curves.point_rows(kept), one.curves.take(kept), one.motion
    for values in (curves.curve, curves.point) if wider else ():
        if "width" in values:
            values["width"] = values["width"] * np.float32(len(one.curves) / len(kept))
    return replace(one, curves=curves, motion=None if motion is None else (lambda frame: motion(frame)[rows]))
