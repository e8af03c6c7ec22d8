"""Cloth in shots: what pins it, what it touches, how it draws together, and what is refused."""

from itertools import pairwise

import numpy as np
import pytest
from ringlet.data.errors import UserError
from ringlet.data.mesh import Clip, Mesh
from ringlet.shot import ShotCloth, parse_shot
from ringlet.sim import Garment, Obstacle, simulate
from ringlet.sim.penetration import edge_triangle_intersections, mesh_edges
from shapes import rotation
from test_shot_contact import CONTACT, SHOT, ball, floor, groom, still


def sheet(cells=8, size=0.08, height=0.02, name="sheet"):
    """A level square sheet over the middle of the floor; its subset ``front`` are the triangles at z < 0."""
    at = np.linspace(-size / 2, size / 2, cells + 1)
    x, z = np.meshgrid(at, at, indexing="ij")
    points = np.stack([x, np.full_like(x, height), z], axis=-1).reshape(-1, 3)
    a = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    corner = np.stack([a, a + 1, a + cells + 2, a, a + cells + 2, a + cells + 1], axis=1).reshape(-1, 3)
    front = np.flatnonzero(points[corner, 2].mean(axis=1) < 0)
    stiff = np.clip(points[:, 0] / size + 0.5, 0, 1)[corner]
    return Mesh(name, points, corner.astype(np.int32), regions={"front": front}, maps={"stiff": stiff})


def tube(radius=0.012, height=0.01, sides=24, rows=4, centre=(0.0, 0.0, 0.0)):
    """An open band around the x-axis."""
    around, along = np.linspace(0, 2 * np.pi, sides, endpoint=False), np.linspace(-height / 2, height / 2, rows)
    points = [[x, radius * np.cos(a), radius * np.sin(a)] for x in along for a in around]
    triangles = []
    for row in range(rows - 1):
        for k in range(sides):
            a, b = row * sides + k, row * sides + (k + 1) % sides
            triangles += [[a, b, b + sides], [a, b + sides, a + sides]]
    return Mesh("band", np.array(points) + centre, np.array(triangles, np.int32))


def garment(mesh=None, clip=None, **settings):
    mesh = mesh or sheet()
    return Garment(mesh, clip or still(mesh), ShotCloth(name=mesh.name, file="cloth.usda", **settings))


def simulated(*garments, text=SHOT + CONTACT, obstacles=None, made=None):
    made = made or groom()
    obstacles = [Obstacle(floor(), still(floor()))] if obstacles is None else obstacles
    return simulate(parse_shot(text), made, still(made.scalp), obstacles=obstacles, garments=garments)


def moving(mesh, move):
    """A clip of frames 1 to 12."""
    frames = np.arange(1.0, 13.0)
    return Clip(frames, np.array([move(mesh.points, f - 1) for f in frames]), 24.0)


LONG = SHOT.replace("12]", "30]") + CONTACT
WEIGHTLESS = SHOT + "[forces]\ngravity = [0, 0, 0]\n" + CONTACT


def test_cloth_falls_onto_locks_and_the_floor_and_through_neither():
    cache = simulated(garment(), text=LONG)
    cloth, alone = cache.cloths[0].points.astype(float), simulated(text=LONG)
    assert cloth.shape == (30, 81, 3)
    assert cloth[:, :, 1].min() > 0  # above the floor
    assert cloth[-1, :, 1].max() < 0.012 < sheet().points[:, 1].min()  # it did fall, and lies on locks
    triangles = sheet().triangles
    segments = np.delete(np.arange(92), [30, 61])[:, None] + [0, 1]
    for locks, places in zip(cache.points, cloth, strict=True):
        assert not len(edge_triangle_intersections(locks.astype(float)[segments], places[triangles]))
    # The locks bear it: they are lower than without it.
    assert cache.points[12, :, 1].mean() < alone.points[12, :, 1].mean() - 1e-4


def test_statistics_tell_of_each_cloth():
    cache = simulated(garment(), garment(sheet(height=0.03, name="other")))
    assert [cloth.name for cloth in cache.cloths] == ["sheet", "other"]
    for frame in cache.statistics:
        assert set(frame["cloth"]) == {"sheet", "other"}
        told = frame["cloth"]["sheet"]
        assert 0 <= told["max_stretch"] < 0.1 and told["nan"] == 0
        assert set(told["energy"]) == {"stretch", "bend", "gravity", "kinetic"}
    assert max(frame["cloth"]["sheet"]["energy"]["kinetic"] for frame in cache.statistics) > 0


def pinned(collider, move, text=WEIGHTLESS, **pin):
    """A sheet, 2 cm over a collider that moves; where its vertices begin and where they are in every frame."""
    obstacle = Obstacle(collider, moving(collider, move))
    one = garment(sheet(height=0.03), pin=[{"to": collider.name, **pin}])
    cache = simulated(one, text=text, obstacles=[obstacle])
    return one.mesh.points, cache.cloths[0].points.astype(float)


def turned(points, frames):
    return points @ rotation((0, 0, 1), 3 * frames).T + [0.002 * frames, 0, 0]


