"""Opening, finding and writing in USD, with every mistake told in one line.

``reading`` and ``writing`` wrap all work on stages: USD's errors become ``UserError`` there, and its warnings stay off
the screen.
"""

from __future__ import annotations

import difflib
import json
import math
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pxr import Sdf, Tf, Usd, UsdGeom, UsdUtils

from ringlet.data.errors import UserError
from ringlet.data.files import replacing, same_place
from ringlet.data.stage import StageSpace

NOT_TEXT = "it holds text that is not UTF-8"
SUFFIXES = (".usd", ".usda", ".usdc", ".usdz")


@dataclass(frozen=True)
class Source:
    """A stage that is being read.

    path:  the file, as the user named it
    space: its unit, up-axis and rate
    """

    path: Path
    stage: Usd.Stage
    space: StageSpace

    def where(self, prim: Usd.Prim) -> str:
        """File and prim, for messages."""
        return f"{self.path} {prim.GetPath()}"


@contextmanager
def reading(path: Path | str) -> Iterator[Source]:
    """Opens a stage; what USD raises inside the block becomes a UserError."""
    path = Path(path)
    if not path.exists():
        raise UserError(f"{path}: there is no such file; check the name")
    if path.is_dir():
        raise UserError(f"{path}: is a folder; give a USD file")
    if path.is_file() and not path.stat().st_size:
        raise UserError(f"{path}: is empty; write it again or choose another")
    with reading_more(path):
        stage = Usd.Stage.Open(str(path))
        _reload(stage)
        yield Source(path, stage, _space(stage, path))


def _reload(stage: Usd.Stage) -> None:
    """Reads its layers anew: what something else holds open may be older than the file.

    A layer that is read anew may name others than before, and those that it names no more are gone: they are asked for
    after each.
    """
    seen = set[str]()
    while fresh := [layer for layer in stage.GetUsedLayers() if layer.identifier not in seen]:
        seen.add(fresh[0].identifier)
        if not fresh[0].anonymous and Path(fresh[0].realPath).exists():
            fresh[0].Reload()


@contextmanager
def reading_more(path: Path | str) -> Iterator[None]:
    """Reading from a stage that is open, where the block around it writes another: whose error it is must be told."""
    warnings = UsdUtils.CoalescingDiagnosticDelegate()  # takes what USD would print
    try:
        yield
    except Tf.ErrorException as error:
        raise UserError(f"{path}: cannot be read as USD ({_reason(error)}); write it again or choose another") from None
    except UnicodeDecodeError:
        raise UserError(f"{path}: cannot be read as USD ({NOT_TEXT}); write it again or choose another") from None
    finally:
        del warnings


def check_name(path: Path | str) -> None:
    """Refuses a file to be written whose name is not one of USD's."""
    if Path(path).suffix not in SUFFIXES[:3]:
        raise UserError(f"{path}: ends in '{Path(path).suffix}'; must end in .usdc, .usd or .usda")


def check_target(path: Path | str, under: Path | str) -> None:
    """Refuses what a layer over another file cannot be called, before there is anything to write."""
    check_name(path)
    refuse_itself(path, under, "file")


@contextmanager
def writing(path: Path | str) -> Iterator[Path]:
    """``replacing`` for stages: yields the path beside ``path`` to write to; USD's errors become a UserError."""
    path = Path(path)
    check_name(path)
    warnings = UsdUtils.CoalescingDiagnosticDelegate()
    try:
        with replacing(path) as aside:
            yield aside
    except Tf.ErrorException as error:
        raise UserError(f"{path}: cannot be written ({_reason(error)}); choose another place") from None
    finally:
        del warnings


def new_stage(aside: Path, space: StageSpace, over: Path | str | None = None) -> Usd.Stage:
    """An empty stage in a new file, laid over another file if one is given; its default prim is to be ``/groom``."""
    layer = Sdf.Layer.CreateNew(str(aside))
    layer.defaultPrim = "groom"
    layer.timeCodesPerSecond = layer.framesPerSecond = space.fps
    if over is not None:
        layer.subLayerPaths.append(relative(over, aside))
    stage = Usd.Stage.Open(layer)
    UsdGeom.SetStageMetersPerUnit(stage, space.meters_per_unit)
    UsdGeom.SetStageUpAxis(stage, space.up_axis)
    return stage


