"""Nothing is written that is not finite, far from the head, or not as many points as declared."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from commands import edit, refused, run
from ringlet.data.cache import Cache, CachedCloth, Touches
from ringlet.data.errors import UserError
from ringlet.groom.operators import Curl
from ringlet.sim.motion import Motion
from usd_scenes import hairs_of, make_groom, write_head
from wear import write_wear

import ringlet
from ringlet import io

BAD = [np.nan, np.inf, -np.inf, 1e15, 1e3]


@pytest.fixture
def scene(tmp_path):
    """A head, five locks on it, and the file of their groom."""
    groom = make_groom(write_head(tmp_path / "head.usda"))
    io.write_groom(groom, tmp_path / "groom.usdc")
    return groom, tmp_path


def spoilt(curves, value, row=9):
    points = np.array(curves.points)
    points[row, 1] = value
    return curves.with_points(points)


def write_caches(groom, folder, points, cloths=()):
    cache = Cache(np.array([1.0, 2.0]), points, cloths=list(cloths))
    io.write_cache(cache, folder / "groom.usdc", folder / "new.usdc", groom.space)


@pytest.mark.parametrize("value", BAD)
def test_every_writer_of_curves_refuses_a_wrong_point_with_its_place(scene, value):
    groom, folder = scene
    new, locks = folder / "new.usdc", groom.locks
    bad = spoilt(locks, value)

    def write_hairs(frame):
        hairs = hairs_of(groom)
        with io.HairWriter(new, groom, hairs, folder / "groom.usdc") as writer:
            writer.add(frame, spoilt(hairs, value).points)

    both = np.stack([locks.points, bad.points])
    bad_guides = spoilt(groom.guides, value, 7)
    writers = {
        "/groom/locks: curve 3, point 2": lambda: io.write_groom(replace(groom, locks=bad), new),
        "/groom/guides: curve 1, point 3": lambda: io.write_groom(replace(groom, guides=bad_guides), new),
        "/groom/locks at frame 2: curve 3, point 2": lambda: write_caches(groom, folder, both),
        "/groom/hairs: curve 1, point 2": lambda: write_hairs(None),
        "/groom/hairs at frame 7: curve 1, point 2": lambda: write_hairs(7),
        "/groom/locks: curve 3": lambda: io.write_rest(bad, {}, new, groom.space, around=groom.scalp.points),
    }
    for place, write in writers.items():
        assert f"new.usdc {place}" in (message := refusal(write))
        assert "must be finite and at most" in message and " m from the head" in message
        assert sorted(path.name for path in folder.iterdir()) == ["groom.usdc", "head.usda"]


def refusal(write):
    try:
        write()
    except UserError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("value", BAD[:4])
def test_cloths_and_contacts_are_bounded_too(scene, value):
    groom, folder = scene
    write_wear(folder)
    points = np.stack([groom.locks.points] * 2)
    cloth = np.zeros((2, 81, 3))
    cloth[1, 5, 2] = value
    with pytest.raises(UserError, match=r"/groom/cloths/wear/scarf at frame 2: point 5 is at"):
        write_caches(groom, folder, points, [CachedCloth("scarf", folder / "wear.usda", "/wear/scarf", cloth)])
    write_caches(groom, folder, points)
    places = np.array([[0, 0, 0], [0, value, 0]])
    touches = [Touches(places, np.ones(2, np.float32), np.ones(2, np.float32))] * 2
    cache = Cache(np.array([1.0, 2.0]), points, touches=touches)
    with pytest.raises(UserError, match=r"/groom/touches at frame 1: point"):
        io.write_touches(cache, folder / "new.usdc", folder / "touches.usdc", groom.space)


def test_counts_are_those_that_are_declared(scene):
    groom, folder = scene
    with pytest.raises(UserError, match=r"/groom/locks at frame 1: has 34 points for curves of 35"):
        write_caches(groom, folder, np.stack([groom.locks.points[:-1]] * 2))
    locks = replace(groom.locks, point={**groom.locks.point, "ramp": np.ones(34)})
    with pytest.raises(UserError, match="/groom/locks: ramp has 34 values; must have 35, being vertex"):
        io.write_groom(replace(groom, locks=locks), folder / "new.usdc")
    wide = replace(groom.locks, point={**groom.locks.point, "width": np.full(35, 1e30)})
    assert "/groom/locks: widths are from" in refusal(
        lambda: io.write_groom(replace(groom, locks=wide), folder / "new.usdc")
    )
    assert not (folder / "new.usdc").exists()


def test_a_stage_of_the_groom_is_refused_by_its_name(copy, monkeypatch):
    apply = Curl.apply
    monkeypatch.setattr(Curl, "apply", lambda self, curves, context: spoilt(apply(self, curves, context), 1e6))
    refused(run("groom", copy / "small.recipe.toml", "-o", copy / "groom.usdc"), "curl: curve", "m from the head")
    assert not (copy / "groom.usdc").exists()


def test_a_simulation_that_leaves_its_head_ends_at_that_frame(copy, monkeypatch):
    advance = Motion.advance

    def spoil(self, begin, end):
        statistics = advance(self, begin, end)
        if end == 3:
            self.strands.positions[45] = (0.0, 1e5, 0.0)
        return statistics

    monkeypatch.setattr(Motion, "advance", spoil)
    result = run("sim", copy / "small.shot.toml", "-o", copy / "cache.usdc")
    refused(result, "sim: locks at frame 3: curve", "point 5 is at (0, 1e+05, 0) m, 1 of 320 points are wrong")
    assert not (copy / "cache.usdc").exists()


def test_long_hair_on_a_small_patch_is_no_mistake(copy):
    edit(copy / "small.recipe.toml", "length = 5", 'length = "4 m"')
    edit(copy / "small.recipe.toml", "pitch = 1.5", 'pitch = "1 m"')
    assert run("groom", copy / "small.recipe.toml", "-o", copy / "groom.usdc").exit_code == 0
    assert ringlet.read_groom(copy / "groom.usdc").locks.lengths().max() > 3.9