def test_a_subset_is_held_by_the_collider_that_moves():
    begin, places = pinned(ball(0.01), turned, subset="front")
    front = begin[:, 2] <= 1e-9
    for k, now in enumerate(places):
        assert np.abs(now[front] - turned(begin[front], k)).max() < 1e-6
    assert np.abs(places[-1][~front] - turned(begin[~front], 11)).max() > 1e-5  # the rest follows by itself


def test_what_is_near_a_collider_is_held_by_it():
    begin, places = pinned(ball(0.01), turned, within=0.022)
    near = np.linalg.norm(begin, axis=1) < 0.0315
    assert 0 < near.sum() < len(near) / 2
    assert np.abs(places[-1][near] - turned(begin[near], 11)).max() < 1e-6


def test_a_map_says_how_strongly_springs_draw():
    def shifted(points, frames):
        return points + [0, 0, 0.0005 * frames]

    begin, places = pinned(ball(0.01), shifted, SHOT + CONTACT, map="stiff", stiffness=0.05)
    low = (begin - places[-1])[:, 1]
    strong, weak = np.isclose(begin[:, 0], 0.04), np.isclose(begin[:, 0], -0.02)
    assert (low[strong] > 1e-5).all() and low[strong].max() < 0.01  # drawn, not held
    assert low[weak].min() > 1.2 * low[strong].max()
    assert np.abs((places[-1] - begin)[strong, 2].mean() - 0.0055) < 1e-3  # along with the collider


def test_an_animated_mesh_leads_what_is_pinned_to_nothing_else():
    mesh = sheet(height=0.03)
    clip = moving(mesh, lambda points, frames: points + [0, 0, 0.003 * frames])
    cache = simulated(garment(mesh, clip, pin=[{"subset": "front"}]), text=WEIGHTLESS)
    front = mesh.points[:, 2] <= 1e-9
    assert np.abs(cache.cloths[0].points[-1][front] - clip.points[-1][front]).max() < 1e-6


def test_a_cloth_begins_where_what_it_lies_on_has_gone():
    """A shot that begins in the middle of an animation: the cloth is modelled for the rest pose."""
    collider = ball(0.01)
    obstacle = Obstacle(collider, moving(collider, turned))
    one = garment(sheet(height=0.03))
    text = WEIGHTLESS.replace("[1, 12]", "[10, 12]")
    cache = simulate(parse_shot(text), groom(), still(floor()), obstacles=[obstacle], garments=[one])
    assert np.abs(cache.cloths[0].points[0] - turned(one.mesh.points, 9)).max() < 2e-4  # as the collider turns on by 3°


def girth(points, rows=4):
    """The mean circumference of a tube [m]."""
    rings = points.reshape(rows, -1, 3).astype(float)
    return np.linalg.norm(rings - np.roll(rings, 1, axis=1), axis=2).sum(axis=1).mean()


def test_elastic_draws_together_as_its_frames_say():
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
def test_friction_of_a_pair_replaces_what_both_say(pair):
    """On a slope of 20°: tan 20° = 0.36."""
    slope = SHOT + f"[forces]\ngravity = [{9.81 * np.sin(0.35)}, {-9.81 * np.cos(0.35)}, 0]\n" + CONTACT
    low = sheet(height=0.0017)
    away = groom(apart=0.02)
    away.locks.points += [0, 0.04, 0]
    slid = {}
    for friction in (0.0, 1.0):
        text = slope + f'[[contact.pair]]\nbetween = ["{pair[0]}", "{pair[1]}"]\nfriction = {friction}\n'
        cache = simulated(garment(low), text=text + "[solver]\nnewton = 20\n", made=away)
        slid[friction] = np.diff(cache.cloths[0].points[[0, -1], :, 0], axis=0).mean()
    assert slid[0.0] > 0.1  # ½ g sin 20° t² = 0.35 m in 11 frames, less what air takes
    assert abs(slid[1.0]) < 2e-3


def test_what_begins_entangled_is_told():
    cache = simulated(garment(sheet(height=0.006)), text=WEIGHTLESS)
    (told,) = cache.start["piercing"]
    assert told["what"] == "locks" and told["cloth"] == "sheet"
    assert told["places"] == told["locks"] == 3
    assert {place["lock"] for place in told["worst"]} == {11, 12, 13}


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
def test_a_mistake_in_the_settings_is_told_in_one_line(text, words):
    with pytest.raises(UserError) as told:
        parse_shot(SHOT + text)
    assert "\n" not in str(told.value)
    for word in words:
        assert word in str(told.value)


def tilted(mesh):
    mesh.points[:] = mesh.points @ rotation((0, 0, 1), 5).T
    return mesh


def flat(mesh):
    mesh.points[mesh.triangles[5]] *= [0, 1, 0]
    return mesh


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
def test_cloth_that_cannot_be_simulated_is_refused_in_one_line(make, words):
    with pytest.raises(UserError) as told:
        simulated(make())
    assert "\n" not in str(told.value)
    for word in words:
        assert word in str(told.value)


def test_friction_between_names_that_nothing_has_is_refused():
    text = SHOT + CONTACT + '[[contact.pair]]\nbetween = ["locks", "sheat"]\nfriction = 1\n'
    with pytest.raises(UserError, match=r"contact\.pair\[0\]\.between\[1\] is 'sheat'.*did you mean 'sheet'\?"):
        simulated(garment(), text=text)


# With files
