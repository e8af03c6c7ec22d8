"""EXR pictures with layers, motion blur, and the denoisers."""

from __future__ import annotations

import sys
from dataclasses import replace

import mitsuba
import numpy as np
import pytest
from commands import refused, run
from pxr import Usd, UsdGeom
from ringlet.data.camera import Camera
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.mesh import Mesh
from ringlet.data.picture import PictureSettings
from ringlet.picture import Pose, PosedBody, engine
from ringlet.picture.engine import OLDEST_LLVM, llvm_version
from ringlet.picture.still import still, take

QUICK = PictureSettings(width=40, height=40, samples=4)
AHEAD = Camera(np.array([0.0, 0.0, 1.0]), np.eye(3), 1.0, (0.1, 0.1))  # sees 20 cm at the origin


def board(x: float = 0.0, z: float = 0.0, half: float = 0.05) -> PosedBody:
    """A square that faces the camera, at a place [m]."""
    points = half * np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) + [x, 0.0, z]
    color = (0.7, 0.3, 0.1)
    return PosedBody(Mesh("board", points, np.array([[0, 1, 2], [0, 2, 3]], np.int32), color=color), points)


def bars(*places: tuple[float, float], locks: tuple[int, ...] = ()) -> Curves:
    """Upright hairs, 1 cm thick, at places x and z [m]."""
    hairs = Curves.from_list([np.array([[x, -0.05, z], [x, 0.0, z], [x, 0.05, z]]) for x, z in places])
    hairs.point["width"] = np.full(len(hairs.points), 0.01)
    if locks:
        hairs.curve["lock"] = np.array(locks, np.int32)
    return hairs


def read(path) -> dict[str, np.ndarray]:
    """Channels of an EXR by name."""
    mitsuba.set_variant("scalar_rgb")
    bitmap = mitsuba.Bitmap(str(path))
    pixels, layout = np.array(bitmap), bitmap.struct_()
    return {layout[k].name: pixels[:, :, k] for k in range(len(layout))}


# EXR


def test_an_exr_has_light_and_layers(tmp_path):
    pose = Pose([board(z=-0.1)], bars((-0.06, 0.0), (0.06, 0.05), locks=(7, 3)), AHEAD)
    layers = read(still(pose, tmp_path / "a.exr", QUICK))
    own = {"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "albedo.R", "albedo.G", "albedo.B", "lock"}
    assert {name for name in layers if not name.startswith("Crypto")} == own
    middle, left, right, corner = (20, 20), (20, 8), (20, 32), (1, 1)
    assert layers["A"][middle] == pytest.approx(1.0) and layers["A"][corner] == 0.0
    assert layers["R"][middle] > 3 * layers["B"][middle] > 0.0  # linear and without a backdrop
    assert layers["R"][corner] == layers["Z"][corner] == layers["N.Z"][corner] == 0.0
    assert layers["Z"][middle] == pytest.approx(1.1, abs=1e-4)  # along the optical axis, not along the ray
    assert layers["Z"][left] == pytest.approx(1.0, abs=0.006) and layers["Z"][right] == pytest.approx(0.95, abs=0.006)
    assert [layers[f"N.{a}"][middle] for a in "XYZ"] == pytest.approx([0.0, 0.0, 1.0], abs=1e-3)
    assert [layers[f"albedo.{c}"][middle] for c in "RGB"] == pytest.approx([0.7, 0.3, 0.1], abs=1e-3)
    assert [layers["lock"][place] for place in (middle, left, right, corner)] == [-1, 7, 3, -1]
    assert layers["albedo.R"][left] < 0.2  # dark brown hair


def test_hairs_without_locks_have_their_own_rows(tmp_path):
    layers = read(still(Pose([], bars((-0.06, 0.0), (0.06, 0.0)), AHEAD), tmp_path / "a.exr", QUICK))
    assert (layers["lock"][20, 8], layers["lock"][20, 32]) == (0, 1)


def test_lights_are_not_in_the_layers():
    """A wide lens from the front sees the rim lights behind the head."""
    wide = Camera(np.array([0.0, 0.0, 1.0]), np.eye(3), 1.0, (1.0, 1.0))
    taken = take(Pose([board()], Curves.from_list([]), wide), QUICK, layers=True)
    assert taken.layers is not None
    assert not taken.layers.depth[taken.image[:, :, 3] < 1e-6].any()


def test_light_hair_has_a_higher_albedo_than_dark_hair():
    albedo = {}
    for color in ("black", "dark_brown", "blond"):
        layers = take(Pose([], bars((0.0, 0.0)), AHEAD), replace(QUICK, color=color), layers=True).layers
        assert layers is not None
        albedo[color] = layers.albedo[20, 20]
    assert (albedo["black"] < albedo["dark_brown"]).all() and (albedo["dark_brown"] < albedo["blond"]).all()


# Motion blur


def test_a_moving_hair_covers_its_path_evenly():
    """A hair of 1 cm that moves by 8 cm covers an eighth of the time each pixel of its path."""
    opening, closing = (Pose([], bars((x, 0.0)), AHEAD) for x in (-0.04, 0.04))
    settings = replace(QUICK, samples=64, bounces=1, denoiser="none")
    row = take(opening, settings, closing=closing).image[16:24, :, 3].mean(axis=0)
    still_row = take(opening, settings).image[16:24, :, 3].mean(axis=0)
    assert row.sum() == pytest.approx(still_row.sum(), rel=0.05)
    assert row[13:27] == pytest.approx(0.125, abs=0.07)
    assert row[:9].max() < 0.02 and row[31:].max() < 0.02
    assert still_row[12] > 0.8


def test_a_camera_that_moves_blurs_what_stands():
    moved = replace(AHEAD, origin=AHEAD.origin + [0.08, 0.0, 0.0])
    hairs, settings = bars((0.0, 0.0)), replace(QUICK, samples=32, bounces=1, denoiser="none")
    row = take(Pose([], hairs, AHEAD), settings, closing=Pose([], hairs, moved)).image[20, :, 3]
    assert 0.0 < row[8:18].max() < 0.4 and row[24:].max() < 0.02  # the hair goes to the left


@pytest.fixture
def moving(tmp_path):
    """A hair that moves by 4 cm from frame 1 to 2 and stands until 3, under a camera."""
    path = tmp_path / "in" / "hair.usda"
    path.parent.mkdir()
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, "Y")
    curves = UsdGeom.BasisCurves.Define(stage, "/hair")
    curves.CreateTypeAttr("linear")
    curves.CreateCurveVertexCountsAttr([3])
    curves.CreateWidthsAttr([0.01])
    curves.SetWidthsInterpolation("constant")
    for frame, x in ((1, 0.0), (2, 0.04), (3, 0.04)):
        curves.CreatePointsAttr().Set([(x, -0.05, 0), (x, 0, 0), (x, 0.05, 0)], frame)
    camera = UsdGeom.Camera.Define(stage, "/camera")
    camera.AddTranslateOp().Set((0.0, 0.0, 1.0))
    camera.CreateFocalLengthAttr(180.0)
    camera.CreateHorizontalApertureAttr(36.0)
    camera.CreateVerticalApertureAttr(36.0)
    stage.Save()
    return path


