"""Pictures of what settings do, in the references of recipes and shots."""

from __future__ import annotations

import xml.dom.minidom
from pathlib import Path

import numpy as np
import pytest

import ringlet

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def pictures(tmp_path_factory):
    patch = pytest.MonkeyPatch()
    patch.syspath_prepend(str(DOCS))
    import setting_pictures

    folder = tmp_path_factory.mktemp("settings")
    yield folder, setting_pictures.write_setting_pictures(ringlet.schema(), folder)
    patch.undo()


def sides(path: Path) -> list[list[np.ndarray]]:
    """The curves left and right in a picture, each from the left of its panel."""
    lines = xml.dom.minidom.parse(str(path)).getElementsByTagName("polyline")
    curves = [np.array([one.split(",") for one in line.getAttribute("points").split()], float) for line in lines]
    number = {line.parentNode: k for k, line in enumerate({line.parentNode: line for line in lines}.values())}
    panels: list[list[np.ndarray]] = [[] for _ in number]
    for line, curve in zip(lines, curves, strict=True):
        panels[number[line.parentNode]].append(curve - (116.0 * number[line.parentNode], 0.0))
    return panels


def test_settings_that_shape_hair_have_pictures(pictures):
    _, made = pictures
    wanted = {("Curl", "width"), ("Curl", "skips"), ("HairSettings", "root_radius"), ("Scraggle", "magnitude")}
    assert wanted <= set(made) and ("Curl", "preset") not in made and len(made) > 90
    styles = {"Braid", "Twist", "Cornrow", "Loc", "Knot", "Tie", "Edges", "Hairline", "Sections"}
    assert styles <= {table for table, _ in made}


def test_both_sides_of_every_picture_differ(pictures):
    folder, made = pictures
    for name in made.values():
        left, right = sides(folder / name)
        same = [a.shape for a in left] == [b.shape for b in right]
        assert not same or max(np.abs(a - b).max() for a, b in zip(left, right, strict=True)) > 1.0, name


def test_the_right_side_shows_the_larger_value(pictures):
    folder, made = pictures
    width = [np.mean([np.ptp(curve[:, 0]) for curve in side]) for side in sides(folder / made["Curl", "width"])]
    assert 2.2 < width[1] / width[0] < 2.8  # 2.5 times as wide
    reach = [
        np.mean([np.ptp(curve, axis=0).max() for curve in side]) for side in sides(folder / made["Length", "factor"])
    ]
    assert reach[1] > 1.5 * reach[0]


def test_stiffer_curls_hang_less_and_those_in_thicker_air_lag_behind_their_roots(pictures):
    folder, made = pictures
    hang = [np.mean([np.ptp(curve[:, 1]) for curve in side]) for side in sides(folder / made["Material", "bend_scale"])]
    assert hang[1] < hang[0] - 2.0
    lag = [np.mean([curve[0, 0] - curve[-1, 0] for curve in side]) for side in sides(folder / made["Material", "drag"])]
    assert lag[1] > lag[0] + 2.0
