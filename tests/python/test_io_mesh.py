"""Meshes from USD in metres, for any unit, up axis and layering."""

from __future__ import annotations

import numpy as np
import pytest
from pxr import Gf, Sdf, Ts, Usd, UsdGeom, UsdSkel, Vt
from ringlet.io import read_bodies, read_clip, read_mesh, read_meshes, read_space, unread_surfaces
from usd_scenes import CUBE, CUBE_FACES, FRAMES, add_cube, new_stage, write_head

from ringlet import Mesh, UserError


def volume(mesh: Mesh, points: np.ndarray | None = None) -> float:
    """Signed volume [m³]; positive when the triangles are counter-clockwise from outside."""
    at = mesh.points if points is None else points
    a, b, c = (at[mesh.triangles[:, k]] for k in range(3))
    return float(np.einsum("nk,nk->", a, np.cross(b, c)) / 6)


@pytest.mark.parametrize("unit", [1.0, 0.01, 0.0254])
@pytest.mark.parametrize("axis", ["Y", "Z"])
def test_the_same_head_in_any_unit_and_axis_is_the_same_in_metres(tmp_path, unit, axis):
    path = write_head(tmp_path / "head.usda", unit=unit, axis=axis)
    mesh, clip = read_mesh(path), read_clip(path)
    np.testing.assert_allclose(mesh.points, 0.1 * CUBE, atol=1e-7)
    assert volume(mesh) == pytest.approx(0.001)
    np.testing.assert_allclose(clip.points[-1] - clip.points[0], np.tile([0.03, 0, 0], (8, 1)), atol=1e-7)
    space = read_space(path)
    assert (space.meters_per_unit, space.up_axis, space.fps) == (unit, axis, 24)


def test_without_a_unit_a_file_is_in_centimetres(tmp_path):
    stage = new_stage(tmp_path / "a.usda", unit=None)
    add_cube(stage)
    stage.Save()
    np.testing.assert_allclose(read_mesh(tmp_path / "a.usda").points, 0.01 * CUBE, atol=1e-9)


def test_a_clip_has_every_whole_frame_with_all_transforms_in_it(tmp_path):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    stage.SetStartTimeCode(1.5)
    stage.SetEndTimeCode(4.5)
    UsdGeom.Xformable(stage.GetPrimAtPath("/head")).AddTranslateOp().Set(Gf.Vec3d(0, 5, 0))
    mesh = add_cube(stage)
    turn = mesh.AddRotateYOp()
    for frame, angle in ((0, 0.0), (10, 90.0)):
        turn.Set(angle, frame)
    stage.Save()
    clip = read_clip(tmp_path / "a.usda")
    np.testing.assert_array_equal(clip.frames, [2, 3, 4])
    angle = np.radians(9.0 * 3)
    np.testing.assert_allclose(clip.points[1, 4], [np.cos(angle), 5, -np.sin(angle)], atol=1e-6)  # corner (1, 0, 0)
    np.testing.assert_array_equal(read_clip(tmp_path / "a.usda", frames=(0, 10)).frames, np.arange(11))


def test_a_static_mesh_has_one_sample(tmp_path):
    path = write_head(tmp_path / "head.usda", moving=False)
    clip = read_clip(path)
    assert clip.points.shape == (1, 8, 3)
    np.testing.assert_allclose(clip.at(17), read_mesh(path).points)


def test_one_sample_holds_at_all_times_and_the_default_is_the_rest_pose(tmp_path):
    stage = new_stage(tmp_path / "head.usda")
    mesh = add_cube(stage)
    mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy((CUBE + 2.0).astype(np.float32)), 7.0)
    stage.Save()
    (body,) = read_bodies(tmp_path / "head.usda")
    np.testing.assert_allclose(body.mesh.points, 0.01 * CUBE, atol=1e-7)
    np.testing.assert_allclose(body.clip.at(1.0), 0.01 * (CUBE + 2.0), atol=1e-7)


