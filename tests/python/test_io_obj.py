"""OBJ files as scalps and guides, and .hair files."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from commands import edit
from pxr import Usd
from ringlet.data.surfaces import color_of
from ringlet.io import problems, read_clip, read_curves, read_groom, read_mesh, write_groom
from usd_scenes import CUBE, CUBE_FACES, make_groom

from ringlet import StageSpace, UserError

CM = StageSpace(0.01, "Y")


def write_cube(path, extra=""):
    lines = [
        "# a cube",
        *(f"v {x * 10:g} {y * 10:g} {z * 10:g}" for x, y, z in CUBE),
        "vt 0 0",
        "vt 1 0",
        "vt 1 1",
        "vt 0 1",
    ]
    for index, face in enumerate(CUBE_FACES):
        lines.append("g scalp" if index == 5 else "g skin")
        lines.append("f " + " ".join(f"{corner + 1}/{k + 1}" for k, corner in enumerate(face)))
    path.write_text("\n".join(lines) + "\n" + extra)
    return path


def test_an_obj_is_a_scalp_with_its_groups_as_regions(tmp_path):
    path = write_cube(tmp_path / "head.obj")
    mesh = read_mesh(path, space=CM)
    np.testing.assert_allclose(mesh.points, 0.1 * CUBE)
    np.testing.assert_array_equal(mesh.regions["scalp"], [10, 11])
    np.testing.assert_allclose(mesh.uv[11], [[0, 0], [1, 1], [0, 1]])
    upright = read_mesh(path, space=StageSpace(0.01, "Z"))
    np.testing.assert_allclose(upright.points, 0.1 * CUBE[:, [0, 2, 1]] * [1, 1, -1])
    np.testing.assert_allclose(read_clip(path, space=CM).at(3), mesh.points)


def test_materials_of_an_obj_are_regions_and_colours(tmp_path):
    path = write_cube(tmp_path / "bust.obj")
    bare = read_mesh(path, space=CM)
    assert bare.colors is None
    assert bare.color == color_of("skin")
    text = path.read_text().replace("g scalp\n", "usemtl M_Iris\ng scalp\n")
    path.write_text("mtllib cube.mtl missing.mtl\nmtllib cube.mtl\n" + text.replace("g skin", "usemtl M_Face\ng skin"))
    guessed = read_mesh(path, space=CM)
    np.testing.assert_array_equal(guessed.regions["M_Iris"], [10, 11])
    corners = guessed.triangles[10:].ravel()
    np.testing.assert_allclose(guessed.colors[corners], np.tile(color_of("iris"), (6, 1)))
    others = np.setdiff1d(np.arange(8), corners)
    np.testing.assert_allclose(guessed.colors[others], np.tile(color_of("skin"), (len(others), 1)))
    (tmp_path / "cube.mtl").write_text("newmtl M_Face\nKd 0.1 0.2 0.3\nnewmtl M_Iris\nKd 1 x 0\nKd\n")
    given = read_mesh(path, space=CM)
    np.testing.assert_allclose(given.colors[others], np.tile([0.1, 0.2, 0.3], (len(others), 1)))
    np.testing.assert_allclose(given.colors[corners], guessed.colors[corners])


def test_a_groom_on_an_obj_stores_the_head(tmp_path):
    path = write_cube(tmp_path / "head.obj")
    groom = make_groom(None, read_mesh(path, space=CM))
    groom.scalp_file = path
    write_groom(groom, tmp_path / "groom.usdc")
    back = read_groom(tmp_path / "groom.usdc")
    np.testing.assert_allclose(back.scalp.points, groom.scalp.points, atol=1e-8)
    np.testing.assert_array_equal(back.scalp.region("scalp"), groom.scalp.region("scalp"))


def test_regions_of_an_obj_keep_names_that_usd_refuses(tmp_path):
    path = write_cube(tmp_path / "head.obj")
    names = ["head-top", "head_top", "1scalp", "char:scalp", "tête", "scalp"]
    for name in names[:5]:
        edit(path, "g skin", f"g {name}")
    groom = make_groom(None, read_mesh(path, space=CM))
    groom.scalp_file, groom.region = path, "char:scalp"
    write_groom(groom, tmp_path / "groom.usdc")
    assert problems(tmp_path / "groom.usdc") == []
    back = read_groom(tmp_path / "groom.usdc")
    assert list(back.scalp.regions) == names and back.region == "char:scalp"
    for name in names:
        np.testing.assert_array_equal(back.scalp.region(name), groom.scalp.region(name))
    stage = Usd.Stage.Open(str(tmp_path / "groom.usdc"))
    subsets = stage.GetPrimAtPath("/groom/body").GetChildren()
    assert [prim.GetName() for prim in subsets] == ["head_top", "head_top_2", "_1scalp", "char_scalp", "tête", "scalp"]
    assert [prim.GetDisplayName() for prim in subsets] == ["head-top", "head_top", "1scalp", "char:scalp", "", ""]


def test_polylines_of_an_obj_are_curves(tmp_path):
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 0 1 0\nv 0 2 0\nl 1 2 3\nv 5 0 0\nl -1 -2\n")
    curves = read_curves(tmp_path / "a.obj", space=CM)
    np.testing.assert_allclose(curves[0][:, 1], [0, 0.01, 0.02])
    np.testing.assert_allclose(curves[1], [[0.05, 0, 0], [0, 0.02, 0]])


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", "has no points"),
        ("v 0 0 0\n", "has no faces"),
        ("v 0 0 x\n", "line 1 is 'v 0 0 x'"),
        ("v 0 nan 0\nf 1 1 1\n", "point 0 is .*; must be finite"),
        ("v 0 0 0\nf 1 2 3\n", "a face uses point 3; must be from 1 to 1"),
        ("v 0 0 0\nf 0 0 0\n", "line 2 uses point 0; must be from 1"),
        ("v 0 0 0\nf 1 1\n", "face 0 has 2 corners"),
        ("v 0 0 0\nvt 0 0\nf 1/9 1/1 1/1\n", "a face uses vt 9; must be from 1 to 1"),
    ],
)
def test_broken_obj_files_are_refused(tmp_path, content, says):
    (tmp_path / "a.obj").write_text(content)
    with pytest.raises(UserError, match=says):
        read_mesh(tmp_path / "a.obj")


def test_a_missing_obj_and_a_prim_of_an_obj_are_refused(tmp_path):
    with pytest.raises(UserError, match=r"no.obj: cannot be read"):
        read_mesh(tmp_path / "no.obj")
    with pytest.raises(UserError, match=r"has no prims such as /head; leave it out \(false in a variant\)"):
        read_mesh(write_cube(tmp_path / "a.obj"), "/head")


def hair_file(points, segments=None, *, hairs=2, default=1, thickness=None, count=None) -> bytes:
    flags = 2 | (segments is not None) | (thickness is not None) << 2
    header = struct.pack("<4sIIIIff3f88s", b"HAIR", hairs, count or len(points), flags, default, 0.5, 0, 1, 1, 1, b"")
    arrays = [np.asarray(points, "<f4")]
    if segments is not None:
        arrays.insert(0, np.asarray(segments, "<u2"))
    if thickness is not None:
        arrays.append(np.asarray(thickness, "<f4"))
    return header + b"".join(array.tobytes() for array in arrays)


def test_hair_files_have_points_and_widths(tmp_path):
    points = np.random.default_rng(0).random((5, 3))
    path = tmp_path / "a.hair"
    path.write_bytes(hair_file(points, [2, 1], thickness=[1, 2, 3, 4, 5]))
    curves = read_curves(path, space=CM)
    np.testing.assert_array_equal(curves.offsets, [0, 3, 5])
    np.testing.assert_allclose(curves.points, 0.01 * points, rtol=1e-6)
    np.testing.assert_allclose(curves.point["width"], 0.01 * np.arange(1, 6))
    path.write_bytes(hair_file(points[:4]))
    curves = read_curves(path)
    np.testing.assert_array_equal(curves.offsets, [0, 2, 4])
    np.testing.assert_allclose(curves.point["width"], 0.5)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "is not a .hair file"),
        (b"HAIR", "is not a .hair file"),
        (b"BALD" + bytes(200), "is not a .hair file"),
        (hair_file(np.eye(3), [2], hairs=1, thickness=[1, 1, 1])[:-4], "bytes, but says it holds"),
        (hair_file(np.eye(3), hairs=1), "1 hairs of 1 segments do not make 3 points"),
        (hair_file(np.eye(3), [1, 1]), "its hairs have 4 points, but it holds 3"),
        (hair_file(np.eye(3), [1, 0]), "curve 1 has 1 point"),
        (hair_file(np.eye(3) * np.nan, [2], hairs=1), "must be finite"),
        (hair_file(np.eye(3), hairs=2**31, default=1, count=2**32 - 1), "too few for 4294967295 points"),
        (hair_file(np.eye(3), hairs=2**31 - 1, default=1, count=2**32 - 2), "too few for 4294967294 points"),
    ],
)
def test_broken_hair_files_are_refused(tmp_path, content, says):
    (tmp_path / "a.hair").write_bytes(content)
    with pytest.raises(UserError, match=says):
        read_curves(tmp_path / "a.hair")
