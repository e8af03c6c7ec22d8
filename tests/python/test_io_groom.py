"""Grooms, caches and hairs: round trips, animation with the head, and valid USD."""

from __future__ import annotations

import shutil

import numpy as np
import pytest
from pxr import Sdf, Usd, UsdGeom
from ringlet.io import (
    CacheWriter,
    HairWriter,
    cache_groom_path,
    problems,
    read_cache,
    read_clip,
    read_curves,
    read_groom,
    read_hairs,
    read_space,
    read_stage,
    write_cache,
    write_groom,
)
from usd_scenes import hairs_of, make_groom, write_head

from ringlet import Cache, UserError, build_groom


@pytest.fixture(params=[(0.01, "Y"), (1.0, "Z")], ids=["cm-Y", "m-Z"])
def folder(tmp_path, request):
    """A head, its groom, and a cache of frames 1 to 3 in which the locks rise 0.01 m a frame."""
    unit, axis = request.param
    (tmp_path / "assets").mkdir()
    head = write_head(tmp_path / "assets/head.usdc", unit=unit, axis=axis)
    groom = make_groom(head)
    write_groom(groom, tmp_path / "out/groom.usdc")
    moved = np.stack([groom.locks.points + [0, 0.01 * k, 0] for k in range(3)]).astype(np.float32)
    cache = Cache(np.array([1.0, 2.0, 3.0]), moved, [{"newton": k, "energy": np.float32(0.5)} for k in range(3)])
    write_cache(cache, tmp_path / "out/groom.usdc", tmp_path / "out/cache.usdc", read_space(head))
    return tmp_path


def test_a_groom_round_trips(folder):
    groom, back = make_groom(folder / "assets/head.usdc"), read_groom(folder / "out/groom.usdc")
    for name in ("recipe", "hairs", "region", "space", "scalp_prim"):
        assert getattr(back, name) == getattr(groom, name)
    assert back.scalp_file.samefile(groom.scalp_file)
    np.testing.assert_allclose(back.scalp.points, groom.scalp.points)
    for kind in ("locks", "guides"):
        written, read = getattr(groom, kind), getattr(back, kind)
        np.testing.assert_allclose(read.points, written.points, atol=2e-8)
        np.testing.assert_array_equal(read.offsets, written.offsets)
        np.testing.assert_array_equal(read.ids, written.ids)
        assert read.curve.keys() == written.curve.keys() and read.point.keys() == written.point.keys()
        for name, values in written.curve.items():
            np.testing.assert_array_equal(read.curve[name], values)
            assert read.curve[name].dtype.kind == values.dtype.kind
        np.testing.assert_allclose(read.point.get("width", 0), written.point.get("width", 0), rtol=1e-6)


def test_the_same_groom_makes_the_same_file(folder):
    write_groom(make_groom(folder / "assets/head.usdc"), folder / "out/again.usdc")
    assert (folder / "out/again.usdc").read_bytes() == (folder / "out/groom.usdc").read_bytes()


def test_widths_of_curves_stay_uniform(folder):
    groom = make_groom(folder / "assets/head.usdc")
    groom.locks.curve["width"] = groom.locks.point.pop("width")[groom.locks.offsets[:-1]]
    write_groom(groom, folder / "out/groom.usdc")
    locks = read_groom(folder / "out/groom.usdc").locks
    np.testing.assert_array_equal(locks.curve["width"], groom.locks.curve["width"])
    assert "width" not in locks.point


def test_a_scalp_without_a_file_is_stored_in_the_groom(tmp_path):
    mesh = make_groom(write_head(tmp_path / "head.usda")).scalp
    write_groom(make_groom(None, mesh), tmp_path / "groom.usdc")
    back = read_groom(tmp_path / "groom.usdc")
    np.testing.assert_allclose(back.scalp.points, mesh.points, atol=1e-8)
    np.testing.assert_array_equal(back.scalp.region("scalp"), mesh.region("scalp"))
    np.testing.assert_allclose(back.scalp.uv, mesh.uv)
    assert read_clip(back.scalp_file, back.scalp_prim).points.shape == (1, 8, 3)


