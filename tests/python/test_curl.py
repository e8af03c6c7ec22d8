"""Controls of the curl, on locks of known shape."""

import numpy as np
import pytest
from shapes import ball, sheet

from ringlet import Curves, UserError
from ringlet.groom import make_groom, parse_recipe

PLAIN = "irregularity = 0\nphase_spread = 0\nright_handed = 1\nstart = 0\n"
HEIGHT = 0.08


def straight(count=3, points=8, apart=0.02):
    """Straight guides of 80 mm in a row along x on the sheet."""
    up = np.linspace(0.0, HEIGHT, points)
    at = apart * (np.arange(count) - 0.5 * (count - 1))
    return Curves.from_list([np.stack([0 * up + x, up, 0 * up], axis=1) for x in at], ids=range(5, 5 + count))


def curled(settings, guides=None, points=240, plain=PLAIN, **options):
    """Locks of drawn guides with ``[curl]`` settings, shape (count, points, 3)."""
    kept = [line for line in plain.splitlines() if line.split(" ")[0] not in settings]
    recipe = "ringlet = 2\n[guides]\nfile='g.usda'\n[locks]\npoints = {}\n[collide]\nmargin = 0\n[curl]\n{}\n{}".format(
        points, "\n".join(kept), settings
    )
    locks = make_groom(parse_recipe(recipe), sheet(), drawn_guides=guides or straight(), **options).locks
    return locks.points.reshape(len(locks), points, 3)


def about(locks):
    """Radius [m] and unwrapped angle [turns] of locks about their straight guides, shapes (count, points)."""
    off = locks - straight(len(locks)).roots[:, None]
    off[:, 0] += [1e-15, 0.0, 0.0]  # defines the phase at the root
    radius, angle = np.hypot(off[..., 0], off[..., 2]), np.arctan2(off[..., 0], off[..., 2])
    return radius, np.unwrap(angle, axis=1) / (2.0 * np.pi)


def turns(locks):
    angle = about(locks)[1]
    return np.abs(angle[:, -1] - angle[:, 0])


# Width

WIDE = "curls = 6\nwidth = { value = 1, ramp = [[0, 1], [1, 0.5]] }"


def test_the_width_is_the_diameter_and_its_ramp_goes_from_root_to_tip():
    radius, _ = about(curled(WIDE))
    height = np.linspace(0.0, 1.0, 5)[1:]
    for one, lock in zip(radius, curled(WIDE), strict=True):
        at = np.interp(height * HEIGHT, lock[:, 1], one)
        assert np.allclose(at, 0.005 * (1.0 - 0.5 * height), atol=3e-5)


def test_the_width_is_painted_set_in_a_region_and_overridden_for_a_lock():
    scalp = sheet()
    left = np.flatnonzero(scalp.points[scalp.triangles][:, :, 0].mean(axis=1) < -0.01).astype(np.int32)
    scalp.regions["left"] = left
    scalp.maps["paint"] = np.where(scalp.points[scalp.triangles][:, :, 0] > 0.03, 0.5, 1.0)
    guides = straight(5, apart=0.03)
    width = "curls = 6\nwidth = { value = 1, map = 'paint', region = { left = 0.6 }, lock = { 7 = 0.2 } }"
    recipe = (
        f"ringlet = 2\n[guides]\nfile='g.usda'\n[locks]\npoints = 240\n[collide]\nmargin = 0\n[curl]\n{PLAIN}{width}"
    )
    locks = make_groom(parse_recipe(recipe), scalp, drawn_guides=guides).locks.points.reshape(5, 240, 3)
    off = locks - guides.roots[:, None]  # the fourth is a fifth between the painted values 1 and 0.5
    assert np.allclose(np.hypot(off[:, -1, 0], off[:, -1, 2]), [0.003, 0.003, 0.001, 0.0045, 0.0025], rtol=1e-3)


# Number of turns


def test_curls_pitch_and_curls_per_cm_count_the_same_turns():
    for how in ("curls = 8", "pitch = 1", "curls_per_cm = 1"):
        assert np.allclose(turns(curled(how)), 8.0, rtol=1e-3), how


