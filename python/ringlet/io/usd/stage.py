"""Opens, searches and writes USD stages, with errors of one line.

``reading`` and ``writing`` wrap all work on stages: they convert USD's errors to ``UserError`` and silence its
warnings.
"""

from __future__ import annotations

import difflib
import json
import os
import re
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from pxr import Ar, Pcp, Sdf, Tf, Usd, UsdGeom, UsdShade, UsdUtils

from ringlet.data.errors import UserError
from ringlet.data.files import check_place, replacing
from ringlet.data.reads import record
from ringlet.data.stage import StageSpace
from ringlet.io.subdivision import Refinement
from ringlet.io.usd.damage import check_bytes, sound_prims
from ringlet.io.usd.skinning import Skinning

SURFACE, LIMIT, CAGE = "ringlet:surface", "limit", "cage"  # attribute of /groom, and its values
NOT_TEXT = "it holds text that is not UTF-8"
_OPENING = threading.Lock()  # OpenUSD crashes where a thread reloads a layer that another is opening
_STAMPS: dict[str, tuple[int, ...]] = {}  # of the files of layers when they were read last, by identifier
TICK = 0.1  # of the clock of a file system, at most [s]
UNITS, RATES = (1e-9, 1e6), (1e-2, 1e5)  # bounds of metersPerUnit and of timeCodesPerSecond
SUFFIXES = (".usd", ".usda", ".usdc", ".usdz")


@dataclass(frozen=True)
class Source:
    """An open stage.

    path:        file name as the user gave it
    space:       unit, up-axis and frame rate of the stage
    cage:        whether subdivision surfaces are read as their cages, instead of on their limit surfaces
    refinements: limit surfaces of meshes that were read, by path; None for other meshes
    """

    path: Path
    stage: Usd.Stage
    space: StageSpace
    cage: bool = False
    refinements: dict[Sdf.Path, Refinement | None] = field(default_factory=dict, compare=False)

    def where(self, prim: Usd.Prim) -> str:
        """File and prim, for messages."""
        return f"{self.path} {prim.GetPath()}"

    @cached_property
    def skinning(self) -> Skinning:
        """Skeletons of the stage, which deform its meshes."""
        return Skinning(self.stage)


@contextmanager
def reading(path: Path | str, cage: bool | None = None) -> Iterator[Source]:
    """Opens a stage; converts USD's errors inside the block to UserError.

    cage: reads subdivision surfaces as their cages; by default as the groom in the stage was made

    Raises UserError for a missing or empty file, for a folder, and for a stage that refers to what is not there.
    """
    path = Path(path)
    if not path.exists():
        raise UserError(f"{path}: there is no such file; check the name")
    if path.is_dir():
        raise UserError(f"{path}: is a folder; give a USD file")
    if path.is_file() and not path.stat().st_size:
        raise UserError(f"{path}: is empty; write it again or choose another")
    with reading_more(path):
        with _OPENING:
            layers, held = _check_layers(path)
            stage = Usd.Stage.Open(str(path))
            del layers  # open until the stage has them
            _reload(stage, path, held)
        _refuse_missing(stage, path)
        yield Source(path, stage, _space(stage, path), _reads_cages(stage) if cage is None else cage)
        record(path, *layer_files(stage))


def _check_layers(path: Path) -> tuple[list[Sdf.Layer], set[str]]:
    """Opens the layers that a file is composed of; returns them, and identifiers of those that were open before.

    Raises UserError for one that is damaged or no regular file.
    """
    names, layers, held = [str(path)], [], set[str]()
    for name in names:  # grows while it is read
        check_bytes(name)
        with suppress(Tf.ErrorException):  # reported when the stage is opened
            if layer := Sdf.Layer.Find(name):
                held.add(layer.identifier)
                if copy := Sdf.Layer.OpenAsAnonymous(name):
                    sound_prims(copy, name)  # another open stage holds it: what will be reloaded is checked apart
            if layer := Sdf.Layer.FindOrOpen(name):
                own = sound_prims(layer, name)
                layers.append(layer)
                assets = [*layer.GetCompositionAssetDependencies(), *_clip_files(own)]
                found = [layer.ComputeAbsolutePath(asset) for asset in assets]
                names += [file for file in found if file not in names]
    return layers, held


def _clip_files(specs: list[Sdf.PrimSpec]) -> Iterator[str]:
    """Assets of the value clips that a layer names."""
    for spec in specs:
        for clips in (spec.GetInfo("clips") if spec.HasInfo("clips") else {}).values():
            assets = [*clips.get("assetPaths", []), clips.get("manifestAssetPath")]
            yield from (asset.path for asset in assets if asset)
            if template := clips.get("templateAssetPath"):  # its number signs stand for the number of a frame
                folder, pattern = os.path.split(spec.layer.ComputeAbsolutePath(template))
                yield from map(str, Path(folder).glob(re.sub("#+", "*", pattern)))


