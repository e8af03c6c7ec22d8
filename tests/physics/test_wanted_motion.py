"""Locks that move as words say, whatever their length, width and type."""

from pathlib import Path

import numpy as np
import pytest
from ringlet.data.curves import Curves
from ringlet.data.errors import UserError
from ringlet.data.groom import Groom
from ringlet.shot import parse_shot
from ringlet.sim.hanging import hang
from ringlet.sim.shot_strands import make_strands, steps_of, with_words
from ringlet.validate.bounce import SHEET, lock, strongest

from ringlet.rest import check_current, dependencies, solve_rest_shape, to_curves

KINDS = ("2C", "3A", "3B", "3C", "4A")
BDF2 = '[solver]\nintegrator = "bdf2"\nsubsteps = 2\nnewton = 20\ntolerance = 1e-9\n'
EQUILIBRIUM = f"{BDF2}[rest]\nmode = 'equilibrium'\n"
WORDS = "[motion]\nbounce = 3.5\nsettle = 0.8\n"


def shot(more):
    return parse_shot(f'ringlet = 2\ngroom = "groom.usdc"\nframes = [1, 2]\n{more}')


def groom(*kinds):
    """Locks of some types, with roots on a sheet."""
    locks = Curves.from_list([lock(kind).points for kind in kinds])
    locks.curve["root_triangle"] = np.zeros(len(kinds), np.int32)
    locks.curve["root_barycentric"] = np.tile([1.0, 0.0, 0.0], (len(kinds), 1))
    return Groom(locks, locks, SHEET)


def shown(scene, made):
    """The words of a groom in a shot, with the rest shape that it asks for."""
    loft = solve_rest_shape(scene, made) if scene.rest.mode != "none" else None
    strands = make_strands(scene, made, loft and loft.rest, None if loft is None else loft.stiffened)
    strands.place(made.locks.points)
    return hang(strands, made.locks.points, scene.forces.gravity).words(steps_of(scene, made.space.fps))


def test_locks_of_all_types_bounce_and_settle_alike_from_equilibrium():
    words = shown(shot(EQUILIBRIUM + WORDS), groom(*KINDS))
    assert words.bounce == pytest.approx(np.full(5, 3.5), rel=0.02)
    assert words.settle == pytest.approx(np.full(5, 0.8), rel=0.04)
    assert np.abs(words.sag).max() < 2e-3
    own = shown(shot(EQUILIBRIUM), groom(*KINDS)).bounce
    assert own.max() > 3 * own.min()


def test_a_lock_that_is_plucked_in_a_shot_shows_the_words():
    scene, made = shot(EQUILIBRIUM + WORDS), groom("3B")
    strands = make_strands(scene, made, solve_rest_shape(scene, made).rest)
    hanging, steps, weight = made.locks.points, steps_of(scene, made.space.fps), np.array(scene.forces.gravity)
    strands.place(hanging)
    strands.settle(gravity=tuple(1.02 * weight), steps=200)
    strands.place(strands.positions.copy())
    moved = []
    for _ in range(80):
        strands.step(hanging, steps.dt, gravity=scene.forces.gravity, solver=scene.solver)
        moved.append(strands.masses @ (strands.positions - hanging)[:, 1])
    bounce, settle = strongest(np.array(moved[3:]), steps, 3.5)
    assert bounce == pytest.approx(3.5, rel=0.05)
    assert settle == pytest.approx(0.8, rel=0.05)


def test_without_a_rest_shape_words_count_for_the_shape_in_which_locks_sag():
    words = shown(shot(BDF2 + WORDS), groom("3A", "3B", "3C"))
    assert words.bounce == pytest.approx(np.full(3, 3.5), rel=0.01)
    assert words.settle == pytest.approx(np.full(3, 0.8), rel=0.01)
    assert words.sag.min() > 0.1


def test_one_word_leaves_the_other_to_the_material():
    free = shown(shot(BDF2), groom("3C"))
    bounce, settle = (shown(shot(f"{BDF2}[motion]\n{word}\n"), groom("3C")) for word in ("bounce = 4", "settle = 0.5"))
    assert bounce.bounce[0] == pytest.approx(4.0, rel=0.01) and bounce.settle[0] > free.settle[0]
    assert settle.settle[0] == pytest.approx(0.5, rel=0.01)
    assert settle.bounce[0] == pytest.approx(free.bounce[0], rel=0.05)