def test_the_rest_pose_is_the_default_value_or_the_first_sample(tmp_path):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    mesh = add_cube(stage)
    mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy((CUBE + 9).astype(np.float32)), 1)
    mesh.GetPointsAttr().Set(Vt.Vec3fArray.FromNumpy((CUBE + 8).astype(np.float32)), 2)
    stage.Save()
    np.testing.assert_allclose(read_mesh(tmp_path / "a.usda").points, CUBE)
    mesh.GetPointsAttr().ClearDefault()
    stage.Save()
    np.testing.assert_allclose(read_mesh(tmp_path / "a.usda").points, CUBE + 9)


@pytest.mark.parametrize("left_handed", [False, True])
@pytest.mark.parametrize("mirrored", [False, True])
def test_triangles_are_counter_clockwise_from_outside_for_any_winding(tmp_path, left_handed, mirrored):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    mesh = add_cube(stage)
    if left_handed:
        mesh.CreateOrientationAttr(UsdGeom.Tokens.leftHanded)
        mesh.GetFaceVertexIndicesAttr().Set([corner for face in CUBE_FACES for corner in face[::-1]])
    if mirrored:
        mesh.AddScaleOp().Set(Gf.Vec3f(-1, 1, 1))
    stage.Save()
    assert volume(read_mesh(tmp_path / "a.usda")) == pytest.approx(1.0)


def test_polygons_become_fans_with_their_polygon_region_and_corners(tmp_path):
    mesh = read_mesh(write_head(tmp_path / "head.usda"))
    np.testing.assert_array_equal(mesh.faces, np.repeat(np.arange(6), 2))
    np.testing.assert_array_equal(mesh.regions["scalp"], [10, 11])
    assert mesh.points[mesh.triangles[mesh.regions["scalp"]]][..., 2] == pytest.approx(0.1)
    np.testing.assert_allclose(mesh.uv[0], [[0, 0], [1, 0], [1, 1]])
    np.testing.assert_allclose(mesh.uv[1], [[0, 0], [1, 1], [0, 1]])


def test_indexed_texture_coordinates_on_vertices_follow_the_corners(tmp_path):
    stage = new_stage(tmp_path / "a.usda")
    mesh = add_cube(stage)
    primvar = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, "vertex")
    primvar.Set([Gf.Vec2f(0, 0), Gf.Vec2f(1, 0.5)])
    primvar.SetIndices(Vt.IntArray([int(corner[0]) for corner in CUBE]))
    stage.Save()
    read = read_mesh(tmp_path / "a.usda")
    x = CUBE[read.triangles][..., 0]
    np.testing.assert_allclose(read.uv, np.stack([x, 0.5 * x], axis=-1))


def test_holes_are_removed_and_regions_keep_their_triangles(tmp_path):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    add_cube(stage).CreateHoleIndicesAttr([0, 3])
    stage.Save()
    mesh = read_mesh(tmp_path / "a.usda")
    np.testing.assert_array_equal(np.unique(mesh.faces), [1, 2, 4, 5])
    assert set(mesh.faces[mesh.regions["scalp"]]) == {5}


def test_the_scalp_is_chosen_among_many_meshes_and_a_parent_may_be_named(tmp_path):
    stage = new_stage(tmp_path / "a.usda")
    add_cube(stage)
    add_cube(stage, "/head/shirt", scalp=False)
    stage.Save()
    assert read_mesh(tmp_path / "a.usda").name == "a.usda /head/skin"
    assert read_mesh(tmp_path / "a.usda", "/head").name == "a.usda /head/skin"
    assert read_mesh(tmp_path / "a.usda", "/head/shirt").name == "a.usda /head/shirt"


def test_bodies_are_the_visible_meshes_with_their_colours_through_references(tmp_path):
    head = write_head(tmp_path / "head.usda")
    stage = new_stage(tmp_path / "shot.usda", unit=0.01)
    stage.SetStartTimeCode(FRAMES[0])
    stage.SetEndTimeCode(FRAMES[1])
    for name in ("left", "right"):
        prim = stage.DefinePrim(f"/head/{name}")
        prim.GetReferences().AddReference(f"./{head.name}")
        prim.SetInstanceable(True)
    UsdGeom.Gprim(add_cube(stage, "/head/red")).CreateDisplayColorAttr([Gf.Vec3f(1, 0, 0)])
    UsdGeom.Imageable(add_cube(stage, "/head/gone")).MakeInvisible()
    add_cube(stage, "/head/sketch").CreatePurposeAttr(UsdGeom.Tokens.guide)
    stage.Save()
    bodies = {body.mesh.name.split("/")[-2]: body for body in read_bodies(tmp_path / "shot.usda")}
    assert set(bodies) == {"left", "right", "head"}
    assert bodies["head"].mesh.color == (1, 0, 0)
    assert bodies["left"].clip.points.shape == (4, 8, 3)


