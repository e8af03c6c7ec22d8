"""Ties: hair sleek on the head up to the band, and tails, puffs and buns after it."""

import numpy as np
import pytest
from ringlet.groom.coil import Coil, on_scalp
from ringlet.groom.operators.tied import TO_TIE
from ringlet.groom.scalp import Scalp
from shapes import ball, rotation
from small_example import FRAMES
from wear import sim

from ringlet import UserError, build_groom, io, read_groom, write_groom, write_hairs
from ringlet.groom import make_groom, parse_recipe

TOP = "toward = [0, 1, 0]\noff = 0.6\nradius = 1\n"
CURL = "[curl]\nwidth = 0.5\npitch = 1\n"
SECTIONS = "[locks.sections]\npattern = 'rows'\nsize = 40\ngap = 0.3\n"


def tied(settings, more="", sections="", count=400, points=260, head="op = 'tie'\n", scalp=None):
    """A groom with a tie on the upper half of a ball of 9 cm."""
    text = f"""
ringlet = 2
[scalp]
region = 'scalp'
[curves.tail]
points = [[0, 10, 0], [0, 12, 0], [6, 13, 0]]
[guides]
count = 30
length = 12
[locks]
count = {count}
points = {points}
{sections}
[[shape]]
{head}{settings}
{more}
[collide]
margin = 0
"""
    return make_groom(parse_recipe(text), scalp or ball())


def bands(made):
    return [accessory.mesh for accessory in made.accessories]


def grid(locks):
    return locks.points.reshape(len(locks), -1, 3)


def arc(points):
    return np.concatenate(
        [np.zeros((len(points), 1)), np.cumsum(np.linalg.norm(np.diff(points, axis=1), axis=2), axis=1)], axis=1
    )


def test_a_curled_puff_is_round():
    locks = tied(TOP + "after = 'ball'\nwidth = 12", CURL, count=900).locks
    points = grid(locks)[arc(grid(locks)) > locks.curve[TO_TIE][:, None]]
    centre = np.array([0.0, 0.096 + 0.85 * 0.06, 0.0])
    offset = points - centre
    distance = np.linalg.norm(offset, axis=1)
    k = np.arange(200)
    height, turn = 1.0 - 1.7 * (k + 0.5) / 200, k * np.pi * (3.0 - np.sqrt(5.0))  # but for the part around the tie
    way = np.stack([np.sqrt(1 - height**2) * np.cos(turn), height, np.sqrt(1 - height**2) * np.sin(turn)], axis=1)
    near = (offset @ way.T) / distance[:, None] > np.cos(np.radians(12))
    envelope = np.where(near, distance[:, None], 0.0).max(axis=0)
    assert envelope.mean() == pytest.approx(0.06, rel=0.02)
    assert envelope.std() < 0.025 * envelope.mean() and np.ptp(envelope) < 0.12 * envelope.mean()


@pytest.mark.parametrize("after", ["tail", "ball"])
def test_curls_begin_at_the_tie_and_hair_before_it_is_as_it_was_led(after):
    settings = TOP + f"after = '{after}'\nwidth = 12"
    plain, curled = (tied(settings, more, count=60, points=400) for more in ("", CURL))
    length = plain.locks.curve[TO_TIE]
    ends = arc(grid(plain.locks))[:, -1]
    assert (length < 0.16).all()
    for a, b, tie, end in zip(grid(plain.locks), grid(curled.locks), length, ends, strict=True):
        if end < tie + 0.03:  # too short for its tie
            continue
        apart = np.linalg.norm(b[:, None] - a[None], axis=2).min(axis=1)
        before = arc(b[None])[0] < tie - 0.003
        assert apart[before].max() < 5e-4 and apart[~before].max() > 0.001


def test_hair_lies_on_the_skin_up_to_the_tie_and_never_under_it():
    groom = tied(TOP + "after = 'ball'\nwidth = 12\nrise = 0.5")
    scalp = Scalp(ball(), "scalp")
    points = grid(groom.locks)
    above = np.asarray(scalp.solid.above(np.ascontiguousarray(points.reshape(-1, 3)))[0]).reshape(points.shape[:2])
    before = arc(points) < groom.locks.curve[TO_TIE][:, None] - 0.02
    assert above.min() > -1e-4 and above[before].max() < 0.0075


def test_each_section_has_its_tie_and_band():
    groom = tied(
        "each = 'section'\ntoward = [0, 0.5, 0]\nafter = 'ball'\nwidth = 8\nradius = 1\nband = 0.4", sections=SECTIONS
    )
    assert len(groom.accessories) == 2
    points, along = grid(groom.locks), arc(grid(groom.locks))
    centres = np.array([band.points.mean(axis=0) for band in bands(groom)])
    assert centres[0, 0] * centres[1, 0] < 0.0  # one on each side
    for lock, run, length in zip(points, along, groom.locks.curve[TO_TIE], strict=True):
        place = lock[np.abs(run - length).argmin()]
        own = centres[np.sign(centres[:, 0]) == np.sign(lock[0, 0])][0]
        assert np.linalg.norm(place - own) < 0.0115  # in the band