def test_a_ramp_on_the_number_moves_turns_and_keeps_their_number():
    locks = curled("curls = { value = 8, ramp = [[0, 1], [1, 3]] }")
    _, angle = about(locks)
    lower = locks[:, :, 1] < 0.5 * HEIGHT
    assert np.allclose(turns(locks), 8.0, rtol=1e-3)
    assert np.ptp(angle[0][lower[0]]) == pytest.approx(8.0 * (0.5 * 1.5 / 2.0), rel=0.02)


def test_a_ramp_on_the_pitch_stretches_turns():
    assert np.allclose(turns(curled("pitch = { value = 1, ramp = [[0, 1], [1, 1]] }")), 8.0, rtol=1e-3)
    assert np.allclose(turns(curled("pitch = { value = 1, ramp = [[0, 2]] }")), 4.0, rtol=1e-3)


# Start, end, taper


def test_the_curl_opens_over_the_start_and_closes_over_the_end():
    locks = curled("curls = 8\nwidth = 1\nstart = 2\nend = 3")
    radius, _ = about(locks)
    height = locks[0, :, 1]
    assert radius[0, 0] < 1e-9 and radius[0, -1] < 1e-9
    assert np.allclose(radius[0][(height > 0.02) & (height < 0.05)], 0.005, rtol=1e-2)
    assert np.interp(0.01, height, radius[0]) == pytest.approx(0.0025, rel=0.05)
    assert np.interp(0.065, height, radius[0]) == pytest.approx(0.0025, rel=0.05)


def test_the_opening_and_the_closing_follow_their_ramps():
    locks = curled(
        "curls = 8\nwidth = 1\nstart = 4\nopening = [[0, 0.5], [1, 1]]\nend = 4\nclosing = [[0, 1], [1, 0.2]]"
    )
    radius, _ = about(locks)
    assert radius[0, 0] == pytest.approx(0.0025, rel=1e-3) and radius[0, -1] == pytest.approx(0.001, rel=1e-3)


def test_the_taper_narrows_the_tip_where_its_ramp_says():
    radius, _ = about(curled("curls = 8\nwidth = 1\ntaper = 0.75"))
    assert radius[0, -1] == pytest.approx(0.00125, rel=1e-3)
    late = curled("curls = 8\nwidth = 1\ntaper = { value = 0.75, ramp = [[0.5, 0], [1, 1]] }")
    radius = np.interp(0.03, late[0, :, 1], about(late)[0][0])
    assert radius == pytest.approx(0.005, rel=1e-3)


# Phase


def test_the_phase_turns_the_curl():
    same, quarter = (about(curled(f"curls = 4\nwidth = 1\nphase = {phase}"))[1][:, 60] for phase in (0, 90))
    assert np.allclose(np.ptp(same), 0.0, atol=1e-9)
    assert np.allclose(np.abs((quarter - same + 0.5) % 1.0 - 0.5), 0.25, atol=1e-3)


def phases(coherence):
    recipe = f"""
ringlet = 2
[scalp]
region = "scalp"
[guides]
count = 400
lift = 1
gravity_bend = 0
[locks]
points = 60
[collide]
margin = 0
[curl]
curls = 3
start = 0
right_handed = 1
phase_coherence = {coherence}
phase_wavelength = 4
"""
    groom = make_groom(parse_recipe(recipe), ball())
    roots, points = groom.guides.roots, groom.locks.points.reshape(400, 60, 3)
    normal = roots / np.linalg.norm(roots, axis=1, keepdims=True)
    across = np.cross(normal, [0.3, 0.1, 1.0])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    off = points[:, 4] - roots
    angle = np.arctan2(np.sum(off * np.cross(normal, across), axis=1), np.sum(off * across, axis=1))
    gaps = np.linalg.norm(roots[:, None] - roots[None], axis=2) + 10.0 * np.eye(400)
    return angle, gaps


