"""Hairs around locks."""

import numpy as np
import pytest
from PIL import Image
from shapes import ball, rotation, sheet
from usd_scenes import write_head

import ringlet
from ringlet import Curves, UserError
from ringlet.groom import HairMemory, make_groom, make_hairs, parse_recipe

RECIPE = """
ringlet = 2
[scalp]
region = "scalp"
[guides]
count = 20
[locks]
count = 40
points = 60
[curl]
preset = "3C"
curls = 5
[hairs]
per_lock = 12
"""


def groom(hairs=""):
    """A groom with settings of its hairs, by default 12 per lock."""
    recipe = RECIPE if "per_lock" not in hairs else RECIPE.replace("per_lock = 12\n", "")
    return make_groom(parse_recipe(recipe + hairs), ball())


def test_the_first_hair_of_a_lock_is_bit_identical_to_the_lock():
    made = groom()
    hairs = make_hairs(made).curves
    first = hairs.points.reshape(40, 12, 60, 3)[:, 0]
    assert hairs.points.dtype == np.float32
    assert np.array_equal(first, made.locks.points.astype(np.float32).reshape(40, 60, 3))


def test_the_first_hair_is_the_simulated_guide_when_locks_move():
    made = groom()
    moved = (made.locks.points + 0.01 * np.sin(40.0 * made.locks.points[:, [1, 2, 0]])).astype(np.float32)
    hairs = make_hairs(made).deformed(moved, made.scalp.points).reshape(40, 12, 60, 3)
    assert np.array_equal(hairs[:, 0], moved.reshape(40, 60, 3))


def test_hairs_move_rigidly_with_locks_and_scalp():
    made = groom()
    hairs = make_hairs(made)
    turn, shift = rotation((1.0, 0.3, -0.5), 100.0), np.array([0.2, 0.1, -0.3])
    now = hairs.deformed(made.locks.points @ turn.T + shift, made.scalp.points @ turn.T + shift)
    assert np.allclose(now, hairs.curves.points @ turn.T + shift, atol=2e-6)


def test_hairs_of_other_point_counts_follow_the_lock():
    made = groom("points = 119\n")
    first = make_hairs(made).curves.points.reshape(40, 12, 119, 3)[:, 0]
    assert np.allclose(first[:, ::2], made.locks.points.reshape(40, 60, 3), atol=1e-6)


def test_roots_of_hairs_are_on_the_scalp_around_their_lock():
    made = groom("root_radius = '4 mm'\n")
    hairs = make_hairs(made).curves
    assert np.isin(hairs.curve["root_triangle"], ball().regions["scalp"]).all()
    at = np.einsum(
        "hc,hcx->hx", hairs.curve["root_barycentric"], ball().points[ball().triangles[hairs.curve["root_triangle"]]]
    )
    assert np.allclose(hairs.roots, at, atol=1e-7)
    assert np.linalg.norm(at - made.locks.roots[hairs.curve["lock"]], axis=1).max() < 0.0045


def test_hairs_stay_within_the_radius_of_their_lock():
    hairs = make_hairs(groom("lock_radius = '1 mm'\nstray = 0\nfrizz = 0\nshorter = 0\n")).curves
    bundle = hairs.points.reshape(40, 12, 60, 3)[:, :, 10:]
    assert np.linalg.norm(bundle - bundle[:, :1], axis=3).max() < 0.00101


def test_a_fraction_selects_some_hairs_and_a_smaller_one_some_of_these():
    made = groom()
    everything, half, few = (make_hairs(made, fraction=fraction).curves for fraction in (1.0, 0.5, 0.25))
    assert len(half) == 40 * 6 and len(few) == 40 * 3
    assert np.isin(few.ids, half.ids).all()
    assert np.array_equal(everything.take(np.isin(everything.ids, half.ids)).points, half.points)
    with pytest.raises(UserError, match="fraction is 0"):
        make_hairs(made, fraction=0.0)


