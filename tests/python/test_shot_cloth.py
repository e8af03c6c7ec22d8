"""Cloth in shots: pins, contact, shrinking and refusals."""

from itertools import pairwise

import numpy as np
import pytest
from cloth_scene import LONG, WEIGHTLESS, garment, sheet, simulated
from floor_scene import CONTACT, SHOT, ball, floor, groom, still
from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip, Mesh
from ringlet.shot import parse_shot
from ringlet.sim import Obstacle, simulate
from ringlet.sim.garment import SimulatedGarment
from ringlet.sim.penetration import edge_triangle_intersections, mesh_edges
from shapes import rotation


def tube(radius=0.012, height=0.01, sides=24, rows=4, centre=(0.0, 0.0, 0.0)):
    """An open cylinder around the x-axis."""
    around, along = np.linspace(0, 2 * np.pi, sides, endpoint=False), np.linspace(-height / 2, height / 2, rows)
    points = [[x, radius * np.cos(a), radius * np.sin(a)] for x in along for a in around]
    triangles = []
    for row in range(rows - 1):
        for k in range(sides):
            a, b = row * sides + k, row * sides + (k + 1) % sides
            triangles += [[a, b, b + sides], [a, b + sides, a + sides]]
    return Mesh("band", np.array(points) + centre, np.array(triangles, np.int32))


def moving(mesh, move):
    """A clip of frames 1 to 12."""
    frames = np.arange(1.0, 13.0)
    return Clip(frames, np.array([move(mesh.points, f - 1) for f in frames]), 24.0)


def test_cloth_falls_onto_locks_and_the_floor_without_intersections():
    cache = simulated(garment(), text=LONG)
    cloth, alone = cache.cloths[0].points.astype(float), simulated(text=LONG)
    assert cloth.shape == (30, 81, 3)
    assert cloth[:, :, 1].min() > 0  # above the floor
    assert cloth[-1, :, 1].max() < 0.012 < sheet().points[:, 1].min()  # it falls and lies on locks
    triangles = sheet().triangles
    segments = np.delete(np.arange(92), [30, 61])[:, None] + [0, 1]
    for locks, points in zip(cache.points, cloth, strict=True):
        assert not len(edge_triangle_intersections(locks.astype(float)[segments], points[triangles]))
    # Its weight lowers the locks.
    assert cache.points[12, :, 1].mean() < alone.points[12, :, 1].mean() - 1e-4


def test_statistics_include_each_cloth():
    cache = simulated(garment(), garment(sheet(height=0.03, name="other")))
    assert [cloth.name for cloth in cache.cloths] == ["sheet", "other"]
    for frame in cache.statistics[1:]:
        assert set(frame["cloth"]) == {"sheet", "other"}
        statistics = frame["cloth"]["sheet"]
        assert 0 <= statistics["max_stretch"] < 0.1 and statistics["nan"] == 0
        assert set(statistics["energy"]) == {"stretch", "bend", "gravity", "kinetic"}
    assert max(frame["cloth"]["sheet"]["energy"]["kinetic"] for frame in cache.statistics[1:]) > 0


def pinned(collider, move, text=WEIGHTLESS, **pin):
    """A sheet pinned to a moving collider 2 cm below; its rest points and its points in every frame."""
    obstacle = Obstacle(collider, moving(collider, move))
    one = garment(sheet(height=0.03), pin=[{"to": collider.name, **pin}])
    cache = simulated(one, text=text, obstacles=[obstacle])
    return one.mesh.points, cache.cloths[0].points.astype(float)


def turned(points, frames):
    return points @ rotation((0, 0, 1), 3 * frames).T + [0.002 * frames, 0, 0]


def test_a_subset_is_pinned_to_a_moving_collider():
    rest, points = pinned(ball(0.01), turned, subset="front")
    front = rest[:, 2] <= 1e-9
    for k, now in enumerate(points):
        assert np.abs(now[front] - turned(rest[front], k)).max() < 1e-6
    assert np.abs(points[-1][~front] - turned(rest[~front], 11)).max() > 1e-5  # free vertices lag behind


def test_vertices_near_a_collider_are_pinned_to_it():
    rest, points = pinned(ball(0.01), turned, within=0.022)
    near = np.linalg.norm(rest, axis=1) < 0.0315
    assert 0 < near.sum() < len(near) / 2
    assert np.abs(points[-1][near] - turned(rest[near], 11)).max() < 1e-6


def test_a_map_scales_the_stiffness_of_attachments():
    def shifted(points, frames):
        return points + [0, 0, 0.0005 * frames]

    rest, points = pinned(ball(0.01), shifted, SHOT + CONTACT, map="stiff", stiffness=0.05)
    low = (rest - points[-1])[:, 1]
    strong, weak = np.isclose(rest[:, 0], 0.04), np.isclose(rest[:, 0], -0.02)
    assert (low[strong] > 1e-5).all() and low[strong].max() < 0.01  # attached, not pinned
    assert low[weak].min() > 1.2 * low[strong].max()
    assert np.abs((points[-1] - rest)[strong, 2].mean() - 0.0055) < 1e-3  # follows the collider