def test_phase_coherence_of_neighbours_follows_its_setting():
    def coherence(value):
        angle, gaps = phases(value)
        return np.cos(angle - angle[gaps.argmin(axis=1)]).mean()

    own, half, shared = coherence(0.0), coherence(0.5), coherence(1.0)
    assert abs(own) < 0.2 < half < shared
    angle, gaps = phases(1.0)
    far = (gaps > 0.1) & (gaps < 9.0)
    assert np.cos(angle[:, None] - angle[None])[far].mean() < shared - 0.3


# Hand


def hand(points):
    """Handedness along the edges of a curve (n, 3): +1 right, -1 left."""
    edges = np.diff(points, axis=0)
    return np.sign(np.einsum("nx,nx->n", np.cross(edges[:-2], edges[1:-1]), edges[2:]))


def test_the_hand_is_fixed_or_random():
    many = straight(200, apart=0.0009)
    for wanted, share in ((1.0, 1.0), (0.0, 0.0), (0.7, 0.7)):
        locks = curled(f"curls = 5\nright_handed = {wanted}", many, points=60)
        right = np.mean([hand(lock).mean() > 0.0 for lock in locks])
        assert right == pytest.approx(share, abs=0.1 if wanted == 0.7 else 0.0)
    by_default = curled("curls = 5", many, points=60, plain=PLAIN.replace("right_handed = 1\n", ""))
    assert 0.4 < np.mean([hand(lock).mean() > 0.0 for lock in by_default]) < 0.6


def test_switchbacks_have_the_requested_frequency():
    many = straight(200, apart=0.0009)
    locks = curled("curls = 12\nwidth = 0.4\nswitchbacks = 1.5", many)
    changes = [np.count_nonzero(np.diff(hand(lock)[5:-5])) for lock in locks]
    assert np.mean(changes) == pytest.approx(1.5, abs=0.4)
    steady = curled("curls = 12\nwidth = 0.4", many)
    assert max(np.count_nonzero(np.diff(hand(lock)[5:-5])) for lock in steady) == 0


def test_a_skip_leaves_out_a_turn():
    many = straight(200, apart=0.0009)
    off = curled("curls = 12\nwidth = 0.4\nskips = 2", many) - many.roots[:, None]
    off[:, 0] = [1.0, 0.0, 0.0]
    angle = np.unwrap(np.arctan2(off[..., 0], off[..., 2]), axis=1) / (2.0 * np.pi)
    missing = 12.0 - np.abs(angle[:, -1] - angle[:, 0])
    assert missing.mean() == pytest.approx(2.0, abs=0.5)  # skips at the ends are clipped, and some overlap
    alone = missing[(missing > 0.9) & (missing < 1.1)]
    assert len(alone) > 20 and np.allclose(alone, 1.0, atol=0.1)


# Phase lock


def test_locked_neighbours_align_phase_and_hand_towards_the_tip():
    guides = straight(9, apart=0.004)
    loose = "curls = 8\nwidth = 1\nphase_spread = 1\nright_handed = 0.5\n"
    alone = curled(loose, guides)
    locked = curled(loose + "phase_groups = { size = 40, length = 4, cohesion = 0 }", guides)

    def agreement(locks, height):
        off = locks - guides.roots[:, None]
        at = [[np.interp(height, lock[:, 1], lock[:, c]) for c in (0, 2)] for lock in off]
        angle = np.arctan2(*np.moveaxis(at, 1, 0))
        return np.abs(np.exp(1j * angle).mean(axis=0)).mean()

    tip, root = np.linspace(0.045, 0.08, 20), np.array([0.001])
    assert agreement(alone, tip) < 0.7
    assert agreement(locked, tip) > 0.999
    assert agreement(locked, root) == pytest.approx(agreement(alone, root), abs=0.02)


def test_cohesion_draws_locked_neighbours_together():
    guides = straight(9, apart=0.004)
    settings = "curls = 8\nwidth = 1\nphase_spread = 1\nphase_groups = {{ size = 40, length = 4, cohesion = {} }}"
    apart, together = (curled(settings.format(cohesion), guides)[:, -1] for cohesion in (0, 1))
    assert np.ptp(apart[:, 0]) > 0.025
    assert np.ptp(together, axis=0).max() < 1e-6