def test_a_fraction_of_the_hairs_keeps_the_thickness_of_locks():
    made = groom("per_lock = 80\nlock_radius = '1 mm'\nstray = 0\nfrizz = 0\nshorter = 0\n")

    def radius(fraction):
        hairs = make_hairs(made, fraction=fraction).curves
        bundle = hairs.points.reshape(40, -1, 60, 3)[:, :, 30]
        return np.sqrt(np.sum((bundle - bundle[:, :1]) ** 2, axis=2).mean(axis=1))

    assert radius(0.3) == pytest.approx(radius(1.0), rel=0.15)


def test_hairs_thin_out_towards_the_tip():
    hairs = make_hairs(groom("width = { value = 0.01, vary = 0, ramp = [[0, 1], [1, 0.2]] }\n")).curves
    width = hairs.point["width"].reshape(-1, 60)
    assert np.allclose(width[:, 0], 1e-4) and np.allclose(width[:, -1], 2e-5)


def test_hairs_have_unique_ids_and_texture_coordinates():
    made = groom()
    made.scalp.uv = made.scalp.points[made.scalp.triangles][:, :, [0, 2]]
    hairs = make_hairs(made).curves
    assert len(np.unique(hairs.ids)) == len(hairs)
    assert np.array_equal(hairs.curve["guide_id"], made.locks.ids[hairs.curve["lock"]])
    assert np.allclose(hairs.curve["st"], hairs.roots[:, [0, 2]], atol=1e-6)


def test_hair_settings_of_a_file_are_checked():
    made = groom()
    made.hairs["per_lock"] = 0
    with pytest.raises(UserError, match=r"groom: hairs: per_lock is 0; must be at least 1"):
        make_hairs(made)


def test_single_locks_have_their_own_number_of_hairs():
    lock = groom().locks.ids[7]
    hairs = make_hairs(groom(f"per_lock = {{ value = 12, lock = {{ {lock} = 3 }} }}\n"))
    count = np.bincount(hairs.curves.curve["lock"])
    assert count[7] == 3 and (np.delete(count, 7) == 12).all()


def section(hairs):
    """Principal coordinates of the hairs in a cross-section of the first lock near its middle [m]."""
    bundle = make_hairs(groom("lock_radius = '1 mm'\nstray = 0\nfrizz = 0\nshorter = 0\nper_lock = 200\n" + hairs))
    points = bundle.curves.points.reshape(40, 200, 60, 3)[0, :, 20].astype(float)
    off = points - points[0]
    return off @ np.linalg.svd(off)[2].T[:, :2]


def test_the_cross_section_is_round_or_a_ribbon():
    widths = np.ptp(section(""), axis=0)
    assert widths[1] > 0.9 * widths[0]
    for flatness in (0.7, 1.0):
        widths = np.ptp(section(f"lock_flatness = {flatness}\n"), axis=0)
        assert widths[1] == pytest.approx((1.0 - flatness) * widths[0], abs=0.05 * widths[0])


def test_hairs_of_a_hollow_lock_are_at_its_rim():
    filled, hollow = (np.linalg.norm(section(f"hollow = {value}\n"), axis=1)[1:] for value in (0, 1))
    assert np.ptp(hollow) < 1e-6 < 1e-4 < np.ptp(filled)


def test_a_taper_draws_hairs_together_at_the_tip():
    settings = "lock_radius = { value = '1 mm', ramp = [[0, 1]] }\nstray = 0\nfrizz = 0\nshorter = 0\n"
    for taper, left in ((0.0, 1.0), (0.6, 0.4), (1.0, 0.0)):
        bundle = make_hairs(groom(settings + f"lock_taper = {taper}\n")).curves.points.reshape(40, 12, 60, 3)
        away = np.linalg.norm(bundle - bundle[:, :1], axis=3).max(axis=(0, 1))
        assert away[-1] == pytest.approx(left * away[20] / (1.0 - taper * 20 / 59), abs=1e-5)