def test_pins_without_a_collider_follow_the_animated_mesh():
    mesh = sheet(height=0.03)
    clip = moving(mesh, lambda points, frames: points + [0, 0, 0.003 * frames])
    cache = simulated(garment(mesh, clip, pin=[{"subset": "front"}]), text=WEIGHTLESS)
    front = mesh.points[:, 2] <= 1e-9
    assert np.abs(cache.cloths[0].points[-1][front] - clip.points[-1][front]).max() < 1e-6


def test_cloth_starts_on_its_collider_of_the_first_frame():
    """A shot from the middle of an animation, with cloth modelled for the rest pose."""
    collider = ball(0.01)
    obstacle = Obstacle(collider, moving(collider, turned))
    one = garment(sheet(height=0.03))
    text = WEIGHTLESS.replace("[1, 12]", "[10, 12]")
    cache = simulate(parse_shot(text), groom(), still(floor()), obstacles=[obstacle], garments=[one])
    assert (
        np.abs(cache.cloths[0].points[0] - turned(one.mesh.points, 9)).max() < 2e-4
    )  # the collider rotates by 3° in the step


def girth(points, rows=4):
    """Mean circumference of a tube [m]."""
    rings = points.reshape(rows, -1, 3).astype(float)
    return np.linalg.norm(rings - np.roll(rings, 1, axis=1), axis=2).sum(axis=1).mean()


def test_elastic_shrinks_over_its_frames():
    band = tube(centre=(0, 0.05, 0))
    cache = simulated(garment(band, shrink=[[1, 1.0], [3, 1.0], [9, 0.5]]), text=WEIGHTLESS + "[solver]\nnewton = 20\n")
    sizes = [girth(points) / girth(band.points) for points in cache.cloths[0].points]
    assert abs(sizes[2] - 1) < 1e-3
    assert abs(sizes[-1] - 0.5) < 0.01
    assert all(after < before + 1e-6 for before, after in pairwise(sizes[2:]))


def test_a_band_gathers_the_locks_in_it():
    made = groom(apart=0.006)
    middle = made.locks.points.mean(axis=0)
    band = tube(0.016, 0.006, 24, 3, centre=middle)
    text = SHOT.replace("12]", "20]") + "[forces]\ngravity = [0, 0, 0]\n" + CONTACT
    cache = simulated(garment(band, shrink=[[1, 1.0], [16, 0.3]]), text=text, made=made, obstacles=[])
    inside = np.abs(made.locks.points[:, 0] - middle[0]) < 0.004

    def spread(points):
        return np.ptp(points[inside, 2].astype(float))

    assert spread(cache.points[-1]) < 0.85 * spread(made.locks.points)
    triangles = band.triangles
    segments = np.delete(np.arange(92), [30, 61])[:, None] + [0, 1]
    assert not len(
        edge_triangle_intersections(
            cache.points[-1].astype(float)[segments], cache.cloths[0].points[-1].astype(float)[triangles]
        )
    )


@pytest.mark.parametrize("pair", [("sheet", "floor"), ("floor", "sheet")])
def test_friction_of_a_pair_replaces_the_friction_of_both(pair):
    """On a slope of 20°, where sticking needs friction above tan 20° = 0.36."""
    slope = SHOT + f"[forces]\ngravity = [{9.81 * np.sin(0.35)}, {-9.81 * np.cos(0.35)}, 0]\n" + CONTACT
    low = sheet(height=0.0017)
    away = groom(apart=0.02)
    away.locks.points += [0, 0.04, 0]
    slid = {}
    for friction in (0.0, 1.0):
        text = slope + f'[[contact.pair]]\nbetween = ["{pair[0]}", "{pair[1]}"]\nfriction = {friction}\n'
        cache = simulated(garment(low), text=text + "[solver]\nnewton = 20\n", made=away)
        slid[friction] = np.diff(cache.cloths[0].points[[0, -1], :, 0], axis=0).mean()
    assert slid[0.0] > 0.1  # ½ g sin 20° t² = 0.35 m in 11 frames, less drag
    assert abs(slid[1.0]) < 2e-3


def test_initial_intersections_are_reported():
    cache = simulated(garment(sheet(height=0.006)), text=WEIGHTLESS)
    (found,) = cache.start["piercing"]
    assert found["what"] == "locks" and found["cloth"] == "sheet"
    assert found["places"] == found["locks"] == 3
    assert {one["lock"] for one in found["worst"]} == {11, 12, 13}