@pytest.mark.parametrize(("frame", "shutter", "least", "most"), [(1, 180, 0, 0.02), (1, 0, 0, 0), (3, 180, 0.04, 0.04)])
def test_the_shutter_opens_at_the_frame(moving, tmp_path, frame, shutter, least, most):
    command = ["picture", moving, "-o", tmp_path / "a.exr", "--camera", "/camera", "--width", 40, "--samples", 16]
    assert run(*command, "--frame", frame, "--shutter", shutter).exit_code == 0
    columns = np.flatnonzero(read(tmp_path / "a.exr")["A"][20] > 0.05)
    assert columns.min() == pytest.approx(20 + 200 * (least - 0.005), abs=1.5)
    assert columns.max() == pytest.approx(19 + 200 * (most + 0.005), abs=1.5)


def test_what_does_not_move_has_no_motion_blur(pipeline, tmp_path):
    assert run("hair", pipeline / "groom.usdc", "-o", tmp_path / "still.usdc").exit_code == 0
    refused(run("picture", tmp_path / "still.usdc", "-o", tmp_path / "a.png", "--shutter", 90), "nothing moves")


# Denoisers


def test_a_denoiser_that_is_not_installed_is_refused(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "pyoidn", None)
    with pytest.raises(UserError, match="pyoidn; install it"):
        still(Pose([board()], Curves.from_list([])), tmp_path / "a.png", replace(QUICK, denoiser="oidn"))


def test_without_a_denoiser_the_noise_stays():
    pytest.importorskip("pyoidn")
    pose, noise = Pose([board()], Curves.from_list([]), AHEAD), {}
    for name in ("none", "oidn"):
        noise[name] = take(pose, replace(QUICK, denoiser=name)).image[15:25, 15:25, 0].std()
    assert noise["none"] > 1.5 * noise["oidn"]


# Engines


@pytest.mark.skipif(llvm_version() < OLDEST_LLVM, reason="needs a library of LLVM")
def test_code_of_llvm_makes_the_same_picture():
    hairs = bars((-0.05, 0.0), (0.0, 0.02), (0.05, 0.0), locks=(2, 1, 0))
    settings = replace(QUICK, samples=64, denoiser="none")
    taken = {
        name: take(Pose([board(z=-0.1)], hairs, AHEAD), replace(settings, engine=name), layers=True)
        for name in ("scalar", "llvm")
    }
    light = {name: each.image for name, each in taken.items()}
    assert light["llvm"].mean(axis=(0, 1)) == pytest.approx(light["scalar"].mean(axis=(0, 1)), rel=0.03)
    assert np.abs(light["llvm"] - light["scalar"]).mean() < 0.1 * light["scalar"].mean()
    assert (taken["llvm"].layers.lock == taken["scalar"].layers.lock).mean() > 0.95


@pytest.mark.parametrize(("found", "said"), [(-1, "finds none"), (15, "finds version 15 of it")])
def test_llvm_that_is_missing_or_too_old_is_refused(monkeypatch, found, said):
    monkeypatch.setattr(engine, "llvm_version", lambda: found)
    with pytest.raises(UserError, match=f"needs LLVM 17 or newer, and Mitsuba {said}; install one"):
        take(Pose([board()], Curves.from_list([]), AHEAD), replace(QUICK, engine="llvm"))
    assert engine.mitsuba().variant() == "scalar_rgb"
