"""Formats of hair: how a file is opened and written, and what each can hold."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ringlet.data.attributes import fits
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.resampling import Resampling
from ringlet.data.stage import StageSpace
from ringlet.data.surfaces import color_of
from ringlet.io import unreal
from ringlet.io.alembic import SCHEMA, holds, open_alembic, write_alembic
from ringlet.io.hair import read_hair, write_hair
from ringlet.io.obj import read_obj_curves, write_obj_curves
from ringlet.io.tfx import SIZES as TFX_SIZES
from ringlet.io.tfx import read_tfx, write_tfx
from ringlet.io.usd.scene import open_usd_scene, unwritten_in_usd, write_usd_scene

METRES, CENTIMETRES = StageSpace(), StageSpace(0.01)
# Shapes of one value of attributes that have a type of their own in USD or Alembic.
ROWS = {name: () for name in ("groom_group_id", "groom_guide", "skinprim", "guide_curve_index", "clumpid")}
ROWS |= {
    "st": (2,),
    "groom_root_uv": (2,),
    "skinprimuv": (2,),
    "surface_uv_coordinate": (2,),
    "groom_color": (3,),
    "displayColor": (3,),
}


@dataclass(frozen=True)
class Format:
    """What a format of hair holds.

    several: guides and hairs apart, surfaces and motion; the others hold one set of curves at rest
    widths:  ``point``, ``curve`` or ``none``
    sizes:   numbers of points of a curve, of which all curves have one; empty for any
    named:   further attributes, with names
    kept:    attributes besides widths of a format without names: whether each is of a ``curve`` or a ``point``, and the
             shape of one value
    space:   unit and up-axis that a file is taken to have; None where the file says
    """

    name: str
    several: bool = False
    widths: str = "none"
    sizes: tuple[int, ...] = ()
    named: bool = False
    kept: dict[str, tuple[str, tuple[int, ...]]] = field(default_factory=dict)
    space: StageSpace | None = METRES
    read: Callable[[Path, StageSpace], Curves] | None = None
    write: Callable[[Curves, Path, StageSpace], None] | None = None


USD = Format("USD", several=True, widths="point", named=True, space=None)
FORMATS = {
    ".usd": USD,
    ".usda": USD,
    ".usdc": USD,
    ".abc": Format("Alembic", several=True, widths="point", named=True, space=CENTIMETRES),
    ".hair": Format(
        ".hair",
        widths="point",
        kept={"color": ("point", (3,)), "displayOpacity": ("point", ())},
        read=read_hair,
        write=write_hair,
    ),
    ".tfx": Format(
        ".tfx", widths="curve", sizes=TFX_SIZES, kept={"st": ("curve", (2,))}, read=read_tfx, write=write_tfx
    ),
    ".obj": Format("OBJ", read=read_obj_curves, write=write_obj_curves),
}


def format_of(path: Path | str) -> Format:
    """The format that the suffix of a file names; raises UserError for another."""
    suffix = Path(path).suffix.lower()
    if suffix == ".usdz":
        return USD
    if suffix not in FORMATS:
        raise UserError(f"{path}: ends in '{Path(path).suffix}'; must end in {', '.join(FORMATS)}")
    return FORMATS[suffix]


@contextmanager
def open_scene(path: Path | str, space: StageSpace | None = None) -> Iterator[HairScene]:
    """Opens a file of hair; its frames are read as they are asked for.

    space: unit and up-axis of a format that stores neither; by default centimetres for Alembic, else metres, Y up

    Raises UserError for a file that is not readable or has neither curves nor surfaces.
    """
    path, kind = Path(path), format_of(path)
    if kind.read is not None:
        space = space or kind.space or StageSpace()
        yield HairScene([CurveSet("hairs", kind.read(path, space))], space=space)
        return
    opened = open_usd_scene(path) if kind is USD else open_alembic(path, space or CENTIMETRES)
    with opened as scene:
        if not scene.sets and not scene.bodies:
            raise UserError(f"{path}: has neither curves nor surfaces; export it again or choose another")
        yield scene


def write_scene(scene: HairScene, path: Path | str, space: StageSpace) -> tuple[HairScene, list[str]]:
    """Writes a scene in a format.

    space: unit and up-axis of the file

    Returns the scene as it is in the file, and a sentence for each thing that the format cannot hold.

    Raises UserError for a scene without curves, in a format that holds nothing else.
    """
    path, kind = Path(path), format_of(path)
    if path.suffix.lower() == ".usdz":
        raise UserError(f"{path}: packages are not written; name a .usdc, .usd or .usda file")
    scene = _typed(scene)
    if kind.write is None:
        (write_usd_scene if kind is USD else write_alembic)(scene, path, space)
        return scene, [*scene.unread, *_unheld(scene, kind)]
    if not scene.sets:
        raise UserError(
            f"{path}: there are no curves to write, and {kind.name} holds nothing else; choose a .usdc or .abc file"
        )
    curves, lost = _one_set(scene, kind)
    kind.write(curves, path, space)
    written = CurveSet("hairs", curves, guide=scene.shown[0].guide)
    return HairScene([written], space=scene.space), [*scene.unread, *lost]


def _typed(scene: HairScene) -> HairScene:
    """The scene without the attributes of other types than their names have; it notes these as unread."""
    kinds = [kind for one in scene.sets for kind in (one.curves.curve, one.curves.point)]
    wrong = {name for kind in kinds for name, row in ROWS.items() if name in kind and not fits(kind[name], row)}
    if not wrong:
        return scene

    def right(kind: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        return {name: values for name, values in kind.items() if name not in wrong}

    curves = [replace(one.curves, curve=right(one.curves.curve), point=right(one.curves.point)) for one in scene.sets]
    sets = [replace(one, curves=of) for one, of in zip(scene.sets, curves, strict=True)]
    sentence = f"values of another type than that of their attribute are left out: without {', '.join(sorted(wrong))}"
    return replace(scene, sets=sets, unread=[*scene.unread, sentence])


def _unheld(scene: HairScene, kind: Format) -> list[str]:
    """What USD and Alembic do not hold."""
    if kind is USD:
        return list(unwritten_in_usd(scene))
    lost = list[str]()
    named = [pair for one in scene.sets for pair in (*one.curves.curve.items(), *one.curves.point.items())]
    if names := sorted({name for name, values in named if not holds(values)} - SCHEMA):
        lost.append(f"{kind.name} holds numbers of 32 bits in rows of up to three: without {', '.join(names)}")
    if (most := max((int(one.curves.counts.max()) for one in scene.sets), default=0)) > unreal.POINTS:
        lost.append(f"Unreal takes at most {unreal.POINTS} points of a curve, and there are {most}: add --unreal")
    if names := sorted(
        {name for one in scene.sets for name in one.curves.point} & {*unreal.ATTRIBUTES} - {"groom_color"}
    ):
        lost.append(f"{kind.name} holds Unreal's attributes for whole curves: without {', '.join(names)} of points")
    lost += _materials(scene, kind)
    meshes = [mesh for mesh, _ in scene.bodies]
    if any(mesh.colors is not None or mesh.color != color_of(mesh.name) for mesh in meshes):
        lost.append(f"{kind.name} is written without the colours of surfaces")
    if regions := sorted({name for mesh in meshes for name in (*mesh.regions, *mesh.maps, *mesh.vectors)}):
        lost.append(f"{kind.name} is written without regions and maps of surfaces: without {', '.join(regions)}")
    return lost


def _materials(scene: HairScene, kind: Format) -> list[str]:
    held = any(one.material for one in scene.sets)
    return [f"{kind.name} holds no materials: without that of hairs"] if held else []


def _one_set(scene: HairScene, kind: Format) -> tuple[Curves, list[str]]:
    """The curves that a format of one set holds, and a sentence for each thing that it does not."""
    shown, lost = scene.shown, list[str]()
    curves = joined(shown)
    every = {name for one in shown for name in (*one.curves.curve, *one.curves.point)}
    if some := sorted(every - {*curves.curve, *curves.point}):
        lost.append(f"only some curves have {', '.join(some)}: {kind.name} holds one set, without them")
    if left := [one for one in scene.sets if one not in shown]:
        lost.append(f"{kind.name} holds one set of curves: without {sum(len(one.curves) for one in left)} guides")
    if scene.bodies:
        lost.append(f"{kind.name} holds no surfaces: without {', '.join(mesh.name for mesh, _ in scene.bodies)}")
    if any(one.motion for one in shown):
        lost.append(f"{kind.name} holds one pose: the rest pose, as no frame of {len(scene.frames)} is chosen")
    most = int(curves.counts.max())
    if kind.sizes and ((curves.counts != most).any() or most not in kind.sizes):
        count = next((size for size in kind.sizes if size >= most), kind.sizes[-1])
        sizes = ", ".join(map(str, kind.sizes))
        lost.append(f"{kind.name} holds curves of {sizes} points, all of one number: all were resampled to {count}")
        curves = Resampling(curves, count).curves(curves)
    own = "width" in curves.point, "width" in curves.curve
    if any(own) and kind.widths == "none":
        lost.append(f"{kind.name} holds no widths")
    elif own[0] and kind.widths == "curve":
        widths = np.maximum.reduceat(curves.point["width"], curves.offsets[:-1])
        curves = replace(curves, curve={**curves.curve, "width": widths})
        lost.append(f"{kind.name} holds one width for each curve: the largest of its points")
    elif own[1] and kind.widths == "point":
        widths = np.repeat(curves.curve["width"], curves.counts)
        curves = replace(curves, point={**curves.point, "width": widths})
    kept = _kept(curves, kind)
    if names := {*curves.curve, *curves.point} - {*kept.curve, *kept.point, "width"}:
        lost.append(f"{kind.name} holds no such attributes: without {', '.join(sorted(names))}")
    curves = kept
    lost += _materials(scene, kind)
    if any((one.curves.ids != np.arange(len(one.curves))).any() for one in shown):
        lost.append(f"{kind.name} holds no ids: curves are numbered from 0")
    return curves, lost


def _kept(curves: Curves, kind: Format) -> Curves:
    """The curves with widths, and with those attributes that the format has a place for."""
    curve, point = ({"width": kind["width"]} if "width" in kind else {} for kind in (curves.curve, curves.point))
    for name, (scope, row) in kind.kept.items():
        of_points, of_curves = curves.point.get(name), curves.curve.get(name)
        values = of_curves if of_points is None else of_points
        if values is None or not fits(values, row):
            continue
        if scope == "point":
            point[name] = np.repeat(values, curves.counts, axis=0) if of_points is None else values
        elif of_points is None:
            curve[name] = values
    return replace(curves, curve=curve, point=point)


def joined(sets: list[CurveSet]) -> Curves:
    """All curves as one set, with the attributes that all have."""
    every = [one.curves for one in sets]
    if len(every) == 1:
        return every[0]

    def shared(kind: str) -> list[dict[str, np.ndarray]]:
        sets_of_values = [getattr(curves, kind) for curves in every]
        names = sorted(set.intersection(*map(set, sets_of_values)))
        return [{name: values[name] for name in names} for values in sets_of_values]

    made = Curves.joined(
        [
            replace(curves, curve=curve, point=point)
            for curves, curve, point in zip(every, shared("curve"), shared("point"), strict=True)
        ]
    )
    unique = len(np.unique(made.ids)) == len(made)
    return made if unique else replace(made, ids=np.arange(len(made), dtype=np.int64))
