"""``ringlet convert``: round trips between formats, units and axes, subsampling, and what formats cannot hold."""

from __future__ import annotations

import importlib.util
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from commands import refused, run
from ringlet.data.resampling import Resampling
from ringlet.io import HairWriter, open_scene, problems, read_curves, read_space, write_cache, write_groom
from usd_scenes import hairs_of, make_groom, write_head

from ringlet import Cache, StageSpace, UserError, convert

HAS_ALEMBIC = importlib.util.find_spec("alembic3d") is not None
needs_alembic = pytest.mark.skipif(not HAS_ALEMBIC, reason="alembic3d is not installed: pip install 'ringlet[alembic]'")
RISE = np.array([0, 0.01, 0])


@pytest.fixture
def hair(tmp_path):
    """Hairs of five locks that rise 0.01 m a frame on a head that slides, in frames 1 to 3, in centimetres."""
    head = write_head(tmp_path / "head.usdc")
    groom = make_groom(head)
    write_groom(groom, tmp_path / "groom.usdc")
    moved = np.stack([groom.locks.points + k * RISE for k in range(3)]).astype(np.float32)
    cache = Cache(np.array([1.0, 2.0, 3.0]), moved)
    write_cache(cache, tmp_path / "groom.usdc", tmp_path / "cache.usdc", read_space(head))
    hairs = hairs_of(groom)
    with HairWriter(tmp_path / "hair.usdc", groom, hairs, tmp_path / "cache.usdc") as writer:
        for k in range(3):
            writer.add(k + 1.0, (hairs.points + k * RISE).astype(np.float32))
    return tmp_path / "hair.usdc"


def seen(path, space=None):
    """Sets by name, bodies and frames of a file, with the points of every frame."""
    with open_scene(path, space) as scene:
        sets = {one.name: (one, [one.points(frame) for frame in scene.frames]) for one in scene.sets}
        return sets, scene.bodies, scene.frames, scene.space


@pytest.mark.parametrize("name", ["a.usdc", pytest.param("a.abc", marks=needs_alembic)])
def test_guides_hairs_head_and_motion_round_trip(hair, tmp_path, name):
    done = convert(hair, tmp_path / name)
    assert (done["hairs"], done["guides"], done["bodies"], done["frames"]) == (10, 5, 1, 3)
    before, bodies, _, _ = seen(hair)
    after, bodies_after, frames, space = seen(tmp_path / name)
    assert frames.tolist() == [1, 2, 3] and space.fps == 24
    for kind in ("hairs", "guides"):
        (one, motion), (back, motion_back) = before[kind], after[kind]
        assert back.guide == one.guide and back.curves.counts.tolist() == one.curves.counts.tolist()
        np.testing.assert_allclose(motion_back, motion, atol=1e-6)
        np.testing.assert_allclose(back.curves.point["width"], one.curves.point["width"], rtol=1e-5)
        np.testing.assert_allclose(back.curves.curve["st"], one.curves.curve["st"], atol=1e-6)
    assert after["hairs"][0].curves.ids.tolist() == before["hairs"][0].curves.ids.tolist()
    (mesh, clip), (mesh_after, clip_after) = bodies[0], bodies_after[0]
    np.testing.assert_allclose(clip_after.points, clip.points, atol=1e-6)
    normals, normals_after = (
        np.cross(*np.diff(m.points[m.triangles], axis=1).transpose(1, 0, 2)) for m in (mesh, mesh_after)
    )
    np.testing.assert_allclose(normals_after.sum(axis=0), normals.sum(axis=0), atol=1e-7)  # closed
    assert np.einsum("ki,ki->", mesh_after.points[mesh_after.triangles[:, 0]] - 0.05, normals_after) > 0  # outward
    if name.endswith("usdc"):
        assert problems(tmp_path / name) == []


