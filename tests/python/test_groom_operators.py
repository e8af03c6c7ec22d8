"""Shape operators: invariants of all operators, and the effect of each on curves of known shape."""

from itertools import pairwise

import numpy as np
import pytest
from ringlet.data.random import Random
from ringlet.groom.groups import leaders
from ringlet.groom.operators import Context
from ringlet.groom.scalp import Scalp
from shapes import ball, sheet

from ringlet import Curves, UserError, _core
from ringlet.groom import make_groom, parse_recipe

OPERATORS = {
    "smooth": "wavelength = 6",
    "length": "factor = 0.7",
    "lift": "angle = 25",
    "volume": "amount = 2",
    "bend": "angle = 60",
    "scraggle": "magnitude = 1",
    "noise": "magnitude = 1",
    "frizz": "magnitude = 0.3\nwavelength = 2",
    "clump": "tightness = { value = 0.8, vary = 0 }\nsize = 3",
    "part": "amount = 2",
    "tie": "curve = 'tail'",
    "flyaways": "share = 0.5",
    "straighten": "",
    "attract": "curve = 'tail'",
    "cut": "at = -6\nspread = 0.5",
    "edges": "within = 15",
    "grow_to": "mesh = 'round'\nspread = 0.5",
    "finger_wave": "curve = 'tail'\nwavelength = 9",
}
KEEPING_LENGTH = ["lift", "volume", "bend", "part", "flyaways", "straighten"]
TAIL = "[curves.tail]\npoints = [[0, 8, -8], [0, 6, -11], [0, -4, -12]]\n"
ROUND = "[meshes.round]\nmiddle = [0, 0, 0]\n"
GROWN = """
[guides]
count = 30
length = 7
lift = 0.5
gravity_bend = 1.5
[locks]
count = {count}
points = 20
[collide]
margin = 0
"""


def locks(shape="", count=40, top="", scalp=None):
    """Locks on a ball before curl and cleaning."""
    text = f"ringlet = 2\n{top}\n[scalp]\nregion = 'scalp'\n{TAIL}{ROUND}{GROWN.format(count=count)}{shape}"
    return uncleaned(parse_recipe(text), scalp or ball())


def uncleaned(recipe, scalp):
    """Curves after the shape stack of a recipe."""
    surface, curves = Scalp(scalp, recipe.scalp.region), Curves.from_list([])
    helpers = {name: helper.inline_curve() for name, helper in recipe.curves.items()}
    meshes = {name: mesh.inline_mesh(name) for name, mesh in recipe.meshes.items()}
    for name, operator in [
        ("guides", recipe.guides),
        ("locks", recipe.locks),
        *((one.op, one) for one in recipe.shape),
    ]:
        curves = operator.apply(curves, Context(recipe.seed, surface, name, recipe.locks.points, helpers, meshes))
    return curves


def step(op, more=""):
    return f"[[shape]]\nop = '{op}'\n{OPERATORS[op]}\n{more}\n"


def grid(curves):
    return curves.points.reshape(len(curves), -1, 3)


def on_sheet(operator, lines, ids=None, top=""):
    """An operator applied to polylines on a flat scalp (y = 0)."""
    recipe = parse_recipe(f"ringlet = 2\n{top}{TAIL}[[shape]]\n{operator}")
    surface = Scalp(sheet(), None)
    curves = surface.bind(Curves.from_list([np.asarray(line, float) for line in lines], ids), 1e-3, "test")
    helpers = {name: helper.inline_curve() for name, helper in recipe.curves.items()}
    return recipe.shape[0].apply(curves, Context(1, surface, recipe.shape[0].op, 64, helpers))


def upright(count=11, height=0.1, x=0.02):
    u = np.linspace(0.0, height, count)
    return np.stack([0 * u + x, u, 0 * u], axis=1)


# Invariants


@pytest.mark.parametrize("op", OPERATORS)
def test_every_operator_changes_shapes_and_leaves_roots_and_names(op):
    plain, shaped = locks(), locks(step(op))
    assert np.abs(shaped.points - plain.points).max() > 1e-3
    np.testing.assert_allclose(shaped.roots, plain.roots, atol=1e-12)
    assert np.array_equal(shaped.ids, plain.ids) and np.isfinite(shaped.points).all()