def test_written_files_pass_the_usd_validators(folder):
    groom = read_groom(folder / "out/groom.usdc")
    with HairWriter(folder / "out/hair.usdc", groom, hairs_of(groom), folder / "out/cache.usdc") as writer:
        writer.add(1, hairs_of(groom).points)
    for name in ("groom", "cache", "hair"):
        assert problems(folder / f"out/{name}.usdc") == []


def test_the_usd_validators_detect_a_violation(tmp_path):
    stage = Usd.Stage.CreateNew(str(tmp_path / "a.usda"))
    UsdGeom.Xform.Define(stage, "/a")
    stage.Save()
    assert any("MissingDefaultPrim" in problem for problem in problems(tmp_path / "a.usda"))


def test_the_head_is_referenced_with_its_animation_after_both_files_move(folder):
    moved = folder.parent / f"{folder.name}-moved"
    shutil.move(folder, moved)
    bodies, hairs, _ = read_stage(moved / "out/groom.usdc")
    assert hairs is None
    assert [body.mesh.name for body in bodies] == ["groom.usdc /groom/body/skin"]
    np.testing.assert_allclose(bodies[0].clip.points, read_clip(moved / "assets/head.usdc").points, atol=1e-7)
    np.testing.assert_allclose(bodies[0].clip.points[3, 0] - bodies[0].clip.points[0, 0], [0.03, 0, 0], atol=1e-7)
    assert len(read_groom(moved / "out/cache.usdc").locks) == 5


def test_a_cache_round_trips_and_leaves_the_groom_at_rest(folder):
    cache, groom = read_cache(folder / "out/cache.usdc"), make_groom(folder / "assets/head.usdc")
    np.testing.assert_array_equal(cache.frames, [1, 2, 3])
    np.testing.assert_allclose(cache.points[2] - cache.points[0], np.tile([0, 0.02, 0], (35, 1)), atol=1e-7)
    assert [row["newton"] for row in cache.statistics] == [0, 1, 2]
    assert cache_groom_path(folder / "out/cache.usdc").samefile(folder / "out/groom.usdc")
    np.testing.assert_allclose(read_groom(folder / "out/cache.usdc").locks.points, groom.locks.points, atol=2e-8)


def test_hairs_and_head_round_trip_at_every_frame(folder):
    groom = read_groom(folder / "out/groom.usdc")
    hairs = hairs_of(groom)
    with HairWriter(folder / "out/hair.usdc", groom, hairs, folder / "out/cache.usdc") as writer:
        for frame in (1, 2, 3):
            writer.add(frame, hairs.points + np.float32([0, 0, 0.1 * frame]))
    at_two = read_hairs(folder / "out/hair.usdc", 2)
    assert at_two.points.dtype == np.float32
    np.testing.assert_allclose(at_two.points, hairs.points + np.float32([0, 0, 0.2]), atol=1e-6)
    np.testing.assert_array_equal(at_two.curve["lock"], hairs.curve["lock"])
    np.testing.assert_allclose(at_two.point["width"], hairs.point["width"], rtol=1e-6)

    bodies, at_three, frames = read_stage(folder / "out/hair.usdc", 3)
    np.testing.assert_array_equal(frames, [1, 2, 3])
    np.testing.assert_allclose(at_three.points, hairs.points + np.float32([0, 0, 0.3]), atol=1e-6)
    np.testing.assert_allclose(bodies[0].clip.at(3) - groom.scalp.points, np.tile([0.02, 0, 0], (8, 1)), atol=1e-6)


def test_hairs_at_rest_stand_on_a_head_at_rest(folder):
    groom = read_groom(folder / "out/groom.usdc")
    with HairWriter(folder / "out/hair.usdc", groom, hairs_of(groom), folder / "out/groom.usdc") as writer:
        writer.add(None, hairs_of(groom).points)
    bodies, hairs, frames = read_stage(folder / "out/hair.usdc")
    assert len(frames) == 0 and len(hairs) == 10
    np.testing.assert_allclose(bodies[0].clip.points, groom.scalp.points[None])


