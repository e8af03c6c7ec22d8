"""Cameras of pictures: those of a stage, close-ups, depth of field, light rigs and transparent backgrounds."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import mitsuba
import numpy as np
import pytest
from commands import refused, run
from PIL import Image
from pxr import Gf, Usd, UsdGeom
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.data.picture import PictureSettings
from ringlet.picture import Pose, PosedBody
from ringlet.picture.camera import angles, frame, picture_size, take_position
from ringlet.picture.still import still, take

from ringlet import io

QUICK = PictureSettings(width=40, height=40, samples=4, view="front")


def board(z: float = 0.0, size: float = 0.1, name: str = "board") -> PosedBody:
    """A white square that faces the front, at a depth [m]."""
    points = 0.5 * size * np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) + [0.0, 0.0, z]
    return PosedBody(Mesh(name, points, np.array([[0, 1, 2], [0, 2, 3]], np.int32), color=(0.6, 0.6, 0.6)), points)


def ball(radius: float = 0.1, rings: int = 12) -> PosedBody:
    """A grey ball about the origin [m]."""
    polar, around = np.meshgrid(
        np.linspace(0.01, np.pi - 0.01, rings), np.linspace(0, 2 * np.pi, 2 * rings), indexing="ij"
    )
    points = radius * np.stack([np.sin(polar) * np.sin(around), np.cos(polar), np.sin(polar) * np.cos(around)], -1)
    k = np.arange(points[:-1, :-1, 0].size).reshape(rings - 1, -1)
    k = k + np.arange(rings - 1)[:, None]  # a row has one point more than it has squares
    a, b, c, d = (x.ravel() for x in (k, k + 2 * rings, k + 2 * rings + 1, k + 1))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]).astype(np.int32)
    return PosedBody(Mesh("ball", points.reshape(-1, 3), triangles), points.reshape(-1, 3))


NO_HAIR = Curves.from_list([])


def write_camera(path: Path, *, up: str = "Y", unit: float = 0.01, **values: float) -> Path:
    """A stage with a camera 1 m in front of the origin that moves 10 cm to the right from frame 1 to 2."""
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(stage, unit)
    UsdGeom.SetStageUpAxis(stage, up)
    camera = UsdGeom.Camera.Define(stage, "/shot/camera")
    for name, value in {"focalLength": 50.0, "horizontalAperture": 36.0, "verticalAperture": 24.0, **values}.items():
        camera.GetPrim().GetAttribute(name).Set(value)
    move = camera.AddTranslateOp()
    for time, x in ((1, 0.0), (2, 0.1)):
        move.Set(Gf.Vec3d(*((x, 0.2, 1.0) if up == "Y" else (x, -1.0, 0.2))) / unit, time)
    if up == "Z":
        camera.AddRotateXOp().Set(90.0)
    stage.Save()
    return path


@pytest.mark.parametrize(("up", "unit"), [("Y", 0.01), ("Y", 1.0), ("Z", 0.01)])
def test_a_camera_of_a_stage_is_read_with_its_lens(tmp_path, up, unit):
    path = write_camera(tmp_path / "c.usda", up=up, unit=unit, fStop=2.8, focusDistance=0.9 / unit)
    camera = io.read_camera(path, "/shot/camera", 2.0)
    assert camera.origin == pytest.approx([0.1, 0.2, 1.0])
    assert camera.axes == pytest.approx(np.eye(3), abs=1e-6)
    assert camera.slopes == pytest.approx((18 / 50, 12 / 50))
    assert camera.focus == pytest.approx(0.9)
    assert camera.lens_radius == pytest.approx(0.5 * 5.0 * unit / 2.8)  # 50 tenths of a unit
    assert io.read_camera(path, "/shot/camera").origin[0] == 0.0  # the first frame


def test_an_aperture_offset_moves_the_centre_of_the_picture(tmp_path):
    path = write_camera(tmp_path / "c.usda", horizontalApertureOffset=9.0, verticalApertureOffset=3.0)
    camera, usd = io.read_camera(path, "/shot/camera", 1.0), Usd.Stage.Open(str(path))
    frustum = UsdGeom.Camera(usd.GetPrimAtPath("/shot/camera")).GetCamera(1).frustum
    point = np.array([0.12, 0.15, 0.0])
    clip = frustum.ComputeViewMatrix() * frustum.ComputeProjectionMatrix()
    expected = np.array(clip.Transform(Gf.Vec3d(*(point / 0.01))))[:2]
    assert camera.project(point[None])[0] == pytest.approx([0.5 + 0.5 * expected[0], 0.5 - 0.5 * expected[1]], abs=1e-6)
    # the renderer has the same centre
    small = replace(QUICK, view=None, width=60, height=None, background="transparent")
    body = board(size=0.02)
    body.points = body.points + point
    seen = take(Pose([body], NO_HAIR, camera), small).image[:, :, 3] > 0.5
    rows, columns = np.nonzero(seen)
    middle = (columns.mean() + 0.5) / 60, (rows.mean() + 0.5) / seen.shape[0]
    assert middle == pytest.approx(camera.project(point[None])[0], abs=0.02)


def test_a_picture_has_the_proportions_of_the_camera(tmp_path):
    camera = io.read_camera(write_camera(tmp_path / "c.usda"), "/shot/camera")
    assert picture_size(PictureSettings(width=300), camera) == (300, 200)
    assert picture_size(PictureSettings(width=300, height=100), camera) == (300, 100)
    assert take_position(PictureSettings(width=300, height=100), [np.zeros((1, 3))], given=camera).slopes == (
        pytest.approx((0.36, 0.12))
    )
    assert picture_size(PictureSettings()) == (900, 1000)


def test_a_close_up_sees_the_lock_from_outside_of_the_head():
    lock = np.array([0.0, 0.1, -0.1]) + 0.01 * np.random.default_rng(0).normal(size=(50, 3))
    camera = take_position(PictureSettings(width=90, height=100), [ball().points], lock)
    assert camera.axes[2] @ [0.0, 0.707, -0.707] > 0.95
    seen = camera.project(lock)
    assert seen.min() > 0.04 and seen.max() < 0.96 and np.ptp(seen, axis=0).max() > 0.85
    near = take_position(PictureSettings(distance=0.3, focal_length=50, view="side"), [ball().points], lock)
    assert np.linalg.norm(near.origin - near.target) == pytest.approx(0.3)
    assert near.axes[2][0] > 0.9 and near.slopes[1] == pytest.approx(18 / 50)


def test_depth_of_field_blurs_what_is_out_of_focus():
    near, far = board(size=0.06), board(-0.5, size=0.06)
    far.points = far.points + [0.05, 0.0, 0.0]
    edges = {}
    for focus in (0.6, 1.1):
        settings = replace(QUICK, view=None, f_stop=1.0, focus=focus, samples=64, background="transparent")
        camera = replace(
            frame([near.points], view=(0.0, 0.0)), origin=np.array([0.025, 0, 0.6]), distance=0.6, slopes=(0.12, 0.12)
        )
        alpha = take(Pose([near, far], NO_HAIR, camera), settings).image[20, :, 3]
        edges[focus] = np.abs(np.diff(alpha[:16])).max()  # the left edge is that of the near board
    assert edges[0.6] > 2.0 * edges[1.1]


@pytest.mark.parametrize(
    ("light", "turn", "side"),
    [("window", 0, -1), ("window", 120, 1), ("sun", 0, -1), ("HDRI", 0, -1), ("HDRI", 180, 0)],
)
def test_a_rig_lights_the_ball_from_its_side(tmp_path, light, turn, side):
    if light == "HDRI":
        pixels = np.full((32, 64, 3), 0.05, np.float32)
        pixels[10:16, 40:44] = 50.0  # right of the middle: towards -X
        light = str(tmp_path / "room.exr")
        mitsuba.set_variant("scalar_rgb")
        mitsuba.Bitmap(pixels).write(light)
    image = take(Pose([ball()], NO_HAIR), replace(QUICK, light=light, light_turn=turn, samples=16)).image
    left, right = image[10:30, 8:16, :3].mean(), image[10:30, 24:32, :3].mean()
    if side:
        assert side * (right - left) > 0.3 * max(left, right)
    else:  # from behind
        assert max(left, right) < 0.3
    if light in ("window", "sun"):
        assert 0.1 < max(left, right) < 2.0


def test_a_transparent_picture_has_the_coverage_as_alpha(tmp_path):
    path = still(Pose([ball()], NO_HAIR), tmp_path / "a.png", replace(QUICK, background="transparent"))
    image = np.asarray(Image.open(path))
    assert image.shape == (40, 40, 4)
    assert image[20, 20, 3] == 255 and image[1, 1, 3] == 0
    assert image[20, 20, :3].mean() > 30


# Command line


@pytest.fixture
def stage(pipeline, tmp_path) -> Path:
    """Hairs of the small example under a camera and a box, in a folder of its own."""
    path = tmp_path / "in" / "shot.usda"
    path.parent.mkdir()
    write_camera(path, fStop=4.0)
    shot = Usd.Stage.Open(str(path))
    shot.GetRootLayer().subLayerPaths.append(str(pipeline / "hair.usdc"))
    flat = UsdGeom.Camera.Define(shot, "/shot/flat")
    flat.GetProjectionAttr().Set("orthographic")
    shot.Save()
    return path


def test_the_command_takes_a_camera_and_a_lock(stage, tmp_path):
    common = ["render", stage, "--width", 24, "--samples", 1, "-o", tmp_path / "a.png"]
    assert run(*common, "--camera", "/shot/camera", "--frame", 2).exit_code == 0
    assert Image.open(tmp_path / "a.png").size == (24, 16)
    lock = int(io.read_groom(stage).locks.ids[3])
    assert run(*common, "--look-at", lock, "--distance", 20, "--f-stop", 2.8, "--light", "window").exit_code == 0
    assert Image.open(tmp_path / "a.png").size == (24, 27)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--camera", "/shot/camra"], ["/shot/camra", "did you mean /shot/camera?"]),
        (["--camera", "/groom"], ["/groom", "not a camera", "/shot/camera"]),
        (["--camera", "/shot/flat"], ["/shot/flat", "orthographic", "perspective"]),
        (["--camera", "/shot/camera", "--view", "side"], ["view", "/shot/camera", "leave one out"]),
        (["--look-at", "17"], ["no lock 17", "nearest id"]),
        (["--view", "90,88"], ["90,88", "elevation 85"]),
        (["--view", "nan,0"], ["azimuth must be at most 360"]),
        (["--view", "below"], ["below", "three_quarter", "90,4"]),
        (["--light", "candle"], ["candle", "studio, window, sun"]),
        (["--light", "none.exr"], ["none.exr", "no such file"]),
        (["--background", "pink"], ["pink", "studio, transparent"]),
        (["--sheet", "--f-stop", "2"], ["--f-stop has no effect", "leave it out"]),
    ],
)
def test_wrong_settings_are_refused_by_name(stage, tmp_path, arguments, words):
    refused(run("render", stage, "-o", tmp_path / "a.png", *arguments), *words)
    assert [file.name for file in tmp_path.iterdir()] == ["in"]


def test_a_jpeg_is_not_transparent_and_an_hdri_must_have_light(stage, tmp_path):
    refused(run("render", stage, "-o", tmp_path / "a.jpg", "--background", "transparent"), "JPEG", ".png")
    broken, dark = tmp_path / "broken.exr", tmp_path / "dark.exr"
    broken.write_bytes(b"light")
    mitsuba.set_variant("scalar_rgb")
    mitsuba.Bitmap(np.zeros((4, 8, 3), np.float32)).write(str(dark))
    for light, word in ((broken, "cannot be read"), (dark, "none at all")):
        refused(run("render", stage, "-o", tmp_path / "a.png", "--width", 16, "--samples", 1, "--light", light), word)


def test_settings_of_the_library_are_named():
    with pytest.raises(UserError, match="did you mean 'samples'"):
        PictureSettings.of({"sample": 3})
    with pytest.raises(UserError, match="f_stop is -1"):
        PictureSettings(f_stop=-1.0)
    assert angles("90,4") == (90.0, 4.0)