@pytest.mark.parametrize("op", [op for op in OPERATORS if op != "clump"])  # its centres are locks
def test_operators_move_no_lock_when_another_is_removed(op):
    more, fewer = locks(step(op), 41), locks(step(op), 40)
    same = more.take(np.isin(more.ids, fewer.ids))
    np.testing.assert_allclose(same.points, fewer.points, atol=1e-12)


@pytest.mark.parametrize("op", OPERATORS)
def test_a_mask_of_zero_and_a_blend_of_zero_change_nothing(op):
    plain = locks()
    for more in ("mask = 0", "blend = 0", "mask = { region = 'scalp', invert = true }", "mask = { where = 'id < 0' }"):
        assert np.array_equal(locks(step(op, more)).points, plain.points)


@pytest.mark.parametrize("op", OPERATORS)
def test_a_mask_by_lock_changes_its_locks_fully_and_no_others(op):
    plain, all_of_them, some = locks(), locks(step(op)), locks(step(op, "mask = { where = 'id % 2 == 0' }"))
    even = plain.ids % 2 == 0
    assert 5 < even.sum() < 35
    assert np.array_equal(grid(some)[~even], grid(plain)[~even])
    np.testing.assert_allclose(grid(some)[even], grid(all_of_them)[even], atol=1e-12)


@pytest.mark.parametrize("op", OPERATORS)
def test_blend_interpolates_between_both_shapes_without_a_jump(op):
    ends = grid(locks()), grid(locks(step(op)))
    shapes = [ends[0], *(grid(locks(step(op, f"blend = {b}"))) for b in (0.25, 0.5, 0.75)), ends[1]]
    whole = np.linalg.norm(ends[1] - ends[0], axis=2).max()
    steps = [np.linalg.norm(b - a, axis=2).max() for a, b in pairwise(shapes)]
    assert max(steps) < 0.6 * whole + 1e-9


@pytest.mark.parametrize("op", KEEPING_LENGTH)
def test_operators_that_rotate_locks_keep_their_lengths_under_any_mask(op):
    plain = locks().lengths()
    for more in ("", "mask = { ramp = [[0, 0], [1, 1]] }", "blend = 0.4"):
        np.testing.assert_allclose(locks(step(op, more)).lengths(), plain, rtol=1e-9)


def test_a_mask_with_a_ramp_leaves_the_base_of_locks():
    plain, shaped = grid(locks()), grid(locks(step("scraggle", "mask = { ramp = [[0.5, 0], [0.6, 1]] }")))
    base = plain.shape[1] // 2
    assert np.array_equal(shaped[:, :base], plain[:, :base])
    assert np.abs(shaped[:, -1] - plain[:, -1]).min() > 0.0


def test_a_region_mask_acts_in_its_region_with_a_falloff():
    scalp = ball()
    front = scalp.triangles[scalp.points[scalp.triangles].mean(axis=1)[:, 2] > 0.0]
    scalp.regions["front"] = np.flatnonzero(scalp.points[scalp.triangles].mean(axis=1)[:, 2] > 0.0).astype(np.int32)
    assert len(front)
    plain = locks(count=200, scalp=scalp)
    moved = lambda mask: np.abs(  # noqa: E731
        grid(locks(step("lift", f"mask = {mask}"), 200, scalp=scalp)) - grid(plain)
    ).max(axis=(1, 2))
    hard, soft = moved("{ region = 'front' }"), moved("{ region = 'front', falloff = 3 }")
    behind = plain.roots[:, 2] < -0.012  # the boundary of the region follows facets
    near, far = behind & (plain.roots[:, 2] > -0.02), plain.roots[:, 2] < -0.05
    assert near.sum() > 3 and far.sum() > 3
    assert not hard[behind].any() and not soft[far].any()
    assert soft[near].all()


