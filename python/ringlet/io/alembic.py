"""Alembic archives: curves with Unreal's groom attributes, and polygon meshes, with their motion.

Needs ``alembic3d`` (``pip install 'ringlet[alembic]'``). An archive stores neither its unit nor its up-axis. Faces of
Alembic are clockwise, seen from outside.

Groom attributes: https://dev.epicgames.com/documentation/en-us/unreal-engine/using-alembic-for-grooms-in-unreal-engine
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ringlet.data import limits
from ringlet.data.attributes import fits
from ringlet.data.curves import Curves, id_halves, pop_id_halves
from ringlet.data.errors import UserError
from ringlet.data.files import replacing
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.mesh import Clip, Mesh
from ringlet.data.names import unique
from ringlet.data.reads import record
from ringlet.data.regular import check_regular
from ringlet.data.stage import StageSpace
from ringlet.io.basis import Sampling
from ringlet.io.polygons import check_polygons, polygon_places, triangulate
from ringlet.io.space import check_points, from_metres, to_metres

VERSION_MAJOR, VERSION_MINOR = 1, 5  # of Unreal's groom attributes
MAGIC = b"Ogawa", b"\x89HDF"
# Attributes that have a property of their own in the schema of curves, or that the writer makes.
SCHEMA = {"width", "rest"}
FOREVER = 1e9  # seconds
NEAR = 1e-3  # of a frame: a sample so near to one is at it
COLORS = ("groom_color", "color", "displayColor")  # attributes that are groom_color: the first of them
SHAPE = "Shape"  # ends the name of a shape, whose transform has the name itself
UNREAL = ("groom_guide", "groom_group_id", "groom_id", "groom_root_uv", "groom_color")


def _library(path: Path) -> SimpleNamespace:
    """The modules of alembic3d; raises UserError where it is not installed."""
    try:
        import imath  # pyright: ignore[reportMissingImports]
        from alembic3d import Abc, AbcCoreAbstract, AbcGeom  # pyright: ignore[reportMissingImports]
    except ImportError:
        raise UserError(
            f"{path}: Alembic needs alembic3d, which is not installed; try: pip install 'ringlet[alembic]'"
        ) from None
    return SimpleNamespace(abc=Abc, geom=AbcGeom, core=AbcCoreAbstract, imath=imath)


# Reading


@contextmanager
def open_alembic(path: Path, space: StageSpace) -> Iterator[HairScene]:
    """Opens an archive; its frames are read as they are asked for.

    space: unit and up-axis of the archive

    Raises UserError for a file that is not readable, and for curves or meshes that are not valid.
    """
    library = _library(path)
    check_regular(path)
    _check_magic(path)
    record(path)
    try:
        archive = library.abc.IArchive(str(path))
        top = archive.getTop()
        rate = float(library.abc.GetArchiveInfo(archive).get("dccFPS") or 0.0)
        yield _Reader(library, path, space, rate).scene(top)
    except RuntimeError as error:
        line = next(iter(str(error).splitlines()), "it is damaged")
        raise UserError(f"{path}: cannot be read as Alembic ({line[:120]}); export it again") from None


def _check_magic(path: Path) -> None:
    if not path.is_file():
        raise UserError(f"{path}: there is no such file; check the name")
    with path.open("rb") as file:
        if not file.read(8).startswith(MAGIC):
            raise UserError(f"{path}: is no Alembic archive; choose another")


class _Reader:
    """Reads the objects of an archive.

    rate: frames per second that the archive names; 0 for none, so that they are those of the fastest samples
    """

    def __init__(self, library: SimpleNamespace, path: Path, space: StageSpace, rate: float) -> None:
        self.library, self.path, self.space = library, path, space
        self.fps, self.rate = space.fps, rate if 1e-2 <= rate <= 1e5 else 0.0
        self.frames = set[float]()
        self.names = dict[int, str]()
        self.unread = list[str]()

    def scene(self, top: Any) -> HairScene:
        """Everything below the top object."""
        sets, meshes = list[CurveSet](), list[tuple[Any, list[Any]]]()
        found = list(self._objects(top, []))
        samplings = [schema.getTimeSampling() for schema, _ in found if self._moves(schema)]
        samplings += [xform.getTimeSampling() for _, above in found for xform in above if xform.getNumSamples() > 1]
        cycles = [sampling.getTimeSamplingType().getTimePerCycle() for sampling in samplings]
        if self.rate:
            self.fps = self.rate
        elif cycles and 1e-5 < min(cycles) < 100.0:
            self.fps = round(1.0 / min(cycles), 6)
        for schema, above in found:
            times = {
                self._frame(timed.getTimeSampling().getSampleTime(k))
                for timed in (schema, *above)
                if self._moves(timed)
                for k in range(timed.getNumSamples())
            }
            self.frames |= times
            if isinstance(schema, self.library.geom.ICurvesSchema):
                sets += self._curve_sets(schema, above, bool(times))
            else:
                meshes.append((schema, above))
        frames = np.array(sorted(self.frames))
        if len(frames) > limits.FRAMES:
            raise UserError(f"{self.path}: has {len(frames)} frames; must be at most {limits.FRAMES:,}")
        bodies = [self._body(schema, above, frames) for schema, above in meshes if self._has_faces(schema)]
        space = StageSpace(self.space.meters_per_unit, self.space.up_axis, self.fps)
        return HairScene(sorted(sets, key=lambda one: one.guide), bodies, frames, space, self.unread)

    def _objects(self, parent: Any, above: list[Any]) -> Iterator[tuple[Any, list[Any]]]:
        """The schemas of curves and meshes below an object, each with those of the transforms above it."""
        geom, wrap = self.library.geom, self.library.abc.WrapExistingFlag.kWrapExisting
        for child in (parent.getChild(index) for index in range(parent.getNumChildren())):
            data, path = child.getMetaData(), above
            if geom.IXform.matches(data):
                path = [*above, geom.IXform(child, wrap).getSchema()]
            for kind in (geom.ICurves, geom.IPolyMesh, geom.ISubD):
                if kind.matches(data):
                    schema = kind(child, wrap).getSchema()
                    own = child.getName() != parent.getName() + SHAPE
                    self.names[id(schema)] = child.getName() if own else parent.getName()
                    yield schema, path
            if geom.INuPatch.matches(data) or geom.IPoints.matches(data):
                self.unread.append(f"{child.getName()} is neither curves nor a mesh, and is not read")
            yield from self._objects(child, path)

    def _moves(self, timed: Any) -> bool:
        """Whether a schema has positions that are not its rest pose: several samples, or one at a frame."""
        if timed.getNumSamples() > 1:
            return True
        if not isinstance(timed, self.library.geom.ICurvesSchema):
            return False
        parameters, sampling = timed.getArbGeomParams(), timed.getTimeSampling()
        is_timed = sampling.getTimeSamplingType().getTimePerCycle() != 1.0 or sampling.getSampleTime(0) != 0.0
        return is_timed and parameters.valid() and parameters.getPropertyHeader("rest") is not None

    def _where(self, schema: Any) -> str:
        return f"{self.path} {self.names[id(schema)]}"

    def _frame(self, seconds: float) -> float:
        """The time code of a sample, which is a whole frame where it is within a thousandth of one."""
        frame = seconds * self.fps
        return float(round(frame)) if abs(frame - round(frame)) < NEAR else round(frame, 6)

    def _first(self) -> Any:
        """Selects the first sample; the library takes a whole number for seconds, too."""
        return self.library.abc.ISampleSelector(-FOREVER)

    def _between(self, timed: Any, frame: float | None, value: Callable[[Any], NDArray]) -> NDArray[np.float64]:
        """A value at a frame, linear between its samples, held beyond the ends; the first sample for None."""
        if frame is None or timed.getNumSamples() < 2:
            return value(timed.getValue(self._first()))
        sampling, count, seconds = timed.getTimeSampling(), timed.getNumSamples(), float(frame) / self.fps
        rows = sampling.getFloorIndex(seconds, count), sampling.getCeilIndex(seconds, count)
        times = [self._frame(sampling.getSampleTime(k)) for k in rows]
        weight = 0.0 if times[1] <= times[0] else float(np.clip((frame - times[0]) / (times[1] - times[0]), 0.0, 1.0))
        wanted = [(k, w) for k, w in zip(rows, (1.0 - weight, weight), strict=True) if w > 1e-6]
        selector = self.library.abc.ISampleSelector
        found = [w * value(timed.getValue(selector(sampling.getSampleTime(k)))) for k, w in wanted]
        if any(one.shape != found[0].shape for one in found):
            raise UserError(
                f"{self.path}: the number of points changes at frame {frame:g}; export it with one topology"
            )
        return np.sum(found, axis=0)

    def _placed(self, schema: Any, above: list[Any], frame: float | None) -> NDArray[np.float64]:
        """Positions in world space [m], shape (n, 3)."""
        points = self._between(schema, frame, lambda at: np.array(at.getPositions(), np.float64).reshape(-1, 3))
        check_points(points, self._where(schema))
        return self._in_world(points, above, frame)

    def _in_world(self, points: NDArray[np.float64], above: list[Any], frame: float | None) -> NDArray[np.float64]:
        """Positions of a shape in world space [m], shape (n, 3)."""
        for xform in reversed(above):
            matrix = self._between(xform, frame, lambda at: np.array(at.getMatrix(), np.float64).reshape(4, 4))
            points = points @ matrix[:3, :3] + matrix[3, :3]
        return to_metres(points, self.space)

    def _curve_sets(self, schema: Any, above: list[Any], moves: bool) -> Iterator[CurveSet]:
        """The curves of a schema; its guides and its hairs apart, where it has both."""
        geom, where = self.library.geom, self._where(schema)
        sample = schema.getValue(self._first())
        counts = np.array(sample.getCurvesNumVertices(), np.int64)
        if len(counts) == 0:  # as valid as a mesh without faces
            return
        controls = self._placed(schema, above, None)
        if counts.min() < 2 or counts.sum() != len(controls):
            raise UserError(f"{where}: its {len(counts)} curves do not fit its {len(controls)} points; export it again")
        basis = {
            geom.BasisType.kBezierBasis: "bezier",
            geom.BasisType.kBsplineBasis: "bspline",
            geom.BasisType.kCatmullromBasis: "catmullRom",
        }.get(sample.getBasis())
        linear = sample.getType() != geom.CurveType.kCubic or basis is None
        periodic = sample.getWrap() == geom.CurvePeriodicity.kPeriodic
        wrap = "periodic" if periodic else "nonperiodic"
        sampling = Sampling("linear" if linear else "cubic", basis or "", wrap, counts, where)

        def motion(frame: float) -> NDArray[np.float64]:
            points = self._placed(schema, above, frame)
            if points.shape != controls.shape:
                raise UserError(
                    f"{where}: has {len(points)} points at frame {frame:g}, {len(controls)} at first; export it with "
                    "one topology"
                )
            return sampling.vertex(points)

        ids = np.arange(len(counts), dtype=np.int64)
        curves = Curves(sampling.vertex(controls), sampling.offsets, ids)
        for name, values, scope in self._attributes(schema):
            self._add(curves, sampling, name, values, scope, where)
        self._tell_unread(schema, sample, curves, moves)
        rest = curves.point.pop("rest", None)
        if rest is not None and rest.shape == curves.points.shape and np.isfinite(rest).all():
            curves.points = self._in_world(rest.astype(np.float64), above, None)
        if not curves.curve.get("groom_group_id", np.ones(1)).any():  # one group
            del curves.curve["groom_group_id"]
        root_uv = curves.curve.pop("groom_root_uv", None)
        if root_uv is not None and root_uv.shape == (len(ids), 2):
            curves.curve["st"] = root_uv.astype(np.float32)
        named = curves.curve.pop("groom_id", ids)
        if named.dtype.kind in "iu" and len(np.unique(named)) == len(ids):
            curves.ids = named.astype(np.int64)
        exact = pop_id_halves(curves.curve)
        curves.ids = curves.ids if exact is None else exact
        curves.check(where)
        yield from CurveSet(self.names[id(schema)], curves, motion=motion if moves else None).apart()

    def _regions(self, schema: Any, faces: NDArray, count: int) -> dict[str, NDArray[np.int32]]:
        """Sets of faces as sets of triangles, by name; raises UserError for a face out of range."""
        regions = dict[str, NDArray[np.int32]]()
        for name in schema.getFaceSetNames():
            sample = schema.getFaceSet(name).getSchema().getValue(self._first())
            chosen = np.array(sample.getFaces(), np.int64)
            if ((chosen < 0) | (chosen >= count)).any():
                raise UserError(
                    f"{self._where(schema)}/{name}: names a face that is not among {count}; export it again"
                )
            regions[name] = np.flatnonzero(np.isin(faces, chosen)).astype(np.int32)
        return regions

    def _tell_unread_of_mesh(self, schema: Any, has_uv: bool) -> None:
        """Notes what a mesh of the archive has and the one that is read has not."""
        unheld, lost = self._named(schema), list[str]()
        if schema.getUVsParam().valid() and not has_uv:
            unheld.add(schema.getUVsParam().getName())
        if unheld:
            lost.append(f"surfaces of an archive are read without {', '.join(sorted(unheld))}")
        if isinstance(schema, self.library.geom.ISubDSchema):
            lost.append("its subdivision surface is read as its cage")
        elif schema.getNormalsParam().valid():
            lost.append("its normals are not read; surfaces are smooth")
        if schema.getVelocitiesProperty().valid() and schema.getNumSamples() < 2:
            lost.append("its velocities are not read; the motion is that of its points")
        self.unread += [f"{self.names[id(schema)]}: {one}" for one in lost]

    def _named(self, schema: Any) -> set[str]:
        """Names of the arbitrary parameters and user properties of a schema."""
        found = [one for one in (schema.getArbGeomParams(), schema.getUserProperties()) if one.valid()]
        return {one.getPropertyHeader(k).getName() for one in found for k in range(one.getNumProperties())}

    def _tell_unread(self, schema: Any, sample: Any, curves: Curves, moves: bool) -> None:
        """Notes what curves of the archive have and those that are read have not."""
        name, unheld = self.names[id(schema)], self._named(schema) - {*curves.curve, *curves.point}
        lost = [f"{', '.join(sorted(unheld))} have no type or length of attributes of curves"] if unheld else []
        if schema.getNormalsParam().valid():
            lost.append("its normals are not used, since hairs are round")
        if schema.getVelocitiesProperty().valid() and not moves:
            lost.append("its velocities are not read; the motion is that of its points")
        if sample.getType() == self.library.geom.CurveType.kVariableOrder:
            lost.append("its curves are NURBS, read as lines through their control points")
        self.unread += [f"{name}: {one}" for one in lost]

    def _attributes(self, schema: Any) -> Iterator[tuple[str, NDArray, str]]:
        """Names, values and scopes of widths and of arbitrary parameters, of types that attributes have."""
        geom = self.library.geom
        if (widths := schema.getWidthsParam()).valid():
            yield "width", self._values(widths) * np.float32(self.space.meters_per_unit), str(widths.getScope())
        if (uvs := schema.getUVsParam()).valid():
            yield "st", self._values(uvs), str(uvs.getScope())
        parameters = schema.getArbGeomParams()
        if not parameters.valid():
            return
        kinds = (
            geom.IFloatGeomParam,
            geom.IInt32GeomParam,
            geom.IInt16GeomParam,
            geom.IV2fGeomParam,
            geom.IV3fGeomParam,
            geom.IC3fGeomParam,
        )
        for header in (parameters.getPropertyHeader(k) for k in range(parameters.getNumProperties())):
            for kind in kinds:
                if kind.matches(header):
                    parameter = kind(parameters, header.getName())
                    yield header.getName(), self._values(parameter), str(parameter.getScope())
                    break

    def _values(self, parameter: Any) -> NDArray:
        values = parameter.getExpandedValue(self._first()).getVals()
        try:
            return np.array(memoryview(values))
        except TypeError:
            return np.array(list(values))

    def _add(self, curves: Curves, sampling: Sampling, name: str, values: NDArray, scope: str, where: str) -> None:
        """Stores an attribute; raises UserError for a width without a value for each curve or point."""
        if scope == "kConstantScope" and len(values) == 1:
            curves.curve[name] = np.repeat(values, len(curves), axis=0)
        elif len(values) == len(curves) and scope != "kVertexScope":
            curves.curve[name] = values
        elif len(values) == sampling.offsets_in[-1]:
            curves.point[name] = sampling.vertex(values)
        elif name == "width":
            raise UserError(
                f"{where}: has {len(values)} widths for {len(curves)} curves and {sampling.offsets_in[-1]} points; "
                "export it again"
            )

    def _has_faces(self, schema: Any) -> bool:
        return len(schema.getValue(self._first()).getFaceCounts()) > 0

    def _body(self, schema: Any, above: list[Any], frames: NDArray) -> tuple[Mesh, Clip | None]:
        where, sample = self._where(schema), schema.getValue(self._first())
        points = self._placed(schema, above, None)
        counts = np.array(sample.getFaceCounts(), np.int64)
        indices = np.array(sample.getFaceIndices(), np.int64)
        check_polygons(counts, indices, len(points), where)
        corners, faces = triangulate(points, counts, indices, clockwise=True)
        uv, parameter = None, schema.getUVsParam()
        if parameter.valid():
            values, scope = self._values(parameter), str(parameter.getScope())
            if scope == "kFacevaryingScope" and len(values) == len(indices):
                uv = values[corners].astype(np.float64)
            elif scope in ("kVertexScope", "kVaryingScope") and len(values) == len(points):
                uv = values[indices[corners]].astype(np.float64)
        self._tell_unread_of_mesh(schema, uv is not None)
        mesh = Mesh(
            name=f"{self.path.name} {self.names[id(schema)]}",
            points=points,
            triangles=indices[corners].astype(np.int32),
            uv=uv,
            faces=faces.astype(np.int32),
            places=polygon_places(counts)[corners],
            regions=self._regions(schema, faces, len(counts)),
        )
        moves = any(timed.getNumSamples() > 1 for timed in (schema, *above))
        if not moves or not len(frames):
            return mesh, None
        clip = [self._placed(schema, above, frame) for frame in frames]
        if any(at.shape != points.shape for at in clip):
            raise UserError(f"{where}: its number of points changes over time; export it with one topology")
        return mesh, Clip(frames, np.stack(clip), self.fps)


def read_alembic_curves(path: Path, prim: str | None, space: StageSpace) -> Curves:
    """Reads the curves of an archive in their first frame: those of a name, or by default the only ones."""
    with open_alembic(path, space) as scene:
        found = [one for one in scene.sets if prim is None or one.name == prim]
        if len(found) != 1:
            names = ", ".join(one.name for one in scene.sets) or "none"
            wrong = "has no such curves" if not found else f"has {len(found)} sets of curves"
            raise UserError(f"{path}: {wrong}; name one of: {names}")
        return found[0].curves


# Writing


def write_alembic(scene: HairScene, path: Path, space: StageSpace) -> None:
    """Writes curves with Unreal's groom attributes, and surfaces.

    space: unit and up-axis to write in; Unreal expects centimetres and Y up
    """
    library = _library(path)
    with replacing(path) as aside:
        _write(library, scene, aside, space)  # the archive is closed when its objects are gone


def _write(library: SimpleNamespace, scene: HairScene, path: Path, space: StageSpace) -> None:
    abc, geom, fps = library.abc, library.geom, scene.space.fps
    archive = abc.CreateArchiveWithInfo(str(path), fps, "Ringlet", "")
    top = archive.getTop()
    times = archive.addTimeSampling(_sampling(library, scene.frames / fps, 1.0 / fps))
    properties = top.getProperties()
    for name, value in (("major", VERSION_MAJOR), ("minor", VERSION_MINOR)):
        abc.OInt16Property(properties, f"groom_version_{name}").setValue(value)
    abc.OStringProperty(properties, "groom_tool").setValue("Ringlet")
    root = geom.OXform(top, "groom")
    taken = list[str]()
    for one, ids in zip(scene.sets, scene.groom_ids, strict=True):
        taken.append(unique(_last_word(one.name), taken))
        _write_curves(library, root, taken[-1], (one, ids), scene.frames, times, space)
    for mesh, clip in scene.bodies:
        taken.append(unique(_last_word(mesh.name), taken))
        _write_body(library, root, taken[-1], (mesh, clip), scene.frames, times, space)


def _sampling(library: SimpleNamespace, seconds: NDArray[np.float64], cycle: float) -> Any:
    """Times of samples: even ones by their distance, which is ``cycle`` for a single one, others one by one."""
    core, steps = library.core, np.diff(seconds)
    if len(steps) and not np.allclose(steps, steps[0], rtol=1e-6):
        times = core.TimeVector()
        times.extend(seconds.tolist())
        return core.TimeSampling(core.TimeSamplingType(core.AcyclicFlag.kAcyclic), times)
    return core.TimeSampling(*map(float, (steps.mean() if len(steps) else cycle, seconds[0] if len(seconds) else 0.0)))


def _last_word(name: str) -> str:
    """The last word of a path, without what Alembic reserves."""
    return next(reversed(name.replace("/", " ").split()), "object")


def _place(library: SimpleNamespace, root: Any, name: str) -> tuple[Any, str]:
    """The transform of a shape, and its name: other programs show the transform as the object."""
    return library.geom.OXform(root, name), name + SHAPE


def _write_curves(
    library: SimpleNamespace,
    root: Any,
    name: str,
    given: tuple[CurveSet, NDArray[np.int32]],
    frames: NDArray,
    times: int,
    space: StageSpace,
) -> None:
    geom, imath, (one, ids), curves = library.geom, library.imath, given, given[0].curves
    vertex, uniform = geom.GeometryScope.kVertexScope, geom.GeometryScope.kUniformScope
    moves = one.motion is not None and len(frames) > 0
    schema = geom.OCurves(*_place(library, root, name), *([times] if moves else [])).getSchema()
    widths = curves.point.get("width")
    if widths is None and "width" in curves.curve:
        widths = np.repeat(curves.curve["width"], curves.counts)
    for frame in frames.tolist() if moves else [None]:
        sample = geom.OCurvesSchemaSample()
        sample.setPositions(imath.V3fArrayFromBuffer(from_metres(one.points(frame), space)))
        sample.setCurvesNumVertices(imath.IntArrayFromBuffer(curves.counts.astype(np.int32)))
        # Polylines: a Catmull-Rom curve of Alembic ends before its first and last points.
        sample.setType(geom.CurveType.kLinear)
        sample.setWrap(geom.CurvePeriodicity.kNonPeriodic)
        sample.setBasis(geom.BasisType.kNoBasis)
        if widths is not None:
            value = imath.FloatArrayFromBuffer(np.ascontiguousarray(widths / space.meters_per_unit, np.float32))
            sample.setWidths(geom.OFloatGeomParamSample(value, vertex))
        if "st" in curves.curve:
            value = imath.V2fArrayFromBuffer(np.ascontiguousarray(curves.curve["st"], np.float32))
            sample.setUVs(geom.OV2fGeomParamSample(value, uniform))
        schema.set(sample)
    parameters = schema.getArbGeomParams()
    if moves:
        _write_attribute(library, parameters, "rest", from_metres(curves.points, space), vertex)
    for attribute, values, scope in unreal_attributes(one, ids):
        _write_attribute(library, parameters, attribute, values, vertex if scope == "vertex" else uniform)


def unreal_attributes(one: CurveSet, ids: NDArray[np.int32]) -> Iterator[tuple[str, NDArray, str]]:
    """Unreal's groom attributes of curves, then those that these have themselves: name, values, scope.

    ids: ``groom_id`` of the curves; where these are not their own, the own ones are written in halves
    """
    curves, count = one.curves, len(one.curves)
    yield "groom_id", ids, "uniform"
    if (ids != curves.ids).any():
        yield from ((name, half, "uniform") for name, half in id_halves(curves.ids).items())
    yield "groom_group_id", one.group_ids, "uniform"
    yield "groom_guide", np.full(count, one.guide, np.int32), "uniform"
    if "st" in curves.curve:
        yield "groom_root_uv", curves.curve["st"].astype(np.float32), "uniform"
    kinds = {"vertex": curves.point, "uniform": curves.curve}
    known = [(scope, name) for name in COLORS for scope, kind in kinds.items() if name in kind]
    colors = [(scope, name) for scope, name in known if fits(kinds[scope][name], (3,))][:1]
    for scope, name in colors:
        values = kinds[scope][name]
        values = values if scope == "vertex" else np.repeat(values, curves.counts, axis=0)
        yield "groom_color", values.astype(np.float32), "vertex"
    taken = {("uniform", "st"), *((scope, name) for scope, name in colors if scope == "vertex")}
    for scope, kind in kinds.items():
        for name, values in kind.items():
            if name not in {*SCHEMA, *UNREAL} and (scope, name) not in taken and holds(values):
                yield name, values, scope


def holds(values: NDArray) -> bool:
    """Whether an attribute can be written: numbers, alone or in rows of two or three, in 32 bits."""
    if values.dtype.kind not in "bifu" or values.shape[1:] not in ((), (2,), (3,)):
        return False
    most = 2.0**31 if values.ndim == 1 else 2.0**24  # whole numbers in rows are written in single precision
    return values.dtype.kind in "bf" or bool(np.abs(values.astype(np.float64)).max(initial=0.0) < most)


def _write_attribute(library: SimpleNamespace, parent: Any, name: str, values: NDArray, scope: Any) -> None:
    geom, imath = library.geom, library.imath
    whole = values.dtype.kind in "biu" and values.ndim == 1
    kind, array = {
        (True, ()): ("Int32", imath.IntArrayFromBuffer),
        (False, ()): ("Float", imath.FloatArrayFromBuffer),
        (False, (2,)): ("V2f", imath.V2fArrayFromBuffer),
        (False, (3,)): ("V3f", imath.V3fArrayFromBuffer),
    }[whole, values.shape[1:]]
    value = array(np.ascontiguousarray(values, np.int32 if whole else np.float32))
    parameter = getattr(geom, f"O{kind}GeomParam")(parent, name, False, scope, 1)
    parameter.set(getattr(geom, f"O{kind}GeomParamSample")(value, scope))


def _write_body(
    library: SimpleNamespace,
    root: Any,
    name: str,
    body: tuple[Mesh, Clip | None],
    frames: NDArray,
    times: int,
    space: StageSpace,
) -> None:
    geom, imath, (mesh, clip) = library.geom, library.imath, body
    moves = clip is not None and len(frames) > 0
    schema = geom.OPolyMesh(*_place(library, root, name), *([times] if moves else [])).getSchema()
    counts = imath.IntArrayFromBuffer(np.full(len(mesh.triangles), 3, np.int32))
    indices = imath.IntArrayFromBuffer(np.ascontiguousarray(mesh.triangles[:, ::-1], np.int32).ravel())
    for frame in frames.tolist() if moves else [None]:
        points = mesh.points if frame is None or clip is None else clip.at(frame)
        sample = geom.OPolyMeshSchemaSample()
        sample.setPositions(imath.V3fArrayFromBuffer(from_metres(points, space)))
        sample.setFaceIndices(indices)
        sample.setFaceCounts(counts)
        if mesh.uv is not None:
            uv = np.ascontiguousarray(mesh.uv[:, ::-1].reshape(-1, 2), np.float32)
            value = geom.OV2fGeomParamSample(imath.V2fArrayFromBuffer(uv), geom.GeometryScope.kFacevaryingScope)
            sample.setUVs(value)
        schema.set(sample)