def test_sag_and_swing_decide_the_stiffness_in_place_of_bounce():
    sag = shown(shot(BDF2 + "[motion]\nsag = 0.1\n"), groom("3A", "3B", "3C"))
    assert sag.sag == pytest.approx(np.full(3, 0.1), rel=0.01)
    swing = shown(shot(BDF2 + "[motion]\nswing = 2.5\nsettle = 0.4\n"), groom("3B", "3C"))
    assert swing.swing == pytest.approx(np.full(2, 2.5), rel=0.02)
    assert swing.settle == pytest.approx(np.full(2, 0.4), rel=0.02)


@pytest.mark.parametrize("rest", ["", "[rest]\nmode = 'equilibrium'\n"])
def test_a_word_of_hair_is_a_part_of_what_each_lock_has_by_itself(rest):
    made, fine = groom("3B", "3C"), f"{BDF2.replace('= 2', '= 16', 1)}{rest}"
    own = shown(shot(fine), made)
    words = shown(shot(f"{fine}[motion]\nbounce = {{ value = 1.2, of_hair = true }}\n"), made)
    assert words.bounce == pytest.approx(1.2 * own.bounce, rel=0.02)
    assert own.bounce[1] > 1.5 * own.bounce[0]


def test_weight_is_mass_without_stiffness():
    made = groom("3B")
    light, heavy = (make_strands(shot(words), made) for words in ("", "[motion]\nweight = 2\n"))
    assert heavy.masses == pytest.approx(2.0 * light.masses)
    for one, other in zip(heavy.stiffness, light.stiffness, strict=True):
        assert one == pytest.approx(other)
    hung = shown(shot(f"{BDF2}[motion]\nweight = 2\n"), made), shown(shot(BDF2), made)
    assert hung[0].sag > 1.4 * hung[1].sag and hung[0].bounce < hung[1].bounce
    asked = shown(shot(f"{BDF2}[motion]\nweight = 2\nbounce = 5\n"), made)
    assert asked.bounce == pytest.approx([5.0], rel=0.01)


def test_beads_weigh_at_the_tip():
    beads = "[motion]\nweight = { value = 1, ramp = [[0, 1], [0.9, 1], [1, 10]] }\n"
    plain, beaded = (make_strands(shot(words), groom("3B")).masses for words in ("", beads))
    middle = len(plain) // 2
    assert beaded[:middle] == pytest.approx(plain[:middle]) and beaded[-1] > 5 * plain[-1]
    with pytest.raises(UserError, match=r"motion.weight is .* on lock 0; must be at least 0.01"):
        make_strands(shot("[motion]\nweight = { ramp = [[0, 1], [1, 0]] }\n"), groom("3B"))


def test_air_settles_a_bounce():
    calm, thick = (shown(shot(f"{BDF2}[motion]\nair = {air}\n"), groom("3B")).settle for air in (0, 20))
    assert thick < 0.6 * calm
    single = "[motion]\nair = { value = 0, lock = { 1 = 20 } }\n"
    assert shown(shot(BDF2 + single), groom("3B", "3B")).settle == pytest.approx([*calm, *thick], rel=1e-6)


@pytest.mark.parametrize(("preset", "kind"), [("tight_springs", "3C"), ("loose_ringlets", "3B"), ("heavy_wet", "3B"),
    ("light_frizz", "4A"), ("stiff_braids", "3A"), ("locs", "3A"), ("afro", "4A")])  # fmt: skip
def test_locks_show_the_character_of_a_preset(preset, kind):
    scene = shot(f"{BDF2.replace('= 2', '= 8', 1)}[motion]\npreset = '{preset}'\n")
    made = with_words(scene, groom(kind))
    words = shown(scene, groom(kind))
    assert scene.motion.given
    for name in scene.motion.given:
        assert getattr(words, name) == pytest.approx(made.locks.curve[f"asked_{name}"], rel=0.05)


def test_what_is_given_counts_before_the_preset():
    given = shot("[motion]\npreset = 'afro'\nweight = 2\nswing = 2\n").motion
    assert (given.weight.value, given.settle.value, given.given) == (2.0, 0.3, ("swing", "settle"))
    with pytest.raises(UserError, match="swing by its preset locs, which is given"):
        shot("[strands]\nbend_scale = 2\n[motion]\npreset = 'locs'\n")


