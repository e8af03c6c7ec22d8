"""Catmull–Clark surfaces against closed forms, and heads that are such surfaces."""

from __future__ import annotations

import numpy as np
import pytest
from commands import edit, made, refused, run
from pxr import Gf, Sdf, Usd, UsdGeom, UsdSkel
from ringlet.api.caches import scalp_clip
from ringlet.io import problems, read_bodies, read_clip, read_hairs, read_mesh, read_meshes, unread_surfaces
from ringlet.io.subdivision import Cage, levels_for, refine
from usd_scenes import CUBE, CUBE_FACES, add_cube, new_stage

import ringlet
from ringlet import _core


def cube(**settings) -> Cage:
    return Cage(np.full(6, 4), np.array(CUBE_FACES).ravel(), 8, **settings)


def sheet(side: int) -> tuple[Cage, np.ndarray]:
    """A grid of quads with random points."""
    row, column = np.divmod(np.arange((side - 1) ** 2), side - 1)
    first = row * side + column
    faces = np.stack([first, first + 1, first + side + 1, first + side], axis=1)
    return Cage(np.full(len(faces), 4), faces.ravel(), side**2), np.random.default_rng(4).random((side**2, 3))


def b_spline(controls: np.ndarray, t: float) -> np.ndarray:
    """Uniform cubic B-spline of four controls, at t from 0 to 1 between the inner two."""
    basis = np.array([(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3]) / 6
    return np.tensordot(basis, controls, axes=1)


@pytest.mark.parametrize("levels", [0, 1, 2])
def test_the_limit_of_a_cube_is_half_as_large_at_its_corners(levels):
    """n = 3: (9 v + 4 Σ e + Σ f) / 24 is v / 2 about the centre."""
    points = refine(cube(), levels).points @ (2.0 * CUBE - 1.0)
    np.testing.assert_allclose(points[:8], 0.5 * (2.0 * CUBE - 1.0), atol=1e-12)


@pytest.mark.parametrize("levels", [1, 2, 3])
def test_a_regular_sheet_is_a_bicubic_b_spline(levels):
    cage, points = sheet(4)
    made = refine(cage, levels)
    limits = made.points @ points
    # The grid of the refined middle face, found through linear values at its corners.
    parameter = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    places = made.corners @ np.tile(parameter, (9, 1))
    middle = np.repeat(made.faces == 4, 4)
    grid = points.reshape(4, 4, 3)  # row, column
    for corner, (u, v) in zip(made.indices[middle], places[middle], strict=True):
        expected = b_spline(np.stack([b_spline(row, u) for row in grid]), v)
        np.testing.assert_allclose(limits[corner], expected, atol=1e-12)


def test_a_boundary_is_a_cubic_b_spline_that_reaches_its_corners():
    cage, points = sheet(4)
    limits = refine(cage, 0).points @ points
    np.testing.assert_allclose(limits[[0, 3, 12, 15]], points[[0, 3, 12, 15]])
    np.testing.assert_allclose(limits[1], (points[0] + 4 * points[1] + points[2]) / 6)
    cage.round_ends = True
    limits = refine(cage, 0).points @ points
    np.testing.assert_allclose(limits[0], (points[1] + 4 * points[0] + points[4]) / 6)


def test_infinite_creases_keep_a_cube_and_finite_ones_decay():
    edges = np.unique(np.sort([[f[k], f[(k + 1) % 4]] for f in CUBE_FACES for k in range(4)], axis=1), axis=0)
    sharp = refine(cube(creases=edges, sharpness=np.full(12, np.inf)), 2).points @ CUBE
    assert set(np.round(sharp.ravel() * 4) / 4) == {0.0, 0.25, 0.5, 0.75, 1.0} and np.ptp(sharp) == 1.0
    np.testing.assert_allclose(sharp[:8], CUBE)
    size = [
        np.ptp((refine(cube(creases=edges, sharpness=np.full(12, s)), 3).points @ CUBE)[:8])
        for s in (0.0, 0.5, 1.0, 2.0)
    ]
    assert size[0] == pytest.approx(0.5) and np.all(np.diff(size) > 0.05) and size[-1] < 1.0
    soft = cube(creases=edges, sharpness=np.full(12, 1.5))
    two, three, four = ((refine(soft, levels).points @ CUBE)[:26] for levels in (2, 3, 4))
    np.testing.assert_allclose(two, three, atol=1e-12)  # nothing moves once the creases have ended
    np.testing.assert_allclose(two, four, atol=1e-12)
    assert levels_for(soft, CUBE * 1e-5) == 2
    # Sharp for one level: the limit of the cube once it is split without rounding.
    split = refine(cube(creases=edges, sharpness=np.full(12, np.inf)), 1)
    once = Cage(split.counts, split.indices, split.points.shape[0])
    np.testing.assert_allclose(
        (refine(cube(creases=edges, sharpness=np.ones(12)), 2).points @ CUBE)[:8],
        (refine(once, 1).points @ (split.points @ CUBE))[:8],
        atol=1e-12,
    )


def test_polygons_of_any_number_of_corners_keep_planes_and_linear_values():
    """A prism of five sides: affine invariance, and faces that know their polygon."""
    angle = 2 * np.pi * np.arange(5) / 5
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    points = np.concatenate([ring, ring + [0, 0, 1]])
    faces = [[4, 3, 2, 1, 0], [5, 6, 7, 8, 9], *([k, (k + 1) % 5, 5 + (k + 1) % 5, 5 + k] for k in range(5))]
    cage = Cage(np.array([len(f) for f in faces]), np.concatenate(faces), 10)
    made = refine(cage, 2)
    np.testing.assert_allclose(np.asarray(made.points.sum(axis=1)).ravel(), 1.0)
    np.testing.assert_allclose(np.asarray(made.corners.sum(axis=1)).ravel(), 1.0)
    np.testing.assert_array_equal(np.bincount(made.faces), [20, 20, 16, 16, 16, 16, 16])
    assert made.corners.shape == (4 * len(made.faces), len(cage.indices))
    deeper = refine(cage, 4).points @ points  # points of a level stay where they are at the next
    np.testing.assert_allclose((made.points @ points)[:10], deeper[:10], atol=1e-12)
    np.testing.assert_allclose(refine(cage, 0).points @ points, deeper[:10], atol=1e-12)


def test_levels_follow_the_distance_from_the_limit_surface():
    assert levels_for(cube(), CUBE * 1e-5) == 0
    assert levels_for(cube(), CUBE * 2e-3) == 1
    assert levels_for(cube(), CUBE * 100.0) == 3
    cage, points = sheet(230)  # as many faces as a refinement may have in its first level
    assert levels_for(cage, points * 100.0) == 0


def smooth_head(folder):
    """Makes the head of the example a subdivision surface."""
    stage = Usd.Stage.Open(str(folder / "head.usda"))
    UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin")).CreateSubdivisionSchemeAttr("catmullClark")
    stage.Save()
    return UsdGeom.Mesh(stage.GetPrimAtPath("/ball/skin")), stage


def limit_of(mesh: UsdGeom.Mesh, levels: int) -> tuple[np.ndarray, np.ndarray]:
    """Limit points [m] of a mesh in centimetres, and its triangles."""
    points = 0.01 * np.array(mesh.GetPointsAttr().Get(), float)
    counts, indices = (np.array(a.Get()) for a in (mesh.GetFaceVertexCountsAttr(), mesh.GetFaceVertexIndicesAttr()))
    fine = refine(Cage(counts, indices, len(points)), levels)
    quads = fine.indices.reshape(-1, 4)
    return fine.points @ points, np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]]).astype(np.int32)


