"""Layers for comp: mattes of locks, grooms and bodies, motion, and light by light."""

from __future__ import annotations

import json
import struct
from dataclasses import replace

import numpy as np
import pytest
from ringlet.data.camera import Camera
from ringlet.data.groom import GROOM
from ringlet.picture import Pose
from ringlet.picture.cryptomatte import NOTHING, float_id, matte, murmur3
from ringlet.picture.still import still, take
from ringlet.picture.tone import develop
from test_picture_layers import AHEAD, QUICK, bars, board, read

from ringlet import UserError


def header(path) -> dict[str, str]:
    """Texts in the header of an EXR, read by its specification."""
    content, at, found = path.read_bytes(), 8, {}
    while content[at]:
        end = content.index(0, at)
        ends = content.index(0, end + 1)
        (size,) = struct.unpack_from("<i", content, ends + 1)
        value = content[ends + 5 : ends + 5 + size]
        if content[end + 1 : ends] == b"string":
            found[content[at:end].decode()] = value.decode()
        at = ends + 5 + size
    return found


def crypto(path, name):
    """Manifest of a matte, and for each thing its coverage, shape (height, width), as a compositor finds them."""
    texts, channels = header(path), read(path)
    (key,) = {text.rsplit("/", 1)[0] for text, value in texts.items() if value == name and text.endswith("/name")}
    assert key == f"cryptomatte/{murmur3(name):08x}"[:19]
    assert (texts[f"{key}/hash"], texts[f"{key}/conversion"]) == ("MurmurHash3_32", "uint32_to_float32")
    covered = {}
    for thing, bits in json.loads(texts[f"{key}/manifest"]).items():
        own = np.uint32(int(bits, 16)).view(np.float32)
        covered[thing] = sum(
            np.where(channels[f"{name}{layer:02d}.{id}"] == own, channels[f"{name}{layer:02d}.{part}"], 0.0)
            for layer in range(3)
            for id, part in ("RG", "BA")
        )
    return covered


@pytest.mark.parametrize(("text", "hashed"), [("", 0), ("hello", 0x248BFA47), ("hello, world", 0x149BBB7F)])
def test_hashes_are_those_that_are_published(text, hashed):
    assert murmur3(text) == hashed


def test_ids_are_usable_floats():
    ids = np.array([float_id(f"lock_{k}") for k in range(20000)])
    assert np.isfinite(ids).all() and (np.abs(ids) >= np.finfo(np.float32).tiny).all()
    bits = {k: murmur3(f"lock_{k}") for k in range(20000)}
    odd = [k for k, hashed in bits.items() if hashed >> 23 & 255 in (0, 255)]
    assert odd and all(int(ids[k].view(np.uint32)) == bits[k] ^ 1 << 23 for k in odd)


def test_what_covers_most_comes_first():
    seen = np.array([[[5, NOTHING]], [[2, NOTHING]], [[2, 7]], [[NOTHING, NOTHING]]], np.int32)
    made = matte("a", [str(k) for k in range(8)], seen)
    assert made.rank[0, 0].tolist() == [2, 5] + 4 * [NOTHING] and made.coverage[0, 0].tolist() == [
        0.5,
        0.25,
        0,
        0,
        0,
        0,
    ]
    assert made.rank[0, 1, 0] == 7 and made.coverage[0, 1].sum() == 0.25


def test_a_compositor_finds_locks_grooms_and_bodies_by_their_names(tmp_path):
    hairs = bars((-0.0615, 0.0), (0.06, 0.05), locks=(7, 3))
    hairs.curve |= {"guide_id": np.array([70, 30]), GROOM: np.array([0, 1], np.int32)}
    path = still(Pose([board(z=-0.1)], hairs, AHEAD, ["hair", "brows"]), tmp_path / "a.exr", QUICK)
    locks, things = crypto(path, "CryptoLock"), crypto(path, "CryptoObject")
    assert set(locks) == {"lock_70", "lock_30"} and set(things) == {"hair", "brows", "board"}
    left, right, middle = (20, 7), (20, 32), (20, 20)
    assert locks["lock_70"][left] == things["hair"][left] == 1.0 and locks["lock_30"][right] == 1.0
    assert things["brows"][right] == 1.0 and things["board"][middle] == 1.0 and locks["lock_70"][middle] == 0.0
    every = sum(things.values())
    assert np.abs(every - np.clip(read(path)["A"], 0, 1)).mean() < 0.02  # what is covered
    edge = locks["lock_70"][20]
    assert ((edge > 0) & (edge < 1)).any()  # smooth at its edge


