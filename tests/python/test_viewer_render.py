"""Renders in place: path-traced pictures for a page of the review."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pages import page, serving
from PIL import Image
from ringlet.picture.camera import frame
from ringlet.viewer.protocol import Render
from ringlet.viewer.show.display_groom import DisplayGroom
from ringlet.viewer.show.rendering import camera_of, poses_of

from ringlet import build_groom
from ringlet.groom import lay_hairs


def request(**more: object) -> dict:
    return {
        "kind": "render",
        "number": 1,
        "camera": [0.0, 0.1, 0.9, 0.0, 0.0, 0.0],
        "width": 64,
        "height": 48,
        "samples": 4,
        **more,
    }


def test_the_camera_of_a_page_is_that_of_a_portrait():
    portrait = frame([np.random.default_rng(1).normal(0.0, 0.1, (50, 3))], aspect=0.9)
    origin = np.array([1.0, 2.0, 3.0])
    message = Render(number=1, camera=[*(portrait.origin - origin), *(portrait.target - origin)], width=90, height=100)
    camera = camera_of(message, origin)
    assert np.allclose(camera.origin, portrait.origin) and np.allclose(camera.axes, portrait.axes)
    assert camera.distance == pytest.approx(portrait.distance) and camera.slopes == pytest.approx(portrait.slopes)


@pytest.mark.parametrize("adopted", [False, True])
def test_the_first_picture_has_few_hairs_that_stand_for_all(folder: Path, adopted: bool):
    groom = build_groom(folder / "small.recipe.toml")
    hairs = lay_hairs(groom)
    groom.locks = replace(groom.locks, point={**groom.locks.point, "width": np.full(len(groom.locks.points), 1e-4)})
    few, whole = (pose.hairs for pose in poses_of(DisplayGroom(groom, None if adopted else hairs, False), []))
    assert len(whole) == len(groom.locks if adopted else hairs.curves) and 0 < len(few) <= 0.5 * len(whole)
    widths = [(hairs.point["width"][hairs.offsets[:-1] + 1]).sum() for hairs in (few, whole)]
    assert widths[0] == pytest.approx(widths[1], rel=0.2)


def test_a_render_grows_to_the_samples_that_were_asked_for(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.receive("locks")
        one.send(**request())
        done = one.receive("rendered", samples=4)
        picture = np.asarray(Image.open(io.BytesIO(done["png"].tobytes())), float)
        assert (done["number"], done["of"], picture.shape) == (1, 4, (48, 64, 3))
        assert picture[20:28, 28:36].mean() > 1.3 * picture[:, 0].mean(), "the head is lit before a darker edge"


def test_another_render_ends_the_one_before_and_a_faulty_one_has_its_reason(folder: Path):
    with serving(folder) as client, page(client) as one:
        one.receive("locks")
        one.send(**request(samples=1000, width=512, height=512))
        one.send(**request(number=2, samples=1))
        assert one.receive("rendered")["number"] == 2
        one.send(**request(camera=[0.0] * 6))
        assert "move it" in one.receive("trouble")["message"]