@pytest.mark.parametrize(("unit", "half"), [("cm", "4"), ("mm", "40"), ("m", "0.04")])
def test_lengths_of_expressions_count_in_the_unit_of_the_recipe(unit, half):
    curves = Curves.from_list([upright(x=x) for x in np.linspace(-0.08, 0.08, 9)])

    def weights(unit, where):
        text = f"ringlet = 2\nunit = '{unit}'\n[[shape]]\nop = 'bend'\nmask = {{ where = '{where}' }}\n"
        mask = parse_recipe(text).shape[0].mask
        assert not mask.everywhere and mask.where == where
        return mask.weights(curves, sheet(), Random(1, "mask"), "mask")[:, 0]

    right = weights("m", "x > 0.05")
    assert 0 < right.sum() < len(right)
    np.testing.assert_array_equal(weights(unit, f"x > 1.25 * {half}"), right)
    np.testing.assert_array_equal(weights(unit, f"length > 2 * {half}"), np.ones(len(curves)))
    np.testing.assert_array_equal(weights(unit, f"length > 3 * {half}"), np.zeros(len(curves)))


def test_a_painted_mask_weights_every_lock_by_the_value_at_its_root():
    scalp = ball()
    scalp.maps["right"] = (scalp.points[scalp.triangles][:, :, 0] > 0.0).astype(float)
    plain, shaped = locks(scalp=scalp), locks(step("bend", "mask = { map = 'right' }"), scalp=scalp)
    moved = np.abs(grid(shaped) - grid(plain)).max(axis=(1, 2)) > 0.0
    assert moved[plain.roots[:, 0] > 0.02].all() and not moved[plain.roots[:, 0] < -0.02].any()


def test_invalid_masks_are_refused_in_one_line():
    for mask, words in (
        ("{ map = 'nothing' }", "scraggle.mask.map is 'nothing', which neither the locks nor ball have"),
        ("{ region = 'scalpp' }", "scraggle.mask.region: ball has no region 'scalpp'; it has: scalp"),
        ("{ where = '1 / (id - id)' }", "not a finite number on lock"),
    ):
        with pytest.raises(UserError) as error:
            locks(step("scraggle", f"mask = {mask}"))
        assert words in str(error.value) and "\n" not in str(error.value)
    for mask, words in (
        ("{ where = 'idd > 3' }", "shape[0].mask.where has 'idd', which is not known; did you mean 'id'?"),
        ("{ where = '__import__(1)' }", "shape[0].mask.where is '__import__(1)'; may use only"),
        ("{ where = 'id.real' }", "may use only numbers, comparisons"),
        ("{ where = 'id >' }", "must be an expression"),
        ("2", "shape[0].mask is 2; must be at most 1"),
    ):
        with pytest.raises(UserError) as error:
            locks(step("scraggle", f"mask = {mask}"))
        assert words in str(error.value) and "\n" not in str(error.value)


# Effects


def test_smooth_removes_short_waves_and_halves_those_of_its_size():
    u = np.linspace(0.0, 0.16, 161)
    wave = lambda length: np.stack([0.0003 * np.sin(2 * np.pi * u / length), u, 0 * u], axis=1)  # noqa: E731
    smoothed = on_sheet("op = 'smooth'\nwavelength = 2", [wave(0.005), wave(0.02), wave(0.08), upright(161, 0.16)])
    height = lambda k: np.ptp(smoothed[k][40:120, 0]) / 0.0006  # noqa: E731
    assert height(0) < 0.01
    assert height(1) == pytest.approx(0.5, abs=0.03)
    assert height(2) > 0.98
    np.testing.assert_allclose(smoothed[3], upright(161, 0.16), atol=1e-9)


def test_length_scales_sets_or_cuts():
    bent = upright()
    bent[6:, 0] += np.linspace(0.01, 0.05, 5)
    length = np.linalg.norm(np.diff(bent, axis=0), axis=1).sum()
    scaled = on_sheet("op = 'length'\nfactor = 0.5", [bent])
    np.testing.assert_allclose(scaled[0] - bent[0], 0.5 * (bent - bent[0]), atol=1e-12)
    assert on_sheet("op = 'length'\nto = 6", [bent]).lengths()[0] == pytest.approx(0.06)
    cut = on_sheet("op = 'length'\nto = 6\ncut = true", [bent])
    assert cut.lengths()[0] == pytest.approx(0.06, rel=0.02)  # the cut is a chord of a corner
    assert np.abs(cut[0][-1] - bent).sum(axis=1).min() < 0.02 and cut.lengths()[0] < length
    np.testing.assert_allclose(on_sheet("op = 'length'\nto = 90\ncut = true", [bent])[0], bent, atol=1e-9)