def test_motion_is_in_pixels_until_the_next_frame(tmp_path):
    """1 cm in a picture of 40 pixels that is 20 cm wide at 1 m is 2 pixels; at 0.9 m from the camera 2.22."""
    pose = Pose([board(z=0.1)], bars((-0.06, 0.0)), AHEAD)
    later = Pose([board(x=0.01, z=0.1)], bars((-0.06, 0.0)).with_points(pose.hairs.points + [0, -0.01, 0]), AHEAD)
    layers = read(still(pose, tmp_path / "a.exr", QUICK, later=later))
    assert [layers[f"forward.{k}"][20, 20] for k in "uv"] == pytest.approx([2.0 / 0.9, 0.0], abs=0.01)
    assert [layers[f"forward.{k}"][20, 7] for k in "uv"] == pytest.approx([0.0, -2.0], abs=0.02)
    assert layers["forward.u"][1, 1] == layers["forward.v"][1, 1] == 0.0
    still_exr = read(still(pose, tmp_path / "b.exr", QUICK))
    assert "forward.u" not in still_exr


def test_a_camera_that_moves_is_in_the_motion(tmp_path):
    pose = Pose([board()], bars((-0.06, 0.0)), AHEAD)
    moved = Camera(AHEAD.origin + [0.01, 0, 0], AHEAD.axes, AHEAD.distance, AHEAD.slopes)
    layers = read(still(pose, tmp_path / "a.exr", QUICK, later=replace(pose, camera=moved)))
    assert [layers[f"forward.{k}"][20, 20] for k in "uv"] == pytest.approx([-2.0, 0.0], abs=0.01)


def test_lights_add_up_to_the_picture(tmp_path):
    settings = replace(QUICK, light_layers=True, denoiser="none")
    pose = Pose([board(z=-0.1)], bars((-0.06, 0.0)), AHEAD)
    layers = read(still(pose, tmp_path / "a.exr", settings))
    names = ["ambient", "key", "fill", "rim_right", "rim_left"]
    for part in "RGB":
        np.testing.assert_allclose(sum(layers[f"{name}.{part}"] for name in names), layers[part], rtol=1e-5, atol=1e-6)
    assert layers["key.R"][20, 20] > layers["fill.R"][20, 20] > 0.0  # the board faces the camera
    assert layers["rim_left.R"][20, 20] < 0.2 * layers["key.R"][20, 20]  # from behind
    whole = take(pose, replace(settings, light_layers=False, samples=64)).image
    assert layers["R"].mean() == pytest.approx(whole[:, :, 0].mean(), rel=0.1)
    with pytest.raises(UserError, match="has no layers of lights"):
        still(pose, tmp_path / "a.png", settings)


CONFIG = "ocio://cg-config-v2.2.0_aces-v1.3_ocio-v2.4"


def test_a_configuration_of_ocio_shows_pictures_and_names_the_light_of_exr(tmp_path, monkeypatch):
    ocio = pytest.importorskip("PyOpenColorIO")
    pose, settings = Pose([board()], bars((-0.06, 0.0)), AHEAD), replace(QUICK, denoiser="none")
    plain = read(still(pose, tmp_path / "a.exr", settings))
    monkeypatch.setenv("OCIO", CONFIG)
    managed = read(still(pose, tmp_path / "b.exr", settings))
    config = ocio.Config.CreateFromBuiltinConfig(CONFIG.removeprefix("ocio://"))
    to_acescg = config.getProcessor("lin_rec709", "ACEScg").getDefaultCPUProcessor()
    pixel = [float(plain[part][20, 20]) for part in "RGB"]
    assert [managed[part][20, 20] for part in "RGB"] == pytest.approx(to_acescg.applyRGB(pixel), rel=1e-4)
    assert managed["A"][20, 20] == plain["A"][20, 20]
    gray = develop(np.full((8, 8, 3), 0.18))
    assert abs(gray.mean() - 255 * 0.356) < 1.0  # as the default view of the configuration shows middle gray
    monkeypatch.delenv("OCIO")
    assert abs(develop(np.full((8, 8, 3), 0.18)).mean() - gray.mean()) > 5.0