def test_words_differ_from_lock_to_lock_by_chance_and_by_id():
    made = groom("3B", "3B", "3B")
    varied = f"[motion]\nbounce = {{ value = 4, vary = 0.3, lock = {{ {made.locks.ids[2]} = 5 }} }}\n"
    words = shown(shot(EQUILIBRIUM + varied), made)
    assert 2.8 < words.bounce[0] < 5.2 and abs(words.bounce[0] - words.bounce[1]) > 0.05
    assert words.bounce[2] == pytest.approx(5.0, rel=0.02)


def test_locks_that_cannot_move_as_asked_keep_their_material():
    made = with_words(shot(EQUILIBRIUM + "[motion]\nbounce = 1.5\n"), groom("2A"))
    assert made.locks.curve["wanted_bend"].tolist() == made.locks.curve["wanted_damping"].tolist() == [1.0]


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("[strands]\nbend_scale = 2\n[motion]\nbounce = 3\n", "bounce, which is given instead of strands.bend_scale"),
        ("[strands]\ndamping = 1\n[motion]\nsettle = 3\n", "settle, which is given instead of strands.damping"),
        ("[strands]\nbend_scale = 2\n[motion]\nsag = 0.1\n", "sag, which is given instead of strands.bend_scale"),
        ("[motion]\nbounce = 3\nsag = 0.1\n", "motion.sag is 0.1, but bounce is 3, and both say how stiff"),
        ("[motion]\nsag = 0.1\nswing = 2\n", "motion.swing is 2, but sag is 0.1, and both say how stiff"),
        ("[motion]\nsag = 0.1\n[rest]\nmode = 'equilibrium'\n", "hang as groomed, but motion.sag is 0.1; take that"),
    ],
)
def test_words_that_contradict_are_refused(text, part):
    with pytest.raises(UserError, match=part):
        shot(text)


@pytest.mark.parametrize(
    "words", ["[motion]\nbounce = 11\nsettle = 1\n", "[strands]\ndamping = 1e-4\n[motion]\nbounce = 11\n"]
)
def test_words_that_the_steps_cannot_show_are_refused_with_steps_that_can(words):
    with pytest.raises(UserError, match="settles it in 0 s at most") as refused:
        with_words(shot(words), groom("3B"))
    substeps = int(str(refused.value).rpartition(" = ")[2])
    better = f'[solver]\nintegrator = "bdf2"\nsubsteps = {substeps}\n{words}'
    assert shown(shot(better), groom("3B")).bounce[0] == pytest.approx(11.0, rel=0.05)


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_locks_that_air_keeps_from_swinging_are_left_without_a_word():
    """Their own swing is 0, and so is what is asked as a factor on it."""
    scene = shot(f"{EQUILIBRIUM}[strands]\ndrag = 0.1\n[motion]\nswing = {{ value = 1.3, of_hair = true }}\n")
    locks = with_words(scene, groom("2C", "3B")).locks
    assert (locks.curve["asked_swing"] == 0.0).all()


def test_locks_without_a_word_of_hair_get_a_rest_shape():
    """Straight hair that stands falls over by its own stiffness, so that it has no swing to be a factor on."""
    standing = groom("2C", "3B")
    rows = standing.locks.offsets[:2]
    standing.locks.points[slice(*rows)] *= [1.0, -1.0, 1.0]
    scene = shot(f"{EQUILIBRIUM}[strands]\nyoungs_modulus = 1e9\n[motion]\nswing = {{ value = 1.3, of_hair = true }}\n")
    asked = with_words(scene, standing).locks.curve["asked_swing"]
    assert np.isnan(asked[0]) and asked[1] > 0.0
    assert np.isfinite(solve_rest_shape(scene, standing).rest.points).all()


def test_a_rest_shape_is_stale_once_the_words_change():
    scene, made = shot(EQUILIBRIUM + WORDS), groom("3B")
    stored, of = to_curves(solve_rest_shape(scene, made), scene), dependencies(scene)
    assert check_current(stored, of, scene, made, Path("rest"), allow_stale=False) is stored
    for other in (
        EQUILIBRIUM + WORDS.replace("3.5", "3"),
        EQUILIBRIUM,
        (EQUILIBRIUM + WORDS).replace("= 2\nn", "= 3\nn"),
        EQUILIBRIUM + WORDS.replace("3.5", "{ value = 3.5, of_hair = true }"),
        f"{EQUILIBRIUM}{WORDS}weight = 1.5\n",
        f"{EQUILIBRIUM}{WORDS}air = 2\n",
    ):
        with pytest.raises(UserError, match="stale"):
            check_current(stored, dependencies(scene), shot(other), made, Path("rest"), allow_stale=False)
