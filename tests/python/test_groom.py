"""The groom stack from a scalp to locks."""

import numpy as np
import pytest
from shapes import ball, sheet

from ringlet import Curves, Mesh, UserError
from ringlet.groom import Memory, make_groom, parse_recipe

BASE = """
[scalp]
region = "scalp"
[guides]
count = 20
length = 6
[locks]
count = 60
points = 64
[curl]
curls = 5
width = 0.8
irregularity = 0
phase_spread = 0
start = 0.5
"""


def groom(text=BASE, scalp=None, top="", **options):
    return make_groom(parse_recipe(f"ringlet = 2\n{top}\n{text}"), scalp or ball(), **options)


def tall(count=3, points=8, height=0.08):
    """Straight guides on the sheet."""
    up = np.linspace(0.0, height, points)
    return Curves.from_list(
        [np.stack([0 * up + 0.02 * i, up, 0 * up], axis=1) for i in range(count)], ids=range(5, 5 + count)
    )


def drawn(curl, guides=None, locks="points = 120", **options):
    return groom(
        f"[guides]\nfile='g.usda'\n[locks]\n{locks}\n[collide]\nmargin=0\n{curl}",
        sheet(),
        drawn_guides=guides or tall(),
        **options,
    )


def test_the_same_recipe_gives_the_same_groom_and_another_seed_another():
    first, again, other = groom(), groom(), groom(top="seed = 2")
    assert np.array_equal(first.locks.points, again.locks.points)
    assert not np.array_equal(first.locks.points, other.locks.points)


def test_combined_variations_leave_every_guide_a_positive_length():
    wild = BASE.replace("length = 6", "length = { value = 6, vary = 1, noise = 1 }").replace(
        "count = 20", "count = 300"
    )
    assert groom(wild).guides.lengths().min() > 0.0025


def test_roots_are_on_the_scalp_region_and_keep_their_distance():
    locks = groom(BASE.replace("count = 60", "count = 300")).locks
    assert len(locks) == 300
    assert np.isin(locks.curve["root_triangle"], ball().regions["scalp"]).all()
    gaps = np.linalg.norm(locks.roots[:, None] - locks.roots[None, :], axis=2) + np.eye(300)
    area = 2.0 * np.pi * 0.09**2
    assert gaps.min() > 0.5 * np.sqrt(area / (2.0 * np.sqrt(3.0) * 300)) * 2.0  # half of a hexagonal packing


def test_removing_a_lock_moves_no_other_lock():
    more, fewer = groom(BASE.replace("count = 60", "count = 61")).locks, groom().locks
    assert set(fewer.ids) < set(more.ids)
    same = more.take(np.isin(more.ids, fewer.ids))
    assert np.array_equal(same.points, fewer.points)


def test_changing_the_shape_stack_leaves_the_randomness_of_its_other_operators():
    operator = "[[shape]]\nop='scraggle'\n"
    without = groom(BASE + operator).locks
    with_more = groom(
        BASE + "[[shape]]\nop='length'\nfactor=1\n" + operator + operator.replace("scraggle", "length")
    ).locks
    assert np.allclose(without.points, with_more.points)


def test_locks_stay_outside_the_head():
    lying = BASE.replace("length = 6", "length = 12\nlift = 0\ngravity_bend = 3") + "[collide]\nmargin = '2 mm'\n"
    locks = groom(lying, ball(rings=48)).locks
    height = np.linalg.norm(locks.points.reshape(60, 64, 3), axis=2) - 0.09
    assert height.min() > -0.0001  # facets are up to 0.1 mm below the sphere
    assert height[:, 16:].min() > 0.0018


def test_points_are_evenly_spaced_along_the_curl():
    edges = np.linalg.norm(np.diff(groom(BASE + "right_handed = 1\n").locks.points.reshape(60, 64, 3), axis=1), axis=2)
    assert (np.ptp(edges, axis=1) < 0.15 * edges.mean(axis=1)).all()


def test_the_curl_begins_at_the_root_and_along_the_shape():
    locks = drawn("[curl]\ncurls = 5\nwidth = 1\nstart = 2").locks
    assert np.allclose(locks.roots, tall().roots)
    first = locks[0][1] - locks[0][0]
    assert first[1] / np.linalg.norm(first) > 0.99


def test_volume_raises_locks_and_keeps_their_length():
    hanging = BASE[: BASE.index("[curl]")].replace("length = 6", "length = 6\ngravity_bend = 2")
    low, high = groom(hanging), groom(hanging + "[[shape]]\nop='volume'\nup=1\namount=1\n")
    assert high.locks.points[:, 1].mean() > low.locks.points[:, 1].mean() + 0.005
    low, high = (g.locks.lengths() for g in (drawn("[[shape]]\nop='volume'\nup=0"), drawn("")))
    assert np.allclose(low, high, rtol=1e-3)


