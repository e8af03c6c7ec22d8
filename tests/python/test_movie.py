"""Movies and turntables: frames, resumed runs, cameras, and the video."""

from __future__ import annotations

import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from commands import refused, run
from PIL import Image
from pxr import Usd, UsdGeom
from ringlet.data.curves import Curves
from ringlet.data.picture import PictureSettings
from ringlet.picture import Pose, movie, still_standpoint, turned_standpoints

import ringlet

TINY = ["--width", 16, "--height", 16, "--samples", 1]


@pytest.fixture
def stage(tmp_path) -> Path:
    """A hair that goes to the right, over frames 1 to 3."""
    path = tmp_path / "in" / "hair.usda"
    path.parent.mkdir()
    made = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(made, 1.0)
    made.SetTimeCodesPerSecond(12)
    curves = UsdGeom.BasisCurves.Define(made, "/hair")
    curves.CreateTypeAttr("linear")
    curves.CreateCurveVertexCountsAttr([3])
    curves.CreateWidthsAttr([0.02])
    curves.SetWidthsInterpolation("constant")
    for frame in (1, 2, 3):
        x = 0.05 * frame
        curves.CreatePointsAttr().Set([(x, -0.05, 0), (x, 0, 0), (x, 0.05, 0)], frame)
    made.Save()
    return path


@pytest.fixture
def encoder(monkeypatch) -> list:
    """An encoder that keeps what it is given."""
    given: list = []

    def write_frames(path, size, **options):
        Path(path).write_bytes(b"video")
        given.append((size, options["fps"]))
        while True:
            given.append((yield).shape)

    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", SimpleNamespace(write_frames=write_frames, __spec__=object()))
    return given


def times(folder: Path) -> dict[str, int]:
    """When each file of a folder was written."""
    return {file.name: file.stat().st_mtime_ns for file in sorted(folder.iterdir())}


def test_a_movie_has_every_frame_seen_by_one_camera(stage, tmp_path):
    assert (
        run("movie", stage, "-o", tmp_path / "out", "--view", "front", *TINY, "--background", "transparent").exit_code
        == 0
    )
    frames = [np.asarray(Image.open(tmp_path / f"out/{number:04d}.png"), float)[:, :, 3] for number in (1, 2, 3)]
    centres = [(alpha * np.arange(16)).sum() / alpha.sum() for alpha in frames]
    assert 0 < centres[0] < centres[1] - 2 < centres[2] - 4 < 11
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == ["0001.png", "0002.png", "0003.png"]


def test_frames_of_the_same_inputs_and_settings_are_kept(stage, tmp_path):
    out, command = tmp_path / "out", ["movie", stage, "-o", tmp_path / "out", *TINY]
    run(*command, "--frames", "1:3")
    before = times(out)
    (out / "0002.png").unlink()  # as if the run had been interrupted
    made = ringlet.write_movie(stage, out, width=16, height=16, samples=1)
    assert made.rendered == 1 and len(made.frames) == 3 and made.video is None
    after = times(out)
    assert after["0001.png"] == before["0001.png"] and after["0003.png"] == before["0003.png"]
    assert ringlet.write_movie(stage, out, width=16, height=16, samples=2).rendered == 3  # other settings
    edited = Usd.Stage.Open(str(stage))
    points = UsdGeom.BasisCurves(edited.GetPrimAtPath("/hair")).GetPointsAttr()
    points.Set([(0.1, -0.05, 0), (0.11, 0, 0), (0.1, 0.05, 0)], 2)  # within the frame of the others
    edited.Save()
    assert ringlet.write_movie(stage, out, width=16, height=16, samples=2).rendered == 1  # only what has changed


def test_a_video_is_encoded_at_the_rate_of_the_stage(stage, tmp_path, encoder):
    size = ["--width", 17, "--height", 18, "--samples", 1]  # an encoder takes even sizes only
    assert run("movie", stage, "-o", tmp_path / "a.mp4", *size).exit_code == 0
    assert encoder == [((16, 18), 12.0), *[(18, 16, 3)] * 3]
    assert (tmp_path / "a.mp4").read_bytes() == b"video"
    assert len(times(tmp_path / "a.frames")) == 3


