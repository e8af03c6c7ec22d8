"""Braids that are simulated as one rod each carry their strands."""

import numpy as np
import pytest
from braids import EXAMPLE, RECIPE, SHAPES
from ringlet.api.grooms import build_groom
from ringlet.api.shots import read_shot, start_motion
from ringlet.data.groom import CORE, SECTION, STRAND_RADIUS
from ringlet.sim.cores import Cores

from ringlet.groom import parse_recipe

SECTIONS = "size = 4.5\nstrands = 3"
SHAPE = """
op = "braid"
width = 1.2
simulate = "core"
mask = { where = "x > 0" }
start = 1.2
tail = 0.8
[[shape]]
op = "braid"
width = 1.2
mask = { where = "x <= 0" }
start = 1.2
tail = 0.8
"""


@pytest.fixture(scope="module")
def groom():
    text = RECIPE.format(sections=SECTIONS, points=110, shape=SHAPE, where="z < -5 and y > 5")
    return build_groom(parse_recipe(text, EXAMPLE / "cores.recipe.toml"))


def test_cores_and_strands_play_in_one_shot(groom):
    core = groom.locks.curve[CORE] > 0
    assert core.any() and not core.all()
    motion = start_motion(read_shot(EXAMPLE / "nod.shot.toml"), groom)
    assert len(motion.locks) == (~core).sum() + core.sum() / 3
    first = motion.first
    np.testing.assert_allclose(motion.points(first), groom.locks.points, atol=1e-9)  # at rest nothing has moved
    for k in range(1, 11):
        statistics = motion.reach(k)
    points = motion.points(first + 10)
    assert np.isfinite(points).all() and statistics["max_stretch"] < 0.05
    moved = np.linalg.norm(points - groom.locks.points, axis=1).reshape(len(core), -1)
    assert (moved[core].max(axis=1) > 2e-3).all()  # they swing
    np.testing.assert_allclose(groom.locks.with_points(points).edge_lengths(), groom.locks.edge_lengths(), rtol=0.05)
    carried = groom.locks.take(core)
    kept = carried.with_points(points[groom.locks.point_rows(core)]).edge_lengths()
    np.testing.assert_allclose(kept, carried.edge_lengths(), rtol=1e-4)  # the rounding of files
    # A core carries its strands across itself: their distances change by less than their radius.
    for section in np.unique(groom.locks.curve[SECTION][core]):
        rows = np.flatnonzero(groom.locks.curve[SECTION] == section)
        now, groomed = (p.reshape(len(core), -1, 3)[rows] for p in (points, groom.locks.points))
        for a, b in ((0, 1), (1, 2)):
            now_apart, apart = (np.linalg.norm(p[a] - p[b], axis=1) for p in (now, groomed))
            np.testing.assert_allclose(now_apart, apart, atol=groom.locks.curve[STRAND_RADIUS].max())


def test_a_core_weighs_and_resists_as_its_strands_side_by_side(groom):
    cores = Cores.of(groom)
    factors = cores.material()
    strands = np.repeat(cores.strands, cores.groom.locks.counts)
    assert set(np.unique(strands)) == {1, 3}
    np.testing.assert_allclose(factors["radius"] ** 2, strands)  # mass and stretch
    np.testing.assert_allclose(factors["radius"] ** 4 * factors["bend"], strands)
    np.testing.assert_allclose(factors["radius"] ** 4 * factors["twist"], strands)
    assert cores.count == (cores.strands == 3).sum()


def test_a_groom_without_cores_is_simulated_as_it_is(groom):
    plain = build_groom(
        parse_recipe(
            RECIPE.format(sections=SECTIONS, points=110, shape='op = "braid"\nwidth = 1.2', where="z < -9"),
            EXAMPLE / "a.recipe.toml",
        )
    )
    cores = Cores.of(plain)
    assert cores.groom is plain and cores.reduced(plain.locks) is plain.locks and not cores.material()


def test_a_cornrow_may_be_a_core_too():
    sections, points, shape = SHAPES["cornrows"]
    recipe = RECIPE.format(sections=sections, points=points, shape=shape + '\nsimulate = "core"', where="x > 3")
    made = build_groom(parse_recipe(recipe, EXAMPLE / "cores.recipe.toml"))
    motion = start_motion(read_shot(EXAMPLE / "nod.shot.toml"), made)
    assert len(motion.locks) == len(made.locks) / 3
    for k in range(1, 6):
        statistics = motion.reach(k)
    assert statistics["max_stretch"] < 0.05
    rows = motion.points(motion.first + 5).reshape(len(made.locks), -1, 3)
    groomed = made.locks.points.reshape(rows.shape)
    np.testing.assert_allclose(
        np.linalg.norm(np.diff(rows, axis=1), axis=2), np.linalg.norm(np.diff(groomed, axis=1), axis=2), rtol=1e-4
    )
    for a, b in ((0, 1), (1, 2)):
        np.testing.assert_allclose(
            np.linalg.norm(rows[a] - rows[b], axis=1), np.linalg.norm(groomed[a] - groomed[b], axis=1), atol=5e-5
        )