def test_the_written_roots_are_where_the_locks_begin(folder):
    groom = read_groom(folder / "out/groom.usdc")
    stage = Usd.Stage.Open(str(folder / "out/groom.usdc"))
    locks = stage.GetPrimAtPath("/groom/locks")
    value = lambda name: np.array(UsdGeom.PrimvarsAPI(locks).GetPrimvar(name).Get())  # noqa: E731
    np.testing.assert_array_equal(value("skinprim"), 5)  # the scalp of the cube is its last polygon
    # Houdini's (u, v) = (0, 0), (0, 1), (1, 1), (1, 0) are the corners (0, 0), (1, 0), (1, 1), (0, 1) of this quad.
    uv = value("skinprimuv") * 0.1
    np.testing.assert_allclose(uv[:, ::-1], groom.locks.roots[:, :2], atol=1e-7)
    for name in ("st", "surface_uv_coordinate", "groom_root_uv"):
        np.testing.assert_allclose(value(name) * 0.1, groom.locks.roots[:, :2], atol=1e-7)
    assert UsdGeom.Imageable(locks).ComputePurpose() == UsdGeom.Tokens.guide


def test_attributes_of_curves_keep_names_that_usd_refuses(folder):
    groom, path = make_groom(folder / "assets/head.usdc"), folder / "out/named.usdc"
    values = {"len-map": 1.0, "len_map": 2.0, "1map": 3.0, "a:b": 4.0, "épais": 5.0, "two words": 6.0}
    groom.locks.curve |= {name: np.full(5, value, np.float32) for name, value in values.items()}
    write_groom(groom, path)
    assert problems(path) == []
    back = read_groom(path).locks.curve
    for name, value in values.items():
        np.testing.assert_array_equal(back[name], value)


def test_drawn_guides_keep_their_names_and_primvars_in_a_round_trip(tmp_path):
    write_head(tmp_path / "head.usdc")
    stage = Usd.Stage.CreateNew(str(tmp_path / "drawn.usda"))
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    drawn = UsdGeom.BasisCurves.Define(stage, "/guides")
    drawn.CreateTypeAttr("linear")
    drawn.CreateCurveVertexCountsAttr([3, 3])
    drawn.CreatePointsAttr([(3, 3, 10), (3, 3, 12), (3, 4, 14), (6, 6, 10), (6, 6, 12), (6, 7, 14)])
    primvars = {
        "groom_id": ("int[]", "uniform", [70, 7]),
        "style": ("int[]", "uniform", [2, 9]),
        "artist": ("string[]", "uniform", ["ada", "bo"]),
        "weight": ("float[]", "vertex", [0, 0.5, 1, 0, 0.25, 1]),
        "flow": ("float3[]", "vertex", [(k, 0, 1) for k in range(6)]),
        "density": ("float", "constant", 0.5),
    }
    for name, (kind, interpolation, values) in primvars.items():
        primvar = UsdGeom.PrimvarsAPI(drawn).CreatePrimvar(name, Sdf.ValueTypeNames.Find(kind), interpolation)
        primvar.Set(values)
    stage.Save()
    (tmp_path / "a.recipe.toml").write_text(
        "ringlet = 2\n[scalp]\nfile = 'head.usdc'\nregion = 'scalp'\n[guides]\nfile = 'drawn.usda'\n"
    )
    for path in (tmp_path / "once.usdc", tmp_path / "twice.usdc"):
        once = path.name == "once.usdc"
        write_groom(build_groom(tmp_path / "a.recipe.toml") if once else read_groom(tmp_path / "once.usdc"), path)
        stage = Usd.Stage.Open(str(path))
        guides = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/groom/guides"))
        for name, (_, interpolation, values) in primvars.items():
            kept = guides.GetPrimvar(name)
            if name == "density":  # a constant value becomes one for each guide
                interpolation, values = "uniform", [0.5, 0.5]
            assert kept.GetInterpolation() == interpolation, name
            assert [tuple(v) if name == "flow" else v for v in kept.Get()] == values, name