def test_without_an_encoder_there_are_frames_and_a_line(stage, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    result = run("movie", stage, "-o", tmp_path / "a.mp4", *TINY)
    assert result.exit_code == 0
    assert "pip install 'ringlet[movie]'" in result.stdout
    assert len(times(tmp_path / "a.frames")) == 3 and not (tmp_path / "a.mp4").exists()


def test_a_turntable_goes_around_counter_clockwise(stage, tmp_path):
    assert run("turntable", stage, "-o", tmp_path / "out", "--views", 3, *TINY).exit_code == 0
    assert len(times(tmp_path / "out")) == 3
    cloud = np.random.default_rng(0).normal(size=(60, 3)) * [0.05, 0.1, 0.1] + [1.0, 2.0, 3.0]
    hairs = Curves.from_list(list(cloud.reshape(20, 3, 3)))
    views = turned_standpoints(Pose([], hairs), PictureSettings(view="front", width=90, height=100), 4)
    assert [np.round(v.camera.axes[2][[0, 2]]).tolist() for v in views] == [[0, 1], [1, 0], [0, -1], [-1, 0]]
    for view in views:
        seen = view.camera.project(hairs.points)
        assert seen.min() > 0.0 and seen.max() < 1.0
        assert view.camera.distance == pytest.approx(views[0].camera.distance)
        assert view.rig.axes == pytest.approx(view.camera.axes)


def test_a_close_up_of_a_clip_follows_no_single_frame():
    locks = [np.array([[x, 0.0, 0.0], [x, 0.1, 0.0]]) for x in (0.0, 0.2)]
    poses = [(Pose([], Curves.from_list([lock, lock + [0.0, 0.0, -1.0]])), lock) for lock in locks]
    camera = still_standpoint(poses, PictureSettings(view="front")).camera
    seen = camera.project(np.concatenate(locks))
    assert seen.min() > 0.0 and seen.max() < 1.0 and np.ptp(seen[:, 0]) > 0.8


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["movie", "STAGE", "-o", "a.avi"], ["a.avi", ".mp4 or .mov"]),
        (["movie", "STAGE", "-o", "a.mp4", "--background", "transparent"], ["a.mp4", "cannot be transparent"]),
        (["movie", "STAGE", "-o", "a", "--frames", "7:9"], ["has no frame from 7 to 9"]),
        (["movie", "STAGE", "-o", "STAGE"], ["must end in .mp4"]),
        (["turntable", "STAGE", "-o", "a", "--camera", "/cam"], ["--camera has no effect", "leave it out"]),
        (["turntable", "STAGE", "-o", "a", "--views", "0"], ["--views: is '0'", "at least 1"]),
        (["turntable", "STAGE", "-o", "a", "--color", "green"], ["green", "dark_brown"]),
    ],
)
def test_movies_that_cannot_be_made_are_refused(stage, tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    refused(run(*[stage if argument == "STAGE" else argument for argument in arguments], *TINY[:2]), *words)
    assert [file.name for file in tmp_path.iterdir()] == ["in"]


def test_foreign_pictures_are_not_replaced(stage, tmp_path):
    (tmp_path / "out").mkdir()
    Image.new("RGB", (4, 4)).save(tmp_path / "out/0001.png")
    before = (tmp_path / "out/0001.png").read_bytes()
    refused(run("movie", stage, "-o", tmp_path / "out", *TINY), "0001.png", "no frame that Ringlet made")
    assert (tmp_path / "out/0001.png").read_bytes() == before


def test_a_movie_is_real_video_where_the_encoder_is_installed(stage, tmp_path):
    encoder = pytest.importorskip("imageio_ffmpeg")
    assert movie.can_encode()
    made = ringlet.write_movie(stage, tmp_path / "a.mp4", width=32, height=32, samples=1)
    reader = encoder.read_frames(str(made.video))
    about = next(reader)
    assert about["size"] == (32, 32) and about["fps"] == pytest.approx(12.0) and len(list(reader)) == 3