@pytest.mark.parametrize("suffix", [".hair", ".tfx", ".obj", ".usda", pytest.param(".abc", marks=needs_alembic)])
def test_points_survive_every_format_in_every_unit_and_axis(hair, tmp_path, suffix):
    path, points = tmp_path / f"a{suffix}", 8 if suffix == ".tfx" else None
    done = convert(hair, path, unit=0.001, up="Z", only="hairs", bodies=False, points=points)
    assert (done["unit"], done["up"], done["hairs"]) == (0.001, "Z", 10)
    space = None if suffix == ".usda" else StageSpace(0.001, "Z")
    back = read_curves(path, space=space or StageSpace())
    hairs = hairs_of(make_groom(tmp_path / "head.usdc"))
    hairs = Resampling(hairs, points).curves(hairs) if points else hairs
    assert back.counts.tolist() == hairs.counts.tolist()
    np.testing.assert_allclose(back.points, hairs.points, atol=1e-6)
    if suffix in (".hair", ".usda", ".abc"):
        np.testing.assert_allclose(back.point["width"], hairs.point["width"], rtol=1e-5)
    if suffix == ".tfx":
        np.testing.assert_allclose(back.curve["width"], hairs.point["width"].reshape(10, 8).max(axis=1), rtol=1e-5)


def test_what_a_format_cannot_hold_is_reported(hair, tmp_path):
    lost = " ".join(convert(hair, tmp_path / "a.obj")["lost"])
    for part in ("without 5 guides", "no surfaces", "no frame of 3 is chosen", "no widths", "st"):
        assert part in lost
    assert "one width for each curve" in " ".join(convert(hair, tmp_path / "a.tfx")["lost"])
    moves = "surfaces move from 1 to 4: only 1 to 3 are kept, in which the curves move"
    assert convert(hair, tmp_path / "b.usdc")["lost"] == [moves]
    assert convert(tmp_path / "b.usdc", tmp_path / "c.usdc")["lost"] == []


@pytest.mark.parametrize("suffix", [".obj", ".hair", ".tfx"])
def test_a_format_of_one_pose_holds_that_of_the_frame_that_is_chosen(hair, tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    points = 8 if suffix == ".tfx" else None
    done = convert(hair, path, only="hairs", frames=(3, 3), unit=1.0, points=points)
    assert f"{suffix if suffix != '.obj' else 'OBJ'} holds one pose: that of frame 3" in done["lost"]
    hairs = hairs_of(make_groom(tmp_path / "head.usdc"))
    rest = (Resampling(hairs, points).curves(hairs) if points else hairs).points
    np.testing.assert_allclose(read_curves(path).points, rest + 2 * RISE, atol=1e-6)


@pytest.mark.parametrize("name", ["a.usdc", pytest.param("a.abc", marks=needs_alembic)])
def test_a_file_of_one_frame_keeps_its_pose_and_the_rest_pose(hair, tmp_path, name):
    convert(hair, tmp_path / name, frames=(3, 3))
    after, _, frames, _ = seen(tmp_path / name)
    one, (pose,) = after["hairs"]
    assert frames.tolist() == [3]
    np.testing.assert_allclose(pose, one.curves.points + 2 * RISE, atol=1e-6)


def test_strands_and_points_are_subsampled_with_motion_and_widths(hair, tmp_path):
    done = convert(hair, tmp_path / "a.usdc", fraction=0.4, wider=True, points=4)
    assert (done["hairs"], done["guides"], done["points"]) == (4, 5, 36)  # hairs name their guides by rows
    assert convert(hair, tmp_path / "c.usdc", only="guides", fraction=0.4)["guides"] == 2
    before, _, _, _ = seen(hair)
    after, _, _, _ = seen(tmp_path / "a.usdc")
    (one, _), (back, motion_back) = before["hairs"], after["hairs"]
    rows = np.isin(one.curves.ids, back.curves.ids)
    kept = one.curves.take(rows)
    assert set(back.curves.ids) <= set(one.curves.ids)
    np.testing.assert_allclose(back.curves.roots, kept.roots, atol=1e-6)
    np.testing.assert_allclose(back.curves.lengths(), kept.lengths(), rtol=1e-4)
    np.testing.assert_allclose(back.curves.point["width"][::4], 2.5 * kept.point["width"][::7], rtol=1e-4)
    np.testing.assert_allclose(motion_back[2] - motion_back[0], np.tile(2 * RISE, (16, 1)), atol=1e-6)
    again = convert(hair, tmp_path / "b.usdc", fraction=0.4, wider=True, points=4)
    assert again == done and (tmp_path / "b.usdc").read_bytes() == (tmp_path / "a.usdc").read_bytes()


def test_curves_of_different_counts_are_resampled_for_tressfx(tmp_path):
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 0 1 0\nv 0 3 0\nv 1 0 0\nv 1 2 0\nl 1 2 3\nl 4 5\n")
    done = convert(tmp_path / "a.obj", tmp_path / "a.tfx")
    assert any("resampled to 4" in sentence for sentence in done["lost"])
    back = read_curves(tmp_path / "a.tfx")
    np.testing.assert_allclose(back.points[:, 1], [0, 1, 2, 3, 0, 2 / 3, 4 / 3, 2], atol=1e-6)


def tfx(version=4.0, strands=1, points=2, values=b""):
    return struct.pack("<f7I128s", version, strands, points, 160, 0, 0, 0, 0, b"") + values


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "too few for a .tfx file"),
        (tfx(version=3.0), "version 4"),
        (tfx(strands=0), "holds 0 strands"),
        (tfx(strands=2**31, points=2**31), "too few for"),
        (tfx(values=struct.pack("<8f", *[np.nan] * 8)), "must be finite"),
        (tfx(values=bytes(32)), "length 0"),
    ],
)
def test_broken_tressfx_files_are_refused(tmp_path, content, says):
    (tmp_path / "a.tfx").write_bytes(content)
    with pytest.raises(UserError, match=says):
        read_curves(tmp_path / "a.tfx")