def test_clumping_draws_tips_together_and_leaves_roots():
    plain = BASE[: BASE.index("[curl]")]
    clumps = "[[shape]]\nop='clump'\nsize=4\ntightness={ value = 1, vary = 0 }\n"
    loose, tight = groom(plain), groom(plain + clumps)
    tips = lambda g: g.locks.points.reshape(60, 64, 3)[:, -1]  # noqa: E731
    nearest = lambda p: np.sort(np.linalg.norm(p[:, None] - p[None], axis=2), axis=1)[:, 1]  # noqa: E731
    assert np.array_equal(loose.locks.roots, tight.locks.roots)
    assert np.median(nearest(tips(tight))) < 0.3 * np.median(nearest(tips(loose)))


def test_a_zone_shortens_the_hair_in_its_direction():
    zone = BASE.replace("length = 6", "length = 6\nzone = [{ toward = [0, 0, 1], angle = 60, length = 0.5 }]")
    plain, zoned = groom().guides, groom(zone).guides
    change = zoned.lengths() / plain.lengths()
    front, back = plain.roots[:, 2].argmax(), plain.roots[:, 2] < 0.0
    assert 0.5 <= change[front] < 0.9
    assert np.allclose(change[back], 1.0)


def test_hair_flows_away_from_a_part_line_and_locks_do_not_mix_its_sides():
    flat = BASE[: BASE.index("[curl]")].replace(
        "count = 20", "count = 150\nlift = 0.1\ngravity_bend = 0\npart_line = { falloff = 20 }"
    )
    locks = groom(flat).locks
    away = np.abs(locks.roots[:, 0])
    near = (away > 0.015) & (away < 0.04)  # closer roots may interpolate guides of the other side
    lean = (locks.points.reshape(60, 64, 3)[:, 20] - locks.roots)[near, 0] / locks.lengths()[near]
    assert (lean * np.sign(locks.roots[near, 0]) > 0.1).all()


def test_drawn_guides_become_locks_of_the_same_name_when_no_number_is_asked():
    locks = drawn("").locks
    assert locks.ids.tolist() == [5, 6, 7]
    assert np.allclose(locks.roots, tall().roots)
    assert (locks.counts == 120).all()


def test_a_lock_among_equal_guides_equals_them():
    locks = drawn("", locks="count = 30\npoints = 10").locks
    shape = locks.points.reshape(30, 10, 3) - locks.roots[:, None]
    assert np.allclose(shape, tall(1, 10)[0], atol=1e-9)


def test_guides_in_another_unit_are_refused_with_a_hint_at_the_unit():
    with pytest.raises(UserError, match=r"not on the scalp .* 100 times the head's size: check metersPerUnit"):
        drawn("", guides=Curves.from_list([tall(10)[i] * 100 for i in range(10)]))


def test_guides_beside_the_scalp_are_refused_with_their_distance():
    away = Curves.from_list([tall(1)[0] + [0.0, 0.5, 0.0]])
    with pytest.raises(UserError, match=r"1 of 1 roots are not on the scalp .* is 0.5 m away"):
        drawn("", guides=away)


def broken(change):
    mesh = sheet()
    change(mesh)
    return mesh


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda m: m.triangles.__setitem__(3, [5, 5, 6]), "no area"),
        (lambda m: m.points.__setitem__(7, np.nan), "not finite"),
        (
            lambda m: setattr(m, "triangles", np.concatenate([m.triangles, m.triangles[:1, [1, 0, 2]]])),
            "at most 2|opposite",
        ),
        (lambda m: m.triangles.__setitem__(3, m.triangles[3, ::-1]), "opposite orientations"),
        (lambda m: setattr(m, "triangles", np.empty((0, 3), np.int32)), "mesh is empty"),
    ],
)
def test_broken_scalps_are_refused(change, words):
    with pytest.raises(UserError, match=words):
        groom("[guides]\ncount = 5", broken(change))


def test_a_missing_or_empty_region_is_refused():
    with pytest.raises(UserError, match="no region 'scalpp'; it has: scalp"):
        groom(BASE.replace('"scalp"', '"scalpp"'))
    with pytest.raises(UserError, match="no faces"):
        groom(
            "[scalp]\nregion='none'",
            Mesh("m", ball().points, ball().triangles, regions={"none": np.empty(0, np.int32)}),
        )


def test_an_edit_recomputes_only_what_follows_it():
    memory = Memory()
    groom(memory=memory)
    before = {name: curves for name, (_, curves, _) in memory.results.items()}
    groom(BASE.replace("width = 0.8", "width = 0.7"), memory=memory)
    kept = {name for name, (_, curves, _) in memory.results.items() if curves is before[name]}
    assert kept == {"guides", "locks"}


def test_progress_reports_every_stage_before_and_after():
    steps = []
    groom(progress=lambda *step: steps.append(step))
    assert steps == [(name, done, 1) for name in ("guides", "locks", "curl", "collide") for done in (0, 1)]