def test_piercings_are_those_of_a_plane():
    corners = np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]])
    rng = np.random.default_rng(1)
    ends = rng.uniform(-1, 1.5, (500, 2, 3))
    t = ends[:, 0, 2] / (ends[:, 0, 2] - ends[:, 1, 2])
    at = ends[:, 0] + t[:, None] * (ends[:, 1] - ends[:, 0])
    through = (t > 0) & (t < 1) & (at[:, 0] > 0) & (at[:, 1] > 0) & (at[:, 0] + at[:, 1] < 1)
    assert 5 < through.sum() < 100
    assert set(edge_triangle_intersections(ends, corners)[:, 0]) == set(np.flatnonzero(through))
    assert len(mesh_edges(sheet().triangles)) == 3 * 64 + 2 * 8


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[[cloth]]\nfile = 'a.usda'\n", ["cloth", "[contact]"]),
        (CONTACT + "on = false\n[[cloth]]\nfile = 'a.usda'\n", ["cloth", "on = true"]),
        (CONTACT + "[[cloth]]\nname = 'a'\n", ["cloth[0]", "`mesh`", "`file`"]),
        (CONTACT + "[[cloth]]\nfile = 'a.usda'\nshrnk = 1\n", ["cloth[0].shrnk", "'shrink'?"]),
        (CONTACT + "[[cloth]]\nfile = 'a.usda'\nshrink = [[4, 1.0], [2, 0.5]]\n", ["cloth[0].shrink", "[4.0, 2.0]"]),
        (CONTACT + "[[cloth]]\nfile = 'a.usda'\nshrink = 0.0\n", ["cloth[0].shrink", "0.0"]),
        (CONTACT + "[[cloth]]\nfile = 'a.usda'\nname = 'a b'\n", ["cloth[0].name", "a b"]),
        (CONTACT + "[[cloth]]\nfile = 'a.usda'\nmaterial = { bend = -1 }\n", ["cloth[0].material.bend", "-1"]),
        (CONTACT + "[[cloth]]\nfile = 'a.usda'\npin = [{ within = 0.1 }]\n", ["cloth[0].pin[0].within", "`to`"]),
        (CONTACT + "[[contact.pair]]\nbetween = ['locks']\nfriction = 1\n", ["contact.pair[0].between"]),
    ],
)
def test_invalid_cloth_settings_are_refused_in_one_line(text, words):
    with pytest.raises(UserError) as caught:
        parse_shot(SHOT + text)
    assert "\n" not in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def tilted(mesh):
    mesh.points[:] = mesh.points @ rotation((0, 0, 1), 5).T
    return mesh


def flat(mesh):
    mesh.points[mesh.triangles[5]] *= [0, 1, 0]
    return mesh


def test_a_pin_to_one_of_two_colliders_of_a_name_is_refused():
    floors = [Obstacle(floor(), still(floor()))] * 2
    with pytest.raises(UserError, match=r"pin\[0\].to is 'floor', which is the name of 2 colliders"):
        simulated(garment(pin=[{"to": "floor"}]), obstacles=floors)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: garment(pin=[{"to": "flor"}]), ["'sheet'", "pin[0].to", "'flor'", "'floor'?"]),
        (lambda: garment(pin=[{"subset": "fron"}]), ["pin[0].subset", "'fron'", "'front'?"]),
        (lambda: garment(pin=[{"map": "stif"}]), ["pin[0].map", "'stif'", "'stiff'?"]),
        (lambda: garment(pin=[{"to": "floor", "within": 0.01}]), ["pin[0].within", "0.01 m", "0.02 m", "'floor'"]),
        (lambda: garment(flat(sheet())), ["sheet", "triangle", "no area"]),
        (lambda: garment(tilted(sheet(height=0.0))), ["'sheet'", "begins through 'floor'", "of its vertices"]),
        (lambda: garment(clip=Clip(np.array([1.0]), np.zeros((1, 5, 3)), 24.0)), ["sheet", "5 points", "81"]),
    ],
)
def test_invalid_cloth_is_refused_in_one_line(make, words):
    with pytest.raises(UserError) as caught:
        simulated(make())
    assert "\n" not in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def test_friction_between_unknown_names_is_refused():
    text = SHOT + CONTACT + '[[contact.pair]]\nbetween = ["locks", "sheat"]\nfriction = 1\n'
    with pytest.raises(UserError, match=r"contact\.pair\[0\]\.between\[1\] is 'sheat'.*did you mean 'sheet'\?"):
        simulated(garment(), text=text)


def test_a_cloth_that_begins_without_area_is_refused_at_its_first_frame():
    mesh = sheet()
    flat = mesh.points * [1.0, 1.0, 0.0] * [0.0, 1.0, 1.0]
    begins_flat = garment(mesh, Clip(np.array([1.0, 2.0]), np.stack([flat, mesh.points]), 24.0))
    with pytest.raises(UserError, match=r"at frame 1 triangle 0 has no area .*; begin where each has one"):
        SimulatedGarment(begins_flat, [], 1.0)
    SimulatedGarment(begins_flat, [], 2.0)