def test_other_programs_can_read_the_locks_as_plain_curves(folder):
    curves = read_curves(folder / "out/groom.usdc", "/groom/locks")
    np.testing.assert_allclose(curves.points, make_groom(folder / "assets/head.usdc").locks.points, atol=2e-8)
    np.testing.assert_allclose(curves.point["rest"], curves.points)
    np.testing.assert_array_equal(curves.ids, [7, 3, 11, 2**40, 5])


def test_extents_contain_the_points_of_their_frame(folder):
    stage = Usd.Stage.Open(str(folder / "out/cache.usdc"))
    locks = UsdGeom.BasisCurves(stage.GetPrimAtPath("/groom/locks"))
    for frame in (1, 2, 3):
        low, high = np.array(locks.GetExtentAttr().Get(frame))
        points = np.array(locks.GetPointsAttr().Get(frame))
        assert (low <= points.min(0)).all() and (high >= points.max(0)).all()
        assert (high - low < np.ptp(points, axis=0) + 0.1).all()


def test_an_interrupted_write_leaves_only_the_old_file(folder):
    out = folder / "out"
    before, files = (out / "cache.usdc").read_bytes(), sorted(out.iterdir())
    locks, space = make_groom(folder / "assets/head.usdc").locks, read_space(out / "groom.usdc")
    with pytest.raises(RuntimeError), CacheWriter(out / "cache.usdc", out / "groom.usdc", space) as writer:
        writer.add(1, locks.points)
        raise RuntimeError("the solver failed")
    assert (out / "cache.usdc").read_bytes() == before
    assert sorted(out.iterdir()) == files


def test_frames_are_flushed_during_a_run(folder, monkeypatch):
    monkeypatch.setattr("ringlet.io.usd.stream.FLUSH", 100)
    groom = read_groom(folder / "out/groom.usdc")
    with CacheWriter(folder / "out/b.usdc", folder / "out/groom.usdc", groom.space) as writer:
        for frame in range(20):
            writer.add(frame, groom.locks.points + frame)
        assert not (folder / "out/b.usdc").exists()
    cache = read_cache(folder / "out/b.usdc")
    np.testing.assert_allclose(cache.points[:, 0] - cache.points[0, 0], np.arange(20)[:, None] * [1, 1, 1], atol=1e-5)


def test_a_cache_of_another_groom_is_refused(folder):
    other = make_groom(folder / "assets/head.usdc")
    other.locks = other.locks.take(np.array([0, 1]))
    write_groom(other, folder / "out/groom.usdc")
    with pytest.raises(UserError, match=r"cache.usdc: has 35 points at frame 1, its groom 14; simulate again"):
        read_cache(folder / "out/cache.usdc")


def test_an_open_cache_is_reread_after_it_was_replaced(folder):
    groom, held = read_groom(folder / "out/groom.usdc"), []
    for name in "abcdefgh":  # several, since the order of reloading layers is random
        path, under = folder / f"out/{name}.usdc", folder / f"out/{name}.groom.usdc"
        shutil.copy(folder / "out/cache.usdc", path)
        held.append(Sdf.Layer.FindOrOpen(str(path)))
        write_groom(groom, under)
        write_cache(Cache(np.array([5.0]), groom.locks.points[None]), under, path, groom.space)
        assert read_cache(path).frames.tolist() == [5.0]


def test_a_groom_whose_head_has_changed_is_refused(tmp_path):
    head = write_head(tmp_path / "head.usda")
    write_groom(make_groom(head), tmp_path / "groom.usda")
    stage = Usd.Stage.Open(str(head))
    UsdGeom.Mesh(stage.GetPrimAtPath("/head/skin")).CreateHoleIndicesAttr([0, 1, 2])
    stage.Save()
    with pytest.raises(UserError, match=r"root on triangle 1[01], but .* has 6; the head has changed"):
        read_groom(tmp_path / "groom.usda")