@needs_alembic
@pytest.mark.parametrize("content", [b"", b"text", b"Ogawa\xff\x00\x01" + bytes(40)])
def test_broken_archives_are_refused(tmp_path, content):
    (tmp_path / "a.abc").write_bytes(content)
    with pytest.raises(UserError, match=r"a\.abc: (is no Alembic archive|cannot be read as Alembic)"):
        read_curves(tmp_path / "a.abc")


def test_wrong_requests_are_refused_in_one_line_and_leave_nothing(hair, tmp_path):
    before = sorted(tmp_path.iterdir())
    for words, says in (
        ((hair, tmp_path / "a.fbx"), "must end in"),
        ((hair, tmp_path / "a.usdz"), "packages are not written"),
        ((hair, hair), "is an input of this command"),
        ((tmp_path / "none.usdc", tmp_path / "a.obj"), "there is no such file"),
        ((hair, tmp_path / "a.usdc", "--from-unit", "mm"), "stores its unit"),
        ((hair, tmp_path / "a.usdc", "--frames", "7:9"), "no frame from 7 to 9; it holds 1 to 3"),
        ((hair, tmp_path / "a.usdc", "--frames", "1:2", "--frame", "1"), "leave one of them out"),
        ((tmp_path / "head.usdc", tmp_path / "a.obj"), "no curves to write"),
        ((tmp_path / "head.usdc", tmp_path / "a.usdc", "--only", "hairs"), "has no hairs"),
    ):
        refused(run("convert", *words), says)
    assert sorted(tmp_path.iterdir()) == before


def test_a_missing_library_is_named(hair, tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "alembic3d", None)
    with pytest.raises(UserError, match=r"pip install 'ringlet\[alembic\]'"):
        convert(hair, tmp_path / "a.abc")
    assert not (tmp_path / "a.abc").exists()


@needs_alembic
def test_the_round_trip_table_is_what_is_measured():
    pytest.importorskip("tinyobjloader")
    root = Path(__file__).parents[2]
    command = [sys.executable, root / "tools/proof/round_trip.py"]
    printed = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True).stdout
    assert printed.strip() in (root / "docs/convert.md").read_text()


def test_strands_of_tressfx_have_a_number_of_points_that_it_takes(hair, tmp_path):
    for points, count in ((None, 8), (16, 16), (20, 32), (300, 64)):
        done = convert(hair, tmp_path / "a.tfx", points=points)
        reported = any(f"all were resampled to {count}" in sentence for sentence in done["lost"])
        assert set(read_curves(tmp_path / "a.tfx").counts) == {count} and reported == (points != 16)
