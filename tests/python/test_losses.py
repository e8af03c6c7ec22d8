"""What a file of hair holds is found again in each format, or named as lost."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade, Vt
from ringlet.data.curves import Curves
from ringlet.data.groom import GROOM
from ringlet.data.hair_scene import CurveSet, HairScene
from ringlet.data.stage import StageSpace
from ringlet.io import open_scene, write_scene
from ringlet.io.formats import ROWS
from ringlet.io.hair import COLOR, HEADER, POINTS, TRANSPARENCY, read_hair

from ringlet import UserError, convert

HAS_ALEMBIC = importlib.util.find_spec("alembic3d") is not None
needs_alembic = pytest.mark.skipif(not HAS_ALEMBIC, reason="alembic3d is not installed: pip install 'ringlet[alembic]'")
abc = pytest.param(".abc", marks=needs_alembic)
Types = Sdf.ValueTypeNames
COUNTS = [4, 4, 8]


def stage_of(path, times=()):
    """Three linear curves that go 0.12 m a second along x, in centimetres at 25 frames a second."""
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    stage.SetTimeCodesPerSecond(25)
    curves = UsdGeom.BasisCurves.Define(stage, "/hair")
    curves.CreateTypeAttr("linear")
    curves.CreateCurveVertexCountsAttr(COUNTS)
    rest = np.array([[2 * c, k, 0] for c, count in enumerate(COUNTS) for k in range(count)], np.float32)
    curves.CreateWidthsAttr([0.01])
    curves.SetWidthsInterpolation("constant")
    for time in times:
        moved = rest + np.array([12 * time / 25, 0, 0], np.float32)
        curves.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(moved), time)
    if not times:
        curves.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy(rest))
    return stage, curves


def seconds_and_places(path):
    with open_scene(path, StageSpace(0.01)) as scene:
        (one,) = scene.sets
        return [(frame / scene.space.fps, one.points(frame)[0, 0]) for frame in scene.frames]


@pytest.mark.parametrize("suffix", [".usda", abc])
@pytest.mark.parametrize(
    "times",
    [
        [k + 25 / 60 for k in range(8)],
        [1.0, 1.5, 2.0, 2.25, 3.0],
        [-3.25, -2.25, -1.25],
        [0.5, 1.0, 1.5],
        [3.25],
    ],
)
def test_samples_between_frames_are_kept_at_their_seconds(tmp_path, times, suffix):
    stage, curves = stage_of(tmp_path / "a.usda", times)
    if len(times) == 1:
        curves.GetPointsAttr().Set(curves.GetPointsAttr().Get(times[0]))
    stage.Save()
    assert convert(tmp_path / "a.usda", tmp_path / f"b{suffix}")["frames"] == len(times)
    convert(tmp_path / f"b{suffix}", tmp_path / "c.usdc", unit=0.01)
    found = seconds_and_places(tmp_path / "c.usdc")
    np.testing.assert_allclose([second for second, _ in found], np.array(times) / 25, atol=1e-6)
    np.testing.assert_allclose([place for _, place in found], 0.12 * np.array(times) / 25, atol=1e-6)


def test_frames_between_samples_far_apart_are_filled(tmp_path):
    stage_of(tmp_path / "a.usda", [1.0, 4.0])[0].Save()
    assert convert(tmp_path / "a.usda", tmp_path / "b.usda")["frames"] == 4


@needs_alembic
def test_alembic_is_linear_between_samples_of_another_rate(tmp_path):
    from alembic3d import Abc, AbcCoreAbstract, AbcGeom
    from imath import IntArrayFromBuffer, V3fArrayFromBuffer

    archive = Abc.OArchive(str(tmp_path / "a.abc"))
    for name, rate in (("slow", 12), ("fast", 24)):
        times = archive.addTimeSampling(AbcCoreAbstract.TimeSampling(1 / rate, -0.5))
        schema = AbcGeom.OCurves(archive.getTop(), name, times).getSchema()
        for k in range(rate + 1):
            points = np.array([[k / rate - 0.5, 0, 0], [0, 1, 0]], np.float32)
            sample = AbcGeom.OCurvesSchemaSample()
            sample.setPositions(V3fArrayFromBuffer(points))
            sample.setCurvesNumVertices(IntArrayFromBuffer(np.array([2], np.int32)))
            sample.setType(AbcGeom.CurveType.kLinear)
            schema.set(sample)
    del archive, schema, sample  # pyright: ignore[reportPossiblyUnboundVariable]
    with open_scene(tmp_path / "a.abc", StageSpace()) as scene:
        assert scene.frames.tolist() == list(range(-12, 13))
        for one in scene.sets:
            assert one.curves.points[0, 0] == -0.5
            np.testing.assert_allclose([one.points(f)[0, 0] for f in scene.frames], scene.frames / 24, atol=1e-6)


def values_of(kind, count):
    rng = np.random.default_rng(1)
    if kind in (Types.StringArray, Types.TokenArray):
        return [f"v{k}" for k in range(count)]
    one = kind.defaultValue
    width = {Types.Float2Array: 2, Types.TexCoord2fArray: 2, Types.Float4Array: 4}.get(kind, 3)
    if kind in (Types.FloatArray, Types.DoubleArray):
        return rng.random(count).tolist()
    if kind == Types.IntArray:
        return list(range(5, 5 + count))
    if kind == Types.Int64Array:
        return [2**40 + k for k in range(count)]
    if kind == Types.BoolArray:
        return [k % 2 == 0 for k in range(count)]
    if kind == Types.QuatfArray:
        return [Gf.Quatf(1, 0, 0, 0)] * count
    assert one is not None
    return [tuple(row) for row in rng.random((count, width)).tolist()]


KINDS = [Types.FloatArray, Types.DoubleArray, Types.IntArray, Types.Int64Array, Types.BoolArray, Types.Float2Array]
KINDS += [Types.Float3Array, Types.Float4Array, Types.Color3fArray, Types.Vector3fArray, Types.StringArray]
KINDS += [Types.TokenArray, Types.QuatfArray]
NAMED = {
    "st": Types.TexCoord2fArray,
    "displayColor": Types.Color3fArray,
    "displayOpacity": Types.FloatArray,
    "color": Types.Color3fArray,
    "melanin": Types.FloatArray,
    "lock": Types.IntArray,
    "root_triangle": Types.IntArray,
    "root_barycentric": Types.Float3Array,
    "guide_id": Types.Int64Array,
    "groom_group_id": Types.IntArray,
    "skinprim": Types.IntArray,
}
EQUAL = {"displayColor": "groom_color", "color": "groom_color"}  # of points, in a format that has one colour


@pytest.mark.parametrize("suffix", [".usda", abc, ".hair", ".tfx", ".obj"])
@pytest.mark.parametrize("interpolation", ["constant", "uniform", "vertex"])
def test_each_attribute_is_found_again_or_named_as_lost(tmp_path, suffix, interpolation):
    """A file for each attribute, so that no line about one of them stands for another."""
    given = {f"my_{k}_{str(kind).strip('[]')}": kind for k, kind in enumerate(KINDS)} | NAMED
    count = {"constant": 1, "uniform": len(COUNTS), "vertex": sum(COUNTS)}[interpolation]
    source, target, space = tmp_path / "a.usda", tmp_path / f"b{suffix}", StageSpace(0.01)
    wrong = []
    for name, kind in given.items():
        source.unlink(missing_ok=True)
        stage, curves = stage_of(source)
        primvar = UsdGeom.PrimvarsAPI(curves).CreatePrimvar(name, kind, interpolation)
        primvar.Set(values_of(kind, count))
        stage.Save()
        lost = " ".join(convert(source, target, unit=0.01)["lost"])
        with open_scene(source) as scene, open_scene(target, space) as after:
            wanted, found = scene.sets[0].curves, after.sets[0].curves
            if name in wanted.curve and name in found.point:  # a format of points
                wanted.point[name] = np.repeat(wanted.curve.pop(name), wanted.counts, axis=0)
            kinds, other_name = ((wanted.curve, found.curve), (wanted.point, found.point)), EQUAL.get(name, name)
            pairs = [(one[name], other.get(name, other.get(other_name))) for one, other in kinds if name in one]
            held = [b is not None and a.shape == b.shape and equal(a, b) for a, b in pairs]
            if not (held and all(held)) and name not in lost:
                wrong.append(name)
        del stage, curves, primvar
    assert wrong == []


def equal(one, other):
    return (one == other).all() if one.dtype.kind in "USbiu" else np.allclose(one, other, atol=1e-6)


@pytest.mark.parametrize("suffix", [".usda", abc, ".hair", ".tfx", ".obj"])
def test_what_is_no_attribute_is_named_as_lost(tmp_path, suffix):
    stage, curves = stage_of(tmp_path / "a.usda")
    count = sum(COUNTS)
    curves.CreateNormalsAttr([(0, 0, 1)] * count)
    curves.CreateVelocitiesAttr([(1, 0, 0)] * count)
    curves.CreateAccelerationsAttr([(1, 0, 0)] * count)
    UsdGeom.NurbsCurves.Define(stage, "/spline").CreatePointsAttr([(0, 0, 0)] * 4)
    UsdGeom.PrimvarsAPI(curves).CreatePrimvar("wet", Types.Float, "constant").Set(1.0, 2.0)
    UsdGeom.PrimvarsAPI(curves).GetPrimvar("wet").Set(2.0, 3.0)
    UsdShade.MaterialBindingAPI.Apply(curves.GetPrim()).Bind(UsdShade.Material.Define(stage, "/looks/fur"))
    stage.Save()
    lost = "\n".join(convert(tmp_path / "a.usda", tmp_path / f"b{suffix}")["lost"])
    for part in ("normals", "velocities", "accelerations", "/spline is a NurbsCurves", "wet change over time"):
        assert part in lost
    assert ("/looks/fur" if suffix == ".usda" else "holds no materials") in lost


@needs_alembic
def test_groom_ids_differ_over_an_archive_and_group_ids_are_those_of_grooms(tmp_path):
    hairs = Curves.from_list([np.array([[k, 0, 0], [k, 1, 0]], float) for k in range(3)], [10**15, 1, 2])
    hairs.curve[GROOM] = np.array([0, 1, 1], np.int32)
    guides = Curves.from_list([np.array([[k, 0, 0], [k, 1, 0]], float) for k in range(2)], [1, 2])
    scene = HairScene([CurveSet("hairs", hairs), CurveSet("guides", guides, True)])
    assert write_scene(scene, tmp_path / "a.abc", StageSpace()) == (scene, [])
    ids = [one.tolist() for one in scene.groom_ids]
    assert HairScene([]).groom_ids == []
    assert len({id for every in ids for id in every}) == 5 and scene.sets[0].group_ids.tolist() == [0, 1, 1]
    with open_scene(tmp_path / "a.abc", StageSpace()) as after:
        assert [one.curves.ids.tolist() for one in after.sets] == [[10**15, 1, 2], [1, 2]]
        assert after.sets[0].curves.curve["groom_group_id"].tolist() == [0, 1, 1]


@needs_alembic
@pytest.mark.parametrize("kind", ["OPolyMesh", "OSubD"])
def test_what_a_mesh_of_an_archive_has_is_kept_or_named_as_lost(tmp_path, kind):
    from alembic3d import Abc, AbcGeom
    from imath import FloatArrayFromBuffer, IntArrayFromBuffer, V2fArrayFromBuffer, V3fArrayFromBuffer

    archive = Abc.OArchive(str(tmp_path / "a.abc"))
    schema = getattr(AbcGeom, kind)(archive.getTop(), "skin").getSchema()
    sample = getattr(AbcGeom, f"{kind}SchemaSample")()
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]], np.float32)
    sample.setPositions(V3fArrayFromBuffer(corners))
    sample.setFaceCounts(IntArrayFromBuffer(np.array([4, 4], np.int32)))
    sample.setFaceIndices(IntArrayFromBuffer(np.array([0, 3, 2, 1, 1, 2, 5, 4], np.int32)))
    vertex = AbcGeom.GeometryScope.kVertexScope
    uv = V2fArrayFromBuffer(np.ascontiguousarray(corners[:, :2] / 2))  # a sample of OSubD does not keep it
    given = AbcGeom.OV2fGeomParamSample(uv, vertex)
    sample.setUVs(given)
    if kind == "OPolyMesh":
        sample.setNormals(AbcGeom.ON3fGeomParamSample(V3fArrayFromBuffer(corners), vertex))
    schema.set(sample)
    wet = AbcGeom.OFloatGeomParam(schema.getArbGeomParams(), "wet", False, vertex, 1)
    wet.set(AbcGeom.OFloatGeomParamSample(FloatArrayFromBuffer(np.ones(6, np.float32)), vertex))
    Abc.OStringProperty(schema.getUserProperties(), "artist").setValue("me")
    chosen = AbcGeom.OFaceSetSchemaSample()
    chosen.setFaces(IntArrayFromBuffer(np.array([1], np.int32)))
    schema.createFaceSet("scalp").getSchema().set(chosen)
    del archive, schema, sample, wet, chosen
    lost = "\n".join(convert(tmp_path / "a.abc", tmp_path / "b.usdc")["lost"])
    with open_scene(tmp_path / "b.usdc") as scene:
        ((mesh, _),) = scene.bodies
    assert mesh.uv is not None
    np.testing.assert_allclose(mesh.uv, mesh.points[mesh.triangles][..., :2] / 0.02, atol=1e-6)
    assert mesh.regions["scalp"].tolist() == [2, 3] and mesh.points[mesh.triangles[2:]][..., 0].min() >= 0.01
    assert "skin: surfaces of an archive are read without artist, wet" in lost
    assert ("as its cage" if kind == "OSubD" else "normals") in lost


def test_curves_of_a_prim_are_hairs_or_guides_each(tmp_path):
    stage, curves = stage_of(tmp_path / "a.usda", [1.0, 2.0])
    marks = UsdGeom.PrimvarsAPI(curves).CreatePrimvar("groom_guide", Types.IntArray, "uniform")
    marks.Set([0, 1, 0])
    stage.Save()
    done = convert(tmp_path / "a.usda", tmp_path / "b.usda")
    assert (done["hairs"], done["guides"], done["lost"]) == (2, 1, [])
    with open_scene(tmp_path / "b.usda") as scene:
        found = {(one.name, one.guide): one.points(2.0)[:, 0] for one in scene.sets}
    assert {key: len(points) for key, points in found.items()} == {("hairs", False): 12, ("guides", True): 4}
    np.testing.assert_allclose(found["guides", True], 0.02 + 0.12 * 2 / 25, atol=1e-6)


@pytest.mark.parametrize("marks", [(Types.StringArray, ["no", "yes", "no"]), (Types.IntArray, [1, 1, 1])])
def test_marks_that_do_not_divide_a_prim_leave_it_whole(tmp_path, marks):
    stage, curves = stage_of(tmp_path / "a.usda")
    UsdGeom.PrimvarsAPI(curves).CreatePrimvar("groom_guide", marks[0], "uniform").Set(marks[1])
    stage.Save()
    lost = convert(tmp_path / "a.usda", tmp_path / "b.usda")["lost"]
    with open_scene(tmp_path / "b.usda") as scene:
        assert [(one.name, one.guide) for one in scene.sets] == [("hair", marks[0] == Types.IntArray)]
    assert marks[0] == Types.IntArray or "groom_guide" in " ".join(lost)


@pytest.mark.parametrize("arrays", [True, False])
def test_colour_and_transparency_of_a_hair_file_are_kept(tmp_path, arrays):
    """A file without these arrays has them in its header, for all hairs."""
    flags = POINTS | (TRANSPARENCY | COLOR if arrays else 0)
    body = np.array([[0, 0, 0], [0, 1, 0]], "<f4").tobytes()
    if arrays:
        body += np.array([0.25, 0.75, 0.2, 0.4, 0.6, 0.1, 0.1, 0.3], "<f4").tobytes()
    header = HEADER.pack(b"HAIR", 1, 2, flags, 1, 0.1, 0.25, 0.2, 0.4, 0.6, b"")
    (tmp_path / "a.hair").write_bytes(header + body)
    assert convert(tmp_path / "a.hair", tmp_path / "b.usda")["lost"] == []
    lost = " ".join(convert(tmp_path / "b.usda", tmp_path / "c.hair")["lost"])
    assert "color" not in lost and "displayOpacity" not in lost
    again = read_hair(tmp_path / "c.hair", StageSpace()).point
    np.testing.assert_allclose(again["displayOpacity"], [0.75, 0.25] if arrays else [0.75, 0.75], atol=1e-7)
    np.testing.assert_allclose(again["color"], [[0.2, 0.4, 0.6], [0.1, 0.1, 0.3] if arrays else [0.2, 0.4, 0.6]])


def test_a_transparency_outside_0_to_1_is_refused(tmp_path):
    header = HEADER.pack(b"HAIR", 1, 2, POINTS, 1, 0.1, 1.5, 1.0, 1.0, 1.0, b"")
    (tmp_path / "a.hair").write_bytes(header + np.arange(6, dtype="<f4").tobytes())
    with pytest.raises(UserError, match=r"a\.hair: displayOpacity is -0\.5 on curve 0; must be from 0 to 1"):
        read_hair(tmp_path / "a.hair", StageSpace())


@pytest.mark.parametrize("suffix", [".usda", abc, ".hair", ".tfx", ".obj"])
def test_points_are_counted_as_they_are_written(tmp_path, suffix):
    stage_of(tmp_path / "a.usda")[0].Save()
    done = convert(tmp_path / "a.usda", tmp_path / f"b{suffix}")
    with open_scene(tmp_path / f"b{suffix}") as scene:
        assert (done["hairs"], done["points"]) == (3, len(scene.sets[0].curves.points))
    assert done["points"] == (24 if suffix == ".tfx" else sum(COUNTS))


@pytest.mark.parametrize("interpolation", ["constant", "uniform", "vertex"])
@pytest.mark.parametrize("suffix", [".usda", abc, ".hair", ".tfx"])
def test_an_attribute_of_another_type_than_its_name_has_is_named(tmp_path, suffix, interpolation):
    """Texts, and rows of four numbers, where the format has a place for other ones."""
    source, wrong = tmp_path / "a.usda", []
    count = {"constant": 1, "uniform": len(COUNTS), "vertex": sum(COUNTS)}[interpolation]
    for name in (*ROWS.keys() - {"displayColor"}, "color"):
        for kind in (Types.StringArray, Types.Float4Array):
            source.unlink(missing_ok=True)
            stage, curves = stage_of(source)
            UsdGeom.PrimvarsAPI(curves).CreatePrimvar(name, kind, interpolation).Set(values_of(kind, count))
            stage.Save()
            own = name == "color" and suffix == ".usda"  # to USD one like any other
            if name not in " ".join(convert(source, tmp_path / f"b{suffix}")["lost"]) and not own:
                wrong.append((name, str(kind)))
            del stage, curves
    assert wrong == []