def test_length_is_random_or_painted():
    scalp = ball()
    scalp.maps["short"] = np.where(scalp.points[scalp.triangles][:, :, 0] > 0.0, 0.5, 1.0)
    plain = locks(scalp=scalp)
    painted = locks("[[shape]]\nop = 'length'\nfactor = { value = 1, map = 'short' }\n", scalp=scalp)
    change = painted.lengths() / plain.lengths()
    assert np.allclose(change[plain.roots[:, 0] > 0.02], 0.5) and np.allclose(change[plain.roots[:, 0] < -0.02], 1.0)
    chance = locks("[[shape]]\nop = 'length'\nfactor = { value = 1, vary = 0.3 }\n").lengths() / plain.lengths()
    assert 0.7 <= chance.min() < 0.8 and 1.2 < chance.max() <= 1.3


def test_lift_rotates_a_lock_towards_the_normal_but_not_beyond():
    lying = np.stack([np.linspace(0, 0.05, 6), np.linspace(0, 0.05, 6), np.zeros(6)], axis=1)  # inclined by 45°
    for angle, left in ((20, 25), (45, 0), (80, 0), (-30, 75)):
        lifted = on_sheet(f"op = 'lift'\nangle = {angle}", [lying])[0]
        chord = lifted[-1] / np.linalg.norm(lifted[-1])
        assert np.degrees(np.arccos(min(chord[1], 1.0))) == pytest.approx(left, abs=1e-4)


def test_bend_makes_an_arc_of_the_angle_towards_its_direction():
    bent = on_sheet("op = 'bend'\nangle = 90\ntoward = [1, 0, 0]", [upright(41)])[0]
    edges = np.diff(bent, axis=0) / np.linalg.norm(np.diff(bent, axis=0), axis=1, keepdims=True)
    turn = np.degrees(np.arccos(np.clip(np.sum(edges[1:] * edges[:-1], axis=1), -1, 1)))
    np.testing.assert_allclose(turn, 90 / 40, rtol=1e-6)
    np.testing.assert_allclose(edges[-1], [1, 0, 0], atol=1e-6)
    radius = 0.1 / (np.pi / 2)
    np.testing.assert_allclose(bent[-1] - bent[0], [radius, radius, 0], atol=0.002)


def test_noise_moves_neighbours_together_and_scraggle_does_not():
    pair = [upright(x=0.02), upright(x=0.0201), upright(x=-0.08)]
    for op, together in (("noise", True), ("scraggle", False)):
        tips = [curve[-1] for curve in on_sheet(f"op = '{op}'\nmagnitude = 2\nwavelength = 3", pair)]
        moved = [tip - curve[-1] for tip, curve in zip(tips, pair, strict=True)]
        assert (np.linalg.norm(moved[0] - moved[1]) < 0.05 * np.linalg.norm(moved[0])) == together
        assert np.linalg.norm(moved[0] - moved[2]) > 0.2 * np.linalg.norm(moved[0])


@pytest.mark.parametrize("op", ["scraggle", "noise", "frizz"])
def test_displacements_keep_lengths_or_say_how_much_longer_locks_become(op):
    text = f"[[shape]]\nop = '{op}'\nmagnitude = 6\nwavelength = 1.5\n"
    plain, longer, kept = locks(), locks(text), locks(f"{text}keep = 'length'\n")
    assert longer.lengths().max() > 2.0 * plain.lengths().max()
    np.testing.assert_allclose(kept.lengths(), plain.lengths(), rtol=1e-3)
    assert np.abs(kept.points - plain.points).max() > 2e-3
    recipe = "ringlet = 2\n[guides]\ncount = 8\n[locks]\ncount = 10\n"
    said, silent = (
        make_groom(parse_recipe(f"{recipe}{text}{keep}"), ball()).conflicts for keep in ("", "keep = 'length'")
    )
    assert any(f"{op} makes" in line and "keep = 'length'" in line for line in said)
    assert not any("makes" in line for line in silent)