# Length


@pytest.mark.parametrize("how", ["pitch = 0.6", "curls = 12", "curls = 40\nwidth = 2", "pitch = 1\nkink = 1\nwave = 1"])
def test_the_length_is_kept_to_a_thousandth(how):
    guides = straight(20, apart=0.005)
    locks = curled(f"{how}\nkeep = 'length'\nirregularity = 0.4\nswitchbacks = 1", guides, points=480)
    lengths = np.linalg.norm(np.diff(locks, axis=1), axis=2).sum(axis=1)
    assert np.abs(lengths / HEIGHT - 1.0).max() < 1e-3


def test_the_curl_keeps_either_length_or_silhouette():
    silhouette, length = (curled(f"pitch = 0.6\nwidth = 0.5\nkeep = '{keep}'") for keep in ("silhouette", "length"))
    assert np.allclose(np.ptp(silhouette[:, :, 1], axis=1), HEIGHT)
    longer = np.hypot(1.0, np.pi * 0.5 / 0.6)  # length of a helix over its height
    assert np.allclose(np.ptp(length[:, :, 1], axis=1), HEIGHT / longer, rtol=1e-2)
    edges = np.linalg.norm(np.diff(silhouette, axis=1), axis=2)
    assert np.allclose(edges.sum(axis=1), HEIGHT * longer, rtol=0.02)  # edges are chords


def test_a_counted_curl_keeps_its_turns_when_the_length_is_kept():
    assert np.allclose(turns(curled("curls = 6\nwidth = 0.6\nkeep = 'length'")), 6.0, rtol=1e-3)


# Form


def test_flatness_makes_an_ellipse_and_then_a_plane_wave():
    for flatness in (0.0, 0.6, 1.0):
        off = (curled(f"curls = 8\nwidth = 1\nflatness = {flatness}") - straight().roots[:, None])[0][:, [0, 2]]
        sizes = np.ptp((off @ np.linalg.svd(off - off.mean(axis=0))[2].T)[20:], axis=0)
        assert sizes[1] / sizes[0] == pytest.approx(1.0 - flatness, abs=0.03)


def test_a_kinked_curl_is_straight_between_corners_and_flat():
    def bends(settings):
        edges = np.diff(curled(settings)[0], axis=0)
        edges /= np.linalg.norm(edges, axis=1, keepdims=True)
        return np.sort(np.arccos(np.clip(np.sum(edges[1:] * edges[:-1], axis=1), -1.0, 1.0)))

    coil, zigzag = bends("curls = 6\nwidth = 1\nkink = 0"), bends("curls = 6\nwidth = 1\nkink = 1")
    share = zigzag[-60:].sum() / zigzag.sum()  # 12 corners of 5 points
    assert share > 0.9 > coil[-60:].sum() / coil.sum()
    off = (curled("curls = 6\nwidth = 1\nkink = 1") - straight().roots[:, None])[0]
    assert np.linalg.svd(off[:, [0, 2]])[1][1] < 1e-9


def test_the_s_wave_runs_in_a_plane_under_the_curl():
    locks = curled("curls = 1\nwidth = 0\nwave = 1.2\nwave_pitch = 4")
    off = (locks - straight().roots[:, None])[0][:, [0, 2]]
    along = off @ np.linalg.svd(off, full_matrices=False)[2].T
    assert np.ptp(along[:, 0]) == pytest.approx(0.012, rel=1e-2) and np.ptp(along[:, 1]) < 1e-9
    assert np.count_nonzero(np.diff(np.sign(along[2:-2, 0]))) == 3  # two waves of 40 mm in 80 mm


# Continuity and independence

RANGES = {
    "width": (0.2, 2.0),
    "pitch": (0.8, 3.0),
    "start": (0.0, 4.0),
    "end": (0.0, 4.0),
    "taper": (-1.0, 1.0),
    "right_handed": (0.0, 1.0),
    "switchbacks": (0.0, 3.0),
    "skips": (0.0, 3.0),
    "phase": (-180.0, 180.0),
    "phase_spread": (0.0, 1.0),
    "phase_coherence": (0.0, 1.0),
    "irregularity": (0.0, 0.9),
    "flatness": (0.0, 1.0),
    "kink": (0.0, 1.0),
    "wave": (0.0, 3.0),
    "wave_pitch": (2.0, 8.0),
}