def skinned_cube(path, samples, *, rate=24.0, fully=False):
    """A cube of 1 m; the joint of its upper half, or of all of it (``fully``), moves along x at time codes."""
    stage = new_stage(path, unit=1.0)
    stage.SetTimeCodesPerSecond(rate)
    UsdSkel.Root.Define(stage, "/head")
    mesh, bones = add_cube(stage), UsdSkel.Skeleton.Define(stage, "/head/bones")
    bones.CreateJointsAttr(["neck", "neck/crown"])
    bones.CreateBindTransformsAttr([Gf.Matrix4d(1), Gf.Matrix4d(1)])
    bones.CreateRestTransformsAttr([Gf.Matrix4d(1), Gf.Matrix4d(1)])
    motion = UsdSkel.Animation.Define(stage, "/head/motion")
    motion.CreateJointsAttr(["neck", "neck/crown"])
    motion.CreateRotationsAttr([Gf.Quatf(1)] * 2)
    motion.CreateScalesAttr([Gf.Vec3h(1)] * 2)
    for time, x in samples.items():
        motion.CreateTranslationsAttr().Set([Gf.Vec3f(0), Gf.Vec3f(x, 0, 0)], time)
    UsdSkel.BindingAPI.Apply(bones.GetPrim()).CreateAnimationSourceRel().SetTargets(["/head/motion"])
    skin = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    skin.CreateSkeletonRel().SetTargets(["/head/bones"])
    skin.CreateJointIndicesPrimvar(fully, 1).Set([1] if fully else [int(y) for y in CUBE[:, 1]])
    skin.CreateJointWeightsPrimvar(fully, 1).Set([1.0] if fully else [1.0] * 8)
    stage.Save()
    return path


@pytest.mark.parametrize("rate", [24, 25, 30, 48, 60])
@pytest.mark.parametrize("fully", [False, True])
def test_a_skinned_mesh_moves_as_far_at_any_rate(tmp_path, rate, fully):
    path = skinned_cube(tmp_path / "a.usda", {0: 0.0, rate: 1.0}, rate=rate, fully=fully)
    clip = read_clip(path, frames=(0, rate))
    moved = clip.points[:, 7, 0] - 1.0  # corner (1, 1, 1), which the joint carries
    np.testing.assert_allclose(moved, clip.frames / rate, atol=1e-6)
    np.testing.assert_allclose(clip.points[:, 5, 0] - 1.0, moved * fully, atol=1e-6)  # corner (1, 0, 1)
    np.testing.assert_allclose(read_mesh(path).points, CUBE)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda skin, bones: skin.GetJointIndicesPrimvar().Set([0] * 7), "joints and weights do not fit"),
        (lambda skin, bones: skin.GetJointIndicesPrimvar().Set([9] * 8), "joints and weights do not fit"),
        (lambda skin, bones: skin.GetJointWeightsPrimvar().SetElementSize(2), "joints and weights do not fit"),
        (lambda skin, bones: bones.GetBindTransformsAttr().Set([Gf.Matrix4d(1)]), "has no bind pose"),
    ],
)
def test_a_skin_that_does_not_fit_its_skeleton_is_refused(tmp_path, change, says):
    stage = Usd.Stage.Open(str(skinned_cube(tmp_path / "a.usda", {0: 0.0, 10: 1.0})))
    change(
        UsdSkel.BindingAPI(stage.GetPrimAtPath("/head/skin")),
        UsdSkel.Skeleton(stage.GetPrimAtPath("/head/bones")),
    )
    stage.Save()
    with pytest.raises(UserError, match=f"a.usda /head/skin.*{says}"):
        read_clip(tmp_path / "a.usda", frames=(0, 10))