def test_frizz_is_transverse_and_refused_on_a_coarse_shape():
    frizzed = on_sheet("op = 'frizz'\nmagnitude = 0.2\nwavelength = 2", [upright(61)])[0]
    np.testing.assert_allclose(frizzed[:, 1], upright(61)[:, 1], atol=1e-12)
    assert 0.0005 < np.abs(frizzed[10:, [0, 2]] - [0.02, 0]).max() < 0.02
    with pytest.raises(UserError, match=r"frizz.wavelength is 0.002 m, less than the 0.01 m between .* to 101"):
        on_sheet("op = 'frizz'\nwavelength = 0.2", [upright()])


def test_clumps_of_a_second_level_are_within_those_of_the_first():
    def kinds(shape):
        tips = grid(locks(shape, 300))[:, -1]
        return len(np.unique(np.round(tips, 6), axis=0))

    one = "[[shape]]\nop = 'clump'\nsize = 4\ntightness = { value = 1, vary = 0 }\n"
    loose = kinds("")
    assert kinds(one) < loose / 4
    soft = one.replace("value = 1", "value = 0.5")
    near = lambda shape: np.median(  # noqa: E731
        np.sort(np.linalg.norm((t := grid(locks(shape, 300))[:, -1])[:, None] - t, axis=2), axis=1)[:, 1]
    )
    assert near(soft + "levels = 3\n") < 0.7 * near(soft)


def test_a_plain_amount_clumps_every_lock_as_much():
    one = "[[shape]]\nop = 'clump'\nsize = 4\ntightness = {}\n"
    plain, table, varied = (locks(one.format(value)) for value in ("1", "{ value = 1, vary = 0 }", "{ value = 1 }"))
    np.testing.assert_array_equal(plain.points, table.points)
    assert np.abs(varied.points - plain.points).max() > 1e-3
    tips = plain.points[plain.offsets[1:] - 1]
    assert len(np.unique(tips.round(9), axis=0)) < 0.7 * len(tips)  # all of a clump end at its centre


def test_locks_follow_no_leader_that_leans_to_the_other_side_of_a_parting():
    line = np.linspace(0.0, 0.1, 13)[:, None]
    roots = np.random.default_rng(1).uniform(-0.05, 0.05, (300, 3)) * [1.0, 0.0, 1.0]
    shapes = roots[:, None] + line * np.where(roots[:, :1] < 0.0, -1.0, 1.0)[:, None] * [1.0, 0.0, 0.0]
    across = []
    for apart in (180.0, 60.0):
        leader = leaders(shapes, 0.03, apart, Scalp(sheet(), None), 1)
        across.append(int((roots[:, 0] * roots[leader, 0] < 0.0).sum()))
        assert len(np.unique(leader)) < 100
    assert across[0] > 5 and across[1] == 0


def test_locks_part_at_a_plane_and_at_a_drawn_line():
    beside = [upright(x=0.01), upright(x=-0.01), upright(x=0.09)]
    for parting in ("", "part_line = { curve = 'middle' }"):
        text = f"op = 'part'\namount = 3\n{parting}\n[curves.middle]\npoints = [[0, 0, -9], [0, 0, 9]]"
        right, left, far = on_sheet(text, beside)
        assert right[-1, 0] > 0.05 and left[-1, 0] < -0.05
        assert far[-1, 0] - 0.09 < 0.5 * (right[-1, 0] - 0.01)


def test_gathered_locks_meet_at_the_tie_keep_their_length_and_hang_along_the_tail():
    gathered, plain = locks("[[shape]]\nop='length'\nto=40\n" + step("tie")), locks()
    np.testing.assert_allclose(gathered.lengths(), 0.4, rtol=0.05)  # chords cut corners
    tie = np.array([0, 0.08, -0.08])
    distance = np.linalg.norm(grid(gathered)[:, :, None] - tie, axis=3).min(axis=(1, 2))
    assert distance.max() < 0.025  # radius of the tie plus spacing of points
    assert grid(gathered)[:, -1, 1].max() < grid(plain)[:, -1, 1].min() + 0.1
    assert (np.linalg.norm(grid(gathered), axis=2) > 0.085).all()  # around the head