def _reload(stage: Usd.Stage, path: Path, held: set[str]) -> None:
    """Reloads the layers of a stage that were open before, and whose files have changed since.

    Reloading a layer may change the set of used layers, so the set is queried again after each. Raises UserError for a
    layer that another open stage holds, but whose file is gone.
    """
    reloaded = set[str]()
    while pending := [layer for layer in stage.GetUsedLayers() if layer.identifier not in reloaded]:
        layer, name = pending[0], pending[0].identifier
        reloaded.add(name)
        if layer.anonymous:
            continue
        file = Path(layer.realPath.split("[")[0])  # a layer in a package has its path in brackets
        if not file.exists():
            raise UserError(f"{path}: uses {layer.realPath}, which is not there; put it back")
        stamp, before = _stamp(file), _STAMPS.get(name)
        _STAMPS[name] = stamp
        if name in held and stamp != before:
            # One that other code opened is known by its time alone, which two writes within a tick leave as it is.
            layer.Reload(force=before is not None or time.time() - file.stat().st_mtime < TICK)


def _stamp(file: Path) -> tuple[int, ...]:
    """What changes with a file."""
    status = file.stat()
    return status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns


def _reads_cages(stage: Usd.Stage) -> bool:
    """Whether the groom in a stage grows on the cage of its head; one without the attribute does."""
    groom = stage.GetPrimAtPath("/groom")
    if not groom or not groom.HasAttribute("ringlet:version"):
        return False
    return groom.GetAttribute(SURFACE).Get() != LIMIT if groom.HasAttribute(SURFACE) else True


def _refuse_missing(stage: Usd.Stage, path: Path) -> None:
    """Raises UserError for a sublayer, reference or payload that is missing, except of materials."""
    for error in stage.GetCompositionErrors():  # pyright: ignore[reportAttributeAccessIssue]
        prim = stage.GetPrimAtPath(error.rootSite.path)
        missing = next(iter(re.findall("@(.+?)@", str(error))), "a file")
        if isinstance(error, Pcp.ErrorInvalidSublayerPath):
            raise UserError(f"{path}: lies over {missing}, which is not there; put it back")
        if not (prim and prim.IsActive()) or UsdShade.NodeGraph(prim) or UsdShade.Shader(prim):
            continue
        if isinstance(error, Pcp.ErrorInvalidAssetPath):
            raise UserError(
                f"{path}: {prim.GetPath()} refers to {missing}, which is not there; put it back, or deactivate the prim"
            )
        if isinstance(error, Pcp.ErrorUnresolvedPrimPath):
            raise UserError(
                f"{path}: {prim.GetPath()} refers to {next(iter(re.findall('@<(.+?)>', str(error))), 'a prim')} of "
                f"{missing}, which is not there; name another, or deactivate the prim"
            )


def layer_files(stage: Usd.Stage) -> Iterator[str]:
    """Files of all layers that a stage uses: sublayers, references, payloads and value clips."""
    for layer in stage.GetUsedLayers():
        if layer.realPath:
            yield Ar.SplitPackageRelativePathOuter(layer.realPath)[0]


@contextmanager
def reading_more(path: Path | str) -> Iterator[None]:
    """Converts USD's errors inside the block to UserError with ``path``, also while another file is written."""
    warnings = UsdUtils.CoalescingDiagnosticDelegate()  # collects the warnings of USD
    try:
        yield
    except Tf.ErrorException as error:
        raise UserError(f"{path}: cannot be read as USD ({_reason(error)}); write it again or choose another") from None
    except UnicodeDecodeError:
        raise UserError(f"{path}: cannot be read as USD ({NOT_TEXT}); write it again or choose another") from None
    finally:
        del warnings


def check_name(path: Path | str) -> None:
    """Raises UserError for an output file without a suffix of USD."""
    if Path(path).suffix not in SUFFIXES[:3]:
        raise UserError(f"{path}: ends in '{Path(path).suffix}'; must end in .usdc, .usd or .usda")


def check_target(path: Path | str, under: Path | str) -> None:
    """Raises UserError for an invalid name of a layer over the file ``under``, before any work is done."""
    check_name(path)
    check_place(path, {"file under it": Path(under)})