@pytest.mark.parametrize("keep", ["silhouette", "length"])
@pytest.mark.parametrize("name", RANGES)
def test_locks_change_continuously_with_every_value(name, keep):
    low, high = RANGES[name]
    settings = {
        "width": 0.8,
        "pitch": 1.5,
        "switchbacks": 1,
        "skips": 1,
        "kink": 0.2,
        "wave": 0.5,
        "phase_coherence": 0.5,
        "keep": f"'{keep}'",
        "phase_groups": "{ size = 4, length = 4 }",
    }
    guides = straight(40, apart=0.0045)

    def at(value):
        text = "\n".join(f"{key} = {setting}" for key, setting in {**settings, name: value}.items())
        return curled(text, guides, points=160, plain="")

    def worst_move(step):
        values = np.linspace(low, high - step, 6)
        return max(np.linalg.norm(at(v + step) - at(v), axis=2).max() for v in values)

    coarse, fine = worst_move(1e-3 * (high - low)), worst_move(1e-5 * (high - low))
    assert fine < 0.1 * coarse + 1e-6  # a jump would not decrease with the step
    assert fine < 3e-4


def test_phases_are_independent_of_the_resampling_of_guides():
    bent = [
        lock + [[0.02 * np.sin(20.0 * y), 0.0, 0.0] for y in lock[:, 1]]
        for lock in map(straight(5, 40).__getitem__, range(5))
    ]
    guides = Curves.from_list(bent, ids=range(5, 10))
    settings = "curls = 6\nwidth = 0.8\nirregularity = 0.4\nphase_spread = 1\nswitchbacks = 1"
    coarse = curled(settings, guides, points=120)
    assert np.linalg.norm(curled(settings, guides, points=239)[:, ::2] - coarse, axis=2).max() < 2e-4
    more = (
        "ringlet = 2\n[guides]\nfile='g.usda'\n[locks]\npoints = 120\nshape_points = {}\n"
        "[collide]\nmargin = 0\n[curl]\n" + settings
    )
    made = [
        make_groom(parse_recipe(more.format(points)), sheet(), drawn_guides=guides).locks.points for points in (30, 60)
    ]
    assert np.linalg.norm(made[0] - made[1], axis=1).max() < 4e-4


def test_adding_a_guide_changes_no_other_lock():
    settings = "curls = 6\nphase_spread = 1\nphase_coherence = 0.5\nswitchbacks = 1\nskips = 1\nirregularity = 0.4"
    few = curled(settings, straight(5))
    more = Curves.from_list(
        [straight(5)[i] for i in range(5)] + [straight(1)[0] + [0.0, 0.0, 0.03]], ids=[5, 6, 7, 8, 9, 77]
    )
    assert np.array_equal(few, curled(settings, more)[:5])


def test_too_few_points_for_the_curls_are_refused_with_the_number_to_set():
    with pytest.raises(UserError, match=r"locks.points is 60: too few for 40.0 curls .* set it to 480"):
        curled("pitch = 0.2", points=60)


def test_locks_get_the_points_that_their_curls_need_where_none_are_given():
    def points(curl):
        recipe = f"ringlet = 2\n[guides]\nfile='g.usda'\n[curl]\n{curl}"
        return int(make_groom(parse_recipe(recipe), sheet(), drawn_guides=straight()).locks.counts.max())

    assert points("curls = 2") == 64 and points("curls = 40") == 12 * 40
    assert points("preset = '4A'\nkeep = 'length'") < points("preset = '4A'")  # of a shape that the curl shortens


def test_too_few_points_for_more_curls_than_points_allow_are_refused_with_the_bound():
    with pytest.raises(UserError, match=r"too few for .* curls .*; must be at most 10000, so ask for fewer than 10 "):
        curled("curls_per_cm = 20", Curves.from_list([10.0 * straight(1)[0]]), points=60)