def test_strays_leave_their_lock_and_change_continuously_with_their_fraction():
    def at(stray):
        return make_hairs(groom(f"stray = {stray}\nstray_distance = '9 mm'\nfrizz = 0\nshorter = 0\n")).curves.points

    tips = at(0.25).reshape(40, 12, 60, 3)[:, 1:, -1] - at(0.0).reshape(40, 12, 60, 3)[:, 1:, -1]
    assert np.mean(np.linalg.norm(tips, axis=2) > 0.001) == pytest.approx(0.25, abs=0.08)
    moves = [np.linalg.norm(at(0.25 + step) - at(0.25), axis=1).max() for step in (2e-3, 2e-4)]
    assert moves[1] < 0.2 * moves[0]


def two_locks(lean, blend):
    """Hairs of two straight locks 8 mm apart, tilted apart by ``lean`` [degrees] each, shape (2, 50, 40, 3)."""
    up = np.linspace(0.0, 0.06, 12)
    angle = np.radians([-lean, lean])
    lines = [
        np.stack([x + up * np.sin(a), up * np.cos(a), 0.0 * up], axis=1)
        for x, a in zip((-0.004, 0.004), angle, strict=True)
    ]
    text = f"""
ringlet = 2
[guides]
file = "g.usda"
[locks]
points = 40
[hairs]
per_lock = 50
root_radius = "6 mm"
lock_radius = "1 mm"
stray = 0
frizz = 0
shorter = 0
blend = {blend}
"""
    made = make_groom(parse_recipe(text), sheet(), drawn_guides=Curves.from_list(lines, ids=[0, 1]))
    return make_hairs(made).curves.points.reshape(2, 50, 40, 3)


def test_hairs_between_two_locks_mix_both_but_not_across_a_part_line():
    apart, mixed = two_locks(0.0, 0.0)[:, :, 20, 0], two_locks(0.0, 1.0)[:, :, 20, 0]
    assert np.abs(apart).min() > 0.0029  # a gap between the locks without blend
    assert np.abs(mixed).min() < 0.0015  # filled by mixed hairs
    assert np.allclose(mixed[:, 0], [-0.004, 0.004], atol=1e-6)  # the first hairs stay
    assert np.array_equal(two_locks(40.0, 0.0), two_locks(40.0, 1.0))


def test_mixed_hairs_keep_their_own_roots():
    assert np.allclose(two_locks(0.0, 0.0)[:, :, 0], two_locks(0.0, 1.0)[:, :, 0], atol=1e-7)


def test_wider_hairs_compensate_for_a_smaller_fraction():
    made = groom("width = { value = 0.01, vary = 0 }\n")
    every, few = make_hairs(made).curves, make_hairs(made, fraction=0.25, wider=True).curves
    assert len(few) == len(every) // 4
    assert few.point["width"].sum() == pytest.approx(every.point["width"].sum(), rel=1e-5)


def test_cached_hairs_equal_rebuilt_hairs():
    memory = HairMemory()
    make_hairs(groom(), memory=memory)
    kept = memory.hairs
    wide = make_groom(parse_recipe(RECIPE.replace('preset = "3C"', 'preset = "3C"\nwidth = 1.4')), ball())
    again = make_hairs(wide, memory=memory).curves.points.copy()
    assert memory.hairs is kept
    assert np.array_equal(again, make_hairs(wide).curves.points)
    make_hairs(groom("root_radius = '5 mm'\n"), memory=memory)
    assert memory.hairs is not kept


def test_hairs_keep_their_curl_when_locks_swing():
    made = groom("lock_radius = '0.3 mm'\nstray = 0\nfrizz = 0\nshorter = 0\n")
    hairs = make_hairs(made)
    bent = made.locks.points.copy()
    for i, lock in enumerate(made.locks.points.reshape(40, 60, 3)):  # rotates every lock about its root by 140°
        bent[60 * i : 60 * i + 60] = lock[0] + (lock - lock[0]) @ rotation((1.0, 0.2, 0.3), 140.0).T
    now = hairs.deformed(bent, made.scalp.points).reshape(40, 12, 60, 3).astype(float)
    rest = hairs.curves.points.reshape(40, 12, 60, 3).astype(float)
    assert np.linalg.norm(now - rest, axis=3).max() > 0.03

    def bends(points):
        edges = np.diff(points[:, :, 12:], axis=2)
        edges /= np.linalg.norm(edges, axis=3, keepdims=True)
        return np.arccos(np.clip(np.sum(edges[:, :, 1:] * edges[:, :, :-1], axis=3), -1.0, 1.0)).sum(axis=2)

    assert np.allclose(bends(now), bends(rest), rtol=0.02)