def test_blend_shapes_of_a_mesh_are_evaluated_at_every_frame(tmp_path):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    stage.SetTimeCodesPerSecond(30)
    UsdSkel.Root.Define(stage, "/head")
    mesh, bones = add_cube(stage), UsdSkel.Skeleton.Define(stage, "/head/bones")
    shape = UsdSkel.BlendShape.Define(stage, "/head/skin/smile")
    shape.CreateOffsetsAttr([Gf.Vec3f(0, 0, 2)])
    shape.CreatePointIndicesAttr([3])
    motion = UsdSkel.Animation.Define(stage, "/head/motion")
    motion.CreateBlendShapesAttr(["smile"])
    for frame, weight in ((0, 0.0), (30, 1.0)):
        motion.CreateBlendShapeWeightsAttr().Set([weight], frame)
    UsdSkel.BindingAPI.Apply(bones.GetPrim()).CreateAnimationSourceRel().SetTargets(["/head/motion"])
    skin = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    skin.CreateSkeletonRel().SetTargets(["/head/bones"])
    skin.CreateBlendShapesAttr(["smile"])
    skin.CreateBlendShapeTargetsRel().SetTargets(["/head/skin/smile"])
    stage.Save()
    clip = read_clip(tmp_path / "a.usda", frames=(0, 30))
    np.testing.assert_allclose(clip.points[:, 3, 2] - 1.0, 2.0 * clip.frames / 30, atol=1e-6)
    np.testing.assert_allclose(clip.points[:, :3], np.broadcast_to(CUBE[:3], (31, 3, 3)))


def test_skinned_instances_follow_their_skeleton(tmp_path):
    skinned_cube(tmp_path / "asset.usda", {0: 0.0, 10: 1.0})
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    prim = stage.DefinePrim("/head/twin")
    prim.GetReferences().AddReference("./asset.usda")
    prim.SetInstanceable(True)
    stage.Save()
    assert prim.IsInstance()
    clip = read_clip(tmp_path / "a.usda", frames=(0, 10))
    np.testing.assert_allclose(clip.points[:, 7, 0] - 1.0, clip.frames / 10, atol=1e-6)


@pytest.mark.parametrize("range_of_stage", [(100, 110), (1, 1), (9, 2), (-1e9, 1e9)])
def test_the_frames_of_a_shot_are_read_whatever_the_range_of_the_stage(tmp_path, range_of_stage):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    stage.SetStartTimeCode(range_of_stage[0])
    stage.SetEndTimeCode(range_of_stage[1])
    slide = add_cube(stage).AddTranslateOp()
    for frame in (0, 40):
        slide.Set(Gf.Vec3d(frame, 0, 0), frame)
    stage.Save()
    clip = read_clip(tmp_path / "a.usda", frames=(20, 24))
    np.testing.assert_allclose([clip.at(frame)[0, 0] for frame in range(20, 25)], range(20, 25))


@pytest.mark.parametrize(("first", "frames"), [(2, [1, 2, 3, 4]), (1, [1, 2, 3]), (0, [0, 1, 2])])
def test_a_clip_of_a_shot_has_the_frame_beside_its_first_that_gives_the_velocity(tmp_path, first, frames):
    path = write_head(tmp_path / "head.usda")  # moves from frame 1
    np.testing.assert_array_equal(read_clip(path, frames=(first, first + 2)).frames, frames)
    assert len(read_clip(path, frames=(first, first)).frames) == 2


def test_a_file_of_another_rate_is_read_at_the_seconds_of_the_shot(tmp_path):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    stage.SetTimeCodesPerSecond(48)
    slide = add_cube(stage).AddTranslateOp()
    for code in (0, 48):  # 1 m/s
        slide.Set(Gf.Vec3d(code / 48, 0, 0), code)
    stage.Save()
    clip = read_clip(tmp_path / "a.usda", frames=(0, 24), fps=24)
    assert clip.fps == 24
    np.testing.assert_allclose(clip.points[:, 0, 0], np.arange(25) / 24, atol=1e-6)
    whole = new_stage(tmp_path / "b.usda", unit=1.0)  # USD maps the time codes of a reference in the same way
    whole.DefinePrim("/head/ball").GetReferences().AddReference("./a.usda")
    whole.Save()
    np.testing.assert_allclose(read_clip(tmp_path / "b.usda", frames=(0, 24)).points, clip.points, atol=1e-6)


