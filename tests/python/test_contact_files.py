"""Contacts in files and pictures: positions, forces and colours."""

import numpy as np
import pytest
from cloth_scene import LONG, garment, simulated
from commands import refused, run
from floor_scene import floor, groom, still
from pxr import Usd, UsdGeom
from ringlet.data.cache import Touches
from ringlet.shot import parse_shot
from ringlet.sim import Obstacle, simulate
from small_example import FRAMES
from wear import sim

import ringlet
from ringlet import io


@pytest.fixture(scope="module")
def touched(cloth_example):
    """Contacts of the example with its sheet on the locks."""
    result = sim(cloth_example, "small.shot.toml", "--contacts", cloth_example / "contacts.usdc")
    assert result.exit_code == 0, result.output
    return cloth_example / "contacts.usdc"


def test_contacts_are_written_as_points_in_valid_usd(touched):
    assert io.problems(touched) == []
    stage = Usd.Stage.Open(str(touched))
    points = UsdGeom.Points(stage.GetPrimAtPath("/groom/touches"))
    assert points.GetPointsAttr().GetTimeSamples() == [float(f) for f in range(1, FRAMES + 1)]
    counts = [0, *(frame["contact"]["contacts"] for frame in ringlet.read_cache(touched).statistics[1:])]
    assert max(counts) > 0
    for frame, count in enumerate(counts, 1):
        assert len(points.GetPointsAttr().Get(float(frame))) == count
    touches, colors = io.read_touches(touched, 4)
    assert touches.places.shape == colors.shape == (counts[3], 3)
    assert (touches.gap > 0).all() and (touches.gap < 1.001).all() and (touches.force >= 0).all()
    head = np.linalg.norm(touches.places - [0, 0, 0], axis=1)
    assert (head < 0.2).all()  # in metres, near the ball of 9 cm


def test_an_outlying_force_leaves_the_colours_of_the_others(touched):
    cache = ringlet.read_cache(touched)
    force = np.full(200, 1e-3, np.float32)
    force[:100], force[0] = 1e-4, 1e3
    touches = Touches(np.zeros((200, 3), np.float32), force, np.ones(200, np.float32))
    cache.touches = [touches for _ in cache.frames]
    ringlet.write_touches(cache, touched.with_name("cache.usdc"), touched.with_name("strong.usdc"))
    _, colors = io.read_touches(touched.with_name("strong.usdc"))
    assert np.allclose(colors[0], colors[-1])  # both red, though their ratio is 1e6
    assert colors[-1, 1] < 0.1 and colors[1, 1] > 0.5  # yellow, a decade below


def test_the_colour_map_goes_from_blue_to_red():
    colors = io.heat(np.array([0.0, 0.5, 1.0]))
    assert colors[0, 2] > colors[0, 0] and colors[2, 0] > colors[2, 2]


def test_contact_forces_support_the_weight_of_a_resting_sheet():
    assert simulated(garment(), text=LONG).touches == []  # contacts are recorded on request
    made = groom()
    obstacle = Obstacle(floor(), still(floor()))
    cache = simulate(parse_shot(LONG), made, still(floor()), obstacles=[obstacle], garments=[garment()], touches=True)
    last = cache.touches[-1]
    on_floor = last.places[:, 1] < 1e-3
    weight = 9.81 * 0.15 * 0.08**2
    assert 0.3 * weight < last.force[on_floor].sum() < 3 * weight


def test_a_picture_shows_contacts_and_initial_overlaps(touched, tmp_path):
    pictures = {}
    for what in ("force", "gap", "start"):
        path = tmp_path / f"{what}.png"
        small = ("--samples", 2, "--width", 180, "--height", 200)
        result = run("render", touched, "--contacts", what, "--frame", 4, "-o", path, *small)
        assert result.exit_code == 0, result.output
        pictures[what] = path.read_bytes()
    assert len(set(pictures.values())) == 3
    refused(run("render", touched, "--contacts", "forse", "-o", tmp_path / "a.png"), "forse", "did you mean 'force'?")
    refused(run("render", touched, "--contacts", "gap", "--frame", 40, "-o", tmp_path / "a.png"), "frame 40", "1 to 4")


def test_a_picture_of_contacts_makes_only_cloth_transparent(touched, tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(ringlet.picture, "still", lambda pose, *rest, **options: drawn.extend(pose.bodies))
    ringlet.write_touches_picture(touched, tmp_path / "a.png", frame=4)
    transparent = {body.mesh.name.split()[-1] for body in drawn if body.opacity < 1}
    assert transparent == {"/groom/cloths/wear/scarf"}
    assert len(drawn) > 2


def test_a_stage_without_contacts_is_refused(cloth_example, tmp_path):
    assert sim(cloth_example).exit_code == 0
    refused(
        run("render", cloth_example / "cache.usdc", "--contacts", "gap", "-o", tmp_path / "a.png"),
        "no contacts",
        "--contacts",
    )


def test_beads_are_round_and_face_outwards():
    from ringlet.picture import beads

    made = beads(np.array([[0.0, 0, 0], [1, 2, 3]]), np.array([[1.0, 0, 0], [0, 1, 0]]), 0.1)
    assert len(made.mesh.triangles) == 40
    assert np.allclose(np.linalg.norm(made.points[12:] - [1, 2, 3], axis=1), 0.1)
    corners = made.points[made.mesh.triangles]
    centres = np.repeat([[0.0, 0, 0], [1, 2, 3]], 20, axis=0)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("ni,ni->n", normals, corners.mean(axis=1) - centres) > 0).all()
    assert np.allclose(made.mesh.colors[12:], [0, 1, 0])