def test_a_band_is_a_closed_body_around_the_hair_that_a_shot_can_name(tmp_path):
    groom = tied(TOP + "after = 'ball'\nwidth = 12\nband = 0.4")
    write_groom(groom, tmp_path / "puff.usdc")
    (band,) = io.read_bodies(tmp_path / "puff.usdc", "/groom/accessories")
    edges = np.sort(np.concatenate([band.mesh.triangles[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    a, b, c = (band.mesh.points[band.mesh.triangles[:, k]] for k in range(3))
    assert np.sum(a * np.cross(b, c)) > 0.0  # faces look outwards
    np.testing.assert_allclose(np.linalg.norm(band.mesh.points[:, [0, 2]], axis=1).min(), 0.01, rtol=0.01)
    assert np.array_equal(read_groom(tmp_path / "puff.usdc").locks.curve[TO_TIE], groom.locks.curve[TO_TIE])


@pytest.mark.parametrize("toward", ["[0, 1, 0]", "[1, 0.3, 0.2]"])
def test_a_band_has_two_beads_side_by_side_on_its_upper_side(toward):
    settings = "after = 'tail'\nband = 0.4\nbead = 1.8\ncolors = ['#ff0000', '#00ff00']"
    band, *beads = bands(tied(TOP.replace("[0, 1, 0]", toward) + settings))
    centre, middles = band.points.mean(axis=0), [bead.points.mean(axis=0) for bead in beads]
    assert len(beads) == 2 and band.color == beads[0].color == beads[1].color
    assert np.linalg.norm(middles[1] - middles[0]) == pytest.approx(0.018, rel=1e-6)  # they touch
    for bead, middle in zip(beads, middles, strict=True):
        assert np.linalg.norm(middle - centre) == pytest.approx(0.01 + 0.004 + 0.009, rel=1e-6)
        assert np.linalg.norm(bead.points - middle, axis=1).max() == pytest.approx(0.009, rel=1e-6)
        a, b, c = (bead.points[bead.triangles[:, k]] - middle for k in range(3))
        assert np.sum(a * np.cross(b, c)) > 0.0  # faces look outwards
    assert np.mean(middles, axis=0)[1] > centre[1] - 1e-5  # level at the crown


def test_a_bun_is_wound_without_overlap_and_its_ends_are_in_it():
    groom = tied(TOP + "after = 'bun'\nwidth = 7\nheight = 4\nwindings = 2.2\nband = 0.4", count=120)
    points = grid(groom.locks)
    coil = Coil.fitted(0.07, 0.04, 2.2)
    centre = bands(groom)[0].points.mean(axis=0)
    axis = np.linalg.svd(bands(groom)[0].points - centre)[2][2]
    axis *= np.sign(axis[1])
    rope = on_scalp(coil.path(), centre, axis, Scalp(ball(), "scalp"))
    along = arc(rope[None])[0]
    distance = np.linalg.norm(rope[:, None] - rope[None], axis=2)
    windings = np.abs(along[:, None] - along[None]) > np.pi * coil.rope
    assert np.where(windings, distance, np.inf).min() > 0.93 * 2.0 * coil.rope
    in_bun = points[arc(points) > arc(points)[:, -1:] - 0.6 * along[-1]]
    assert np.linalg.norm(in_bun[:, None] - rope[None, ::2], axis=2).min(axis=1).max() < 1.03 * coil.rope
    away = np.linalg.norm(np.cross(in_bun - centre, axis), axis=1)
    assert 2.0 * away.max() == pytest.approx(0.07, rel=0.06)
    assert np.linalg.norm(points, axis=2).max() - 0.09 == pytest.approx(0.04, rel=0.15)
    tips = np.linalg.norm(np.cross(points[:, -1] - centre, axis), axis=1)
    assert tips.max() < away.max() - 0.8 * coil.rope  # in the middle of the last winding


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ("", "has no place for the tie; give it a curve, toward, or each = 'section'"),
        ("curve = 'tail'\ntoward = [0, 1, 0]", "has a curve and also toward or each = 'section'; give one of them"),
        ("each = 'section'", "tie.each is 'section', but there are none; add [locks.sections]"),
        ("curve = 'tial'", "tie.curve is 'tial', which is no helper curve; did you mean 'tail'"),
    ],
)
def test_a_tie_without_a_place_is_refused(settings, message):
    with pytest.raises(UserError) as refused:
        tied(settings)
    assert message in str(refused.value)


TIED = """
[[shape]]
op = "tie"
toward = [0, 1, 0]
radius = 1
band = 0.4
[curl]"""


def tied_example(folder):
    recipe = folder / "small.recipe.toml"
    recipe.write_text(recipe.read_text().replace("[curl]", TIED).replace("points = 40", "points = 120"))
    write_groom(build_groom(recipe), folder / "groom.usdc")
    return folder


def test_the_band_of_a_tie_follows_the_head(copy):
    result = sim(tied_example(copy))
    assert result.exit_code == 0, result.output
    assert io.problems(copy / "cache.usdc") == []
    write_hairs(copy / "groom.usdc", copy / "hair.usdc", cache=copy / "cache.usdc")
    (rest,) = read_groom(copy / "groom.usdc").accessories
    for frame in (1, FRAMES):
        bodies, _, _ = io.read_stage(copy / "hair.usdc", frame)
        (band,) = [body for body in bodies if body.prim == "/groom/accessories/tie_0"]
        turn = rotation((0, 1, 0), 5.0 * (frame - 1))  # as the head does
        np.testing.assert_allclose(band.clip.at(frame), rest.mesh.points @ turn.T, atol=2e-6)


def test_a_band_that_a_shot_makes_cloth_is_there_once(copy):
    shot = copy / "small.shot.toml"
    cloth = '[contact]\n[[cloth]]\nfile = "groom.usdc"\nmesh = "/groom/accessories/tie_0"\n[[cloth.pin]]\nto = "skin"\n'
    shot.write_text(shot.read_text() + cloth)
    result = sim(tied_example(copy))
    assert result.exit_code == 0, result.output
    bodies = [body.prim for body in io.read_bodies(copy / "cache.usdc")]
    assert [prim for prim in bodies if "tie" in prim] == ["/groom/accessories/tie_0"]


def test_ties_have_values_of_their_own():
    settings = "each = 'section'\ntoward = [0, 0.5, 0]\nafter = 'tail'\nband = 0.4\noff = 2\n"
    plain = tied(settings, sections=SECTIONS)
    first, second = np.unique(plain.locks.curve["section"])
    own = f"off = {{ value = 2, lock = {{ {second} = 5 }} }}\nradius = {{ value = 1, lock = {{ {first} = 2 }} }}"
    varied = tied(settings.replace("off = 2", own), sections=SECTIONS)
    before, after = (np.array([band.points.mean(axis=0) for band in bands(made)]) for made in (plain, varied))
    assert np.linalg.norm(after - before, axis=1) == pytest.approx([0.0, 0.03], abs=1e-3)
    sizes = [np.linalg.norm(band.points - band.points.mean(axis=0), axis=1).max() for band in bands(varied)]
    assert sizes == pytest.approx([0.024, 0.014], abs=1e-3)


def test_the_rise_of_locks_goes_by_maps_and_ramps():
    scalp = ball()
    scalp.maps["right"] = (scalp.points[scalp.triangles][:, :, 0] > 0.0).astype(np.float64)

    def heights(ramp):
        locks = tied(f"{TOP}rise = {{ value = 2, map = 'right', ramp = {ramp} }}", scalp=scalp).locks
        above = Scalp(scalp, "scalp").solid.above(np.ascontiguousarray(locks.points, np.float64))[0]
        on_head = arc(grid(locks)) < locks.curve[TO_TIE][:, None] - 0.03
        highest = np.where(on_head, np.asarray(above).reshape(on_head.shape), 0.0).max(axis=1)
        return [highest[side].max() for side in (locks.roots[:, 0] > 0.01, locks.roots[:, 0] < -0.01)]

    right, left = heights("[[0, 1], [1, 1]]")
    assert right > 0.014 and left < 0.004
    assert max(heights("[[0, 0], [1, 0]]")) < 0.004


def test_the_spread_of_a_tail_has_a_ramp():
    made = [
        tied(f"{TOP}flare = {{ value = 4, ramp = {ramp} }}").locks for ramp in ("[[0, 1], [1, 1]]", "[[0, 0], [1, 1]]")
    ]
    apart = []
    for locks in made:
        past = np.abs(arc(grid(locks)) - locks.curve[TO_TIE][:, None] - 0.02).argmin(axis=1)
        places = grid(locks)[np.arange(len(locks)), past][locks.lengths() > 0.1]
        apart.append(np.linalg.norm(places - places.mean(axis=0), axis=1).mean())
    assert apart[0] > 1.3 * apart[1]


def test_a_tail_that_splays_falls_to_all_sides_as_a_fountain():
    """Outermost locks leave the tie level and fall; those in its middle rise along its axis first."""
    tips = {}
    for splay in (0, 90):
        settings = f"{TOP}after = 'tail'\nflare = 1\nfall = 8\nsplay = {splay}\n"
        locks = tied(settings).locks
        tips[splay] = grid(locks)[:, -1] - [0.0, 0.096, 0.0]
    along, out = (np.linalg.norm(tips[splay][:, [0, 2]], axis=1) for splay in (0, 90))
    assert np.percentile(out, 90) > 2.0 * np.percentile(along, 90)
    side = np.arctan2(tips[90][:, 0], tips[90][:, 2])[out > 0.02]
    assert out.max() > 0.03 and np.histogram(side, 4, (-np.pi, np.pi))[0].min() > 0.15 * len(side)