@contextmanager
def writing(path: Path | str) -> Iterator[Path]:
    """``replacing`` for stages: yields a temporary path beside ``path``; converts USD's errors to UserError."""
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
    """Creates an empty stage with the default prim ``/groom``.

    aside: path of the new file
    space: unit, up-axis and frame rate
    over:  file to add as a sublayer
    """
    # The layer of an attempt that failed lives on in the frames of its error, while somebody keeps that.
    layer = Sdf.Layer.Find(str(aside)) or Sdf.Layer.CreateNew(str(aside))
    layer.Clear()
    layer.defaultPrim = "groom"
    layer.timeCodesPerSecond = layer.framesPerSecond = space.fps
    if over is not None:
        layer.subLayerPaths.append(relative(over, aside))
    stage = Usd.Stage.Open(layer)
    UsdGeom.SetStageMetersPerUnit(stage, space.meters_per_unit)
    UsdGeom.SetStageUpAxis(stage, space.up_axis)
    return stage


def relative(target: Path | str, file: Path | str) -> str:
    """Path of ``target`` relative to the folder of ``file``, so that both can move together."""
    try:
        path = os.path.relpath(Path(target).absolute(), Path(file).absolute().parent)
    except ValueError:  # another drive
        return Path(target).absolute().as_posix()
    return "./" + Path(path).as_posix()


def read_usd_space(path: Path | str) -> StageSpace:
    """Unit, up-axis and frame rate of a USD file."""
    with reading(path) as source:
        return source.space


def find_prim(source: Source, name: str) -> Usd.Prim:
    """The prim at a path; raises UserError, with the most similar path, when there is none."""
    stage = source.stage
    prim = stage.GetPrimAtPath(name) if Sdf.Path.IsValidPathString(name) and name.startswith("/") else None
    if prim:
        return prim
    paths = [str(prim.GetPath()) for prim in prims(stage.GetPseudoRoot())]
    similar = difflib.get_close_matches(name, paths, n=1, cutoff=0.4)
    hint = f"did you mean {similar[0]}?" if similar else f"there are: {', '.join(paths[:8]) or 'none'}"
    raise UserError(f"{source.path}: has no prim {name}; {hint}")


def prims(root: Usd.Prim) -> Iterator[Usd.Prim]:
    """All prims at and below ``root``, including instance proxies, excluding prototypes of point instancers."""
    walk = iter(Usd.PrimRange(root, Usd.TraverseInstanceProxies()))
    for prim in walk:
        if prim.IsPseudoRoot():
            continue
        if UsdGeom.PointInstancer(prim):
            walk.PruneChildren()
        yield prim


def choose(source: Source, candidates: list[Usd.Prim], what: str) -> Usd.Prim:
    """The only candidate of a type such as ``Mesh``; raises UserError for none and for several."""
    if not candidates:
        raise UserError(f"{source.path}: has no {what} prim; export one or choose another file")
    if len(candidates) > 1:
        names = ", ".join(str(prim.GetPath()) for prim in candidates[:8])
        raise UserError(f"{source.path}: has {len(candidates)} {what} prims; name one of: {names}")
    return candidates[0]


def parse_json(source: Source, text: Any, name: str) -> Any:
    """Parses metadata that is stored as JSON; raises UserError for other text."""
    try:
        return json.loads(text)
    except (TypeError, ValueError):
        raise UserError(f"{source.path}: {name} is not JSON; write the file again") from None


def _space(stage: Usd.Stage, path: Path) -> StageSpace:
    unit, rate = UsdGeom.GetStageMetersPerUnit(stage), stage.GetTimeCodesPerSecond()
    for name, value, (least, most) in (("metersPerUnit", unit, UNITS), ("timeCodesPerSecond", rate, RATES)):
        if not least <= value <= most:
            raise UserError(f"{path}: {name} is {value:g}; must be from {least:g} to {most:g}")
    axis = UsdGeom.GetStageUpAxis(stage)
    return StageSpace(unit, "Z" if axis == UsdGeom.Tokens.z else "Y", rate)


def _reason(error: Tf.ErrorException) -> str:
    """Essential part of a USD error message."""
    try:
        messages = [str(part.commentary).strip() for part in error.args]
    except UnicodeDecodeError:
        return NOT_TEXT
    if syntax := re.search(r"\.usda?:(\d+):\d+: ", messages[0]):
        return f"syntax error in line {syntax[1]}"
    if value := re.search(r" at '(.{0,60}).*' in <", messages[0], re.DOTALL):
        return f"syntax error at '{value[1]}'"
    if messages[0].startswith("Failed to open layer"):
        return "not a USD file"
    return messages[0].splitlines()[0][:120]