def test_flyaways_have_the_requested_share_and_other_locks_stay():
    plain, flown = locks(count=400), locks("[[shape]]\nop='flyaways'\nshare=0.2\n", 400)
    moved = np.abs(grid(flown) - grid(plain)).max(axis=(1, 2)) > 0.0
    assert 0.14 < moved.mean() < 0.26


def test_straightened_locks_point_where_their_tips_were():
    shaped, plain = grid(locks(step("straighten"))), grid(locks())
    edges = np.diff(shaped, axis=1)
    edges /= np.linalg.norm(edges, axis=2, keepdims=True)
    chord = plain[:, -1] - plain[:, 0]
    chord /= np.linalg.norm(chord, axis=1, keepdims=True)
    np.testing.assert_allclose(edges, np.broadcast_to(chord[:, None], edges.shape), atol=1e-9)


def test_attracted_locks_end_on_the_curve_and_those_out_of_reach_stay():
    line = "[curves.line]\npoints = [[3, 0, 0], [3, 4, 2], [3, 9, 3]]"
    near, far = on_sheet(
        f"op = 'attract'\ncurve = 'line'\namount = 1\nfalloff = 5\n{line}", [upright(x=0.03), upright(x=-0.05)]
    )
    np.testing.assert_allclose(near[-1], [0.03, 0.09, 0.03], atol=1e-9)
    np.testing.assert_allclose(far, upright(x=-0.05), atol=1e-12)


def test_an_unknown_helper_curve_is_refused_with_the_nearest_name():
    with pytest.raises(UserError, match=r"attract.curve is 'tial', which is no helper curve; did you mean 'tail'"):
        locks("[[shape]]\nop='attract'\ncurve='tial'\n")
    with pytest.raises(UserError, match=r"curves.tail needs either 'points' or a 'file'"):
        parse_recipe("ringlet = 2\n[curves.tail]\n")


def test_values_by_region_and_by_lock():
    scalp = ball()
    scalp.regions["right"] = np.flatnonzero(scalp.points[scalp.triangles].mean(axis=1)[:, 0] > 0.0).astype(np.int32)
    plain = locks(scalp=scalp)
    one = int(plain.ids[7])
    text = (
        f"[[shape]]\nop = 'length'\nfactor = {{ value = 1, region = {{ right = 0.5 }}, lock = {{ {one} = 0.25 }} }}\n"
    )
    change = locks(text, scalp=scalp).lengths() / plain.lengths()
    others = np.arange(40) != 7
    assert change[7] == pytest.approx(0.25)
    assert np.allclose(change[others & (plain.roots[:, 0] > 0.02)], 0.5)
    assert np.allclose(change[others & (plain.roots[:, 0] < -0.02)], 1.0)
    with pytest.raises(UserError, match=r"shape\[0\].factor for region 'right' is 500; must be at most 100"):
        locks(text.replace("right = 0.5", "right = 500"))


def test_a_recipe_of_all_operators_makes_a_groom():
    text = (
        "ringlet = 2\n[scalp]\nregion = 'scalp'\n"
        + TAIL
        + ROUND
        + GROWN.format(count=40)
        + "".join(map(step, OPERATORS))
    )
    groom = make_groom(parse_recipe(text), ball())
    assert len(groom.locks) == 40 and np.isfinite(groom.locks.points).all()