def relative(target: Path | str, file: Path | str) -> str:
    """The path of ``target`` as ``file`` should name it, so that both can move together."""
    try:
        path = os.path.relpath(Path(target).absolute(), Path(file).absolute().parent)
    except ValueError:  # another drive
        return Path(target).absolute().as_posix()
    return "./" + Path(path).as_posix()


def refuse_itself(path: Path | str, target: Path | str, what: str) -> None:
    """Refuses to write a file over the one it refers to."""
    if same_place(path, target):
        raise UserError(f"{path}: is the {what} that it would refer to; choose another name")


def read_usd_space(path: Path | str) -> StageSpace:
    """Unit, up-axis and rate of a USD file."""
    with reading(path) as source:
        return source.space


def find_prim(source: Source, name: str) -> Usd.Prim:
    """The prim at a path; refuses one that is not there, with the nearest one that is."""
    stage = source.stage
    prim = stage.GetPrimAtPath(name) if Sdf.Path.IsValidPathString(name) and name.startswith("/") else None
    if prim:
        return prim
    paths = [str(prim.GetPath()) for prim in prims(stage.GetPseudoRoot())]
    near = difflib.get_close_matches(name, paths, n=1, cutoff=0.4)
    hint = f"did you mean {near[0]}?" if near else f"there are: {', '.join(paths[:8]) or 'none'}"
    raise UserError(f"{source.path}: has no prim {name}; {hint}")


def prims(root: Usd.Prim) -> Iterator[Usd.Prim]:
    """All prims from ``root`` down, through instances, but not the prototypes of point instancers."""
    walk = iter(Usd.PrimRange(root, Usd.TraverseInstanceProxies()))
    for prim in walk:
        if prim.IsPseudoRoot():
            continue
        if UsdGeom.PointInstancer(prim):
            walk.PruneChildren()
        yield prim


def choose(source: Source, candidates: list[Usd.Prim], what: str) -> Usd.Prim:
    """The only candidate of a type, e.g. ``Mesh``; refuses none and many."""
    if not candidates:
        gone = [
            Path(path).name for path in source.stage.GetRootLayer().GetExternalReferences() if _missing(source, path)
        ]
        remedy = f"{', '.join(gone)}, which it refers to, is not there" if gone else "export one or choose another file"
        raise UserError(f"{source.path}: has no {what} prim; {remedy}")
    if len(candidates) > 1:
        names = ", ".join(str(prim.GetPath()) for prim in candidates[:8])
        raise UserError(f"{source.path}: has {len(candidates)} {what} prims; name one of: {names}")
    return candidates[0]


def parse_json(source: Source, text: Any, name: str) -> Any:
    """Plain values that Ringlet keeps as text under a name."""
    try:
        return json.loads(text)
    except (TypeError, ValueError):
        raise UserError(f"{source.path}: {name} is not JSON; write the file again") from None


def require_layers(source: Source) -> None:
    """Refuses a file that lies over another which is not there."""
    for layer in source.stage.GetLayerStack(includeSessionLayers=False):
        for path in layer.subLayerPaths:
            if not Path(layer.ComputeAbsolutePath(path)).exists():
                raise UserError(f"{source.path}: lies over {path}, which is not there; put it back")


def _missing(source: Source, path: str) -> bool:
    return bool(path) and not Path(source.stage.GetRootLayer().ComputeAbsolutePath(path)).exists()


def _space(stage: Usd.Stage, path: Path) -> StageSpace:
    unit, rate = UsdGeom.GetStageMetersPerUnit(stage), stage.GetTimeCodesPerSecond()
    for name, value in (("metersPerUnit", unit), ("timeCodesPerSecond", rate)):
        if not (math.isfinite(value) and value > 0):
            raise UserError(f"{path}: {name} is {value:g}; must be above 0")
    axis = UsdGeom.GetStageUpAxis(stage)
    return StageSpace(unit, "Z" if axis == UsdGeom.Tokens.z else "Y", rate)


def _reason(error: Tf.ErrorException) -> str:
    """The telling part of what USD says."""
    try:
        said = [str(part.commentary).strip() for part in error.args]
    except UnicodeDecodeError:
        return NOT_TEXT
    if syntax := re.search(r"\.usda?:(\d+):\d+: ", said[0]):
        return f"syntax error in line {syntax[1]}"
    if said[0].startswith("Failed to open layer"):
        return "not a USD file"
    return said[0].splitlines()[0]