def distances(points: np.ndarray, surface: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    return _core.bind_roots(np.ascontiguousarray(surface[0]), surface[1], np.ascontiguousarray(points, np.float64))[2]


def test_hair_is_rooted_on_the_limit_surface_in_every_frame(folder):
    mesh, _ = smooth_head(folder)
    surface = limit_of(mesh, 3)
    assert distances(0.01 * np.array(mesh.GetPointsAttr().Get()), surface).max() > 1e-3  # the cage is off
    groom = made(folder)
    assert problems(groom) == []
    locks = ringlet.read_groom(groom).locks
    assert distances(locks.roots, surface).max() < 1e-4
    edit(folder / "small.shot.toml", "preroll = 0", "preroll = 0\n[contact]")
    result = run("sim", folder / "small.shot.toml", "--groom", groom, "-o", folder / "cache.usdc")
    assert result.exit_code == 0, result.output
    cache = ringlet.read_cache(folder / "cache.usdc")
    for frame, points in zip(cache.frames, cache.points, strict=True):
        angle = np.radians(5.0 * (frame - 1))  # the head turns about the vertical
        c, s = np.cos(angle), np.sin(angle)
        back = points[locks.offsets[:-1]] @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
        assert distances(back, surface).max() < 1e-4
    ringlet.write_hairs(groom, folder / "hair.usdc", cache=folder / "cache.usdc")
    hairs = read_hairs(folder / "hair.usdc", 1.0)
    assert distances(hairs.points[hairs.offsets[:-1]], surface).max() < 1e-4


def test_a_recipe_may_choose_the_cage(folder):
    mesh, _ = smooth_head(folder)
    edit(folder / "small.recipe.toml", "[scalp]", "[scalp]\nsurface = 'cage'")
    groom = ringlet.read_groom(made(folder))
    cage = 0.01 * np.array(mesh.GetPointsAttr().Get())
    np.testing.assert_allclose(groom.scalp.points, cage, atol=1e-7)
    assert groom.cage and scalp_clip(groom).points.shape[1:] == cage.shape
    (shown,) = read_meshes(folder / "groom.usdc")
    assert shown.points.shape == cage.shape  # the hairs' skin is that of the groom
    edit(folder / "small.recipe.toml", "surface = 'cage'", "surface = 'smooth'")
    refused(run("groom", folder / "small.recipe.toml", "-o", folder / "groom.usdc"), "scalp.surface", "limit")


def test_a_groom_without_the_setting_stays_on_the_cage(folder):
    mesh, _ = smooth_head(folder)
    edit(folder / "small.recipe.toml", "[scalp]", "[scalp]\nsurface = 'cage'")
    stage = Usd.Stage.Open(str(made(folder)))
    stage.GetPrimAtPath("/groom").RemoveProperty("ringlet:surface")
    stage.Save()
    groom = ringlet.read_groom(folder / "groom.usdc")
    assert groom.cage and len(groom.scalp.points) == len(mesh.GetPointsAttr().Get())


def test_attributes_of_a_subdivision_surface_follow_its_refinement(tmp_path):
    """Linear values on a cube: its corners' places in the cage, whose limit is half as large about the centre."""
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    mesh = add_cube(stage)
    mesh.CreateSubdivisionSchemeAttr("catmullClark")
    api, kinds = UsdGeom.PrimvarsAPI(mesh), Sdf.ValueTypeNames
    api.CreatePrimvar("height", kinds.FloatArray, "vertex").Set(CUBE[:, 1].tolist())
    api.CreatePrimvar("face", kinds.FloatArray, "uniform").Set(list(range(6)))
    api.CreatePrimvar("varied", kinds.FloatArray, "varying").Set(CUBE[:, 1].tolist())
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    uv = api.CreatePrimvar("st", kinds.TexCoord2fArray, "faceVarying")
    uv.Set([Gf.Vec2f(*corner) for _ in range(6) for corner in corners])
    stage.Save()
    read = read_mesh(tmp_path / "a.usda")
    assert len(read.triangles) == 2 * 6 * 64
    np.testing.assert_allclose(read.points[read.triangles][..., 1], read.maps["height"], atol=1e-6)
    np.testing.assert_array_equal(read.maps["face"], np.repeat(read.faces[:, None], 3, axis=1))
    np.testing.assert_array_equal(np.bincount(read.faces), [128] * 6)
    np.testing.assert_array_equal(read.faces[read.region("scalp")], [5] * 128)
    assert read.maps["varied"].min() == 0.0 and read.maps["varied"].max() == 1.0  # linear in each face
    np.testing.assert_allclose(np.unique(read.uv), np.linspace(0, 1, 9), atol=1e-7)
    np.testing.assert_allclose(read.places[..., 0] + read.places[..., 1], read.uv.sum(axis=-1), atol=1e-7)
    (body,) = read_bodies(tmp_path / "a.usda", cage=True)
    np.testing.assert_allclose(body.mesh.points, CUBE)


def test_creases_and_holes_of_a_file_are_kept(tmp_path):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    mesh = add_cube(stage)
    mesh.CreateSubdivisionSchemeAttr("catmullClark")
    mesh.CreateHoleIndicesAttr([0])
    mesh.CreateCreaseIndicesAttr(CUBE_FACES[1] + CUBE_FACES[1][:1])
    mesh.CreateCreaseLengthsAttr([5])
    mesh.CreateCreaseSharpnessesAttr([10.0])
    mesh.CreateCornerIndicesAttr([0])
    mesh.CreateCornerSharpnessesAttr([10.0])
    stage.Save()
    read = read_mesh(tmp_path / "a.usda")
    assert 0 not in read.faces
    np.testing.assert_allclose(read.points[0], CUBE[0])
    ring = read.points[CUBE_FACES[1]]  # a cubic B-spline in the plane of its square
    np.testing.assert_allclose(ring[0], (4 * CUBE[4] + CUBE[5] + CUBE[6]) / 6, atol=1e-7)
    np.testing.assert_allclose(ring[:, 0], 1.0, atol=1e-7)


def test_a_boundary_that_is_not_interpolated_is_not_drawn(tmp_path):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    mesh, (cage, points) = UsdGeom.Mesh.Define(stage, "/head/skin"), sheet(5)
    mesh.CreatePointsAttr([Gf.Vec3f(*map(float, point)) for point in points])
    mesh.CreateFaceVertexCountsAttr(cage.counts.tolist())
    mesh.CreateFaceVertexIndicesAttr(cage.indices.tolist())
    for rule, drawn in (("edgeAndCorner", set(range(16))), ("none", {5, 6, 9, 10})):
        mesh.CreateInterpolateBoundaryAttr(rule)
        stage.Save()
        assert set(read_mesh(tmp_path / "a.usda").faces.tolist()) == drawn


def test_a_skinned_subdivision_surface_is_refined_after_its_skeleton(tmp_path):
    stage = new_stage(tmp_path / "a.usda", unit=1.0)
    UsdSkel.Root.Define(stage, "/head")
    mesh, bones = add_cube(stage), UsdSkel.Skeleton.Define(stage, "/head/bones")
    mesh.CreateSubdivisionSchemeAttr("catmullClark")
    bones.CreateJointsAttr(["neck"])
    bones.CreateBindTransformsAttr([Gf.Matrix4d(1)])
    bones.CreateRestTransformsAttr([Gf.Matrix4d(1)])
    motion = UsdSkel.Animation.Define(stage, "/head/motion")
    motion.CreateJointsAttr(["neck"])
    motion.CreateRotationsAttr([Gf.Quatf(1)])
    motion.CreateScalesAttr([Gf.Vec3h(1)])
    for frame in (1, 5):
        motion.CreateTranslationsAttr().Set([Gf.Vec3f(frame - 1, 0, 0)], frame)
    UsdSkel.BindingAPI.Apply(bones.GetPrim()).CreateAnimationSourceRel().SetTargets(["/head/motion"])
    skin = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    skin.CreateSkeletonRel().SetTargets(["/head/bones"])
    skin.CreateJointIndicesPrimvar(False, 1).Set([0] * 8)
    skin.CreateJointWeightsPrimvar(False, 1).Set([1.0] * 8)
    stage.Save()
    read, clip = read_mesh(tmp_path / "a.usda"), read_clip(tmp_path / "a.usda", frames=(1, 5))
    np.testing.assert_allclose(clip.points[:, 0, 0] - read.points[0, 0], [0, 1, 2, 3, 4], atol=1e-5)
    np.testing.assert_allclose(clip.points[4] - [4, 0, 0], read.points, atol=1e-5)


def test_a_subdivision_surface_whose_points_change_in_number_is_refused(tmp_path):
    stage = new_stage(tmp_path / "a.usda")
    mesh = add_cube(stage)
    mesh.CreateSubdivisionSchemeAttr("catmullClark")
    for frame, count in ((1, 8), (2, 9)):
        mesh.GetPointsAttr().Set([Gf.Vec3f(k, k * k, -k) for k in range(count)], frame)
    stage.Save()
    with pytest.raises(ringlet.UserError, match=r"skin at frame 2: has 9 points, 8 in its rest pose; must not change"):
        read_clip(tmp_path / "a.usda", frames=(1, 2))


def test_a_loop_surface_is_read_as_its_cage_and_reported(folder):
    mesh, stage = smooth_head(folder)
    mesh.GetSubdivisionSchemeAttr().Set("loop")
    stage.Save()
    made = ringlet.build_groom(folder / "small.recipe.toml")
    np.testing.assert_allclose(made.scalp.points, 0.01 * np.array(mesh.GetPointsAttr().Get()), atol=1e-7)
    (note,) = made.conflicts
    assert "head.usda /ball/skin: its subdivisionScheme is loop; its cage is read" in note
    assert unread_surfaces(folder / "head.usda") == made.conflicts