def test_a_spline_moves_a_mesh(tmp_path):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    spline = Ts.Spline("float")
    for time, value in ((1.0, 0.0), (11.0, 90.0)):
        knot = Ts.Knot(typeName="float")
        knot.SetTime(time)
        knot.SetValue(value)
        knot.SetNextInterpolation(Ts.InterpLinear)
        spline.SetKnot(knot)
    assert add_cube(stage).AddRotateYOp().GetAttr().SetSpline(spline)
    stage.Save()
    clip = read_clip(tmp_path / "a.usda")
    np.testing.assert_array_equal(clip.frames, np.arange(1, 12))
    np.testing.assert_allclose(clip.points[-1, 4], [0, 0, -1], atol=1e-6)  # corner (1, 0, 0)


def test_frames_after_the_last_sample_are_not_read_unless_a_spline_goes_on(tmp_path):
    assert len(read_clip(write_head(tmp_path / "head.usda"), frames=(1, 1000)).frames) == 4
    assert len(read_clip(tmp_path / "head.usda", frames=(500, 1000)).frames) == 2
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    spline = Ts.Spline("float")
    for time in (1.0, 2.0):
        knot = Ts.Knot(typeName="float")
        knot.SetTime(time)
        knot.SetValue(time)
        knot.SetNextInterpolation(Ts.InterpLinear)
        spline.SetKnot(knot)
    spline.SetPostExtrapolation(Ts.Extrapolation(Ts.ExtrapLinear))
    add_cube(stage).AddRotateYOp().GetAttr().SetSpline(spline)
    stage.Save()
    clip = read_clip(tmp_path / "a.usda", frames=(1, 90))
    np.testing.assert_allclose(clip.at(90)[4], [0, 0, -1], atol=1e-6)  # corner (1, 0, 0)
    np.testing.assert_array_equal(read_clip(tmp_path / "a.usda").frames, [1, 2])


def test_colours_of_every_interpolation_reach_the_vertices(tmp_path):
    each = {
        "vertex": CUBE,
        "varying": CUBE,
        "faceVarying": np.concatenate([CUBE[face] for face in CUBE_FACES]),
        "uniform": np.repeat(np.arange(6.0)[:, None] / 6, 3, axis=1),
        "constant": np.array([[0.2, 0.4, 0.6]]),
    }
    meshes = {}
    for interpolation, colors in each.items():
        stage = new_stage(tmp_path / f"{interpolation}.usda")
        primvar = UsdGeom.Gprim(add_cube(stage)).CreateDisplayColorPrimvar(interpolation)
        primvar.Set(Vt.Vec3fArray.FromNumpy(colors.astype(np.float32)))
        stage.Save()
        meshes[interpolation] = read_mesh(tmp_path / f"{interpolation}.usda")
        assert meshes[interpolation].color == pytest.approx(colors.mean(axis=0), abs=1e-6)
    for interpolation in ("vertex", "varying", "faceVarying"):
        np.testing.assert_allclose(meshes[interpolation].colors, CUBE)
    corner_0 = np.mean([k / 6 for k, face in enumerate(CUBE_FACES) if 0 in face])
    np.testing.assert_allclose(meshes["uniform"].colors[0], corner_0, atol=1e-6)
    assert meshes["constant"].colors is None


def add_beads(stage, path="/head/beads"):
    """Two instances of a cube: at x = 10, which moves 1 m a frame, and at x = 20, mirrored and twice as large."""
    beads = UsdGeom.PointInstancer.Define(stage, path)
    beads.AddTranslateOp().Set(Gf.Vec3d(0, 0, 100))
    stage.OverridePrim(f"{path}/prototypes")  # undefined, so that it is drawn as instances only
    cube = add_cube(stage, f"{path}/prototypes/bead", scalp=False)
    cube.AddTranslateOp().Set(Gf.Vec3d(0, 5, 0))
    stage.GetPrimAtPath(f"{path}/prototypes").SetSpecifier(Sdf.SpecifierOver)
    beads.CreatePrototypesRel().SetTargets([cube.GetPath()])
    beads.CreateProtoIndicesAttr([0, 0])
    beads.CreateScalesAttr([Gf.Vec3f(1), Gf.Vec3f(-2, 2, 2)])
    for frame in (1, 5):
        beads.CreatePositionsAttr().Set([Gf.Vec3f(10 + frame - 1, 0, 0), Gf.Vec3f(20, 0, 0)], frame)
    return beads


