"""HDRIs as lights of the review: what the live picture makes of them, and renders in their light."""

from __future__ import annotations

import io
from pathlib import Path

import mitsuba
import numpy as np
import pytest
from pages import page, serving
from PIL import Image
from ringlet.picture import rigs
from ringlet.viewer.project import Project
from ringlet.viewer.protocol import Lamp
from ringlet.viewer.show.lights import live_rigs_of
from ringlet.viewer.show.surroundings import lamps_and_sky

HEIGHT, WIDTH = 128, 256


def directions() -> np.ndarray:
    """Directions of the texels of a picture in latitude and longitude, its middle at +Z; shape (height, width, 3)."""
    polar = np.pi * (np.arange(HEIGHT)[:, None] + 0.5) / HEIGHT
    azimuth = 2.0 * np.pi * (0.5 - (np.arange(WIDTH) + 0.5) / WIDTH)
    up = np.cos(polar) + 0.0 * azimuth
    return np.stack([np.sin(polar) * np.sin(azimuth), up, np.sin(polar) * np.cos(azimuth)], axis=2)


def lobe(towards: tuple[float, float, float], color: tuple[float, float, float], sharpness: float) -> np.ndarray:
    cosine = directions() @ (np.array(towards) / np.linalg.norm(towards))
    return np.exp(sharpness * (cosine - 1.0))[:, :, None] * np.array(color)


def disk(towards: tuple[float, float, float], radius: float) -> np.ndarray:
    cosine = directions() @ (np.array(towards) / np.linalg.norm(towards))
    return (cosine > np.cos(np.arctan(radius)))[:, :, None] * np.ones(3)


def direction(lamp: Lamp) -> np.ndarray:
    a, e = np.radians([lamp.azimuth, lamp.elevation])
    return np.array([np.sin(a) * np.cos(e), np.sin(e), np.cos(a) * np.cos(e)])


def write(path: Path, radiance: np.ndarray) -> Path:
    mitsuba.set_variant("scalar_rgb")
    path.parent.mkdir(exist_ok=True)
    mitsuba.Bitmap(np.asarray(radiance, np.float32)).write(str(path))
    return path


def test_a_disk_in_even_light_is_a_lamp_of_its_direction_size_and_irradiance():
    towards, radius, radiance = (0.5, 0.6, 0.3), 0.3, 7.0
    (lamp,), sky = lamps_and_sky(0.2 + radiance * disk(towards, radius))
    assert direction(lamp) @ np.array(towards) / np.linalg.norm(towards) > np.cos(np.radians(0.5))
    assert lamp.size == pytest.approx(2.0 * radius, rel=0.05)
    sine = np.sin(np.arctan(radius))
    assert lamp.strength[0] == pytest.approx(np.pi * sine**2 * radiance, rel=0.03)
    assert sky == pytest.approx((0.2, 0.2, 0.2), rel=1e-6)


def test_even_light_has_no_lamps():
    lamps, sky = lamps_and_sky(np.broadcast_to([0.2, 0.3, 0.4], (HEIGHT, WIDTH, 3)))
    assert not lamps and sky == pytest.approx((0.2, 0.3, 0.4))


@pytest.mark.parametrize(
    "radiance",
    [
        0.2 + lobe((0, 1, 0), (0.3, 0.4, 0.6), 1.5) + lobe((0.5, 0.6, 0.6), (300.0, 270.0, 210.0), 2000.0),
        0.1 + lobe((1, 0.1, 0.2), (8.0, 8.0, 9.0), 30.0) + lobe((-0.3, 0.2, 1), (3.0, 2.4, 1.8), 20.0),
    ],
    ids=["sun and sky", "two windows"],
)
def test_plates_have_the_light_of_the_surroundings(radiance: np.ndarray):
    lamps, sky = lamps_and_sky(radiance)
    polar = np.pi * (np.arange(HEIGHT) + 0.5) / HEIGHT
    angles = (2.0 * np.pi**2 / (HEIGHT * WIDTH) * np.sin(polar))[:, None]
    ours, theirs = [], []
    for normal in np.vstack([np.eye(3), -np.eye(3)]):
        theirs.append(((np.maximum(directions() @ normal, 0.0) * angles)[:, :, None] * radiance).sum(axis=(0, 1)))
        lit = [np.array(lamp.strength) * max(direction(lamp) @ normal, 0.0) for lamp in lamps]
        ours.append(np.pi * np.array(sky) + sum(lit))
    assert np.array(ours) == pytest.approx(np.array(theirs), abs=0.1 * np.max(theirs))


def test_a_lamp_stands_where_the_path_tracer_has_the_light(tmp_path: Path):
    file = write(tmp_path / "lamp.exr", 0.1 + 50.0 * disk((0.7, 0.3, 0.2), 0.1))
    (lamp,), _ = lamps_and_sky(rigs.read_surroundings(file))
    light = mitsuba.load_dict(rigs._surroundings(mitsuba, file, 0.0)["surroundings"])

    def radiance(towards: np.ndarray) -> float:
        seen = mitsuba.SurfaceInteraction3f()
        seen.wi = mitsuba.Vector3f(*(float(-x) for x in towards))
        return float(np.mean(light.eval(seen)))

    assert radiance(direction(lamp)) > 50.0 * radiance(direction(lamp) * [-1.0, 1.0, 1.0])


def test_hdris_of_the_project_are_lights_and_pictures_of_other_shapes_are_not(tmp_path: Path):
    write(tmp_path / "lights" / "red_room.hdr", 0.1 + 5.0 * disk((0.0, 0.0, 1.0), 0.3))
    write(tmp_path / "render.exr", np.ones((8, 8, 3)))
    (tmp_path / "torn.exr").write_bytes(b"light")
    found, (wrong,) = live_rigs_of(Project(tmp_path))
    assert list(found) == ["studio", "window", "sun", "lights/red_room.hdr"]
    assert found["lights/red_room.hdr"].label == "red room"
    assert "torn.exr: cannot be read as a picture" in wrong


def test_a_render_has_the_light_of_an_hdri_and_none_from_outside_of_the_project(folder: Path):
    write(folder / "red.exr", np.broadcast_to([1.0, 0.02, 0.02], (16, 32, 3)))
    with serving(folder) as client, page(client) as one:
        one.receive("locks")
        camera = [0.0, 0.1, 0.9, 0.0, 0.0, 0.0]
        request = {"kind": "render", "number": 1, "camera": camera, "width": 48, "height": 48, "samples": 4}
        one.send(**request, light="red.exr")
        done = one.receive("rendered", samples=4)
        middle = np.asarray(Image.open(io.BytesIO(done["png"].tobytes())), float)[16:32, 16:32].mean(axis=(0, 1))
        assert middle[0] > 3.0 * middle[1]
        one.send(**request, light="../red.exr")
        assert "outside of the project" in one.receive("trouble")["message"]
        one.send(**request, light="candle")
        assert "there is no light" in one.receive("trouble")["message"]