def test_cut_locks_end_on_the_plane_within_their_spread_and_keep_their_way_to_it():
    plain, cut = locks(), locks("[[shape]]\nop = 'cut'\ntoward = [0, 0, 1]\nat = 5\nspread = 0.2\nleast = 1")
    middle = Scalp(ball(), "scalp").middle
    roots, tips, before = (lock[:, :, 2] - middle[2] for lock in (grid(cut)[:, :1], grid(cut)[:, -1:], grid(plain)))
    beyond, crosses = roots[:, 0] > 0.052, before.max(axis=1) > 0.052
    inside = crosses & ~(before[:, 0] > 0.045)
    assert inside.sum() > 3 and beyond.sum() > 3 and (~crosses).sum() > 3
    assert np.abs(tips[inside, 0] - 0.05).max() < 0.002 + 1e-9 and np.ptp(tips[inside, 0]) > 0.001
    np.testing.assert_allclose(cut.lengths()[beyond], 0.01, rtol=0.02)
    kept = before.max(axis=1) < 0.048
    assert np.array_equal(grid(cut)[kept], grid(plain)[kept])
    # What is left lies on the spline of the old shape.
    whole = plain.take(inside)
    fine = _core.resample_curves(np.ascontiguousarray(whole.points, np.float64), whole.offsets, 600)
    fine = fine.reshape(len(whole), 600, 3)
    a, b = fine[:, :-1], fine[:, 1:]
    for lock, start, edge in zip(grid(cut)[inside], a, b - a, strict=True):
        t = np.clip(np.einsum("pkx,kx->pk", lock[:, None] - start, edge) / np.sum(edge**2, axis=1), 0.0, 1.0)
        off = np.linalg.norm(lock[:, None] - (start + t[:, :, None] * edge), axis=2).min(axis=1)
        assert off.max() < 1e-6


def _turning(points):
    """Curvature at the inner points of a polyline (n, 3), shape (n - 2,) [rad/m]."""
    edges = np.diff(points, axis=0)
    lengths = np.linalg.norm(edges, axis=1)
    cosines = np.sum(edges[1:] * edges[:-1], axis=1) / (lengths[1:] * lengths[:-1])
    return np.arccos(np.clip(cosines, -1.0, 1.0)) / (0.5 * (lengths[1:] + lengths[:-1]))


def test_a_smooth_shape_of_few_points_has_no_bends_at_them():
    u = (np.arange(9) + 0.5) / 9
    heading = np.stack([0 * u + 1.0, 0.3 - 8.0 * u, 0 * u], axis=1)  # a guide that falls from a parting
    guide = np.concatenate([np.zeros((1, 3)), np.cumsum(heading / np.linalg.norm(heading, axis=1)[:, None], axis=0)])
    shape = _core.resample_curves(guide, np.array([0, 10], np.int32), 20)
    bend = _turning(_core.resample_curves(shape, np.array([0, 20], np.int32), 100))
    before, after = np.maximum.accumulate(bend), np.maximum.accumulate(bend[::-1])[::-1]
    assert (np.minimum(before, after) - bend).max() < 0.02 * bend.max()  # one bend, at the parting
    assert np.abs(np.diff(bend)).max() < 0.15 * bend.max()


def test_a_shape_of_uneven_points_is_as_smooth():
    along = np.cumsum([0.0, 0.1, 0.4, 0.1, 0.1, 0.5, 0.2, 0.1, 0.4])
    circle = np.stack([np.cos(along), np.sin(along), 0 * along], axis=1)
    dense = _core.resample_curves(circle, np.array([0, len(along)], np.int32), 60)
    np.testing.assert_allclose(np.linalg.norm(dense, axis=1), 1.0, atol=1e-3)
    np.testing.assert_allclose(_turning(dense)[4:-4], 1.0, atol=0.1)


def test_a_cut_shape_has_no_bends_at_the_points_it_had():
    text = """
ringlet = 2
[scalp]
region = "scalp"
[guides]
count = 30
length = 20
lift = 0.2
gravity_bend = 3
[locks]
count = 60
shape_points = 12
points = 80
[[shape]]
op = "length"
factor = 0.7
cut = true
[collide]
margin = 0
"""
    locks = make_groom(parse_recipe(text), ball(0.02)).locks.points.reshape(60, 80, 3)
    bend = np.array([_turning(points) for points in locks])
    assert (np.abs(np.diff(bend, axis=1)).max(axis=1) < 0.15 * bend.max(axis=1)).mean() > 0.9