def test_instances_of_a_point_instancer_are_one_body_that_moves(tmp_path):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    add_beads(stage)
    stage.Save()
    (body,) = read_bodies(tmp_path / "a.usda", frames=(1, 5))
    assert body.prim == "/head/beads" and body.mesh.triangles.shape == (24, 3)
    first, second = body.mesh.points[:8], body.mesh.points[8:]
    np.testing.assert_allclose(first, CUBE + [10, 5, 100], atol=1e-5)
    np.testing.assert_allclose(second, (CUBE + [0, 5, 0]) * [-2, 2, 2] + [20, 0, 100], atol=1e-5)
    assert volume(body.mesh) == pytest.approx(1.0 + 8.0, abs=1e-3)  # outward, also of the mirrored one
    np.testing.assert_allclose(body.clip.points[:, 0, 0], [10, 11, 12, 13, 14], atol=1e-5)
    (named,) = read_bodies(tmp_path / "a.usda", "/head/beads")
    np.testing.assert_allclose(named.mesh.points, body.mesh.points)
    (shown,) = read_meshes(tmp_path / "a.usda")
    np.testing.assert_allclose(shown.points, body.mesh.points)


def test_instances_of_instancers_are_read_and_hidden_ones_are_not(tmp_path):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    inner = add_beads(stage, "/head/chains/prototypes/beads")
    inner.CreateInvisibleIdsAttr([1])
    chains = UsdGeom.PointInstancer.Define(stage, "/head/chains")
    chains.CreatePrototypesRel().SetTargets([inner.GetPath()])
    chains.CreateProtoIndicesAttr([0, 0])
    chains.CreatePositionsAttr([Gf.Vec3f(0), Gf.Vec3f(0, 50, 0)])
    stage.Save()
    (body,) = read_bodies(tmp_path / "a.usda")
    expected = CUBE + [10, 5, 100]
    np.testing.assert_allclose(body.mesh.points, np.concatenate([expected, expected + [0, 50, 0]]), atol=1e-5)


def test_visible_surfaces_that_are_no_colliders_are_reported(tmp_path):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    add_cube(stage)
    UsdGeom.Sphere.Define(stage, "/head/bead")
    UsdGeom.Sphere.Define(stage, "/head/ghost").CreateVisibilityAttr("invisible")
    UsdGeom.BasisCurves.Define(stage, "/head/brows")
    add_cube(stage, "/shirt", scalp=False)
    stage.Save()
    notes = unread_surfaces(tmp_path / "a.usda")
    assert len(notes) == 2
    assert "a.usda /head/bead: is a Sphere, which hair does not touch" in notes[0]
    assert "a.usda /shirt: is outside of the default prim /head" in notes[1]
    assert unread_surfaces(tmp_path / "a.usda", "/head", ["/head/bead"]) == []


def test_surfaces_whose_visibility_changes_are_reported(tmp_path):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    add_cube(stage)
    for name, first, second in (("coming", "invisible", "inherited"), ("going", "inherited", "invisible")):
        above = UsdGeom.Xform.Define(stage, f"/head/{name}")
        add_cube(stage, f"/head/{name}/hat", scalp=False)
        above.CreateVisibilityAttr().Set(first, 1)
        above.GetVisibilityAttr().Set(second, 10)
    stage.Save()
    coming, going = unread_surfaces(tmp_path / "a.usda")
    assert "/head/coming/hat: its visibility changes over time; it is never touched" in coming
    assert "/head/going/hat: its visibility changes over time; it is touched all the time" in going
    assert [body.prim for body in read_bodies(tmp_path / "a.usda")] == ["/head/skin", "/head/going/hat"]
