"""Bad files and output paths: one line with file and value, and no partial file."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade
from ringlet.io import (
    open_scene,
    read_bodies,
    read_cache,
    read_clip,
    read_curves,
    read_groom,
    read_hairs,
    read_mesh,
    read_space,
    write_cache,
    write_groom,
)
from usd_scenes import add_cube, make_groom, new_stage, write_head

from ringlet import Cache, UserError


def refused(call, *args) -> str:
    """The one-line message of a refused call."""
    with pytest.raises(UserError) as caught:
        call(*args)
    line = str(caught.value)
    assert "\n" not in line and "Error in" not in line and "pxrInternal" not in line
    return line


def names_in(folder) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("no.usda", None, "there is no such file"),
        ("folder.usd", "folder", "is a folder"),
        ("text.usda", b"hello", "cannot be read as USD"),
        ("syntax.usda", b'#usda 1.0\n\ndef Xform "a" {', "syntax error in line 3"),
        ("latin.usda", b'#usda 1.0\n\ndef Xform "\xe9" {}', "cannot be read as USD"),
        ("empty.usdc", b"", "is empty"),
        ("cut.usdc", "cut", "cannot be read as USD"),
        ("photo.usd", b"\x89PNG\r\n\x1a\n" + bytes(100), "cannot be read as USD"),
        ("notes.txt", b"hello", "cannot be read as USD"),
    ],
)
def test_files_other_than_usd_are_refused(tmp_path, capfd, name, content, says):
    path = tmp_path / name
    if content == "folder":
        path.mkdir()
    elif content == "cut":
        path.write_bytes(write_head(tmp_path / "head.usdc").read_bytes()[:-200])
    elif content is not None:
        path.write_bytes(content)
    for call in (read_mesh, read_space, read_clip, read_bodies, read_groom, read_cache, read_hairs):
        line = refused(call, path)
        assert says in line and str(path) in line
    assert capfd.readouterr().err == ""  # messages of USD are suppressed


def retype(mesh, name, kind, values):
    """Gives an attribute another type than that of its schema, as a damaged or hand-written file does."""
    mesh.GetPrim().RemoveProperty(name)
    spec = mesh.GetPrim().GetStage().GetRootLayer().GetPrimAtPath(mesh.GetPath())
    Sdf.AttributeSpec(spec, name, kind).default = values


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda m: m.CreatePointsAttr([]), "/head/skin: has no points"),
        (lambda m: m.GetPointsAttr().Block(), "/head/skin: has no points"),
        (lambda m: m.CreatePointsAttr([Gf.Vec3f(0, float("inf"), 0)] * 8), "point 0 is .*inf.*; must be finite"),
        (
            lambda m: retype(m, "points", Sdf.ValueTypeNames.FloatArray, [1.0] * 8),
            "points are no rows of three numbers",
        ),
        (lambda m: retype(m, "points", Sdf.ValueTypeNames.Float2Array, [(1, 2)] * 6), "points are no rows of three"),
        (
            lambda m: retype(m, "primvars:displayColor", Sdf.ValueTypeNames.StringArray, ["red"]),
            "displayColor are no rows of three numbers",
        ),
        (lambda m: m.CreateFaceVertexCountsAttr([]), "/head/skin: has no faces"),
        (lambda m: m.CreateFaceVertexCountsAttr([4] * 5), "its faces have 20 corners, but there are 24 indices"),
        (lambda m: m.CreateFaceVertexCountsAttr([4] * 5 + [2, 2]), "face 5 has 2 corners; must have at least 3"),
        (lambda m: m.CreateFaceVertexCountsAttr([4] * 5 + [-4, 8]), "face 5 has -4 corners"),
        (lambda m: m.CreateFaceVertexIndicesAttr([8] * 24), "a face uses point 8; must be from 0 to 7"),
        (lambda m: m.CreateFaceVertexIndicesAttr([-1] * 24), "a face uses point -1"),
        (lambda m: m.CreateHoleIndicesAttr(range(6)), "has no faces"),
        (
            lambda m: UsdGeom.Subset.CreateGeomSubset(m, "neck", "face", [99]),
            "skin/neck: names face 99; must be from 0 to 5",
        ),
        (lambda m: set_uv(m, [Gf.Vec2f(0, 0)] * 7), "primvars:st has 7 values for 24 corners"),
        (lambda m: set_uv(m, [Gf.Vec2f(0, float("nan"))] * 24), "primvars:st has a value that is no number"),
        (lambda m: set_uv(m, [Gf.Vec2f(0, 0)], [5] * 24), "primvars:st has an index outside of 0 to 0"),
    ],
)
def test_broken_meshes_are_refused(tmp_path, change, says):
    stage = new_stage(tmp_path / "a.usda")
    change(add_cube(stage))
    stage.Save()
    with pytest.raises(UserError, match=says):
        read_mesh(tmp_path / "a.usda")


@pytest.mark.parametrize("values", [[float("nan"), 0, 0], [-1, 0, 0], [0, 1e30, 0]])
def test_colors_that_are_none_are_refused(tmp_path, values):
    stage = new_stage(tmp_path / "a.usda")
    add_cube(stage).CreateDisplayColorAttr([Gf.Vec3f(*values)])
    stage.Save()
    with pytest.raises(UserError, match=r"/head/skin: displayColor is .* on value 0; must be from 0"):
        read_mesh(tmp_path / "a.usda")


def test_prims_that_show_nothing_are_passed_over(tmp_path):
    stage = new_stage(tmp_path / "a.usda")
    add_cube(stage, scalp=False)
    UsdGeom.Mesh.Define(stage, "/head/empty").CreatePointsAttr([Gf.Vec3f(0)] * 2)
    UsdGeom.Mesh.Define(stage, "/head/nothing")
    UsdGeom.PointInstancer.Define(stage, "/head/beads")
    for name, counts in (("hair", [2]), ("bald", [])):
        curves = UsdGeom.BasisCurves.Define(stage, f"/head/{name}")
        curves.CreatePointsAttr([Gf.Vec3f(0, k, 0) for k in range(sum(counts))])
        curves.CreateCurveVertexCountsAttr(counts)
        curves.CreateTypeAttr("linear")
    stage.Save()
    assert len(read_mesh(tmp_path / "a.usda").triangles) == 12
    assert [body.prim for body in read_bodies(tmp_path / "a.usda")] == ["/head/skin"]
    assert [body.prim for body in read_bodies(tmp_path / "a.usda", "/head")] == ["/head/skin"]
    assert len(read_curves(tmp_path / "a.usda")) == len(read_hairs(tmp_path / "a.usda")) == 1
    with open_scene(tmp_path / "a.usda") as scene:
        assert [one.name for one in scene.sets] == ["hair"] and len(scene.bodies) == 1
    assert "/head/empty: has no faces" in refused(read_mesh, tmp_path / "a.usda", "/head/empty")


def set_uv(mesh, values, indices=None):
    primvar = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, "faceVarying")
    primvar.Set(values)
    if indices:
        primvar.SetIndices(indices)


def test_a_mesh_with_a_varying_point_count_is_refused(tmp_path):
    stage = new_stage(tmp_path / "a.usda")
    mesh = add_cube(stage)
    mesh.GetPointsAttr().Set([Gf.Vec3f(0)] * 8, 1)
    mesh.GetPointsAttr().Set([Gf.Vec3f(0)] * 9, 2)
    stage.Save()
    assert "has 9 points at frame 2, 8 before" in refused(read_clip, tmp_path / "a.usda")


@pytest.mark.parametrize("name", ["faceVertexIndices", "faceVertexCounts"])
def test_a_mesh_whose_faces_change_is_refused(tmp_path, name):
    path = write_head(tmp_path / "head.usda")
    stage = Usd.Stage.Open(str(path))
    faces = stage.GetPrimAtPath("/head/skin").GetAttribute(name)
    same, other = list(faces.Get()), list(reversed(faces.Get())) if name == "faceVertexIndices" else [3, 5, 4, 4, 4, 4]
    for frame, value in ((1, same), (2, same), (3, other)):
        faces.Set(value, frame)
    stage.Save()
    assert f"at frame 3: its {name} differ from those in its rest pose" in refused(read_clip, path)
    assert len(read_clip(path, frames=(1, 2)).frames) == 2  # the change is after the shot


def test_a_missing_prim_is_refused_with_the_nearest_name(tmp_path):
    path = write_head(tmp_path / "head.usda")
    assert "has no prim /head/skn; did you mean /head/skin?" in refused(read_mesh, path, "/head/skn")
    assert "did you mean /head/skin?" in refused(read_mesh, path, "head/skin")
    assert "has no prim" in refused(read_mesh, path, "not a path!")


def test_missing_and_ambiguous_meshes_are_refused(tmp_path):
    stage = new_stage(tmp_path / "a.usda")
    stage.Save()
    assert "has no Mesh prim" in refused(read_mesh, tmp_path / "a.usda")
    add_cube(stage, "/head/one")
    add_cube(stage, "/head/two")
    stage.Save()
    assert "has 2 Mesh prims; name one of: /head/one, /head/two" in refused(read_mesh, tmp_path / "a.usda")


def break_reference(stage):
    stage.DefinePrim("/head/shirt").GetReferences().AddReference("./gone.usda")


def break_payload(stage):
    stage.DefinePrim("/head/shirt").GetPayloads().AddPayload("./gone.usda")


def break_sublayer(stage):
    stage.GetRootLayer().subLayerPaths.append("./gone.usda")


def break_target(stage):
    stage.DefinePrim("/head/shirt").GetReferences().AddInternalReference("/gone")


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (break_reference, "/head/shirt refers to .*gone.usda, which is not there; put it back"),
        (break_payload, "/head/shirt refers to .*gone.usda, which is not there; put it back"),
        (break_sublayer, "lies over .*gone.usda, which is not there; put it back"),
        (break_target, "/head/shirt refers to /gone of .*a.usda, which is not there"),
    ],
)
def test_a_stage_that_refers_to_what_is_missing_is_refused(tmp_path, change, says):
    stage = new_stage(tmp_path / "a.usda")
    add_cube(stage)
    change(stage)
    stage.Save()
    for call in (read_mesh, read_clip, read_bodies):
        with pytest.raises(UserError, match=says):
            call(tmp_path / "a.usda")
    if prim := stage.GetPrimAtPath("/head/shirt"):
        prim.SetActive(False)  # the remedy
        stage.Save()
        assert len(read_bodies(tmp_path / "a.usda")) == 1


def test_missing_materials_are_accepted(tmp_path):
    stage = new_stage(tmp_path / "a.usda")
    add_cube(stage)
    UsdShade.Material.Define(stage, "/head/skin/lacquer").GetPrim().GetReferences().AddReference("./gone.usda")
    stage.Save()
    assert len(read_bodies(tmp_path / "a.usda")) == 1


@pytest.mark.parametrize(
    ("unit", "rate", "says"),
    [
        (0, 24, "metersPerUnit is 0"),
        (-1, 24, "metersPerUnit is -1"),
        (1e300, 24, "metersPerUnit is 1e+300"),
        (1, 0, "timeCodesPerSecond is 0"),
        (1, 1e300, "timeCodesPerSecond is 1e+300"),
        (1, float("nan"), "timeCodesPerSecond is nan"),
    ],
)
def test_units_and_rates_out_of_bounds_are_refused(tmp_path, unit, rate, says):
    path = write_head(tmp_path / "head.usda")
    layer = Sdf.Layer.FindOrOpen(str(path))
    layer.pseudoRoot.SetInfo("metersPerUnit", float(unit))
    layer.timeCodesPerSecond = rate
    layer.Save()
    assert says in refused(read_mesh, path)
    assert "must be from" in refused(read_space, path)


def test_files_without_groom_or_head_are_refused(tmp_path):
    head = write_head(tmp_path / "head.usda")
    assert "is not a Ringlet groom" in refused(read_groom, head)
    assert "is not a Ringlet groom" in refused(read_cache, head)
    groom = make_groom(head)
    write_groom(groom, tmp_path / "groom.usdc")
    assert "holds no simulated frames" in refused(read_cache, tmp_path / "groom.usdc")
    assert "has no hairs" in refused(read_hairs, tmp_path / "groom.usdc")
    cache = Cache(np.array([1.0]), groom.locks.points[None].astype(np.float32))
    write_cache(cache, tmp_path / "groom.usdc", tmp_path / "cache.usdc", groom.space)
    head.unlink()
    assert "head.usda, which is not there" in refused(read_groom, tmp_path / "groom.usdc")
    (tmp_path / "groom.usdc").unlink()
    assert "which is not there" in refused(read_cache, tmp_path / "cache.usdc")


def test_a_groom_of_a_later_layout_is_refused(tmp_path):
    write_groom(make_groom(write_head(tmp_path / "head.usda")), tmp_path / "groom.usda")
    text = (tmp_path / "groom.usda").read_text().replace("ringlet:version = 1", "ringlet:version = 3")
    (tmp_path / "later.usda").write_text(text)
    assert "has layout 3; this Ringlet reads up to 2" in refused(read_groom, tmp_path / "later.usda")


def test_unwritable_paths_are_refused(tmp_path):
    groom = make_groom(write_head(tmp_path / "head.usda"))
    (tmp_path / "file").write_text("a file")
    assert "cannot be written" in refused(write_groom, groom, tmp_path / "file/groom.usdc")
    assert "ends in '.abc'" in refused(write_groom, groom, tmp_path / "groom.abc")
    assert "is an input of this command" in refused(write_groom, groom, tmp_path / "head.usda")
    assert names_in(tmp_path) == ["file", "head.usda"]


FULL = """
import resource, sys, numpy as np
from ringlet import UserError
from ringlet.io import CacheWriter, read_groom
groom = read_groom("groom.usdc")
resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
try:
    with CacheWriter("cache.usdc", "groom.usdc", groom.space) as writer:
        for frame in range(2000):
            writer.add(frame, groom.locks.points + np.random.rand(*groom.locks.points.shape))
except UserError as error:
    print(error)
"""


def test_a_full_disk_leaves_no_file(tmp_path):
    write_groom(make_groom(write_head(tmp_path / "head.usda")), tmp_path / "groom.usdc")
    done = subprocess.run([sys.executable, "-c", FULL], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.stdout.startswith("cache.usdc: cannot be written") and done.stdout.count("\n") == 1, done
    assert done.stderr == ""
    assert names_in(tmp_path) == ["groom.usdc", "head.usda"]