def test_textures_of_hairs_are_stored_with_the_groom(tmp_path):
    write_head(tmp_path / "head.usdc")
    Image.fromarray(np.array([[255], [64]], np.uint8).repeat(2, axis=1)).save(tmp_path / "thick.png")
    (tmp_path / "a.recipe.toml").write_text(
        "ringlet = 2\n[scalp]\nfile = 'head.usdc'\nregion = 'scalp'\n[maps]\n1-thick = 'thick.png'\n"
        "[guides]\ncount = 10\n[locks]\ncount = 10\n"
        "[hairs]\nper_lock = 2\nwidth = { value = '0.1 mm', map = '1-thick' }\n"
    )
    made = ringlet.build_groom(tmp_path / "a.recipe.toml")
    ringlet.write_groom(made, tmp_path / "groom.usdc")
    back = ringlet.build_hairs(ringlet.read_groom(tmp_path / "groom.usdc")).curves
    np.testing.assert_allclose(back.point["width"], ringlet.build_hairs(made).curves.point["width"], rtol=1e-5)
    assert np.ptp(back.point["width"]) > 3e-5


def test_hairs_stay_on_their_locks_side_of_surfaces():
    made = groom("lock_radius = 0.004\n")
    hairs = make_hairs(made)
    # Parallel locks, half a millimetre below a roof.
    x, z = np.meshgrid(np.linspace(0.0, 0.1, 60), np.linspace(-0.1, 0.1, 40))
    locks = np.stack([x, 0 * x + 0.2, z], axis=-1)
    roof = sheet(20, 0.5)
    roof.points[:, 1] = 0.2005
    free = hairs.deformed(locks.reshape(-1, 3), made.scalp.points).reshape(40, 12, 60, 3)
    beside = [(made.scalp.points, made.scalp.triangles), (roof.points, roof.triangles)]
    kept = hairs.deformed(locks.reshape(-1, 3), made.scalp.points, surfaces=beside).reshape(40, 12, 60, 3)
    after_roots = np.s_[:, :, 10:]
    assert free[after_roots][..., 1].max() > 0.2015
    assert kept[after_roots][..., 1].max() < 0.2005 - 0.9e-4
    assert np.array_equal(kept[:, 0], free[:, 0])  # the first hairs keep the shape of their locks
    assert np.array_equal(kept[:, :, 0], free[:, :, 0])  # roots stay
    assert 0.2 < (kept == free).all(axis=(2, 3)).mean() < 0.8
    left = hairs.offset_fractions(locks.reshape(-1, 3), hairs.deformation(made.scalp.points), beside).reshape(
        40, 12, 60
    )
    assert np.array_equal((left < 255).any(axis=2), (kept != free).any(axis=(2, 3)))
    above, was = kept[..., 1] - 0.2, free[..., 1] - 0.2
    assert np.abs(above - left / 255.0 * was)[left < 255].max() < 0.004 * np.abs(was).max()
    far = (roof.points + [0.0, 0.1, 0.0], roof.triangles)
    assert np.array_equal(
        hairs.deformed(locks.reshape(-1, 3), made.scalp.points, surfaces=[far]).reshape(free.shape), free
    )


def test_cached_hairs_follow_a_map_that_was_painted_again():
    def painted(values):
        made = groom("lock_radius = { value = '3 mm', map = 'thick' }\n")
        made.scalp.maps["thick"] = np.full((len(made.scalp.triangles), 3), values)
        return made

    memory = HairMemory()
    make_hairs(painted(0.5), memory=memory)
    again = painted(1.0)
    assert np.array_equal(make_hairs(again, memory=memory).curves.points, make_hairs(again).curves.points)
